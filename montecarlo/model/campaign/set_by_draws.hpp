/// What all draws have in common: parameters whose nominal value is lost, because a dispersion sets them in every run;
/// and whether draws differ at all.
#pragma once

#include "distributions/prepared_distribution.hpp"
#include "montecarlo/model/campaign/dispersion.hpp"

#include <algorithm>
#include <map>
#include <span>
#include <string>

namespace wingspread {

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
