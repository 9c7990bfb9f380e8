/// The dispersions of a campaign: a law, and the scene's parameters to which its draws are applied.
#pragma once

#include "core/scene/curve.hpp"
#include "distributions/prepared_distribution.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"
#include "montecarlo/model/scene_file/scene_parameter.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// How a draw changes its target: replaces, multiplies or is added to the value. Dispersions act in the order of the
/// list, each on the result of those before it; the first acts on the nominal value.
enum class Apply { set, scale, add };
inline constexpr std::array<std::string_view, 3> apply_names{"set", "scale", "add"};

void apply_to(double& parameter, Apply how, double value);

/// One entry of `through`: parameters to which a table's value at the draw is applied.
struct Driven {
  Apply apply = Apply::set;
  std::vector<SceneParameter> targets;
  Curve table; ///< monotone, constant beyond its ends
};

/// A random variable, drawn once per run, and the parameters that it changes.
struct Dispersion {
  std::string name; ///< names the draw's column and its random stream
  Distribution distribution;
  Apply apply = Apply::set;
  std::vector<SceneParameter> targets;
  std::vector<Driven> through{}; ///< instead of apply and targets: one cause with several effects
  /// Name of the block of `rows` of which this is a column; empty: the dispersion has a draw of its own. All columns of a
  /// block take the same row; their empirical laws have the values in the order of the file.
  std::string rows{};
};

/// Calls `use(apply, targets, table)` for each effect of the draw, in order. Without a table (null) the draw itself is
/// applied.
template <class Use> void for_each_effect(const Dispersion& dispersion, Use use) {
  if (!dispersion.targets.empty())
    use(dispersion.apply, dispersion.targets, static_cast<const Curve*>(nullptr));
  for (const Driven& driven : dispersion.through) use(driven.apply, driven.targets, &driven.table);
}

struct Dispersions {
  std::vector<Dispersion> list;
  Json resolved; ///< the JSON in SI, with values instead of file names; an `each` is not expanded
};

/// The coordinates of the unit cube in which a run is drawn: one for each dispersion, and one for all columns of
/// `rows`.
struct Coordinates {
  std::vector<std::string> names;
  std::vector<std::size_t> of; ///< the coordinate of each dispersion
};
[[nodiscard]] Coordinates coordinates_of(std::span<const Dispersion> dispersions);

/// Reads the list of dispersions. An `each` becomes one dispersion for each match, named `name.panel_1`; with several
/// paths, all parameters of one body, hinge or synchronisation share a draw. A `rows` becomes one for each column.
///
/// Notes problems: names that cannot head a column, unknown targets, and draws that a later "set" would overwrite. With
/// any problem, the returned value is not usable.
/// @param scene     null if the scene has problems: then targets are not looked up
/// @param directory base of the file names of empirical laws
[[nodiscard]] Dispersions read_dispersions(const JsonCursor& at, const Scene* scene,
                                           const std::filesystem::path& directory);

/// Parameters that the same draws change one after the other.
struct SharedTarget {
  std::vector<std::string> paths;
  std::vector<std::string> draws; ///< "lot scales", "root_spring adds"; in order of application
};
[[nodiscard]] std::vector<SharedTarget> shared_targets(std::span<const Dispersion> dispersions,
                                                       const Scene& scene);

/// Maps each parameter that a dispersion sets (not scales or adds to) to the dispersion's name.
inline std::map<SceneParameter, std::string> set_by_draws(std::span<const Dispersion> dispersions) {
  std::map<SceneParameter, std::string> writers;
  for (const Dispersion& dispersion : dispersions)
    for_each_effect(dispersion, [&](Apply how, const auto& targets, const Curve*) {
      for (const SceneParameter& target : targets)
        if (how == Apply::set) writers.emplace(target, dispersion.name);
    });
  return writers;
}

/// Whether a law has more than one value.
inline bool varies(const Distribution& distribution) {
  constexpr double tail = 1e-12; // beyond any campaign's number of runs
  const PreparedDistribution law(distribution);
  return law.quantile(tail) != law.quantile_complement(tail);
}

/// Whether draws differ: without it all runs are one and the same.
inline bool vary(std::span<const Dispersion> dispersions) {
  return std::ranges::any_of(
      dispersions, [](const Dispersion& dispersion) { return varies(dispersion.distribution); });
}

} // namespace wingspread
