#include "montecarlo/analyses/fit/trace_file.hpp"

#include "montecarlo/foundation/formats/csv.hpp"
#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/formats/nearest.hpp"
#include "montecarlo/foundation/formats/number_text.hpp"
#include "montecarlo/foundation/formats/quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <sstream>

namespace wingspread {
namespace {

constexpr std::size_t least_rows = 2;
// Heuristic: a prediction has a sample every 10 to 20 ms, 1e6 of them up to this time. A larger limit lets a typing
// error in a time take all memory.
constexpr double latest = 2e4; // s

/// Index of a column in the file, and the factor of its unit.
struct Place {
  std::size_t index;
  double factor;
};

/// The factor from a unit to SI; nothing, with a problem, for another dimension.
std::optional<double> factor_of(const TraceColumn& column, const std::string& unit) {
  if (unit.empty()) return 1;
  const auto factor = in_unit("1 " + unit, column.si);
  if (!factor)
    column.at.refuse(fmt::format("the unit \"{}\" of the column \"{}\"", unit, column.header),
                     column.si.empty() ? "no unit" : "one such as " + units_like(column.si));
  return factor;
}

std::optional<Place> place_of(const TraceColumn& column, const std::vector<std::string>& header,
                              const std::string& file) {
  std::vector<std::string> names;
  std::optional<Place> place;
  std::string unit;
  for (std::size_t i = 0; i < header.size(); ++i) {
    const HeaderCell cell = header_cell(header[i]);
    names.push_back(cell.name);
    if (cell.name != column.header && without_blanks(header[i]) != column.header) continue;
    if (place) {
      column.at.refuse(fmt::format("\"{}\", twice in the header of {}", column.header, file),
                       "a column once in the header");
      return std::nullopt;
    }
    place = {i, 1};
    // of a column that is named by its whole header, brackets without a unit are part of the name
    unit = cell.name == column.header || is_unit(cell.unit) ? cell.unit : "";
  }
  if (!place) {
    column.at.refuse(fmt::format("\"{}\"", column.header),
                     fmt::format("a column of {}{}", file, did_you_mean(column.header, names)));
    return std::nullopt;
  }
  const auto given = factor_of(column, column.unit), there = factor_of(column, unit);
  if (!given || !there) return std::nullopt;
  if (!column.unit.empty() && !unit.empty() && *given != *there) {
    column.at.refuse(
        fmt::format("the unit \"{}\", and \"{}\" in the header of {}", column.unit, unit, file),
        "one unit");
    return std::nullopt;
  }
  place->factor = column.unit.empty() ? *there : *given;
  return place;
}

class TraceReader {
public:
  TraceReader(std::istream& in, std::string file, std::vector<TraceColumn>& columns)
      : csv_(in, file), file_(std::move(file)), columns_(columns) {}

  /// @return false if a column has a problem
  bool find_places(const JsonCursor& at) {
    if (!csv_.next()) return at.refuse(fmt::format("no header in {}", file_), "a header and rows");
    const std::vector<std::string> header = csv_.cells();
    width_ = header.size();
    if (width_ == 1 && header[0].find_first_of(";\t") != std::string::npos)
      return at.refuse(fmt::format("one column in the header of {}: \"{}\"", file_, header[0]),
                       "columns separated by commas", "/file");
    for (const TraceColumn& column : columns_) {
      const auto place = place_of(column, header, file_);
      if (place) places_.push_back(*place);
    }
    return places_.size() == columns_.size();
  }

  /// @throws SpecError at the first row with a problem
  void read_rows() {
    while (csv_.next()) {
      const std::vector<std::string>& cells = csv_.cells();
      if (cells.size() == 1 && cells[0].empty() && width_ > 1) continue; // an empty line
      if (cells.size() != width_)
        throw csv_.error("", fmt::format("{} cells", cells.size()),
                         fmt::format("{}, as in the header", width_));
      for (std::size_t i = 0; i < columns_.size(); ++i) read_cell(cells, i);
    }
  }

private:
  void read_cell(const std::vector<std::string>& cells, std::size_t i) {
    TraceColumn& column = columns_[i];
    const std::string& cell = cells[places_[i].index];
    const auto number = parse_csv_number(cell);
    if (!number)
      throw csv_.error(column.header, fmt::format("'{}'", cell),
                       "a finite number: leave out rows that lack one");
    const double value = *number * places_[i].factor;
    if (column.ascending && !column.values.empty() && !(value > column.values.back()))
      throw csv_.error(column.header, fmt::format("{} after {}", cell, column.last),
                       value < column.values.back() ? "ascending times: sort the rows"
                                                    : "each time once: drop one of the rows");
    column.values.push_back(value);
    column.last = cell;
  }

  CsvReader csv_;
  std::string file_;
  std::vector<TraceColumn>& columns_;
  std::vector<Place> places_;
  std::size_t width_ = 0;
};

/// Refuses times that a run does not have. @param time with at least one row
void refuse_times(const TraceColumn& time, const std::string& file) {
  const double last = time.values.back();
  if (!(last > 0))
    time.at.refuse(fmt::format("times that end at {:g} s in {}, before the run begins", last, file),
                   "times since the run begins, at 0 s");
  else if (last > latest)
    time.at.refuse(fmt::format("times up to {:g} s in {}", last, file),
                   fmt::format("times up to {:g} s: leave out the rest after the motion", latest));
}

} // namespace

void read_trace(const JsonCursor& at, const std::filesystem::path& path,
                std::vector<TraceColumn>& columns) {
  const auto text = read_text(path);
  if (!text)
    return void(at.refuse(fmt::format("no file that can be read at \"{}\"", path.string()),
                          "a CSV file", "/file"));
  std::istringstream in(*text);
  try {
    TraceReader reader(in, path.string(), columns);
    if (!reader.find_places(at)) return;
    reader.read_rows();
  } catch (const SpecError& error) {
    at.problems().insert(at.problems().end(), error.problems().begin(), error.problems().end());
    return;
  }
  if (columns.front().values.size() < least_rows)
    return void(
        at.refuse(fmt::format("{} {} in {}", columns.front().values.size(),
                              columns.front().values.size() == 1 ? "row" : "rows", path.string()),
                  fmt::format("at least {}", least_rows), "/file"));
  refuse_times(columns.front(), path.string());
  for (const TraceColumn& column : columns)
    if (std::ranges::all_of(column.values, [&](double v) { return v == column.values.front(); }))
      column.at.refuse(fmt::format("\"{}\", which is {} in every row of {}", column.header,
                                   column.last, path.string()),
                       "a column that changes: leave a sensor that did not record out");
}

} // namespace wingspread
