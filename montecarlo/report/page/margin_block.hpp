/// The page's data of a search for a permissible scale (`wingspread margin`).
#pragma once

#include "montecarlo/foundation/formats/json_parse.hpp"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace wingspread {

/// The rows of margin.csv of one requirement in one case, by scale.
struct RequirementScales {
  std::string text;
  std::vector<double> scales;
  std::vector<long> runs, broken;
  std::vector<std::string> verdicts;
};
/// The rows of margin.csv by search, then by requirement in the order of the file.
using MarginTable = std::vector<std::pair<std::string, std::vector<RequirementScales>>>;

[[nodiscard]] MarginTable read_margin_csv(const std::filesystem::path& path);

/// The block "margin" of a set (DATA.md).
/// @param search one of margin.json
/// @param confidence of the bounds; null if it is not known: then there are none
[[nodiscard]] Json margin_block(const Json& search, const MarginTable& table,
                                const Json& confidence);

} // namespace wingspread
