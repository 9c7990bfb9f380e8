/// Names of parameters and dispersions in plain words, for a reader who does not know the scene file's paths.
#pragma once

#include "montecarlo/model/campaign/dispersion.hpp"

#include <span>
#include <string>

namespace wingspread {

/// "R_root spring" of hinges.R_root.spring.scale; "spring of all hinges"; "mass of yoke and panel_1"; of several
/// quantities what their paths share, else their number: "R_root latch", "4 parameters".
/// @pre at least one
[[nodiscard]] std::string plain_words(const Scene& scene,
                                      std::span<const SceneParameter> parameters);

/// The varied quantity of a dispersion: the words of its targets, or its name if it acts through tables.
[[nodiscard]] std::string plain_words(const Scene& scene, const Dispersion& dispersion);

/// The paths of parameters, one with `*` where it names exactly these of a quantity: "hinges.*.spring.scale".
[[nodiscard]] std::vector<std::string> short_paths(const Scene& scene,
                                                   std::span<const SceneParameter> parameters);

} // namespace wingspread
