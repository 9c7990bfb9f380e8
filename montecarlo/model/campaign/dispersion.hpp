/// What a campaign varies: a law, and the parameters of the scene that its draws are applied to.
#pragma once

#include "core/scene/curve.hpp"
#include "distributions/distribution.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"
#include "montecarlo/model/scene_file/scene_parameter.hpp"

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// What a draw does to its target: becomes its value, multiplies it, or is added to it. Dispersions
/// act in the order in which they are listed, each on what those before it have left; the first
/// finds the nominal value.
enum class Apply { set, scale, add };
inline constexpr std::array<std::string_view, 3> apply_names{"set", "scale", "add"};

void apply_to(double& parameter, Apply how, double value);

/// Parameters that a draw drives by way of a table: what is applied to them is its value at the draw.
struct Driven {
  Apply apply = Apply::set;
  std::vector<SceneParameter> targets;
  Curve table; ///< monotone, constant beyond its ends
};

/// One draw per run, and the parameters that it is applied to.
struct Dispersion {
  std::string name; ///< of the draw: its column, and its random stream
  Distribution distribution;
  Apply apply = Apply::set;
  std::vector<SceneParameter> targets;
  std::vector<Driven> through{}; ///< in place of apply and targets: one cause of several effects
};

/// Calls `use(apply, targets, table)` for all that the draw is applied to, in order; the table is null where the draw
/// itself is what is applied.
template <class Use> void for_each_effect(const Dispersion& dispersion, Use use) {
  if (!dispersion.targets.empty())
    use(dispersion.apply, dispersion.targets, static_cast<const Curve*>(nullptr));
  for (const Driven& driven : dispersion.through) use(driven.apply, driven.targets, &driven.table);
}

struct Dispersions {
  std::vector<Dispersion> list;
  Json resolved; ///< as it was read, not expanded, but with the values of files in their place
};

/// Reads a campaign's list of dispersions, with one for each match of an `each`: `name.panel_1`.
///
/// Notes a problem, besides what cannot be read, for names that cannot head a column of their own,
/// targets that the scene does not have, and draws that would be lost because a later dispersion
/// sets their target. When there is any, what is returned is of no use.
/// @param scene     null when it has problems of its own: then targets are not looked up
/// @param directory that the files of empirical laws are relative to
/// An `each` of several paths has one draw for all the parameters of one body, hinge or
/// synchronisation.
[[nodiscard]] Dispersions read_dispersions(const JsonCursor& at, const Scene* scene,
                                           const std::filesystem::path& directory);

/// The unit of a dispersion's draws where they are set or added: that of all targets. Empty where they have none in
/// common, and where a table stands between.
/// @param spec  the dispersion as it was read
/// @param scene null when it has problems of its own
[[nodiscard]] std::string_view unit_of_draws(const Json& spec, const Scene* scene);

/// What one after another is done to parameters that more than one draw changes: their paths, by the draws that do.
struct SharedTarget {
  std::vector<std::string> paths;
  std::vector<std::string> draws; ///< "lot scales", "root_spring adds"; in order
};
[[nodiscard]] std::vector<SharedTarget> shared_targets(std::span<const Dispersion> dispersions,
                                                       const Scene& scene);

} // namespace wingspread
