/// The campaign of the prediction: the fitted dispersions are rows of the posterior.
#pragma once

#include "montecarlo/analyses/fit/fit_spec.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace wingspread {

inline constexpr const char* posterior_file = "posterior.csv";

/// The campaign with the dispersions replaced by one that draws rows of posterior.csv. Their correlations and laws
/// that cases give them are left out.
/// @param fitted indices of the dispersions; the columns have their names
[[nodiscard]] Json predicting_campaign(const Campaign& campaign,
                                       const std::vector<std::size_t>& fitted);

/// The laws of cases that predicting_campaign leaves out: "cold: temperature".
[[nodiscard]] std::vector<std::string> lost_laws(const Campaign& campaign,
                                                 const std::vector<std::size_t>& fitted);

} // namespace wingspread
