#include "montecarlo/model/scene_file/scene_json.hpp"

#include "montecarlo/foundation/formats/printable.hpp"
#include "montecarlo/model/scene_file/base_json.hpp"
#include "montecarlo/model/scene_file/hinge_json.hpp"
#include "montecarlo/model/scene_file/mirror.hpp"
#include "montecarlo/model/scene_file/synchronisation_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace wingspread {
namespace {

using Array = std::vector<JsonCursor>;

void read_plate(const JsonCursor& at, std::optional<Plate>& plate) {
  JsonObject object(at, "an object with the plate's edges, width and drag_coefficient");
  plate.emplace();
  object.required("from", plate->from, Dimension{"m"});
  object.required("to", plate->to, Dimension{"m"});
  object.required("width", plate->width, Dimension{"m", "≥ 0"});
  object.required("drag_coefficient", plate->drag_coefficient, "a number, ≥ 0");
  object.refuse_others();
}

/// Reads how a body bends. @param body with its plate as read
void read_flexible(const JsonCursor& at, Body& body) {
  JsonObject object(at, "an object with joints, damping_ratio, and bending_stiffness or frequency");
  Flexible& flexible = body.flexible.emplace();
  std::int64_t joints = 1;
  if (object.required("joints", joints, fmt::format("an integer from 1 to {}", most_joints),
                      [](const std::int64_t& n) { return n >= 1 && n <= most_joints; }))
    flexible.joints = static_cast<int>(joints);
  const auto frequency = object.find("frequency");
  const auto stiffness = frequency
                             ? object.find("bending_stiffness")
                             : object.require("bending_stiffness",
                                              "a number, N·m², > 0, or \"frequency\" in its place");
  if (frequency) frequency->read(flexible.frequency.emplace(), Dimension{"Hz", "> 0"});
  if (frequency && stiffness)
    stiffness->refuse("no bending_stiffness beside \"frequency\": each gives the other");
  else if (stiffness)
    stiffness->read(flexible.bending_stiffness.emplace(), Dimension{"N·m²", "> 0"});
  object.required("damping_ratio", flexible.damping_ratio, "a number, ≥ 0");
  object.refuse_others();
  if (body.plate) return;
  at.refuse("a body with a \"plate\", which gives the flexible body's length");
  body.flexible.reset();
}

void read_body(const JsonCursor& at, Body& body) {
  JsonObject object(at, "a body: an object");
  object.required("name", body.name, "a string, the body's name");
  object.required("mass", body.mass, Dimension{"kg", "> 0"});
  object.required("inertia", body.inertia, Dimension{"kg·m²", "> 0"});
  if (const auto plate = object.find("plate")) read_plate(*plate, body.plate);
  if (const auto flexible = object.find("flexible")) read_flexible(*flexible, body);
  object.refuse_others();
}

void read_environment(const JsonCursor& at, Environment& environment) {
  JsonObject object(at, "an object with gravity and air_density");
  object.optional("gravity", environment.gravity, Dimension{"m/s²"});
  object.optional("air_density", environment.air_density, Dimension{"kg/m³", "≥ 0"});
  object.refuse_others();
}

Array read_list(JsonObject& object, std::string_view key, std::string_view expected) {
  const auto list = object.require(key, expected);
  if (list && (!list->value().is_array() || list->value().empty())) list->refuse(expected);
  return list ? list->elements() : Array{};
}

/// The elements of `synchronisations`; none without the key.
Array read_synchronisation_list(JsonObject& object) {
  const auto list = object.find("synchronisations");
  if (list && !list->value().is_array()) list->refuse("an array of synchronisations");
  return list ? list->elements() : Array{};
}

/// Replaces names by indices, so that a fault's path is a JSON pointer.
template <class Named> void name_by_index(std::vector<Named>& all) {
  for (std::size_t i = 0; i < all.size(); ++i) all[i].name = std::to_string(i);
}

/// The pointer below the scene of a fault in `stop/…` or `far_stop/…`: both may be elements of the array `stop`.
std::string place_of_stop(const Json& scene, std::string below) {
  const auto cut = below.find("stop/");
  if (cut == std::string::npos) return below;
  const bool latched = below.compare(cut - 4, 4, "far_") == 0;
  const std::string hinge = below.substr(0, latched ? cut - 4 : cut);
  const std::string field = below.substr(cut + 5);
  const Json& stop = scene[Json::json_pointer(hinge + "stop")];
  if (!stop.is_array()) return hinge + "stop/" + field;
  std::size_t k = 0;
  const auto is_latched = [](const Json& each) {
    return each.is_object() && each.contains("side") && each["side"] == "latched";
  };
  while (k < stop.size() && is_latched(stop[k]) != latched) ++k;
  return fmt::format("{}stop/{}/{}", hinge, k, field);
}

/// Adds a problem for each unphysical parameter whose pointer has no problem yet.
void refuse_unphysical(const JsonCursor& at, Scene scene) {
  name_by_index(scene.bodies);
  name_by_index(scene.hinges);
  name_by_index(scene.synchronisations);
  const std::vector<Problem> known = at.problems();
  for (const Fault& fault : unphysical(scene)) {
    std::string below = "/" + fault.path;
    std::ranges::replace(below, '.', '/');
    below = place_of_stop(at.value(), std::move(below));
    const std::string pointer = at.pointer() + below + "/";
    const auto covers = [&](const Problem& problem) {
      return problem.file == at.file() && pointer.starts_with(problem.pointer + "/");
    };
    if (std::ranges::any_of(known, covers)) continue;
    const Json::json_pointer place(below);
    const bool stated = at.value().contains(place); // else the fault is in a default
    at.refuse(stated ? describe_value(at.value()[place]) : fault.found, fault.expected, below);
  }
}

Json write_flexible(const Flexible& flexible) {
  Json json{{"joints", flexible.joints}};
  if (flexible.bending_stiffness) json["bending_stiffness"] = *flexible.bending_stiffness;
  if (flexible.frequency) json["frequency"] = *flexible.frequency;
  json["damping_ratio"] = flexible.damping_ratio;
  return json;
}

Json write_body(const Body& body) {
  Json json{{"name", body.name}, {"mass", body.mass}, {"inertia", body.inertia}};
  if (body.plate)
    json["plate"] = {{"from", write_vector(body.plate->from)},
                     {"to", write_vector(body.plate->to)},
                     {"width", body.plate->width},
                     {"drag_coefficient", body.plate->drag_coefficient}};
  if (body.flexible) json["flexible"] = write_flexible(*body.flexible);
  return json;
}

} // namespace

