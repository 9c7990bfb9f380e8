/// For tests of tables in files: their rows, each cell by the name of its column.
#pragma once

#include "montecarlo/foundation/formats/csv.hpp"

#include <catch2/catch.hpp>

#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace wingspread::test {

using CsvRow = std::map<std::string, std::string>;

inline std::vector<CsvRow> rows_by_name(const std::string& text) {
  std::istringstream in(text);
  CsvReader reader(in, "table.csv");
  REQUIRE(reader.next());
  const std::vector<std::string> names = reader.cells();
  std::vector<CsvRow> rows;
  while (reader.next()) {
    REQUIRE(reader.cells().size() == names.size());
    CsvRow& row = rows.emplace_back();
    for (std::size_t k = 0; k < names.size(); ++k) row[names[k]] = reader.cells()[k];
    REQUIRE(row.size() == names.size()); // no name twice
  }
  return rows;
}

} // namespace wingspread::test
