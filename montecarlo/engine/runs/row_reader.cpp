#include "montecarlo/engine/runs/row_reader.hpp"

#include "montecarlo/foundation/formats/number_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

namespace wingspread {
namespace {

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

Status parse_status(const CsvReader& reader, const std::string& cell) {
  if (const auto status = status_named(cell)) return *status;
  std::vector<std::string> allowed;
  std::ranges::transform(statuses, std::back_inserter(allowed),
                         [](Status s) { return to_string(s); });
  throw reader.error("status", fmt::format("'{}'", cell),
                     fmt::format("one of {}", fmt::join(allowed, ", ")));
}

PeaksFinal parse_final(const CsvReader& reader, const std::string& cell) {
  if (const auto final = peaks_final_named(cell)) return *final;
  throw reader.error(std::string(peaks_final_column), fmt::format("'{}'", cell),
                     "true, false, peak_moment, peak_force, or nothing");
}

double parse_value(const CsvReader& reader, const std::string& cell, const std::string& column) {
  if (cell.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto value = parse_csv_number(cell);
  if (!value) throw reader.error(column, fmt::format("'{}'", cell), "a finite number, or nothing");
  return *value;
}

} // namespace

RowReader::RowReader(std::istream& in, std::string file, const ResultNames& names,
                     UnterminatedRow last)
    : csv_(in, std::move(file)), names_(names), last_(last) {
  row_.run = -1; // none yet
  row_.draws.resize(names.draws.size());
  row_.outputs.resize(names.outputs.size());
  has_header_ = next_wanted();
  if (has_header_)
    find_places();
  else if (last_ == UnterminatedRow::read)
    throw csv_.error("", "an empty file", "a header");
}

bool RowReader::next() {
  if (!has_header_ || !next_wanted()) return false;
  parse(csv_.cells());
  return true;
}

/// Reads the next record; false at the end, or at a record to drop. A crash cuts only the last line. So a quote that
/// stays open over several lines is a fault of the file: it would swallow complete rows.
bool RowReader::next_wanted() {
  if (!csv_.next()) return false;
  unterminated_ = !csv_.terminated();
  if (unterminated_ && csv_.spans_lines())
    throw csv_.error("", "a quote that is never closed", "a closing quote");
  if (!unterminated_) complete_bytes_ = csv_.bytes();
  return !unterminated_ || last_ == UnterminatedRow::read;
}

void RowReader::find_places() {
  const std::vector<std::string> header = csv_.cells();
  refuse_wrong_columns(csv_, header, header_cells(names_));
  const auto find = [&](const std::string& name) {
    const auto found = std::ranges::find(header, name);
    if (found == header.end()) throw csv_.error(name, "no such column", "it in the header");
    return static_cast<std::size_t>(found - header.begin());
  };
  places_ = {find("run"), find("status"), find("latch_order"), {}, {}, {}, {}, header.size()};
  if (names_.peaks_final) places_.peaks_final = find(std::string(peaks_final_column));
  if (std::ranges::find(header, "reason") != header.end()) places_.reason = find("reason");
  std::ranges::transform(names_.draws, std::back_inserter(places_.draws), find);
  std::ranges::transform(names_.outputs, std::back_inserter(places_.outputs), find);
}

long RowReader::parse_run(const std::string& cell) const {
  const auto run = parse_number<long>(cell);
  if (run && *run >= least_run_ && *run < std::numeric_limits<long>::max()) return *run;
  throw csv_.error(
      "run", fmt::format("'{}'", cell),
      fmt::format("a whole number of at least {} (runs count from 0, in order)", least_run_));
}

void RowReader::parse(const std::vector<std::string>& cells) {
  if (cells.size() != places_.count)
    throw csv_.error("", fmt::format("{} cells", cells.size()),
                     fmt::format("{}, as in the header", places_.count));
  row_.run = parse_run(cells[places_.run]);
  row_.status = parse_status(csv_, cells[places_.status]);
  const auto numbers = [&](std::vector<double>& values, const std::vector<std::string>& names,
                           const std::vector<std::size_t>& at) {
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = parse_value(csv_, cells[at[i]], names[i]);
  };
  numbers(row_.draws, names_.draws, places_.draws);
  numbers(row_.outputs, names_.outputs, places_.outputs);
  if (places_.peaks_final) row_.peaks_final = parse_final(csv_, cells[*places_.peaks_final]);
  row_.latch_order = cells[places_.latch_order];
  row_.reason = places_.reason ? cells[*places_.reason] : "";
  least_run_ = row_.run + 1;
}

} // namespace wingspread