Scene read_scene(const JsonCursor& at) {
  const std::size_t known_problems = at.problems().size();
  Scene scene;
  JsonObject object(at, "a scene: an object");
  object.required(
      "name", scene.name, "a string, the scene's name, not empty, without control characters",
      [](const std::string& name) { return !name.empty() && !has_control_characters(name); });
  if (const auto base = object.require("base", "an object with the base's motion"))
    read_base(*base, scene.base);
  const Array bodies = read_list(object, "bodies", "an array of at least one body");
  const Array hinges = read_list(object, "hinges", "an array of at least one hinge");
  const Array loops = read_synchronisation_list(object);
  if (const auto environment = object.find("environment"))
    read_environment(*environment, scene.environment);
  const auto mirror = object.find("mirror");
  const MirrorNames names = mirror ? read_mirror(*mirror) : MirrorNames{};
  object.pass_over_schema();
  object.refuse_others();
  scene.bodies.resize(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) read_body(bodies[i], scene.bodies[i]);
  scene.hinges.resize(hinges.size());
  std::vector<HingeEnds> ends;
  for (std::size_t i = 0; i < hinges.size(); ++i)
    ends.push_back(read_hinge(hinges[i], scene.hinges[i]));
  scene.synchronisations.resize(loops.size());
  std::vector<LoopEnds> loop_ends;
  for (std::size_t i = 0; i < loops.size(); ++i)
    loop_ends.push_back(read_synchronisation(loops[i], scene.synchronisations[i]));
  refuse_unphysical(at, scene);
  check_names(at, scene);
  const std::size_t before_links = at.problems().size();
  link_hinges(at, ends, scene);
  link_releases(at, ends, scene);
  link_synchronisations(at, loop_ends, scene);
  explain_copies(names, scene, before_links, at.problems());
  if (mirror && at.problems().size() == known_problems) add_mirrored(*mirror, names, scene);
  return scene;
}

Scene read_scene(const Json& document, const std::string& file) {
  std::vector<Problem> problems;
  Scene scene = read_scene(JsonCursor(document, file, problems));
  if (!problems.empty()) throw SpecError(std::move(problems));
  return scene;
}

Json write_scene(const Scene& scene) {
  Json json{{"name", scene.name}, {"base", write_base(scene.base)}};
  json["bodies"] = Json::array();
  for (const Body& body : scene.bodies) json["bodies"].push_back(write_body(body));
  json["hinges"] = Json::array();
  for (const Hinge& hinge : scene.hinges) json["hinges"].push_back(write_hinge(scene, hinge));
  for (const Synchronisation& loop : scene.synchronisations)
    json["synchronisations"].push_back(write_synchronisation(scene, loop));
  const Environment& around = scene.environment;
  if (!around.gravity.isZero(0) || around.air_density != 0)
    json["environment"] = {{"gravity", write_vector(around.gravity)},
                           {"air_density", around.air_density}};
  return json;
}

} // namespace wingspread
