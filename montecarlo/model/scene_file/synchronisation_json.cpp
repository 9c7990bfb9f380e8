#include "montecarlo/model/scene_file/synchronisation_json.hpp"

#include "montecarlo/foundation/formats/nearest.hpp"
#include "montecarlo/model/scene_file/torque_json.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace wingspread {
namespace {

constexpr std::string_view expected_ratio =
    "a number, not 0, or an object with a table of travel and travel_of_second";

LoopEnds read_between(JsonObject& object) {
  constexpr std::string_view expected = "an array of 2 hinges' names";
  LoopEnds ends;
  const auto at = object.require("between", expected);
  if (!at) return ends;
  if (!at->value().is_array() || at->value().size() != 2) {
    at->refuse(expected);
    return ends;
  }
  for (std::size_t i = 0; i < ends.size(); ++i)
    if (std::string name; at->element(i).read(name, "a string, a hinge's name")) ends[i] = name;
  return ends;
}

constexpr std::string_view expected_ratio_table =
    "a table: an object with travel and travel_of_second; a monotone cubic (PCHIP) between its "
    "points, straight beyond its ends";

void read_ratio_table(const JsonCursor& at, Synchronisation& loop) {
  JsonObject object(at, expected_ratio_table);
  const Dimension dimension{"rad"};
  const auto travel = object.require("travel", expected_column("rad"));
  const auto second = object.require("travel_of_second", expected_column("rad"));
  object.refuse_others();
  if (!travel || !second || !travel->read(loop.travel, dimension)) return;
  if (!can_be_knots(loop.travel.size())) return void(travel->refuse(expected_column("rad")));
  if (!check_ascending(*travel, loop.travel, "travel") ||
      !read_column_beside(*second, loop.travel, "travels", dimension, loop.travel_of_second))
    return;
  Curve curve(loop.travel, loop.travel_of_second, Interpolation::monotone, Beyond::straight);
  if (is_finite(curve))
    loop.table = std::make_shared<const Curve>(std::move(curve));
  else
    at.refuse("a curve that overflows", "travels further apart");
}

void read_ratio(const JsonCursor& at, Synchronisation& loop) {
  if (!at.value().is_object()) return void(at.read(loop.ratio, expected_ratio));
  JsonObject object(at, expected_ratio);
  if (const auto table = object.require("table", expected_ratio_table))
    read_ratio_table(*table, loop);
  object.refuse_others();
}

std::optional<int> hinge_index(const Scene& scene, const std::string& name) {
  const auto found = std::ranges::find(scene.hinges, name, &Hinge::name);
  if (found == scene.hinges.end()) return std::nullopt;
  return static_cast<int>(found - scene.hinges.begin());
}

/// The index of the hinge that one end names; 0, with a problem, if it is unknown.
int link_end(const JsonCursor& between, std::size_t end, const std::string& name,
             const Scene& scene) {
  const auto index = hinge_index(scene, name);
  if (index && scene.hinges[*index].joint)
    between.element(end).refuse("a hinge with a travel: an elastic joint has none");
  if (index) return *index;
  std::vector<std::string> names;
  for (const Hinge& hinge : scene.hinges) names.push_back(hinge.name);
  between.element(end).refuse("a hinge's name" + did_you_mean(name, names));
  return 0;
}

} // namespace

LoopEnds read_synchronisation(const JsonCursor& at, Synchronisation& loop) {
  JsonObject object(at, "a synchronisation: an object");
  object.required("name", loop.name, "a string, the synchronisation's name");
  LoopEnds ends = read_between(object);
  if (const auto ratio = object.require("ratio", expected_ratio)) read_ratio(*ratio, loop);
  object.required("stiffness", loop.stiffness, Dimension{"N·m/rad", "≥ 0"});
  object.optional("damping", loop.damping, Dimension{"N·m·s/rad", "≥ 0"});
  object.optional("preload", loop.preload, Dimension{"N·m", "> 0"});
  object.refuse_others();
  return ends;
}

void link_synchronisations(const JsonCursor& at, const std::vector<LoopEnds>& ends, Scene& scene) {
  for (std::size_t i = 0; i < ends.size(); ++i) {
    if (!ends[i][0] || !ends[i][1]) continue; // has a problem already
    const JsonCursor between = at.member("synchronisations").element(i).member("between");
    Synchronisation& loop = scene.synchronisations[i];
    loop.first = link_end(between, 0, *ends[i][0], scene);
    loop.second = link_end(between, 1, *ends[i][1], scene);
    if (ends[i][0] == ends[i][1]) between.element(1).refuse_repeated("another hinge");
  }
}

Json write_synchronisation(const Scene& scene, const Synchronisation& loop) {
  Json json{{"name", loop.name},
            {"between", {scene.hinges[loop.first].name, scene.hinges[loop.second].name}}};
  if (loop.table)
    json["ratio"] = {
        {"table", {{"travel", loop.travel}, {"travel_of_second", loop.travel_of_second}}}};
  else
    json["ratio"] = loop.ratio;
  json["stiffness"] = loop.stiffness;
  json["damping"] = loop.damping;
  if (loop.preload) json["preload"] = *loop.preload;
  return json;
}

} // namespace wingspread
