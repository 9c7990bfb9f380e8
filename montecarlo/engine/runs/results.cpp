#include "montecarlo/engine/runs/results.hpp"

#include "montecarlo/engine/runs/row_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <iterator>

namespace wingspread {

std::vector<std::string> header_cells(const ResultNames& names) {
  std::vector<std::string> cells{"run", "status"};
  std::ranges::copy(names.draws, std::back_inserter(cells));
  std::ranges::copy(names.outputs, std::back_inserter(cells));
  if (names.peaks_final) cells.emplace_back(peaks_final_column);
  cells.insert(cells.end(), {"latch_order", "reason"});
  return cells;
}

Results::Results(const ResultNames& names) : has_peaks_final(names.peaks_final) {
  const auto empty = [](const std::string& name) { return Column{name, {}}; };
  std::ranges::transform(names.draws, std::back_inserter(draws), empty);
  std::ranges::transform(names.outputs, std::back_inserter(outputs), empty);
}

void Results::append(const ResultRow& row) {
  assert(row.draws.size() == draws.size() && row.outputs.size() == outputs.size());
  runs.push_back(row.run);
  status.push_back(row.status);
  for (std::size_t i = 0; i < draws.size(); ++i) draws[i].values.push_back(row.draws[i]);
  for (std::size_t i = 0; i < outputs.size(); ++i) outputs[i].values.push_back(row.outputs[i]);
  peaks_final.push_back(row.peaks_final.value_or(PeaksFinal::unknown));
  latch_order.push_back(row.latch_order);
  reason.push_back(row.reason);
}

ResultRow Results::row(std::size_t index) const {
  ResultRow row{runs[index],
                status[index],
                {},
                {},
                std::string(latch_order[index]),
                std::string(reason[index])};
  if (has_peaks_final) row.peaks_final = peaks_final[index];
  const auto value = [index](const Column& column) { return column.values[index]; };
  std::ranges::transform(draws, std::back_inserter(row.draws), value);
  std::ranges::transform(outputs, std::back_inserter(row.outputs), value);
  return row;
}

void Results::release() const {
  runs.release();
  status.release();
  for (const auto* columns : {&draws, &outputs})
    for (const Column& column : *columns) column.values.release();
  peaks_final.release();
  latch_order.release();
  reason.release();
}

long count_cut(const Results& results, std::string_view output) {
  const PeakKind kind = peak_kind(output);
  if (kind == PeakKind::none) return 0;
  long cut = 0;
  for (const PeaksFinal final : results.peaks_final) cut += is_cut(kind, final) ? 1 : 0;
  results.peaks_final.release();
  return cut;
}

long count_open_latches(const Results& results) {
  long open = 0;
  for (std::size_t row = 0; row < results.size(); ++row) open += results.may_let_go(row) ? 1 : 0;
  results.status.release();
  results.reason.release();
  return open;
}

void append_header(std::string& buffer, const ResultNames& names) {
  for (const char* separator = ""; const std::string& name : header_cells(names)) {
    buffer += separator;
    append_csv_cell(buffer, name);
    separator = ",";
  }
  buffer += '\n';
}

void append_row(std::string& buffer, const ResultRow& row) {
  buffer += fmt::format_int(row.run).c_str();
  buffer += ',';
  buffer += to_string(row.status);
  for (const auto* numbers : {&row.draws, &row.outputs})
    for (const double number : *numbers) append_csv_cells(buffer, number);
  if (row.peaks_final) append_csv_cells(buffer, to_string(*row.peaks_final));
  append_csv_cells(buffer, row.latch_order, row.reason);
  buffer += '\n';
}

ResultsFile read_results(std::istream& in, const std::string& file, const ResultNames& names,
                         UnterminatedRow last) {
  ResultsFile read{Results(names), 0, false};
  RowReader reader(in, file, names, last);
  while (reader.next()) read.results.append(reader.row());
  read.complete_bytes = reader.complete_bytes();
  read.unterminated = reader.unterminated();
  return read;
}

} // namespace wingspread
