#include "montecarlo/model/scene_file/hinge_json.hpp"

#include "montecarlo/model/scene_file/motor_json.hpp"
#include "montecarlo/model/scene_file/torque_json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace wingspread {
namespace {

Way way_of(const Hinge& hinge) {
  if (hinge.stowed == hinge.latched) return Way::unknown; // `unphysical` tells it
  return hinge.stowed < hinge.latched ? Way::up : Way::down;
}

/// Reads both angles. Returns the hinge's sense; unknown if an angle could not be read.
Way read_angle(const JsonCursor& at, Hinge& hinge) {
  JsonObject object(at, "an object with the stowed and the latched angle");
  // NaN, so that a missing angle never equals the other: the scene's checks compare the two.
  hinge.stowed = std::numeric_limits<double>::quiet_NaN();
  const bool stowed = object.required("stowed", hinge.stowed, Dimension{"rad"});
  const bool latched =
      object.required("latched", hinge.latched, Dimension{"rad", "different from stowed"});
  object.refuse_others();
  return object.is_object() && stowed && latched ? way_of(hinge) : Way::unknown;
}

/// Refuses a key of the exact friction model beside the regularized one.
void refuse_static(JsonObject& friction) {
  if (const auto at = friction.find("static"))
    at->refuse("no static level with the regularized model (\"model\": \"exact\" has one)");
}

void read_friction(const JsonCursor& at, Friction& friction) {
  JsonObject object(at, "an object with the friction's parameters");
  object.optional("coulomb", friction.coulomb, Dimension{"N·m", "≥ 0"});
  object.optional("viscous", friction.viscous, Dimension{"N·m·s/rad", "≥ 0"});
  const bool known = object.optional_choice("model", friction.model, friction_model_names);
  object.optional("regularization_rate", friction.regularization_rate, Dimension{"rad/s", "> 0"});
  object.optional("static", friction.static_level, Dimension{"N·m", "≥ coulomb"});
  if (known && friction.model == FrictionModel::regularized) refuse_static(object);
  object.optional("scale", friction.scale, "a number, ≥ 0");
  object.refuse_others();
}

/// The unit of A in the torque A·|rate|^p.
std::string power_unit(double exponent) { return fmt::format("N·m·(s/rad)^{}", exponent); }

void read_power_law(JsonObject& object, Damper& damper) {
  const bool exponent = object.required("exponent", damper.exponent, "a number, > 0");
  const std::string unit = exponent ? power_unit(damper.exponent) : "N·m·(s/rad)^exponent";
  if (const auto at = object.find("coefficient")) at->note_quantity("N·m·(s/rad)^exponent", "≥ 0");
  object.required("coefficient", damper.coefficient, Dimension{unit, "≥ 0"});
  object.optional("regularization_rate", damper.regularization_rate, Dimension{"rad/s", "> 0"});
}

void read_damper_law(JsonObject& object, Damper& damper) {
  switch (damper.law) {
  case DamperLaw::viscous:
    object.required("coefficient", damper.coefficient, Dimension{"N·m·s/rad", "≥ 0"});
    break;
  case DamperLaw::power:
    read_power_law(object, damper);
    break;
  case DamperLaw::eddy_current:
    object.required("peak_torque", damper.peak_torque, Dimension{"N·m", "≥ 0"});
    object.required("peak_rate", damper.peak_rate, Dimension{"rad/s", "> 0"});
    break;
  }
}

void read_damper(const JsonCursor& at, std::optional<Damper>& damper) {
  JsonObject object(at, "an object with the damper's law");
  damper.emplace();
  if (!object.required_choice("law", damper->law, damper_law_names) || !object.is_object()) return;
  read_damper_law(object, *damper);
  Eigen::Vector2d window;
  if (const auto ends = object.find("window"); ends && ends->read(window, Dimension{"rad"}))
    damper->window = {window[0], window[1]};
  object.optional("scale", damper->scale, "a number, ≥ 0");
  object.refuse_others();
}

/// Reads a stop to the side that it names; without a name, the stowed side.
void read_stop(const JsonCursor& at, Hinge& hinge) {
  JsonObject object(at, "an object with the stop's stiffness and dissipation");
  enum class Side { stowed, latched } side = Side::stowed;
  const bool known = object.optional_choice("side", side, stop_side_names);
  std::optional<Stop>& stop = side == Side::latched ? hinge.far_stop : hinge.stop;
  if (known && stop && object.is_object()) at.refuse_repeated("one stop at each side");
  stop.emplace();
  object.required("stiffness", stop->stiffness, Dimension{"N·m/rad", "≥ 0"});
  object.optional("dissipation", stop->dissipation, Dimension{"s/rad", "≥ 0"});
  object.optional("gap", stop->gap, Dimension{"rad", "≥ 0"});
  object.refuse_others();
}

void read_stops(const JsonCursor& at, Hinge& hinge) {
  if (!at.value().is_array()) return read_stop(at, hinge);
  if (at.value().empty() || at.value().size() > 2)
    return void(at.refuse("a stop, or an array of two, one at each side"));
  for (const JsonCursor& element : at.elements()) read_stop(element, hinge);
}

/// Reads the event for which a release waits.
void read_event(const JsonCursor& at, Release& release) {
  if (!at.value().is_object()) {
    const auto index = at.choice(release_event_names);
    if (index) release.event = *index == 0 ? Release::Event::latched : Release::Event::released;
    return;
  }
  JsonObject object(at, "\"latched\", \"released\", or an object with the other hinge's angle");
  release.event = Release::Event::passed;
  object.required("angle", release.angle, Dimension{"rad", "> 0"});
  object.refuse_others();
}

/// Returns the name of the hinge for which the release waits.
std::optional<std::string> read_release(const JsonCursor& at, Release& release) {
  JsonObject object(at, "an object with the time of the release, or the hinge and event that it "
                        "waits for");
  std::optional<std::string> after;
  if (const auto other = object.find("after")) {
    if (std::string name; other->read(name, "a string, another hinge's name")) after = name;
    if (const auto event = object.require(
            "event", "\"latched\", \"released\", or an object with the other hinge's angle"))
      read_event(*event, release);
  } else if (const auto time =
                 object.require("time", "a number, s, ≥ 0, or \"after\" in its place")) {
    time->read(release.time, Dimension{"s", "≥ 0"});
  }
  object.optional("delay", release.delay, Dimension{"s", "≥ 0"});
  object.optional("fails", release.fails, "0 or 1");
  object.refuse_others();
  return after;
}

/// Reads an elastic hold. @param released whether the hinge has a release
void read_hold(const JsonCursor& at, bool released, std::optional<Hold>& hold) {
  JsonObject object(at, "an object with the hold's stiffness and damping");
  if (!released) return void(at.refuse("no hold without a release: nothing would let go"));
  hold.emplace();
  object.required("stiffness", hold->stiffness, Dimension{"N·m/rad", "> 0"});
  object.optional("damping", hold->damping, Dimension{"N·m·s/rad", "≥ 0"});
  object.refuse_others();
}

void read_latch(const JsonCursor& at, std::optional<Latch>& latch) {
  JsonObject object(at, "an object with the latch's stiffness, and its damping or dissipation");
  latch.emplace();
  object.required("stiffness", latch->stiffness, Dimension{"N·m/rad", "≥ 0"});
  if (const auto dissipation = object.find("dissipation")) {
    latch->dissipation = 0;
    dissipation->read(*latch->dissipation, Dimension{"s/rad", "≥ 0"});
    if (const auto damping = object.find("damping"))
      damping->refuse("no damping beside \"dissipation\": a latch has one of the two");
  } else if (const auto damping = object.require(
                 "damping", "a number, N·m·s/rad, ≥ 0, or \"dissipation\" in its place")) {
    damping->read(latch->damping, Dimension{"N·m·s/rad", "≥ 0"});
  }
  object.optional("backlash", latch->backlash,
                  Dimension{"rad", "≥ 0: the total play, half of it on either side"});
  object.optional("capture_rate", latch->capture_rate, Dimension{"rad/s", "≥ 0"});
  if (const auto moment = object.find("holding_moment"))
    moment->note(
        Question::What::quantity,
        "a number, N·m, > 0, or a string of a number and its unit, such as \"12 N*m\": a load "
        "towards stowed opens the engaged latch from this moment on; a load the other way "
        "never does");
  object.optional("holding_moment", latch->holding_moment, Dimension{"N·m", "> 0"});
  object.refuse_others();
}

/// Refuses the laws that a joint replaces.
void refuse_laws_beside_joint(JsonObject& object) {
  for (const char* key :
       {"spring", "harness", "friction", "damper", "stop", "latch", "release", "hold", "motor"})
    if (const auto law = object.find(key))
      law->refuse(
          fmt::format("no \"{}\" beside \"joint\": an elastic joint has no other law", key));
}

/// Reads an elastic joint and its angle, one number.
void read_joint(JsonObject& object, const JsonCursor& at, Hinge& hinge) {
  JsonObject joint(at, "an object with the joint's stiffness and damping");
  hinge.joint.emplace();
  joint.required("stiffness", hinge.joint->stiffness, Dimension{"N·m/rad", "> 0"});
  joint.optional("damping", hinge.joint->damping, Dimension{"N·m·s/rad", "≥ 0"});
  joint.refuse_others();
  if (const auto angle = object.find("angle"); angle && angle->value().is_object())
    angle->refuse("one number, rad: an elastic joint rests at one angle");
  else
    object.required("angle", hinge.stowed, Dimension{"rad"});
  hinge.latched = hinge.stowed;
  refuse_laws_beside_joint(object);
}

std::optional<std::string> read_end(JsonObject& object, std::string_view key,
                                    std::string_view expected) {
  std::string name;
  const auto at = object.require(key, expected);
  return at && at->read(name, expected) ? std::optional(name) : std::nullopt;
}

/// Reads all torques, the damper, stops, latch and motor.
void read_laws(JsonObject& object, Way way, Hinge& hinge) {
  if (const auto spring = object.find("spring")) read_spring(*spring, way, hinge.spring);
  if (const auto harness = object.find("harness")) read_harness(*harness, way, hinge.harness);
  if (const auto friction = object.find("friction")) read_friction(*friction, hinge.friction);
  if (const auto damper = object.find("damper")) read_damper(*damper, hinge.damper);
  if (const auto stop = object.find("stop")) read_stops(*stop, hinge);
  if (const auto latch = object.find("latch")) read_latch(*latch, hinge.latch);
  if (const auto motor = object.find("motor")) read_motor(*motor, hinge.motor);
}

Json write_angle(const Hinge& hinge) {
  if (hinge.joint) return hinge.stowed;
  return {{"stowed", hinge.stowed}, {"latched", hinge.latched}};
}

Json write_friction(const Friction& friction) {
  Json json{{"model", friction_model_names[static_cast<std::size_t>(friction.model)]},
            {"coulomb", friction.coulomb},
            {"viscous", friction.viscous}};
  if (friction.model == FrictionModel::regularized)
    json["regularization_rate"] = friction.regularization_rate;
  if (friction.static_level) json["static"] = *friction.static_level;
  if (friction.scale != 1) json["scale"] = friction.scale;
  return json;
}

Json write_damper(const Damper& damper) {
  Json json{{"law", damper_law_names[static_cast<std::size_t>(damper.law)]}};
  if (damper.law == DamperLaw::eddy_current) {
    json["peak_torque"] = damper.peak_torque;
    json["peak_rate"] = damper.peak_rate;
  } else {
    json["coefficient"] = damper.coefficient;
  }
  if (damper.law == DamperLaw::power) {
    json["exponent"] = damper.exponent;
    json["regularization_rate"] = damper.regularization_rate;
  }
  if (damper.window) json["window"] = *damper.window;
  json["scale"] = damper.scale;
  return json;
}

Json write_latch(const Latch& latch) {
  Json json{{"stiffness", latch.stiffness}};
  if (latch.dissipation)
    json["dissipation"] = *latch.dissipation;
  else
    json["damping"] = latch.damping;
  if (latch.backlash != 0) json["backlash"] = latch.backlash;
  if (latch.capture_rate) json["capture_rate"] = *latch.capture_rate;
  if (latch.holding_moment) json["holding_moment"] = *latch.holding_moment;
  return json;
}

Json write_stop(const Stop& stop) {
  return {{"stiffness", stop.stiffness}, {"dissipation", stop.dissipation}, {"gap", stop.gap}};
}

/// A single stop at the stowed side has no "side", so that its scene keeps its hash; others have it.
Json write_stops(const Hinge& hinge) {
  if (!hinge.far_stop) return write_stop(*hinge.stop);
  Json beyond = write_stop(*hinge.far_stop);
  beyond["side"] = "latched";
  if (!hinge.stop) return beyond;
  Json stowed = write_stop(*hinge.stop);
  stowed["side"] = "stowed";
  return Json::array({stowed, beyond});
}

Json write_release(const Scene& scene, const Release& release) {
  Json json = Json::object();
  if (release.event == Release::Event::time) {
    json["time"] = release.time;
  } else {
    json["after"] = scene.hinges[release.after].name;
    if (release.event == Release::Event::passed)
      json["event"] = {{"angle", release.angle}};
    else
      json["event"] = release_event_names[release.event == Release::Event::latched ? 0 : 1];
  }
  json["delay"] = release.delay;
  json["fails"] = release.fails;
  return json;
}

} // namespace

