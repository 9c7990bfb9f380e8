#include "montecarlo/model/scene_file/scene_parameter.hpp"

#include "montecarlo/foundation/formats/nearest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>

namespace wingspread {
namespace {

/// One number of a base, body, hinge, synchronisation or environment. The tables below list all of them.
template <class Owner> struct Field {
  template <class Get>
  constexpr Field(std::string_view field_path, std::string_view field_unit, Get get,
                  bool (*is_there)(const Owner&) = nullptr, std::string_view field_needs = "")
      : path(field_path), unit(field_unit), read(get), write(get), exists(is_there),
        needs(field_needs) {}

  std::string_view path; ///< after the owner's name
  std::string_view unit;
  const double& (*read)(const Owner&);
  double& (*write)(Owner&);
  bool (*exists)(const Owner&); ///< null: always
  std::string_view needs;       ///< what has the field, for a message

  [[nodiscard]] bool in(const Owner& owner) const { return !exists || exists(owner); }
};

bool is_free(const Base& base) { return base.motion == BaseMotion::free; }
bool is_prescribed(const Base& base) { return base.motion == BaseMotion::prescribed; }
bool is_moving(const Base& base) { return base.motion != BaseMotion::fixed; }
bool has_table(const Base& base) { return is_prescribed(base) && base.table; }
bool has_acceleration(const Base& base) {
  return is_prescribed(base) && !(base.table && base.table->gives_acceleration());
}
bool has_angular_acceleration(const Base& base) {
  return is_prescribed(base) && !(base.table && base.table->gives_turning());
}
bool has_rate(const Base& base) {
  return is_moving(base) && !(has_table(base) && base.table->gives_rate());
}
bool has_plate(const Body& body) { return body.plate.has_value(); }
bool has_stiffness(const Body& body) { return body.flexible && body.flexible->bending_stiffness; }
bool has_frequency(const Body& body) { return body.flexible && body.flexible->frequency; }
bool is_flexible(const Body& body) { return body.flexible.has_value(); }
bool has_joint(const Hinge& hinge) { return hinge.joint.has_value(); }
bool has_laws(const Hinge& hinge) { return !hinge.joint; }
bool has_spring_line(const Hinge& hinge) { return !hinge.joint && !hinge.spring.table; }
bool has_harness_line(const Hinge& hinge) { return !hinge.joint && !hinge.harness.table; }
bool has_damper(const Hinge& hinge) { return hinge.damper.has_value(); }
bool has_law(const Hinge& hinge, DamperLaw law) { return hinge.damper && hinge.damper->law == law; }
bool has_eddy_current(const Hinge& hinge) { return has_law(hinge, DamperLaw::eddy_current); }
bool has_power_law(const Hinge& hinge) { return has_law(hinge, DamperLaw::power); }
bool has_coefficient(const Hinge& hinge) { return hinge.damper && !has_eddy_current(hinge); }
bool has_window(const Hinge& hinge) { return hinge.damper && hinge.damper->window; }
bool has_stop(const Hinge& hinge) { return hinge.stop.has_value(); }
bool has_far_stop(const Hinge& hinge) { return hinge.far_stop.has_value(); }
bool has_capture_rate(const Hinge& hinge) { return hinge.latch && hinge.latch->capture_rate; }
bool has_holding_moment(const Hinge& hinge) { return hinge.latch && hinge.latch->holding_moment; }
bool has_release(const Hinge& hinge) { return hinge.release.has_value(); }
bool has_event(const Hinge& hinge, Release::Event event) {
  return hinge.release && hinge.release->event == event;
}
bool has_release_time(const Hinge& hinge) { return has_event(hinge, Release::Event::time); }
bool has_release_angle(const Hinge& hinge) { return has_event(hinge, Release::Event::passed); }
bool has_ratio(const Synchronisation& loop) { return !loop.table; }
bool has_preload(const Synchronisation& loop) { return loop.preload.has_value(); }
bool has_latch(const Hinge& hinge) { return hinge.latch.has_value(); }
bool has_dissipation(const Hinge& hinge) { return hinge.latch && hinge.latch->dissipation; }
bool has_damping(const Hinge& hinge) { return hinge.latch && !hinge.latch->dissipation; }
bool has_static(const Hinge& hinge) { return hinge.friction.static_level.has_value(); }
bool is_regularized(const Hinge& hinge) {
  return !hinge.joint && hinge.friction.model == FrictionModel::regularized;
}

constexpr std::string_view needs_free = "a base whose motion is \"free\"";
constexpr std::string_view needs_acceleration =
    "a base whose motion is \"prescribed\", with no table of it (table.scale disperses one)";
constexpr std::string_view needs_table = "a base whose motion is prescribed by a table";
constexpr std::string_view needs_motion = "a base that is not fixed";
constexpr std::string_view needs_rate = "a base that is not fixed, with no table of its rate";
constexpr std::string_view needs_plate = "a body that has a plate";
constexpr std::string_view needs_flexible = "a body that is flexible";
constexpr std::string_view needs_stiffness = "a flexible body with a bending_stiffness";
constexpr std::string_view needs_frequency = "a flexible body with a frequency";
constexpr std::string_view needs_joint = "a hinge that is an elastic joint";
constexpr std::string_view needs_laws = "a hinge that is no elastic joint";
constexpr std::string_view needs_spring_line =
    "a hinge whose spring has no table (scale and offset disperse one)";
constexpr std::string_view needs_harness_line =
    "a hinge whose harness has no table (scale and offset disperse one)";
constexpr std::string_view needs_damper = "a hinge that has a damper";
constexpr std::string_view needs_coefficient = "a hinge with a viscous or a power-law damper";
constexpr std::string_view needs_power_law = "a hinge with a power-law damper";
constexpr std::string_view needs_eddy_current = "a hinge with an eddy-current damper";
constexpr std::string_view needs_window = "a hinge whose damper has a window";
constexpr std::string_view needs_stop = "a hinge that has a stop";
constexpr std::string_view needs_far_stop = "a hinge that has a stop at its latched side";
constexpr std::string_view needs_capture_rate = "a hinge whose latch has a capture_rate";
constexpr std::string_view needs_holding_moment = "a hinge whose latch has a holding_moment";
constexpr std::string_view needs_release = "a hinge that has a release";
constexpr std::string_view needs_release_time = "a hinge with a release at a time";
constexpr std::string_view needs_release_angle =
    "a hinge with a release after another hinge's angle";
constexpr std::string_view needs_ratio = "a synchronisation whose ratio is a number";
constexpr std::string_view needs_preload = "a synchronisation that has a preload";
constexpr std::string_view needs_latch = "a hinge that has a latch";
constexpr std::string_view needs_damping = "a hinge whose latch has a damping";
constexpr std::string_view needs_dissipation = "a hinge whose latch has a dissipation";
constexpr std::string_view needs_regularized = "a hinge with the regularized friction model";
constexpr std::string_view needs_static = "a hinge whose friction has a static level";

// clang-format off
constexpr std::array base_fields{
    Field<Base>{"mass", "kg", [](auto& b) -> auto& { return b.mass; }, is_free, needs_free},
    Field<Base>{"inertia", "kg·m²", [](auto& b) -> auto& { return b.inertia; }, is_free, needs_free},
    Field<Base>{"position.0", "m", [](auto& b) -> auto& { return b.position[0]; }, is_free, needs_free},
    Field<Base>{"position.1", "m", [](auto& b) -> auto& { return b.position[1]; }, is_free, needs_free},
    Field<Base>{"velocity.0", "m/s", [](auto& b) -> auto& { return b.velocity[0]; }, is_free, needs_free},
    Field<Base>{"velocity.1", "m/s", [](auto& b) -> auto& { return b.velocity[1]; }, is_free, needs_free},
    Field<Base>{"acceleration.0", "m/s²", [](auto& b) -> auto& { return b.acceleration[0]; }, has_acceleration, needs_acceleration},
    Field<Base>{"acceleration.1", "m/s²", [](auto& b) -> auto& { return b.acceleration[1]; }, has_acceleration, needs_acceleration},
    Field<Base>{"angular_acceleration", "rad/s²", [](auto& b) -> auto& { return b.angular_acceleration; }, has_angular_acceleration, needs_acceleration},
    Field<Base>{"table.scale", "", [](auto& b) -> auto& { return b.table_scale; }, has_table, needs_table},
    Field<Base>{"angle", "rad", [](auto& b) -> auto& { return b.angle; }, is_moving, needs_motion},
    Field<Base>{"rate", "rad/s", [](auto& b) -> auto& { return b.rate; }, has_rate, needs_rate}};

constexpr std::array body_fields{
    Field<Body>{"mass", "kg", [](auto& b) -> auto& { return b.mass; }},
    Field<Body>{"inertia", "kg·m²", [](auto& b) -> auto& { return b.inertia; }},
    Field<Body>{"plate.width", "m", [](auto& b) -> auto& { return b.plate->width; }, has_plate, needs_plate},
    Field<Body>{"plate.drag_coefficient", "", [](auto& b) -> auto& { return b.plate->drag_coefficient; }, has_plate, needs_plate},
    Field<Body>{"flexible.bending_stiffness", "N·m²", [](auto& b) -> auto& { return *b.flexible->bending_stiffness; }, has_stiffness, needs_stiffness},
    Field<Body>{"flexible.frequency", "Hz", [](auto& b) -> auto& { return *b.flexible->frequency; }, has_frequency, needs_frequency},
    Field<Body>{"flexible.damping_ratio", "", [](auto& b) -> auto& { return b.flexible->damping_ratio; }, is_flexible, needs_flexible}};

constexpr std::array hinge_fields{
    Field<Hinge>{"parent_point.0", "m", [](auto& h) -> auto& { return h.parent_point[0]; }},
    Field<Hinge>{"parent_point.1", "m", [](auto& h) -> auto& { return h.parent_point[1]; }},
    Field<Hinge>{"child_point.0", "m", [](auto& h) -> auto& { return h.child_point[0]; }},
    Field<Hinge>{"child_point.1", "m", [](auto& h) -> auto& { return h.child_point[1]; }},
    Field<Hinge>{"angle.stowed", "rad", [](auto& h) -> auto& { return h.stowed; }, has_laws, needs_laws},
    Field<Hinge>{"angle.latched", "rad", [](auto& h) -> auto& { return h.latched; }, has_laws, needs_laws},
    Field<Hinge>{"initial_rate", "rad/s", [](auto& h) -> auto& { return h.initial_rate; }},
    Field<Hinge>{"spring.torque_stowed", "N·m", [](auto& h) -> auto& { return h.spring.torque_stowed; }, has_spring_line, needs_spring_line},
    Field<Hinge>{"spring.torque_latched", "N·m", [](auto& h) -> auto& { return h.spring.torque_latched; }, has_spring_line, needs_spring_line},
    Field<Hinge>{"spring.scale", "", [](auto& h) -> auto& { return h.spring.scale; }, has_laws, needs_laws},
    Field<Hinge>{"spring.offset", "N·m", [](auto& h) -> auto& { return h.spring.offset; }, has_laws, needs_laws},
    Field<Hinge>{"harness.torque_stowed", "N·m", [](auto& h) -> auto& { return h.harness.torque_stowed; }, has_harness_line, needs_harness_line},
    Field<Hinge>{"harness.torque_latched", "N·m", [](auto& h) -> auto& { return h.harness.torque_latched; }, has_harness_line, needs_harness_line},
    Field<Hinge>{"harness.scale", "", [](auto& h) -> auto& { return h.harness.scale; }, has_laws, needs_laws},
    Field<Hinge>{"harness.offset", "N·m", [](auto& h) -> auto& { return h.harness.offset; }, has_laws, needs_laws},
    Field<Hinge>{"friction.coulomb", "N·m", [](auto& h) -> auto& { return h.friction.coulomb; }, has_laws, needs_laws},
    Field<Hinge>{"friction.viscous", "N·m·s/rad", [](auto& h) -> auto& { return h.friction.viscous; }, has_laws, needs_laws},
    Field<Hinge>{"friction.regularization_rate", "rad/s", [](auto& h) -> auto& { return h.friction.regularization_rate; }, is_regularized, needs_regularized},
    Field<Hinge>{"friction.static", "N·m", [](auto& h) -> auto& { return *h.friction.static_level; }, has_static, needs_static},
    Field<Hinge>{"friction.scale", "", [](auto& h) -> auto& { return h.friction.scale; }, has_laws, needs_laws},
    Field<Hinge>{"damper.coefficient", "N·m·(s/rad)^p", [](auto& h) -> auto& { return h.damper->coefficient; }, has_coefficient, needs_coefficient},
    Field<Hinge>{"damper.exponent", "", [](auto& h) -> auto& { return h.damper->exponent; }, has_power_law, needs_power_law},
    Field<Hinge>{"damper.regularization_rate", "rad/s", [](auto& h) -> auto& { return h.damper->regularization_rate; }, has_power_law, needs_power_law},
    Field<Hinge>{"damper.peak_torque", "N·m", [](auto& h) -> auto& { return h.damper->peak_torque; }, has_eddy_current, needs_eddy_current},
    Field<Hinge>{"damper.peak_rate", "rad/s", [](auto& h) -> auto& { return h.damper->peak_rate; }, has_eddy_current, needs_eddy_current},
    Field<Hinge>{"damper.window.0", "rad", [](auto& h) -> auto& { return (*h.damper->window)[0]; }, has_window, needs_window},
    Field<Hinge>{"damper.window.1", "rad", [](auto& h) -> auto& { return (*h.damper->window)[1]; }, has_window, needs_window},
    Field<Hinge>{"damper.scale", "", [](auto& h) -> auto& { return h.damper->scale; }, has_damper, needs_damper},
    Field<Hinge>{"stop.stiffness", "N·m/rad", [](auto& h) -> auto& { return h.stop->stiffness; }, has_stop, needs_stop},
    Field<Hinge>{"stop.dissipation", "s/rad", [](auto& h) -> auto& { return h.stop->dissipation; }, has_stop, needs_stop},
    Field<Hinge>{"stop.gap", "rad", [](auto& h) -> auto& { return h.stop->gap; }, has_stop, needs_stop},
    Field<Hinge>{"far_stop.stiffness", "N·m/rad", [](auto& h) -> auto& { return h.far_stop->stiffness; }, has_far_stop, needs_far_stop},
    Field<Hinge>{"far_stop.dissipation", "s/rad", [](auto& h) -> auto& { return h.far_stop->dissipation; }, has_far_stop, needs_far_stop},
    Field<Hinge>{"far_stop.gap", "rad", [](auto& h) -> auto& { return h.far_stop->gap; }, has_far_stop, needs_far_stop},
    Field<Hinge>{"release.time", "s", [](auto& h) -> auto& { return h.release->time; }, has_release_time, needs_release_time},
    Field<Hinge>{"release.event.angle", "rad", [](auto& h) -> auto& { return h.release->angle; }, has_release_angle, needs_release_angle},
    Field<Hinge>{"release.delay", "s", [](auto& h) -> auto& { return h.release->delay; }, has_release, needs_release},
    Field<Hinge>{"release.fails", "", [](auto& h) -> auto& { return h.release->fails; }, has_release, needs_release},
    Field<Hinge>{"latch.capture_rate", "rad/s", [](auto& h) -> auto& { return *h.latch->capture_rate; }, has_capture_rate, needs_capture_rate},
    Field<Hinge>{"latch.holding_moment", "N·m", [](auto& h) -> auto& { return *h.latch->holding_moment; }, has_holding_moment, needs_holding_moment},
    Field<Hinge>{"latch.stiffness", "N·m/rad", [](auto& h) -> auto& { return h.latch->stiffness; }, has_latch, needs_latch},
    Field<Hinge>{"latch.damping", "N·m·s/rad", [](auto& h) -> auto& { return h.latch->damping; }, has_damping, needs_damping},
    Field<Hinge>{"latch.dissipation", "s/rad", [](auto& h) -> auto& { return *h.latch->dissipation; }, has_dissipation, needs_dissipation},
    Field<Hinge>{"latch.backlash", "rad", [](auto& h) -> auto& { return h.latch->backlash; }, has_latch, needs_latch},
    Field<Hinge>{"angle", "rad", [](auto& h) -> auto& { return h.stowed; }, has_joint, needs_joint},
    Field<Hinge>{"joint.stiffness", "N·m/rad", [](auto& h) -> auto& { return h.joint->stiffness; }, has_joint, needs_joint},
    Field<Hinge>{"joint.damping", "N·m·s/rad", [](auto& h) -> auto& { return h.joint->damping; }, has_joint, needs_joint}};

constexpr std::array synchronisation_fields{
    Field<Synchronisation>{"ratio", "", [](auto& s) -> auto& { return s.ratio; }, has_ratio, needs_ratio},
    Field<Synchronisation>{"stiffness", "N·m/rad", [](auto& s) -> auto& { return s.stiffness; }},
    Field<Synchronisation>{"damping", "N·m·s/rad", [](auto& s) -> auto& { return s.damping; }},
    Field<Synchronisation>{"preload", "N·m", [](auto& s) -> auto& { return *s.preload; }, has_preload, needs_preload}};

constexpr std::array environment_fields{
    Field<Environment>{"gravity.0", "m/s²", [](auto& e) -> auto& { return e.gravity[0]; }},
    Field<Environment>{"gravity.1", "m/s²", [](auto& e) -> auto& { return e.gravity[1]; }},
    Field<Environment>{"air_density", "kg/m³", [](auto& e) -> auto& { return e.air_density; }}};
// clang-format on

using Owner = SceneParameter::Owner;

/// Calls `use(owner, fields)` with the parameter's owner and its table of fields.
template <class SceneType, class Use>
decltype(auto) with_owner(const SceneParameter& parameter, SceneType& scene, Use use) {
  switch (parameter.owner) {
  case Owner::body:
    return use(scene.bodies[parameter.index], body_fields);
  case Owner::hinge:
    return use(scene.hinges[parameter.index], hinge_fields);
  case Owner::synchronisation:
    return use(scene.synchronisations[parameter.index], synchronisation_fields);
  case Owner::environment:
    return use(scene.environment, environment_fields);
  case Owner::base:
    break;
  }
  return use(scene.base, base_fields);
}

/// The first word of a path, by Owner.
constexpr std::array<std::string_view, 5> lists{"base", "bodies", "hinges", "synchronisations",
                                                "environment"};

/// The parts of a path: bodies.NAME.field, or base.field.
struct Path {
  std::string_view list, name, field;
};

/// Whether paths have no name after this word.
bool is_nameless(std::string_view list) { return list == "base" || list == "environment"; }

Path split(std::string_view path) {
  const auto cut = [&path] {
    const auto dot = path.find('.');
    const std::string_view first = path.substr(0, dot);
    path = dot == std::string_view::npos ? "" : path.substr(dot + 1);
    return first;
  };
  const std::string_view list = cut();
  const std::string_view name = is_nameless(list) ? "" : cut();
  return {list, name, path};
}

/// Whether the name matches the pattern; `*` matches any characters.
bool is_like(std::string_view name, std::string_view pattern) {
  std::size_t n = 0, p = 0, star = pattern.size(), after_star = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++, after_star = n;
    } else if (p < pattern.size() && pattern[p] == name[n]) {
      ++n, ++p;
    } else if (star < pattern.size()) { // let the last star match one more character
      p = star + 1, n = ++after_star;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

/// Adds the path's matches among owners of one kind. Where an owner lacks the field, notes what would have it.
template <class Named, std::size_t n>
void match(Owner kind, std::span<const Named> owners, const std::array<Field<Named>, n>& fields,
           const Path& path, ParameterMatches& found) {
  const auto of_path = [&](const Field<Named>& field) { return field.path == path.field; };
  const auto field = std::ranges::find_if(fields, of_path);
  if (field == fields.end()) return;
  for (std::size_t i = 0; i < owners.size(); ++i) {
    std::string name;
    if constexpr (requires { owners[i].name; }) name = owners[i].name;
    if (!is_like(name, path.name)) continue;
    if (field->in(owners[i]))
      found.matches.push_back(
          {{kind, static_cast<int>(i), static_cast<int>(field - fields.begin())}, name});
    else
      found.expected = field->needs;
  }
}

template <class Named, std::size_t n>
void list_paths(const std::string& prefix, const Named& owner,
                const std::array<Field<Named>, n>& fields, std::vector<std::string>& paths) {
  for (const auto& field : fields)
    if (field.in(owner)) paths.push_back(prefix + std::string(field.path));
}

/// All paths of the scene, for suggestions; names that match the path's pattern are replaced by the pattern.
std::vector<std::string> candidates(const Scene& scene, const Path& path) {
  std::vector<std::string> paths = parameter_paths(scene);
  if (path.name.find('*') == std::string_view::npos) return paths;
  for (std::string& candidate : paths) {
    const auto [list, name, field] = split(candidate);
    if (!name.empty() && is_like(name, path.name))
      candidate = fmt::format("{}.{}.{}", list, path.name, field);
  }
  return paths;
}

} // namespace

double& SceneParameter::in(Scene& scene) const {
  return with_owner(*this, scene, [this](auto& its, const auto& fields) -> double& {
    return fields[field].write(its);
  });
}

double SceneParameter::in(const Scene& scene) const {
  return with_owner(*this, scene, [this](const auto& its, const auto& fields) {
    return fields[field].read(its);
  });
}

ParameterMatches resolve(const Scene& scene, std::string_view path) {
  const Path parts = split(path);
  ParameterMatches found;
  if (parts.list == "base")
    match<Base>(Owner::base, {&scene.base, 1}, base_fields, parts, found);
  else if (parts.list == "bodies")
    match<Body>(Owner::body, scene.bodies, body_fields, parts, found);
  else if (parts.list == "hinges")
    match<Hinge>(Owner::hinge, scene.hinges, hinge_fields, parts, found);
  else if (parts.list == "synchronisations")
    match<Synchronisation>(Owner::synchronisation, scene.synchronisations, synchronisation_fields,
                           parts, found);
  else if (parts.list == "environment")
    match<Environment>(Owner::environment, {&scene.environment, 1}, environment_fields, parts,
                       found);
  if (!found.matches.empty())
    found.expected.clear();
  else if (found.expected.empty())
    found.expected = "the path of a parameter" + did_you_mean(path, candidates(scene, parts));
  return found;
}

std::vector<ParameterMatch> read_path(const JsonCursor& at, const Scene* scene) {
  std::string path;
  if (!at.read(path, "a string, the path of a parameter") || !scene) return {};
  ParameterMatches found = resolve(*scene, path);
  if (found.matches.empty()) at.refuse(found.expected);
  return std::move(found.matches);
}

std::vector<SceneParameter> read_paths(const JsonCursor& at, const Scene* scene) {
  std::vector<SceneParameter> parameters;
  if (!at.value().is_array() || at.value().empty())
    at.refuse("an array of at least one parameter's path");
  for (const JsonCursor& element : at.elements())
    for (const ParameterMatch& match : read_path(element, scene))
      if (std::ranges::find(parameters, match.parameter) == parameters.end())
        parameters.push_back(match.parameter);
      else
        element.refuse_repeated(path_of(*scene, match.parameter), "each parameter once");
  return parameters;
}

std::string path_of(const Scene& scene, const SceneParameter& parameter) {
  return with_owner(parameter, scene, [&](const auto& owner, const auto& fields) {
    const std::string_view field = fields[parameter.field].path;
    const std::string_view list = lists[static_cast<std::size_t>(parameter.owner)];
    if constexpr (requires { owner.name; })
      return fmt::format("{}.{}.{}", list, owner.name, field);
    else
      return fmt::format("{}.{}", list, field);
  });
}

std::vector<std::string> paths_of(const Scene& scene, std::span<const SceneParameter> parameters) {
  std::vector<std::string> paths;
  for (const SceneParameter& parameter : parameters) paths.push_back(path_of(scene, parameter));
  return paths;
}

std::string_view unit_of(const SceneParameter& parameter) {
  const auto [owner, field] = std::pair(parameter.owner, parameter.field);
  if (owner == Owner::body) return body_fields[field].unit;
  if (owner == Owner::hinge) return hinge_fields[field].unit;
  if (owner == Owner::synchronisation) return synchronisation_fields[field].unit;
  if (owner == Owner::environment) return environment_fields[field].unit;
  return base_fields[field].unit;
}

std::vector<std::string> parameter_paths(const Scene& scene) {
  std::vector<std::string> paths;
  list_paths("base.", scene.base, base_fields, paths);
  for (const Body& body : scene.bodies)
    list_paths("bodies." + body.name + ".", body, body_fields, paths);
  for (const Hinge& hinge : scene.hinges)
    list_paths("hinges." + hinge.name + ".", hinge, hinge_fields, paths);
  for (const Synchronisation& loop : scene.synchronisations)
    list_paths("synchronisations." + loop.name + ".", loop, synchronisation_fields, paths);
  list_paths("environment.", scene.environment, environment_fields, paths);
  return paths;
}

} // namespace wingspread
