#include "montecarlo/report/page/margin_block.hpp"

#include "montecarlo/foundation/formats/csv.hpp"
#include "montecarlo/foundation/statistics/binomial_bounds.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "montecarlo/model/static_margins/static_margin.hpp"
#include "montecarlo/report/data/page_numbers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>

namespace wingspread {
namespace {

/// The first element for which `same` is true; if none, a new one at the end.
template <class List, class Same, class Make>
auto& found_or_made(List& list, Same same, Make make) {
  const auto found = std::ranges::find_if(list, same);
  if (found != list.end()) return *found;
  list.push_back(make());
  return list.back();
}

/// A verdict in the page's words.
std::string page_verdict(const std::string& verdict) {
  return verdict == "pass" ? "passed" : verdict == "fail" ? "failed" : "open";
}

} // namespace

MarginTable read_margin_csv(const std::filesystem::path& path) {
  std::ifstream in(path);
  CsvReader reader(in, path.string());
  std::map<std::string, std::size_t> place;
  MarginTable table;
  while (reader.next()) {
    const std::vector<std::string>& cells = reader.cells();
    if (place.empty()) {
      for (std::size_t i = 0; i < cells.size(); ++i) place[cells[i]] = i;
      continue;
    }
    const auto cell = [&](const char* name) -> const std::string& { return cells[place.at(name)]; };
    const auto number = [&](const char* name) { return parse_csv_number(cell(name)).value_or(0); };
    auto& search = found_or_made(
        table, [&](const auto& each) { return each.first == cell("search"); },
        [&] {
          return MarginTable::value_type{cell("search"), {}};
        });
    const std::string text = cell("case") == "nominal" ? cell("requirement")
                                                       : cell("requirement") + " · " + cell("case");
    RequirementScales& row = found_or_made(
        search.second, [&](const RequirementScales& each) { return each.text == text; },
        [&] {
          return RequirementScales{text, {}, {}, {}, {}};
        });
    row.scales.push_back(number("scale"));
    row.runs.push_back(std::lround(number("runs")));
    row.broken.push_back(std::lround(number("broken")));
    row.verdicts.push_back(page_verdict(cell("verdict")));
  }
  return table;
}

namespace {

/// @param confidence of the bounds; null if it is not known: then there are none
Json requirement_json(const RequirementScales& row, const Json& confidence) {
  Json json{{"text", row.text},
            {"passed", Json::array()},
            {"lower", Json::array()},
            {"upper", Json::array()},
            {"verdict", row.verdicts}};
  for (std::size_t i = 0; i < row.scales.size(); ++i) {
    const long kept = row.runs[i] - row.broken[i];
    const Interval bounds = confidence.is_null()
                                ? Interval{undefined, undefined}
                                : clopper_pearson(kept, row.runs[i], confidence.get<double>());
    json["passed"].push_back(
        page_number(static_cast<double>(kept) / static_cast<double>(row.runs[i]), 5));
    json["lower"].push_back(page_number(bounds.lower, 5));
    json["upper"].push_back(page_number(bounds.upper, 5));
  }
  return json;
}

/// The requirements, with their cases, that the runs of another seed break at the recommended scale: "M-2 in ambient";
/// null if they confirm it, or if there is none.
Json not_confirmed(const Json& recommended) {
  if (recommended.is_null() || !recommended.contains("confirmation")) return nullptr;
  const Json& confirmation = recommended.at("confirmation");
  if (confirmation.at("passes").get<bool>()) return nullptr;
  std::vector<std::string> broken;
  for (const Json& verdict : confirmation.at("verdicts")) {
    if (verdict.at("verdict") == "pass") continue;
    std::string name = verdict.value("name", verdict.at("output").get<std::string>());
    if (verdict.contains("case")) name += " in " + verdict["case"].get<std::string>();
    broken.push_back(std::move(name));
  }
  return fmt::format("not met: {}", fmt::join(broken, ", "));
}

/// Both ends of the neighbouring scales of a window that are furthest apart; null if it has one scale, or none.
Json widest_gap_of(const Json& window) {
  const Json gap = window.is_null() ? Json(nullptr) : window.value("widest_gap", Json(nullptr));
  if (gap.is_null() || !(gap.at("to") > gap.at("from"))) return nullptr;
  return {gap.at("from"), gap.at("to")};
}

/// Both scales of every further window.
Json other_windows(const Json& search) {
  Json windows = Json::array();
  for (const Json& other : search.value("other_windows", Json::array()))
    windows.push_back({other.at("lower").at("scale"), other.at("upper").at("scale")});
  return windows;
}

/// A static margin of margin.json with its standard in words.
Json with_standard_in_words(Json margin) {
  if (!margin.is_object() || !margin.contains("margin")) return margin;
  const auto key = std::ranges::find(margin_kind_names, margin["margin"].get<std::string>());
  if (key != margin_kind_names.end())
    margin["margin"] = margin_kind_texts[static_cast<std::size_t>(key - margin_kind_names.begin())];
  return margin;
}

/// What the recommended scale gives up; null without one, and of an older version.
Json given_up(const Json& recommended) {
  Json json = recommended.is_null() ? Json(nullptr) : recommended.value("given_up", Json(nullptr));
  if (json.is_null()) return json;
  for (Json& margin : json.at("static_margins")) margin = with_standard_in_words(margin);
  return json;
}

} // namespace

Json margin_block(const Json& search, const MarginTable& table, const Json& confidence) {
  const auto own = std::ranges::find(table, search.at("name").get<std::string>(),
                                     &MarginTable::value_type::first);
  const auto rows = own == table.end() ? std::vector<RequirementScales>{} : own->second;
  const auto edge = [&](const char* side) -> Json {
    const Json& window = search.at("window");
    if (window.is_null()) return nullptr;
    const Json& found = window.at(side);
    return found.at("range_end").get<bool>() ? Json(nullptr) : found.at("scale");
  };
  Json requirements = Json::array();
  for (const RequirementScales& row : rows)
    requirements.push_back(requirement_json(row, confidence));
  const Json &recommended = search.at("recommended"), &window = search.at("window");
  const Json as_good =
      recommended.is_null() || !recommended.contains("as_good")
          ? Json(nullptr) // of an older version
          : Json::array({recommended["as_good"].at("from"), recommended["as_good"].at("to")});
  return {{"scales", rows.empty() ? std::vector<double>{} : rows.front().scales},
          {"requirements", std::move(requirements)},
          {"recommended", recommended.is_null() ? Json(nullptr) : recommended.at("scale")},
          {"as_good", as_good},
          {"not_confirmed", not_confirmed(recommended)},
          {"given_up", given_up(recommended)},
          {"passed_over", with_standard_in_words(search.value("passed_over", Json(nullptr)))},
          {"widest_gap", widest_gap_of(window)},
          {"other_windows", other_windows(search)},
          {"joint_confidence",
           window.is_null() ? Json(nullptr) : window.value("joint_confidence", Json(nullptr))},
          {"why_none", search.at("why_none")},
          {"of_springs", search.value("of_springs", true)},
          {"paths", search.value("scales", Json::array())},
          {"window", {edge("lower"), edge("upper")}}};
}

} // namespace wingspread
