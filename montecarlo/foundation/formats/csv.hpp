/// Comma-separated values after RFC 4180: records end in LF or CRLF. A cell with a comma, a quote or a line break is
/// enclosed in double quotes, and quotes within the cell are doubled.
#pragma once

#include "montecarlo/foundation/formats/spec_error.hpp"

#include <concepts>
#include <cstddef>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// Appends `text` as one cell, quoted only if it has to be.
void append_csv_cell(std::string& buffer, std::string_view text);

/// Appends `value` with 17 significant digits (C's "%.17g", in any locale), which read back to the same double. A value
/// that is not finite gives an empty cell.
void append_csv_cell(std::string& buffer, double value);
template <std::integral Integer> void append_csv_cell(std::string& buffer, Integer value) {
  buffer += std::to_string(value);
}
/// Appends the value's cell; an empty cell if there is no value.
template <class T> void append_csv_cell(std::string& buffer, const std::optional<T>& value) {
  if (value) append_csv_cell(buffer, *value);
}

/// Appends each value as ",cell", i.e. all cells of a record after the first.
template <class... Cells> void append_csv_cells(std::string& buffer, const Cells&... cells) {
  ((buffer += ',', append_csv_cell(buffer, cells)), ...);
}

/// The cell of a number: "1.5".
[[nodiscard]] std::string csv_cell(double value);

/// The finite number that is the whole cell; nothing otherwise.
[[nodiscard]] std::optional<double> parse_csv_number(std::string_view cell);

/// Reads a CSV stream record by record. A leading UTF-8 byte order mark is skipped.
class CsvReader {
public:
  /// @param file name for the error messages.
  CsvReader(std::istream& in, std::string file);

  /// Reads the next record without splitting it; false at the end.
  [[nodiscard]] bool next();

  /// The cells of the current record. The reference holds until the next call of next().
  /// @throws SpecError for a quote inside an unquoted cell, text after a closing quote, a quote that
  /// is never closed, or a carriage return that no line feed follows.
  [[nodiscard]] const std::vector<std::string>& cells();

  /// Whether a line break ended the current record. A last record without a line break may be cut off or complete (RFC
  /// 4180 allows both), so the caller decides.
  [[nodiscard]] bool terminated() const { return terminated_; }

  /// Whether the current record spans several lines, by a line break in a quoted cell.
  [[nodiscard]] bool spans_lines() const { return lines_read_ > line_; }

  /// Line on which the current record begins, counted from 1.
  [[nodiscard]] std::size_t line() const { return line_; }

  /// Bytes from the start of the stream to the end of the current record.
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

  /// An error to throw about the current record; its place reads "line 3, column 'status'".
  /// @param column its name in the header; empty when the whole record is meant.
  [[nodiscard]] SpecError error(const std::string& column, std::string found,
                                std::string expected) const;

private:
  void read_physical_line();
  std::size_t split_plain(std::size_t start, std::string& cell) const;
  std::size_t split_quoted(std::size_t start, std::string& cell) const;

  std::istream& in_;
  std::string file_;
  std::string physical_, record_;
  std::vector<std::string> cells_;
  std::size_t line_ = 0, lines_read_ = 0, bytes_ = 0;
  bool terminated_ = true;
};

/// The text without blanks at its ends.
[[nodiscard]] std::string without_blanks(std::string text);

/// A cell of a header: a name, and a unit in brackets if there is one ("th1 [deg]", "M (N*m)"), without blanks around it.
struct HeaderCell {
  std::string name, unit;
};
[[nodiscard]] HeaderCell header_cell(const std::string& given);

} // namespace wingspread
