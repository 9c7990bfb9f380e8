/// A campaign's rank correlations: which dispersions vary together, and how much.
#pragma once

#include "distributions/copula.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"
#include "montecarlo/model/campaign/dispersion.hpp"

#include <vector>

namespace wingspread {

/// Reads the list of correlations.
///
/// Notes a problem, besides what cannot be read, for names that no dispersion has, pairs named
/// twice, and coefficients that no dispersions can have all together: then with those nearest to
/// them that some can.
/// @param dispersions null when they have problems of their own: then names are not looked up
[[nodiscard]] std::vector<RankCorrelation>
read_wanted_correlations(const JsonCursor& at, const std::vector<Dispersion>* dispersions);

[[nodiscard]] Json write_wanted_correlations(const std::vector<RankCorrelation>& correlations,
                                             const std::vector<Dispersion>& dispersions);

} // namespace wingspread
