/// The campaign's key `correlations`: rank correlations between dispersions.
#pragma once

#include "distributions/copula.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"
#include "montecarlo/model/campaign/dispersion.hpp"

#include <vector>

namespace wingspread {

/// Reads the list of correlations. Notes problems: unknown names, repeated pairs, and coefficients without a positive
/// definite matrix; the message then has the nearest possible ones.
/// @param dispersions null if they have problems: then names are not looked up
[[nodiscard]] std::vector<RankCorrelation>
read_wanted_correlations(const JsonCursor& at, const std::vector<Dispersion>* dispersions);

[[nodiscard]] Json write_wanted_correlations(const std::vector<RankCorrelation>& correlations,
                                             const std::vector<Dispersion>& dispersions);

} // namespace wingspread