HingeEnds read_hinge(const JsonCursor& at, Hinge& hinge) {
  HingeEnds ends;
  JsonObject object(at, "a hinge: an object");
  object.required("name", hinge.name, "a string, the hinge's name");
  ends.parent = read_end(object, "parent", "a string, \"base\" or a body's name");
  ends.child = read_end(object, "child", "a string, a body's name");
  object.required("parent_point", hinge.parent_point, Dimension{"m"});
  object.required("child_point", hinge.child_point, Dimension{"m"});
  object.optional("initial_rate", hinge.initial_rate, Dimension{"rad/s"});
  if (const auto joint = object.find("joint")) {
    read_joint(object, *joint, hinge);
  } else {
    const auto angle = object.require("angle", "an object with the stowed and the latched angle");
    read_laws(object, angle ? read_angle(*angle, hinge) : Way::unknown, hinge);
    if (const auto release = object.find("release"))
      ends.after = read_release(*release, hinge.release.emplace());
    if (const auto hold = object.find("hold"))
      read_hold(*hold, hinge.release.has_value(), hinge.hold);
  }
  object.refuse_others();
  return ends;
}

// Optional parts are written only where they are used: a campaign's hash depends on the JSON.
Json write_hinge(const Scene& scene, const Hinge& hinge) {
  const bool on_base = hinge.parent == base_index;
  Json json{{"name", hinge.name},
            {"parent", on_base ? "base" : scene.bodies[hinge.parent].name},
            {"child", scene.bodies[hinge.child].name},
            {"parent_point", write_vector(hinge.parent_point)},
            {"child_point", write_vector(hinge.child_point)},
            {"angle", write_angle(hinge)},
            {"initial_rate", hinge.initial_rate}};
  if (hinge.joint) {
    json["joint"] = {{"stiffness", hinge.joint->stiffness}, {"damping", hinge.joint->damping}};
    return json;
  }
  json["spring"] = write_torque(hinge.spring);
  json["harness"] = write_torque(hinge.harness);
  json["friction"] = write_friction(hinge.friction);
  if (hinge.damper) json["damper"] = write_damper(*hinge.damper);
  if (hinge.stop || hinge.far_stop) json["stop"] = write_stops(hinge);
  if (hinge.latch) json["latch"] = write_latch(*hinge.latch);
  if (hinge.release) json["release"] = write_release(scene, *hinge.release);
  if (hinge.hold)
    json["hold"] = {{"stiffness", hinge.hold->stiffness}, {"damping", hinge.hold->damping}};
  if (hinge.motor) json["motor"] = write_motor(*hinge.motor);
  return json;
}

Json write_vector(const Eigen::Vector2d& vector) { return {vector.x(), vector.y()}; }

} // namespace wingspread
