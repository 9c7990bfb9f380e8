#include "montecarlo/foundation/formats/csv.hpp"

#include "montecarlo/foundation/formats/number_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <istream>
#include <utility>

namespace wingspread {
namespace {

constexpr std::size_t most_record_bytes =
    16 << 20; // bounds the memory for a quote that is never closed

} // namespace

void append_csv_cell(std::string& buffer, std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) {
    buffer += text;
    return;
  }
  buffer += '"';
  for (const char c : text) {
    if (c == '"') buffer += '"';
    buffer += c;
  }
  buffer += '"';
}

void append_csv_cell(std::string& buffer, double value) {
  if (!std::isfinite(value)) return;
  std::array<char, 32> digits;
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                          std::chars_format::general, 17);
  buffer.append(digits.data(), end);
}

std::string csv_cell(double value) {
  std::string cell;
  append_csv_cell(cell, value);
  return cell;
}

std::optional<double> parse_csv_number(std::string_view cell) {
  const auto value = parse_number<double>(cell);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

CsvReader::CsvReader(std::istream& in, std::string file) : in_(in), file_(std::move(file)) {}

SpecError CsvReader::error(const std::string& column, std::string found,
                           std::string expected) const {
  std::string place = fmt::format("line {}", std::max<std::size_t>(line_, 1));
  if (!column.empty()) place += fmt::format(", column '{}'", column);
  return SpecError({{file_, place, std::move(found), std::move(expected)}});
}

void CsvReader::read_physical_line() {
  std::getline(in_, physical_);
  terminated_ = !in_.eof();
  bytes_ += physical_.size() + (terminated_ ? 1 : 0);
  ++lines_read_;
}

bool CsvReader::next() {
  if (in_.peek() == std::istream::traits_type::eof()) return false;
  line_ = lines_read_ + 1;
  read_physical_line();
  if (line_ == 1 && physical_.starts_with("\xEF\xBB\xBF")) physical_.erase(0, 3);
  record_ = physical_;
  // A line break is inside a cell if the number of quotes before the break is odd.
  auto quotes = std::ranges::count(record_, '"');
  while (quotes % 2 != 0 && terminated_) {
    read_physical_line();
    record_ += '\n';
    record_ += physical_;
    quotes += std::ranges::count(physical_, '"');
    if (record_.size() > most_record_bytes)
      throw error("", fmt::format("a quote open for {} bytes", record_.size()), "a closing quote");
  }
  if (record_.ends_with('\r')) record_.pop_back();
  return true;
}

/// Copies the unquoted cell that begins at `start`; returns where it ends.
std::size_t CsvReader::split_plain(std::size_t start, std::string& cell) const {
  const std::size_t end = std::min(record_.find(',', start), record_.size());
  cell.assign(record_, start, end - start);
  if (cell.find('"') != std::string::npos)
    throw error("", fmt::format("a quote inside the cell '{}'", cell),
                "quotes around the whole cell");
  if (cell.find('\r') != std::string::npos)
    throw error("", "a carriage return on its own", "lines that end in LF or CRLF");
  return end;
}

/// Copies the quoted cell whose opening quote is at `start`; returns where it ends.
std::size_t CsvReader::split_quoted(std::size_t start, std::string& cell) const {
  cell.clear();
  std::size_t at = start + 1;
  for (;;) {
    const std::size_t quote = record_.find('"', at);
    if (quote == std::string::npos)
      throw error("", "a quote that is never closed", "a closing quote");
    cell.append(record_, at, quote - at);
    at = quote + 1;
    if (at == record_.size() || record_[at] == ',') return at;
    if (record_[at] != '"')
      throw error("", fmt::format("'{}' after a closing quote", record_[at]),
                  "a comma or a line break");
    cell += '"';
    ++at;
  }
}

const std::vector<std::string>& CsvReader::cells() {
  std::size_t count = 0;
  for (std::size_t at = 0;; ++at) {
    if (count == cells_.size()) cells_.emplace_back();
    const bool quoted = at < record_.size() && record_[at] == '"';
    at = quoted ? split_quoted(at, cells_[count]) : split_plain(at, cells_[count]);
    ++count;
    if (at == record_.size()) break;
  }
  cells_.resize(count);
  return cells_;
}

std::string without_blanks(std::string text) {
  text.erase(0, text.find_first_not_of(' '));
  while (text.ends_with(' ')) text.pop_back();
  return text;
}

HeaderCell header_cell(const std::string& given) {
  const std::string cell = without_blanks(given);
  if (!cell.ends_with(']') && !cell.ends_with(')')) return {cell, ""};
  std::size_t open = cell.size();
  for (int depth = 0;
       open == cell.size() || depth > 0;) { // back to the bracket that the last one closes
    if (open-- == 0) return {cell, ""};
    const char c = cell[open];
    depth += (c == ']' || c == ')') - (c == '[' || c == '(');
  }
  return {without_blanks(cell.substr(0, open)), cell.substr(open + 1, cell.size() - open - 2)};
}

} // namespace wingspread
