/// The parameters of a scene by their paths: `bodies.panel_1.mass`, `hinges.*.child_point.0`.
#pragma once

#include "core/scene/scene.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// One number of a scene, valid in every copy of the scene. Access costs no search and no string.
struct SceneParameter {
  enum class Owner { base, body, hinge, synchronisation, environment };
  Owner owner = Owner::base;
  int index = 0; ///< index of the body, hinge or synchronisation
  int field = 0; ///< index into the owner's table of fields (scene_parameter.cpp)

  [[nodiscard]] double& in(Scene& scene) const;
  [[nodiscard]] double in(const Scene& scene) const;
  auto operator<=>(const SceneParameter&) const = default;
};

/// One match of a path.
struct ParameterMatch {
  SceneParameter parameter;
  std::string name; ///< name of its body, hinge or synchronisation; empty for base and environment
};

/// All matches of a path.
struct ParameterMatches {
  std::vector<ParameterMatch> matches; ///< in the scene's order
  std::string expected; ///< without matches: what the path should name, for a message
};

/// Finds the parameters of a path. In the name, `*` matches any characters: `*` all names, `panel_*` names with this
/// beginning. Only objects with the parameter match: a hinge without a latch has no latch.stiffness.
[[nodiscard]] ParameterMatches resolve(const Scene& scene, std::string_view path);

/// Reads a path; notes a problem if nothing matches.
/// @param scene null if the scene has problems: then paths are not looked up
[[nodiscard]] std::vector<ParameterMatch> read_path(const JsonCursor& at, const Scene* scene);
/// Reads an array of at least one path; notes a problem for each repeated parameter.
[[nodiscard]] std::vector<SceneParameter> read_paths(const JsonCursor& at, const Scene* scene);

/// The path of one parameter.
[[nodiscard]] std::string path_of(const Scene& scene, const SceneParameter& parameter);
[[nodiscard]] std::vector<std::string> paths_of(const Scene& scene,
                                                std::span<const SceneParameter> parameters);
/// The SI unit, e.g. "kg"; empty for a dimensionless number.
[[nodiscard]] std::string_view unit_of(const SceneParameter& parameter);

/// The paths of all parameters of the scene.
[[nodiscard]] std::vector<std::string> parameter_paths(const Scene& scene);

/// Whether the name matches the pattern; `*` matches any characters.
[[nodiscard]] bool is_like(std::string_view name, std::string_view pattern);

} // namespace wingspread
