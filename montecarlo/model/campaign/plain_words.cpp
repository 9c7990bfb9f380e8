#include "montecarlo/model/campaign/plain_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace wingspread {
namespace {

/// A parameter's path in parts: "hinges", "R_root", "spring.scale". The base and the environment have no name.
struct PathParts {
  std::string kind, name, quantity;
};

PathParts parts_of(const Scene& scene, const SceneParameter& parameter) {
  using Owner = SceneParameter::Owner;
  const std::string path = path_of(scene, parameter);
  const std::size_t dot = path.find('.');
  PathParts parts{path.substr(0, dot), "", path.substr(dot + 1)};
  const auto index = static_cast<std::size_t>(parameter.index);
  if (parameter.owner == Owner::body) parts.name = scene.bodies[index].name;
  if (parameter.owner == Owner::hinge) parts.name = scene.hinges[index].name;
  if (parameter.owner == Owner::synchronisation)
    parts.name = parts.quantity.substr(0, parts.quantity.find('.'));
  if (!parts.name.empty()) parts.quantity.erase(0, parts.name.size() + 1);
  return parts;
}

/// The leading parts that two quantities share: "spring" of "spring.torque_stowed" and "spring.torque_latched".
std::string shared(std::string_view a, std::string_view b) {
  if (a == b) return std::string(a);
  std::size_t end = 0;
  for (std::size_t i = 0; i <= std::min(a.size(), b.size()); ++i) {
    const bool ends_a = i == a.size() || a[i] == '.', ends_b = i == b.size() || b[i] == '.';
    if (ends_a && ends_b) end = i;
    if (i == a.size() || i == b.size() || a[i] != b[i]) break;
  }
  return std::string(a.substr(0, end));
}

std::string spoken(std::string quantity) {
  if (quantity.ends_with(".scale"))
    quantity.resize(quantity.size() - std::string_view(".scale").size());
  std::ranges::replace(quantity, '.', ' ');
  std::ranges::replace(quantity, '_', ' ');
  return quantity;
}

/// "a", "a and b", "a, b and c".
std::string listed(const std::vector<std::string>& names) {
  if (names.size() < 2) return fmt::format("{}", fmt::join(names, ""));
  return fmt::format("{} and {}", fmt::join(names.begin(), names.end() - 1, ", "), names.back());
}

void add_once(std::vector<std::string>& list, const std::string& text) {
  if (std::ranges::find(list, text) == list.end()) list.push_back(text);
}

std::size_t count_of(const Scene& scene, std::string_view kind) {
  return kind == "bodies"   ? scene.bodies.size()
         : kind == "hinges" ? scene.hinges.size()
                            : scene.synchronisations.size();
}

} // namespace

std::string plain_words(const Scene& scene, std::span<const SceneParameter> parameters) {
  constexpr std::size_t most_named = 3;
  std::vector<std::string> kinds, names;
  std::string quantity;
  std::vector<std::string> quantities;
  for (const SceneParameter& each : parameters) {
    const PathParts parts = parts_of(scene, each);
    add_once(kinds, parts.kind);
    if (!parts.name.empty()) add_once(names, parts.name);
    quantity = quantities.empty() ? parts.quantity : shared(quantity, parts.quantity);
    add_once(quantities, parts.quantity);
  }
  if (kinds.size() > 1 || quantity.empty()) return fmt::format("{} parameters", parameters.size());
  const std::string words = spoken(quantity);
  if (names.empty()) return fmt::format("{} {}", kinds.front(), words);
  if (names.size() == 1) return fmt::format("{} {}", names.front(), words);
  if (names.size() == count_of(scene, kinds.front()))
    return fmt::format("{} of all {}", words, kinds.front());
  return names.size() <= most_named
             ? fmt::format("{} of {}", words, listed(names))
             : fmt::format("{} of {} {}", words, names.size(), kinds.front());
}

std::string plain_words(const Scene& scene, const Dispersion& dispersion) {
  if (!dispersion.targets.empty()) return plain_words(scene, dispersion.targets);
  std::string name = dispersion.name;
  std::ranges::replace(name, '_', ' ');
  return name;
}

std::vector<std::string> short_paths(const Scene& scene,
                                     std::span<const SceneParameter> parameters) {
  std::vector<std::string> paths;
  for (const SceneParameter& each : parameters) {
    const PathParts parts = parts_of(scene, each);
    const std::string starred = fmt::format("{}.*.{}", parts.kind, parts.quantity);
    const auto matches = parts.name.empty() ? ParameterMatches{} : resolve(scene, starred);
    const bool all = matches.matches.size() > 1 &&
                     std::ranges::all_of(matches.matches, [&](const ParameterMatch& match) {
                       return std::ranges::find(parameters, match.parameter) != parameters.end();
                     });
    add_once(paths, all ? starred : path_of(scene, each));
  }
  return paths;
}

} // namespace wingspread
