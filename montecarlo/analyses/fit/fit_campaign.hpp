/// The campaigns of a test and of the prediction, and the rows of the posterior that the latter draws.
#pragma once

#include "montecarlo/analyses/fit/parameter_space.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace wingspread {

inline constexpr const char* posterior_file = "posterior.csv";

/// The campaign of a test: its case, without cases, and without what only statistics need. @param of_case may be null
[[nodiscard]] Campaign campaign_of_test(const Campaign& campaign, const CaseSpec* of_case);

/// Adds the family that has a measured output; notes a problem for what is no number of a run.
void add_measured(const JsonCursor& at, const std::string& name, const Scene& scene,
                  Outputs& outputs);

/// The dispersions among these whose law in the test's campaign is not the campaign's.
[[nodiscard]] std::vector<std::size_t> with_other_law(const Campaign& test,
                                                      const Campaign& campaign,
                                                      const std::vector<std::size_t>& dispersions);

/// The campaign with the dispersions replaced by one that draws rows of posterior.csv. Their correlations and laws
/// that cases give them are left out.
/// @param fitted indices of the dispersions; the columns have their names
/// @pre refuse_lost_order has not thrown
[[nodiscard]] Json predicting_campaign(const Campaign& campaign,
                                       const std::vector<std::size_t>& fitted);

/// The laws of cases that predicting_campaign leaves out, by case and fitted dispersion: "cold: temperature".
[[nodiscard]] std::vector<std::string> lost_laws(const Campaign& campaign,
                                                 const std::vector<std::size_t>& fitted);

/// The parameters of the space that posterior.csv has: the common ones, and tests' own that follow from them.
[[nodiscard]] std::vector<std::size_t> posterior_parameters(const ParameterSpace& space);

/// Refuses a fit of which the written campaign cannot keep the order of draws that change the same parameter: it draws
/// all fitted dispersions at one place.
/// @param file the tests'
/// @throws SpecError
void refuse_lost_order(const Campaign& campaign, const ParameterSpace& space,
                       const std::string& file);

/// posterior.csv: the common parameters, then every test's own parameters (`own`) that the campaign correlates with
/// common ones. Each row draws the latter for a new unit, given its common parameters.
struct PosteriorRows {
  std::vector<std::size_t> columns; ///< dispersions of the campaign
  std::vector<std::string> names;   ///< of the columns
  std::vector<std::vector<double>> rows;
};

/// @param points samples of the posterior, a row each
[[nodiscard]] PosteriorRows posterior_rows(const Campaign& campaign, const ParameterSpace& space,
                                           PhysicalValues& values, std::vector<FitPoint> points);

} // namespace wingspread
