#include "montecarlo/engine/mpi/serializer.hpp"

#include <cassert>
#include <utility>

namespace wingspread {
namespace {

/// Means that the column peaks_final does not exist.
constexpr signed char no_finality = -1;

void put_row(Serializer& packer, const ResultRow& row) {
  packer.put(row.status);
  packer.put(row.peaks_final ? static_cast<signed char>(*row.peaks_final) : no_finality);
  packer.put(row.draws);
  packer.put(row.outputs);
  packer.put(row.latch_order);
  packer.put(row.reason);
}

} // namespace

void Serializer::put(const Batch& batch) {
  put(batch.rows.size());
  for (const ResultRow& row : batch.rows) put_row(*this, row);
  put(batch.csv);
}

std::string_view Deserializer::take_bytes(std::size_t count) {
  assert(count <= bytes_.size());
  const std::string_view taken = bytes_.substr(0, count);
  bytes_.remove_prefix(count);
  return taken;
}

std::vector<double> Deserializer::take_numbers() {
  std::vector<double> values(take<std::size_t>());
  const std::string_view bytes = take_bytes(values.size() * sizeof(double));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

ResultRow Deserializer::take_row(long run) {
  ResultRow row;
  row.run = run;
  row.status = take<Status>();
  const auto finality = take<signed char>();
  if (finality != no_finality) row.peaks_final = static_cast<PeaksFinal>(finality);
  row.draws = take_numbers();
  row.outputs = take_numbers();
  row.latch_order = take_text();
  row.reason = take_text();
  return row;
}

Batch Deserializer::take_batch(long first) {
  Batch batch;
  const auto rows = take<std::size_t>();
  batch.rows.reserve(rows);
  for (std::size_t i = 0; i < rows; ++i)
    batch.rows.push_back(take_row(first + static_cast<long>(i)));
  batch.csv = take_text();
  return batch;
}

} // namespace wingspread
