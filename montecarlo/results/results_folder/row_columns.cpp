#include "montecarlo/results/results_folder/row_columns.hpp"

#include "montecarlo/foundation/formats/csv.hpp"
#include "montecarlo/foundation/formats/input_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace wingspread {

void refuse_other_columns(const std::filesystem::path& file, const ResultNames& names) {
  InputFile in(file);
  CsvReader reader(in, file.string());
  if (!reader.next()) return;
  const std::vector<std::string>&found = reader.cells(), expected = header_cells(names);
  const auto [its, ours] = std::ranges::mismatch(found, expected);
  if (its == found.end() && ours == expected.end()) return;
  const auto named = [](auto cell, auto end) {
    return cell == end ? "nothing" : '"' + *cell + '"';
  };
  throw reader.error(
      "", fmt::format("{} as column {}", named(its, found.end()), its - found.begin() + 1),
      fmt::format("{}: rows are appended in the order in which this program writes "
                  "columns",
                  named(ours, expected.end())));
}

} // namespace wingspread
