/// Reads runs.csv row by row, and keeps one row in memory.
#pragma once

#include "montecarlo/engine/runs/results.hpp"

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace wingspread {

class RowReader {
public:
  /// Reads the header.
  /// @param file name for error messages
  /// @pre the stream outlives the reader
  /// @throws SpecError as next() does
  RowReader(std::istream& in, std::string file, const ResultNames& names, UnterminatedRow last);

  /// Reads the next row. @return false at the end. @throws SpecError as read_results (results.hpp)
  [[nodiscard]] bool next();
  /// The row read last. The reference stays valid; next() overwrites the row.
  [[nodiscard]] const ResultRow& row() const { return row_; }

  /// Length of the file up to the last complete line read; 0: no header.
  [[nodiscard]] std::size_t complete_bytes() const { return complete_bytes_; }
  /// Whether bytes without a line break follow the last complete line.
  [[nodiscard]] bool unterminated() const { return unterminated_; }

  /// An error about the current row, for the caller to throw.
  [[nodiscard]] SpecError error(const std::string& column, std::string found,
                                std::string expected) const {
    return csv_.error(column, std::move(found), std::move(expected));
  }

private:
  /// Index of each column of the table in the file's rows.
  struct Places {
    std::size_t run, status, latch_order;
    std::optional<std::size_t> reason, peaks_final;
    std::vector<std::size_t> draws, outputs;
    std::size_t count;
  };

  [[nodiscard]] bool next_wanted();
  void find_places();
  void parse(const std::vector<std::string>& cells);
  [[nodiscard]] long parse_run(const std::string& cell) const;

  CsvReader csv_;
  ResultNames names_;
  UnterminatedRow last_;
  Places places_{};
  ResultRow row_;
  long least_run_ = 0;
  std::size_t complete_bytes_ = 0;
  bool has_header_ = false, unterminated_ = false;
};

} // namespace wingspread
