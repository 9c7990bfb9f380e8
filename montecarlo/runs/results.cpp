#include "montecarlo/runs/results.hpp"

#include "montecarlo/formats/number_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <limits>
#include <optional>

namespace wingspread {

namespace {

/// Where each column of the table stands in the file's rows.
struct Places {
  std::size_t run, status, latch_order;
  std::optional<std::size_t> reason;
  std::vector<std::size_t> draws, outputs;
  std::size_t count;
};

std::vector<std::string> header_cells(const ResultNames& names) {
  std::vector<std::string> cells{"run", "status"};
  std::ranges::copy(names.draws, std::back_inserter(cells));
  std::ranges::copy(names.outputs, std::back_inserter(cells));
  cells.insert(cells.end(), {"latch_order", "reason"});
  return cells;
}

void refuse_wrong_columns(const CsvReader& reader, const std::vector<std::string>& header,
                          const std::vector<std::string>& known) {
  for (const std::string& name : header) {
    if (std::ranges::find(known, name) == known.end())
      throw reader.error(name, "a column that the campaign does not have",
                         fmt::format("only {}", fmt::join(known, ", ")));
    if (std::ranges::count(header, name) > 1)
      throw reader.error(name, "the column more than once", "each column once");
  }
}

Places find_places(CsvReader& reader, const ResultNames& names) {
  const std::vector<std::string> header = reader.cells();
  refuse_wrong_columns(reader, header, header_cells(names));
  const auto find = [&](const std::string& name) {
    const auto found = std::ranges::find(header, name);
    if (found == header.end()) throw reader.error(name, "no such column", "it in the header");
    return static_cast<std::size_t>(found - header.begin());
  };
  Places places{find("run"), find("status"), find("latch_order"), {}, {}, {}, header.size()};
  if (std::ranges::find(header, "reason") != header.end()) places.reason = find("reason");
  std::ranges::transform(names.draws, std::back_inserter(places.draws), find);
  std::ranges::transform(names.outputs, std::back_inserter(places.outputs), find);
  return places;
}

long parse_run(const CsvReader& reader, const std::string& cell, const Results& results) {
  const long least = results.runs.empty() ? 0 : results.runs.back() + 1;
  const auto run = parse_number<long>(cell);
  if (run && *run >= least) return *run;
  throw reader.error(
      "run", fmt::format("'{}'", cell),
      fmt::format("a whole number of at least {} (runs count from 0, in order)", least));
}

Status parse_status(const CsvReader& reader, const std::string& cell) {
  if (const auto status = status_named(cell)) return *status;
  std::vector<std::string> allowed;
  std::ranges::transform(statuses, std::back_inserter(allowed),
                         [](Status s) { return to_string(s); });
  throw reader.error("status", fmt::format("'{}'", cell),
                     fmt::format("one of {}", fmt::join(allowed, ", ")));
}

double parse_number(const CsvReader& reader, const std::string& cell, const std::string& column) {
  if (cell.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto value = parse_csv_number(cell);
  if (!value) throw reader.error(column, fmt::format("'{}'", cell), "a finite number, or nothing");
  return *value;
}

void parse_row(CsvReader& reader, const Places& places, Results& results) {
  const std::vector<std::string>& cells = reader.cells();
  if (cells.size() != places.count)
    throw reader.error("", fmt::format("{} cells", cells.size()),
                       fmt::format("{}, as in the header", places.count));
  const long run = parse_run(reader, cells[places.run], results);
  results.status.push_back(parse_status(reader, cells[places.status]));
  const auto numbers = [&](std::vector<Column>& columns, const std::vector<std::size_t>& at) {
    for (std::size_t i = 0; i < columns.size(); ++i)
      columns[i].values.push_back(parse_number(reader, cells[at[i]], columns[i].name));
  };
  numbers(results.draws, places.draws);
  numbers(results.outputs, places.outputs);
  results.latch_order.push_back(cells[places.latch_order]);
  results.reason.push_back(places.reason ? std::string_view(cells[*places.reason]) : "");
  results.runs.push_back(run);
}

/// Goes to the next record that is to be read; false at the end, or at one that is to be dropped.
bool next_wanted(CsvReader& reader, UnterminatedRow last, ResultsFile& file) {
  if (!reader.next()) return false;
  file.unterminated = !reader.terminated();
  if (reader.terminated()) file.complete_bytes = reader.bytes();
  return reader.terminated() || last == UnterminatedRow::read;
}

} // namespace

Results::Results(const ResultNames& names) {
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
  latch_order.release();
  reason.release();
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
  append_csv_cells(buffer, row.latch_order, row.reason);
  buffer += '\n';
}

ResultsFile read_results(std::istream& in, const std::string& file, const ResultNames& names,
                         UnterminatedRow last) {
  ResultsFile read{Results(names), 0, false};
  CsvReader reader(in, file);
  if (!next_wanted(reader, last, read)) {
    if (last == UnterminatedRow::drop) return read;
    throw reader.error("", "an empty file", "a header");
  }
  const Places places = find_places(reader, names);
  while (next_wanted(reader, last, read)) parse_row(reader, places, read.results);
  return read;
}

} // namespace wingspread
