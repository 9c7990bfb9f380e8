/// Parameters whose nominal value is lost, because a dispersion sets them in every run.
#pragma once

#include "montecarlo/model/campaign/dispersion.hpp"

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

} // namespace wingspread
