/// Reads a recorded trace: a CSV with a header, times and measured columns.
#pragma once

#include "montecarlo/foundation/formats/json_reader.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// A column to read. The header may have a unit in brackets after the name: `th1 [deg]`.
struct TraceColumn {
  JsonCursor at;       ///< for problems
  std::string header;  ///< its name in the header
  std::string unit;    ///< as written in TESTS.json; empty: the header's, or SI
  std::string_view si; ///< unit of the result
  bool ascending = false;
  std::vector<double> values{}; ///< output, in SI
  std::string last{};           ///< output: the last cell, as written
};

/// Reads the columns; notes problems: a file that cannot be read, a missing column, a wrong unit, a cell that is no
/// number, times that do not ascend, times before the run or far beyond it, and a column that never changes.
/// @param at for problems of the file as a whole
void read_trace(const JsonCursor& at, const std::filesystem::path& path,
                std::vector<TraceColumn>& columns);

} // namespace wingspread
