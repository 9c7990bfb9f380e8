#include "montecarlo/model/scene_file/scene_parameter.hpp"

#include "montecarlo/foundation/formats/nearest.hpp"
#include "montecarlo/model/scene_file/parameter_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>

namespace wingspread {
namespace {

using namespace parameter_fields;
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

/// Adds the path's matches among owners of one kind. Where an owner lacks the field, notes what would have it.
template <class Named, std::size_t n>
void match(Owner kind, std::span<const Named> owners, const std::array<Field<Named>, n>& fields,
           const Path& path, ParameterMatches& found) {
  for (std::size_t i = 0; i < owners.size(); ++i) {
    std::string name;
    if constexpr (requires { owners[i].name; }) name = owners[i].name;
    if (!is_like(name, path.name)) continue;
    for (std::size_t k = 0; k < n; ++k) { // fields with one path differ in who has them
      if (fields[k].path != path.field) continue;
      if (fields[k].in(owners[i]))
        found.matches.push_back({{kind, static_cast<int>(i), static_cast<int>(k)}, name});
      else
        found.expected = fields[k].needs;
    }
  }
}

template <class Named, std::size_t n>
void list_paths(const std::string& prefix, const Named& owner,
                const std::array<Field<Named>, n>& fields, std::vector<std::string>& paths) {
  for (const auto& field : fields)
    if (field.in(owner)) paths.push_back(prefix + std::string(field.path));
}

/// The path of the stop at the hinge's other side; empty if the path is no stop's.
std::string other_stop(const Path& path) {
  constexpr std::string_view stowed = "stop.", latched = "far_stop.";
  const auto with = [&](std::string_view stop, std::size_t used) {
    return fmt::format("{}.{}.{}{}", path.list, path.name, stop, path.field.substr(used));
  };
  if (path.field.starts_with(stowed)) return with(latched, stowed.size());
  return path.field.starts_with(latched) ? with(stowed, latched.size()) : "";
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

/// The matches of a path, or what its owner would need.
ParameterMatches find_matches(const Scene& scene, const Path& parts) {
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
  return found;
}

} // namespace

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
  ParameterMatches found = find_matches(scene, parts);
  if (!found.matches.empty())
    found.expected.clear();
  else if (const std::string other = other_stop(parts);
           !other.empty() && !find_matches(scene, split(other)).matches.empty())
    found.expected += fmt::format(" (did you mean \"{}\"?)", other);
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
