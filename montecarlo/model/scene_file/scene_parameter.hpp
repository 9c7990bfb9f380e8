/// The parameters of a scene by their paths: `bodies.panel_1.mass`, `hinges.*.child_point.0`.
#pragma once

#include "core/scene/scene.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// One parameter of a scene, and of every copy of it.
/// Cheap to copy and to follow: no search, no string.
struct SceneParameter {
  enum class Owner { base, body, hinge, synchronisation, environment };
  Owner owner = Owner::base;
  int index = 0; ///< of the body, hinge or synchronisation
  int field = 0; ///< of its kind of owner

  [[nodiscard]] double& in(Scene& scene) const;
  [[nodiscard]] double in(const Scene& scene) const;
  auto operator<=>(const SceneParameter&) const = default;
};

/// A parameter that a path names.
struct ParameterMatch {
  SceneParameter parameter;
  std::string name; ///< of its body, hinge or synchronisation; else empty
};

/// What a path names, or why it names nothing.
struct ParameterMatches {
  std::vector<ParameterMatch> matches; ///< in the scene's order
  std::string expected;                ///< what would do; empty when there are matches
};

/// Follows a path. In its name each `*` stands for any characters, or none: `*` is every one of them,
/// `panel_*` those whose names begin so. Only those match that have the parameter: a hinge without a
/// latch, say, has no latch.stiffness.
[[nodiscard]] ParameterMatches resolve(const Scene& scene, std::string_view path);

/// Reads a path; a problem when it names nothing.
/// @param scene null when it has problems of its own: then paths are not looked up
[[nodiscard]] std::vector<ParameterMatch> read_path(const JsonCursor& at, const Scene* scene);
/// Reads an array of paths, at least one; a problem for each parameter that is named twice.
[[nodiscard]] std::vector<SceneParameter> read_paths(const JsonCursor& at, const Scene* scene);

/// The path of one parameter.
[[nodiscard]] std::string path_of(const Scene& scene, const SceneParameter& parameter);
[[nodiscard]] std::vector<std::string> paths_of(const Scene& scene,
                                                std::span<const SceneParameter> parameters);
/// Its unit, e.g. "kg"; empty of what has no dimension.
[[nodiscard]] std::string_view unit_of(const SceneParameter& parameter);

/// The paths of all parameters that the scene has.
[[nodiscard]] std::vector<std::string> parameter_paths(const Scene& scene);

} // namespace wingspread
