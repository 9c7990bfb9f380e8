/// The response of an output to a change of some draws: a quadratic along the change, with each run's own residual.
///
///   symbol  meaning
///   u_i     part of run i's linear fit that the moved draws make, from its mean
///   r_i     the rest of the linear fit, from its mean
///   d_i     change of u_i for t = 1
///   e_i     residual of the linear fit
///
///   e ≈ c₀ + c₁ u + c₂ r + c₃ u² + c₄ u r + c₅ r²   (least squares)                             (1)
///   y_i(t) = y_i + t d_i (1 + c₁ + 2 c₃ u_i + c₄ r_i) + c₃ (t d_i)²                             (2)
///
/// Without (1) the output would follow the straight line beyond the draws' mean. Where the slope falls off towards the
/// moved values, that promises too much: a hinge's peak moment of 2,000 runs seemed to need a spring × 0.93, and needed
/// × 0.89; (2) gives × 0.88.
#pragma once

#include "montecarlo/foundation/statistics/bounds.hpp"

#include <array>
#include <optional>
#include <vector>

namespace wingspread {

/// The runs with the output, in the direction in which a larger one is worse.
struct LeverRuns {
  std::vector<double> y, d, u, r;
  std::vector<double> residual; ///< e
  std::vector<int> group;       ///< of the jackknife, from 0
  std::size_t fitted = 0;       ///< the first runs, which the fit (1) uses
  std::vector<double>
      group_slope; ///< slope along the change without each group, divided by that of all
};

class LeverResponse {
public:
  /// Cost O(n).
  explicit LeverResponse(LeverRuns runs);

  /// A t between 0 and `end`, of its sign, at which at most `most` runs are beyond the limit: the nearest to 0 if their
  /// number falls steadily. Nothing if more are beyond it at `end`. Cost O(n) for each of about 44 bisections.
  [[nodiscard]] std::optional<double> change(double limit, long most, double end) const;

  /// Mean decrease of the output over the runs beyond the limit, for a change t, with the jackknife's bounds.
  struct Fall {
    double mean = 0;
    Bounds bounds{};
  };
  /// @pre a run is beyond the limit
  [[nodiscard]] Fall fall(double t, double limit, double confidence) const;

private:
  static constexpr std::size_t terms = 5;
  using Curve = std::array<double, terms>;

  [[nodiscard]] long count_beyond(double limit, double t) const;
  [[nodiscard]] double moved(std::size_t run, double t, double slope, const Curve& curve) const;
  [[nodiscard]] double mean_fall(double t, double limit, double slope, const Curve& curve) const;

  LeverRuns runs_;
  Curve curve_{}; ///< c₁ … c₅
  std::vector<Curve> without_;
};

} // namespace wingspread
