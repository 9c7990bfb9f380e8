/// Points of a fit as values of its parameters, and the rows of posterior.csv.
#pragma once

#include "montecarlo/analyses/fit/parameter_space.hpp"
#include "montecarlo/engine/runs/run_plan.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace wingspread {

/// u → dispersions as they are applied, offsets in SI.
class PhysicalValues {
public:
  /// @pre the space outlives the object
  PhysicalValues(const Campaign& campaign, const FitSpec& spec, const ParameterSpace& space);
  PhysicalValues(const PhysicalValues&) = delete;
  PhysicalValues& operator=(const PhysicalValues&) = delete;

  /// The values of all parameters of the space, in its order.
  [[nodiscard]] std::vector<double> of(const FitPoint& at);

private:
  const ParameterSpace& space_;
  Campaign campaign_;
  std::optional<std::size_t> test_;
  const FitPoint* at_ = nullptr;
  RunPlan plan_;
};

/// posterior.csv: the common parameters, then dispersions that every test has of its own and that depend on common ones
/// through correlations. The latter are a new unit's: a draw of their law given the row's common parameters.
struct PosteriorRows {
  std::vector<std::size_t> columns; ///< dispersions of the campaign
  std::vector<std::string> names;   ///< of the columns
  std::vector<std::vector<double>> rows;
};

/// @param points samples of the posterior, a row each
[[nodiscard]] PosteriorRows posterior_rows(const Campaign& campaign, const ParameterSpace& space,
                                           PhysicalValues& values, std::vector<FitPoint> points);

} // namespace wingspread
