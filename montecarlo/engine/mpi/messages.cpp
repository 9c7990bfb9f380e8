#include "montecarlo/engine/mpi/messages.hpp"

#include <utility>

namespace wingspread {
namespace {

void put_samples(Serializer& packer, const SampledColumns& samples) {
  packer.put(samples.columns.size());
  for (const std::size_t column : samples.columns) packer.put(column);
  packer.put(samples.interval);
  packer.put(samples.t_end);
}

SampledColumns take_samples(Deserializer& message) {
  SampledColumns samples;
  samples.columns.resize(message.take<std::size_t>());
  for (std::size_t& column : samples.columns) column = message.take<std::size_t>();
  samples.interval = message.take<double>();
  samples.t_end = message.take<double>();
  return samples;
}

} // namespace

std::string bare_message(MessageKind kind) {
  Serializer packer;
  packer.put(kind);
  return packer.take();
}

std::string open_message(const PlanDescription& description) {
  Serializer packer;
  packer.put(MessageKind::open);
  packer.put(description.campaign);
  packer.put(description.recipe);
  packer.put(description.samples.has_value());
  if (description.samples) put_samples(packer, *description.samples);
  packer.put(description.own_points);
  packer.put(description.wants_csv);
  packer.put(description.threads);
  packer.put(description.set);
  return packer.take();
}

PlanDescription read_description(Deserializer& message) {
  PlanDescription description;
  description.campaign = message.take_text();
  description.recipe = message.take_text();
  if (message.take<bool>()) description.samples = take_samples(message);
  description.own_points = message.take<bool>();
  description.wants_csv = message.take<bool>();
  description.threads = message.take<int>();
  description.set = message.take<InstructionSet>();
  return description;
}

std::string chunk_message(const Chunk& chunk, const RunPlan& plan) {
  Serializer packer;
  packer.put(MessageKind::chunk);
  packer.put(chunk);
  if (plan.has_own_points()) {
    std::vector<Tails> point(plan.coordinates().names.size());
    for (long run = chunk.runs.first; run < chunk.runs.last; ++run) {
      plan.place(run, point);
      for (const Tails& u : point) packer.put(u);
    }
  }
  return packer.take();
}

Chunk read_chunk(Deserializer& message) { return message.take<Chunk>(); }

std::vector<Tails> read_points(Deserializer& message, long runs, std::size_t coordinates) {
  std::vector<Tails> points(static_cast<std::size_t>(runs) * coordinates);
  for (Tails& u : points) u = message.take<Tails>();
  return points;
}

std::string report_message(const Report& report) {
  Serializer packer;
  packer.put(MessageKind::report);
  packer.put(report.wanted);
  packer.put(report.stopped);
  packer.put(report.finished.size());
  for (const FinishedChunk& finished : report.finished) {
    packer.put(finished.chunk);
    packer.put(finished.complete);
    packer.put(finished.batch);
  }
  return packer.take();
}

Report read_report(Deserializer& message) {
  Report report;
  report.wanted = message.take<long>();
  report.stopped = message.take<bool>();
  report.finished.resize(message.take<std::size_t>());
  for (FinishedChunk& finished : report.finished) {
    finished.chunk = message.take<Chunk>();
    finished.complete = message.take<bool>();
    finished.batch = message.take_batch(finished.chunk.runs.first);
  }
  return report;
}

std::string closed_message(const Closing& closing) {
  Serializer packer;
  packer.put(MessageKind::closed);
  packer.put(closing.occupancy);
  packer.put(closing.failure);
  return packer.take();
}

Closing read_closing(Deserializer& message) {
  Closing closing;
  closing.occupancy = message.take<Occupancy>();
  closing.failure = message.take_text();
  return closing;
}

} // namespace wingspread
