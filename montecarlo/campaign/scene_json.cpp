#include "montecarlo/campaign/scene_json.hpp"

#include "montecarlo/campaign/scene_tree.hpp"
#include "montecarlo/formats/printable.hpp"

#include <algorithm>
#include <limits>

namespace wingspread {
namespace {

using Array = std::vector<JsonCursor>;

void read_base(const JsonCursor& at, Base& base) {
  JsonObject object(at, "an object with the base's motion");
  if (!object.required_choice("motion", base.motion, base_motion_names)) return;
  if (base.motion == BaseMotion::free) {
    object.required("mass", base.mass, "a number, kg, > 0");
    object.required("inertia", base.inertia, "a number, kg·m², > 0");
    object.optional("position", base.position, "an array of 2 numbers, m");
    object.optional("velocity", base.velocity, "an array of 2 numbers, m/s");
  }
  if (base.motion == BaseMotion::prescribed) {
    object.optional("acceleration", base.acceleration, "an array of 2 numbers, m/s²");
    object.optional("angular_acceleration", base.angular_acceleration, "a number, rad/s²");
  }
  if (base.motion != BaseMotion::fixed) {
    object.optional("angle", base.angle, "a number, rad");
    object.optional("rate", base.rate, "a number, rad/s");
  }
  object.refuse_others();
}

void read_body(const JsonCursor& at, Body& body) {
  JsonObject object(at, "a body: an object");
  object.required("name", body.name, "a string, the body's name");
  object.required("mass", body.mass, "a number, kg, > 0");
  object.required("inertia", body.inertia, "a number, kg·m², > 0");
  object.refuse_others();
}

void read_angle(const JsonCursor& at, Hinge& hinge) {
  JsonObject object(at, "an object with the stowed and the latched angle");
  // Not zero: the two are compared, and one that is missing differs from whatever the other is.
  hinge.stowed = std::numeric_limits<double>::quiet_NaN();
  object.required("stowed", hinge.stowed, "a number, rad");
  object.required("latched", hinge.latched, "a number, rad, different from stowed");
  object.refuse_others();
}

void read_torque(const JsonCursor& at, LinearTorque& torque) {
  JsonObject object(at, "an object with torque_stowed and torque_latched");
  object.required("torque_stowed", torque.torque_stowed, "a number, N·m");
  object.required("torque_latched", torque.torque_latched, "a number, N·m");
  object.refuse_others();
}

/// What the other model of friction has is refused, and never ignored.
void refuse_static(JsonObject& friction) {
  if (const auto at = friction.find("static"))
    at->refuse("no static level with the regularized model (\"model\": \"exact\" has one)");
}

void read_friction(const JsonCursor& at, Friction& friction) {
  JsonObject object(at, "an object with the friction's parameters");
  object.optional("coulomb", friction.coulomb, "a number, N·m, ≥ 0");
  object.optional("viscous", friction.viscous, "a number, N·m·s/rad, ≥ 0");
  const bool known = object.optional_choice("model", friction.model, friction_model_names);
  object.optional("regularization_rate", friction.regularization_rate, "a number, rad/s, > 0");
  double static_level = 0;
  if (const auto level = object.find("static");
      level && level->read(static_level, "a number, N·m, ≥ coulomb"))
    friction.static_level = static_level;
  if (known && friction.model == FrictionModel::regularized) refuse_static(object);
  object.refuse_others();
}

void read_latch(const JsonCursor& at, std::optional<Latch>& latch) {
  JsonObject object(at, "an object with the latch's stiffness and damping");
  latch.emplace();
  object.required("stiffness", latch->stiffness, "a number, N·m/rad, ≥ 0");
  object.required("damping", latch->damping, "a number, N·m·s/rad, ≥ 0");
  object.refuse_others();
}

std::optional<std::string> read_end(JsonObject& object, std::string_view key,
                                    std::string_view expected) {
  std::string name;
  const auto at = object.require(key, expected);
  return at && at->read(name, expected) ? std::optional(name) : std::nullopt;
}

HingeEnds read_hinge(const JsonCursor& at, Hinge& hinge) {
  HingeEnds ends;
  JsonObject object(at, "a hinge: an object");
  object.required("name", hinge.name, "a string, the hinge's name");
  ends.parent = read_end(object, "parent", "a string, \"base\" or a body's name");
  ends.child = read_end(object, "child", "a string, a body's name");
  object.required("parent_point", hinge.parent_point, "an array of 2 numbers, m");
  object.required("child_point", hinge.child_point, "an array of 2 numbers, m");
  if (const auto angle = object.require("angle", "an object with the stowed and the latched angle"))
    read_angle(*angle, hinge);
  object.optional("initial_rate", hinge.initial_rate, "a number, rad/s");
  if (const auto spring = object.find("spring")) read_torque(*spring, hinge.spring);
  if (const auto harness = object.find("harness")) read_torque(*harness, hinge.harness);
  if (const auto friction = object.find("friction")) read_friction(*friction, hinge.friction);
  if (const auto latch = object.find("latch")) read_latch(*latch, hinge.latch);
  object.refuse_others();
  return ends;
}

Array read_list(JsonObject& object, std::string_view key, std::string_view expected) {
  const auto list = object.require(key, expected);
  if (list && (!list->value().is_array() || list->value().empty())) list->refuse(expected);
  return list ? list->elements() : Array{};
}

/// A problem for each parameter that physics forbids, less those in places that have one already.
void refuse_unphysical(const JsonCursor& at, Scene scene) {
  // With its index for a name, a parameter's path is its pointer.
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) scene.bodies[i].name = std::to_string(i);
  for (std::size_t i = 0; i < scene.hinges.size(); ++i) scene.hinges[i].name = std::to_string(i);
  const std::vector<Problem> known = at.problems();
  for (const Fault& fault : unphysical(scene)) {
    std::string below = "/" + fault.path;
    std::ranges::replace(below, '.', '/');
    const std::string pointer = at.pointer() + below + "/";
    const auto covers = [&](const Problem& problem) {
      return problem.file == at.file() && pointer.starts_with(problem.pointer + "/");
    };
    if (std::ranges::any_of(known, covers)) continue;
    const Json::json_pointer place(below);
    const bool stated = at.value().contains(place); // else it is a default
    at.refuse(stated ? describe_value(at.value()[place]) : fault.found, fault.expected, below);
  }
}

Json write_vector(const Eigen::Vector2d& vector) { return {vector.x(), vector.y()}; }

Json write_base(const Base& base) {
  Json json{{"motion", base_motion_names[static_cast<std::size_t>(base.motion)]}};
  if (base.motion == BaseMotion::fixed) return json;
  if (base.motion == BaseMotion::free) {
    json["mass"] = base.mass;
    json["inertia"] = base.inertia;
    json["position"] = write_vector(base.position);
    json["velocity"] = write_vector(base.velocity);
  } else {
    json["acceleration"] = write_vector(base.acceleration);
    json["angular_acceleration"] = base.angular_acceleration;
  }
  json["angle"] = base.angle;
  json["rate"] = base.rate;
  return json;
}

Json write_torque(const LinearTorque& torque) {
  return {{"torque_stowed", torque.torque_stowed}, {"torque_latched", torque.torque_latched}};
}

Json write_friction(const Friction& friction) {
  Json json{{"model", friction_model_names[static_cast<std::size_t>(friction.model)]},
            {"coulomb", friction.coulomb},
            {"viscous", friction.viscous}};
  if (friction.model == FrictionModel::regularized)
    json["regularization_rate"] = friction.regularization_rate;
  if (friction.static_level) json["static"] = *friction.static_level;
  return json;
}

Json write_hinge(const Scene& scene, const Hinge& hinge) {
  const bool on_base = hinge.parent == base_index;
  Json json{{"name", hinge.name},
            {"parent", on_base ? "base" : scene.bodies[hinge.parent].name},
            {"child", scene.bodies[hinge.child].name},
            {"parent_point", write_vector(hinge.parent_point)},
            {"child_point", write_vector(hinge.child_point)},
            {"angle", {{"stowed", hinge.stowed}, {"latched", hinge.latched}}},
            {"initial_rate", hinge.initial_rate},
            {"spring", write_torque(hinge.spring)},
            {"harness", write_torque(hinge.harness)},
            {"friction", write_friction(hinge.friction)}};
  if (hinge.latch)
    json["latch"] = {{"stiffness", hinge.latch->stiffness}, {"damping", hinge.latch->damping}};
  return json;
}

} // namespace

