#include "montecarlo/results/results_folder/replay.hpp"

#include "montecarlo/engine/runs/row_reader.hpp"
#include "montecarlo/foundation/formats/csv.hpp"
#include "montecarlo/foundation/formats/input_file.hpp"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cmath>

namespace wingspread {
namespace {

/// Whether two numbers are equal, or both missing.
bool same(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

std::string shown(double value) { return std::isnan(value) ? "nothing" : csv_cell(value); }

/// The start of a row at or shortly before the run, found by bisection, because run numbers increase. The end of the
/// header if bisection fails.
std::size_t place_before(InputFile& in, long run, std::size_t header_bytes) {
  constexpr std::size_t near = 1 << 16; // so few bytes are read faster than bisected
  std::size_t first = header_bytes, last = in.size();
  std::string line;
  while (last - first > near) {
    const std::size_t middle = first + (last - first) / 2;
    in.seek(middle);
    if (!std::getline(in, line)) return header_bytes; // the rest of a row
    const std::size_t row = middle + line.size() + 1;
    long there = -1;
    if (!std::getline(in, line)) return header_bytes;
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), there);
    if (error != std::errc{} || end == line.data() + line.size() || *end != ',')
      return header_bytes;
    if (there <= run && row < last)
      first = row;
    else
      last = middle;
  }
  return first;
}

/// The run's row, if the reader reaches one.
std::optional<ResultRow> find_row(RowReader& reader, long run) {
  while (reader.next())
    if (reader.row().run >= run)
      return reader.row().run == run ? std::optional(reader.row()) : std::nullopt;
  return std::nullopt;
}

} // namespace

std::vector<std::string> differences(const ResultNames& names, const ResultRow& recorded,
                                     const ResultRow& computed) {
  std::vector<std::string> lines;
  const auto differ = [&](std::string_view column, const std::string& there,
                          const std::string& here) {
    lines.push_back(fmt::format("run {}, column {}: recorded as {}, computed as {}", computed.run,
                                column, there, here));
  };
  const auto compare = [&](const std::vector<std::string>& columns,
                           const std::vector<double>& there, const std::vector<double>& here) {
    for (std::size_t i = 0; i < columns.size(); ++i)
      if (!same(there[i], here[i])) differ(columns[i], shown(there[i]), shown(here[i]));
  };
  const auto compare_text = [&](const char* column, const std::string& there,
                                const std::string& here) {
    if (there != here) differ(column, '"' + there + '"', '"' + here + '"');
  };
  compare_text("status", to_string(recorded.status), to_string(computed.status));
  compare(names.draws, recorded.draws, computed.draws);
  compare(names.outputs, recorded.outputs, computed.outputs);
  const auto final_text = [](const ResultRow& row) {
    return std::string(to_string(row.peaks_final.value_or(PeaksFinal::unknown)));
  };
  compare_text("peaks_final", final_text(recorded), final_text(computed));
  compare_text("latch_order", recorded.latch_order, computed.latch_order);
  compare_text("reason", recorded.reason, computed.reason);
  return lines;
}

std::optional<ResultRow> find_stored_row(const StoredCampaign& stored, long run) {
  const std::filesystem::path path = stored.folder / rows_file(stored.folder);
  if (!std::filesystem::exists(path)) return std::nullopt;
  const ResultNames names = RunPlan(stored.campaign).names();
  try {
    InputFile in(path);
    RowReader reader(in, path.string(), names, UnterminatedRow::drop);
    in.seek(place_before(in, run, reader.complete_bytes()));
    return find_row(reader, run);
  } catch (const SpecError&) { // reads again from the beginning, so that the error names the line
    InputFile in(path);
    RowReader reader(in, path.string(), names, UnterminatedRow::drop);
    return find_row(reader, run);
  }
}

void refuse_other_row(const RunPlan& plan, const ResultRow& recorded,
                      const std::filesystem::path& file) {
  std::vector<Problem> problems;
  for (std::string& difference :
       differences(plan.names(), recorded, Runner(plan).run(recorded.run)))
    problems.push_back({file.string(), "", std::move(difference),
                        "the same: all rows made by one program on one kind "
                        "of machine"});
  if (!problems.empty()) throw SpecError(std::move(problems));
}

void refuse_other_rows(const RunPlan& plan, const Results& results,
                       const std::filesystem::path& file) {
  if (results.size() > 0) refuse_other_row(plan, results.row(results.size() - 1), file);
}

ReplayRequest::ReplayRequest(const StoredCampaign& stored, long run) : stored_(&stored), run_(run) {
  const long runs = stored.campaign.sampling.runs;
  if (run < 0 || run >= runs)
    throw SpecError({{stored.folder.string(), "", fmt::format("no run {}", run),
                      fmt::format("a run from 0 to {}", runs - 1)}});
  recorded_ = find_stored_row(stored, run);
}

Scene ReplayRequest::applied_scene() const {
  const Campaign& campaign = stored_->campaign;
  std::vector<double> draws(campaign.dispersions.size());
  RunPlan(campaign).draw(run_, draws);
  return scene_with(campaign, draws);
}

Replayed ReplayRequest::replay(const Observer& observer, double interval) const {
  const RunPlan plan(stored_->campaign);
  auto [outcome, row, scene] = Runner(plan).replay(run_, observer, interval);
  Replayed replayed{std::move(outcome),
                    std::move(row),
                    std::move(scene),
                    plan.names(),
                    rows_file(stored_->folder),
                    recorded_.has_value(),
                    {}};
  if (recorded_) replayed.differences = differences(plan.names(), *recorded_, replayed.row);
  return replayed;
}

} // namespace wingspread
