#include "montecarlo/model/campaign/margin_spec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <set>
#include <utility>

namespace wingspread {
namespace {

constexpr std::array<std::string_view, 2> case_names{"nominal", "one_spring_out"};
constexpr const char* expected_range = "two numbers > 0, the first below the second";
constexpr const char* expected_widest = "an array of two numbers > 0 that enclose \"range\"";
/// Default of `widest`: the range widened by three octaves on either side. Heuristic: the study does not find the edges
/// of a window that lie beyond.
constexpr double widening = 8;

bool is_point_count(const std::int64_t& number) {
  return number >= 2 && number <= most_margin_points;
}

void read_range(const JsonCursor& at, MarginSpec& margin) {
  std::vector<double> range;
  if (!at.read(range, expected_range)) return;
  if (range.size() != 2) return void(at.refuse(expected_range));
  if (!(range[0] > 0 && range[0] < range[1]))
    return void(at.refuse(fmt::format("{} and {}", range[0], range[1]), expected_range));
  margin.lower = range[0];
  margin.upper = range[1];
  margin.lowest = margin.lower / widening;
  margin.highest = margin.upper * widening;
}

void read_widest(const JsonCursor& at, MarginSpec& margin) {
  std::vector<double> widest;
  if (!at.read(widest, expected_widest)) return;
  if (widest.size() != 2) return void(at.refuse(expected_widest));
  if (!(widest[0] > 0 && widest[0] <= margin.lower && widest[1] >= margin.upper))
    return void(at.refuse(fmt::format("{} and {}", widest[0], widest[1]), expected_widest));
  margin.lowest = widest[0];
  margin.highest = widest[1];
}

void read_cases(const JsonCursor& at, MarginSpec& margin) {
  if (!at.value().is_array() || at.value().empty())
    return void(at.refuse("an array of " + quoted_list(case_names)));
  std::set<std::size_t> cases;
  for (const JsonCursor& element : at.elements())
    if (const auto index = element.choice(case_names); index && !cases.insert(*index).second)
      element.refuse_repeated("each case once");
  margin.nominal = cases.contains(0);
  margin.one_spring_out = cases.contains(1);
}

/// The given fields of a hinge's spring, as far as the spring has them.
std::vector<SceneParameter> of_spring(const Scene& scene, int hinge,
                                      std::initializer_list<std::string_view> fields) {
  std::vector<SceneParameter> parameters;
  for (const std::string_view field : fields)
    for (const ParameterMatch& match :
         resolve(scene, fmt::format("hinges.{}.spring.{}", scene.hinges[hinge].name, field))
             .matches)
      parameters.push_back(match.parameter);
  return parameters;
}

void refuse_unusable(const JsonCursor& at, const MarginSpec& margin, const Scene& scene) {
  const auto of_hinge = [](const SceneParameter& parameter) {
    return parameter.owner == SceneParameter::Owner::hinge;
  };
  const auto is_spring = [&](const SceneParameter& parameter) {
    return of_hinge(parameter) && sizes_spring({&parameter, 1}, scene, parameter.index);
  };
  if (margin.mode == MarginMode::each && !std::ranges::all_of(margin.scaled, of_hinge))
    at.refuse("\"each\" with a parameter that is not a hinge's", "parameters of hinges", "/mode");
  if (margin.one_spring_out && std::ranges::none_of(margin.scaled, is_spring))
    at.refuse("\"one_spring_out\" with no spring's torque in \"scale\"",
              "a spring that can be lost", "/cases");
}

} // namespace

std::vector<SceneParameter> spring_torques(const Scene& scene, int hinge) {
  if (scene.hinges[hinge].spring.table) return of_spring(scene, hinge, {"scale", "offset"});
  return of_spring(scene, hinge, {"torque_stowed", "torque_latched", "offset"});
}

bool sizes_spring(std::span<const SceneParameter> scaled, const Scene& scene, int hinge) {
  const auto all = of_spring(scene, hinge, {"torque_stowed", "torque_latched", "scale"});
  return std::ranges::any_of(scaled, [&](const SceneParameter& parameter) {
    return std::ranges::find(all, parameter) != all.end();
  });
}

bool sizes_a_spring(const SceneParameter& parameter, const Scene& scene) {
  return parameter.owner == SceneParameter::Owner::hinge &&
         sizes_spring({&parameter, 1}, scene, parameter.index);
}

MarginSpec read_margin(const JsonCursor& at, const Scene* scene, StaticMarginSpec& motorization) {
  MarginSpec margin;
  const std::size_t before = at.problems().size();
  JsonObject object(at, "what to size: an object");
  if (const auto scale = object.require("scale", "the paths of the parameters to size"))
    margin.scaled = read_paths(*scale, scene);
  if (const auto range = object.require("range", expected_range)) read_range(*range, margin);
  if (const auto widest = object.find("widest")) read_widest(*widest, margin);
  object.optional_choice("mode", margin.mode, margin_mode_names);
  const std::string points = fmt::format("an integer from 2 to {}", most_margin_points);
  object.optional("points", margin.points, points, is_point_count);
  object.optional("tolerance", margin.edge_tolerance, "a number, > 0 and < 1", is_proper_share);
  if (const auto cases = object.find("cases")) read_cases(*cases, margin);
  read_springs_per_hinge(object, motorization);
  if (const auto factors = object.find("motorization"))
    read_static_margins(*factors, scene, motorization);
  object.refuse_others();
  if (scene && at.problems().size() == before) refuse_unusable(at, margin, *scene);
  return margin;
}

Json write_margin(const MarginSpec& margin, const StaticMarginSpec& motorization,
                  const Scene& scene) {
  Json cases = Json::array();
  if (margin.nominal) cases.push_back(case_names[0]);
  if (margin.one_spring_out) cases.push_back(case_names[1]);
  return {{"scale", paths_of(scene, margin.scaled)},
          {"range", {margin.lower, margin.upper}},
          {"widest", {margin.lowest, margin.highest}},
          {"mode", margin_mode_names[static_cast<std::size_t>(margin.mode)]},
          {"points", margin.points},
          {"tolerance", margin.edge_tolerance},
          {"cases", cases},
          {"springs_per_hinge", motorization.springs_per_hinge},
          {"motorization", write_static_margins(motorization, scene)}};
}

} // namespace wingspread