Scene read_scene(const JsonCursor& at) {
  Scene scene;
  JsonObject object(at, "a scene: an object");
  object.required(
      "name", scene.name, "a string, the scene's name, not empty, without control characters",
      [](const std::string& name) { return !name.empty() && !has_control_characters(name); });
  if (const auto base = object.require("base", "an object with the base's motion"))
    read_base(*base, scene.base);
  const Array bodies = read_list(object, "bodies", "an array of at least one body");
  const Array hinges = read_list(object, "hinges", "an array of at least one hinge");
  object.refuse_others();
  scene.bodies.resize(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) read_body(bodies[i], scene.bodies[i]);
  scene.hinges.resize(hinges.size());
  std::vector<HingeEnds> ends;
  for (std::size_t i = 0; i < hinges.size(); ++i)
    ends.push_back(read_hinge(hinges[i], scene.hinges[i]));
  refuse_unphysical(at, scene);
  check_names(at, scene);
  link_hinges(at, ends, scene);
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
  for (const Body& body : scene.bodies)
    json["bodies"].push_back({{"name", body.name}, {"mass", body.mass}, {"inertia", body.inertia}});
  json["hinges"] = Json::array();
  for (const Hinge& hinge : scene.hinges) json["hinges"].push_back(write_hinge(scene, hinge));
  return json;
}

} // namespace wingspread
