/// Modes of the posterior by Levenberg–Marquardt (Eigen's, a port of MINPACK) from several starts, and Laplace's
/// approximation at each.
///
/// Derivatives are central differences in u with the step ε^{1/3} (1 + |u|), of runs with rtol ≤ 1e-10. All runs of a
/// Jacobian are made at once. The starts are the prior's median and Sobol' points of the prior.
#pragma once

#include "montecarlo/analyses/fit/likelihood.hpp"
#include "montecarlo/foundation/formats/spec_error.hpp"

#include <cstdint>

namespace wingspread {

/// A mode and the normal law of the same curvature.
struct FitMode {
  FitPoint at;
  double log_posterior = 0;
  Eigen::MatrixXd
      covariance; ///< inverse of VᵀV, V the Jacobian of least_squares; the prior makes it positive definite
  Prediction prediction;
};

/// Heuristic: a trace whose rms residual at the best fit is this many σ is probably of another hinge or in another unit.
inline constexpr double foreign_sigmas = 10;
/// Heuristic: at more than so many σ the best fit may be a local one. Larger: a noise-free trace of the seed wing is missed from
/// two starts, at 2.03 σ. Smaller: where the noise is but underestimated, the search takes 32 starts too.
inline constexpr double settled_sigmas = 1.5;
/// Whether the rms residual of a trace is larger than `settled_sigmas`.
[[nodiscard]] bool is_far_from_a_trace(const FitData& data, const FitMode& mode);

/// Derivatives of all predictions in u: a row a number. Missing numbers have the derivative 0.
[[nodiscard]] Eigen::MatrixXd jacobian_of(TestRuns& runs, const FitPoint& at);

/// Σ (r − b̂)² of each channel: the argument of least_squares().
[[nodiscard]] std::vector<double> squares_of(const FitData& data, const Prediction& prediction);

/// Derivative of least_squares() with fixed squares.
[[nodiscard]] Eigen::MatrixXd least_squares_jacobian(const FitData& data,
                                                     std::span<const double> squares,
                                                     TestRuns& runs, const FitPoint& at);

/// Laplace's covariance at a point. @param data with their present tempering
[[nodiscard]] Eigen::MatrixXd laplace_covariance(const FitData& data, TestRuns& runs,
                                                 const FitPoint& at, const Prediction& prediction);

/// The modes found, the highest first, each once. @throws Stopped
[[nodiscard]] std::vector<FitMode> find_modes(const FitData& data, TestRuns& runs,
                                              std::span<const FitPoint> starts);

/// The prior's median and the points of a Sobol' design.
[[nodiscard]] std::vector<FitPoint> first_points(std::size_t dimensions, int count,
                                                 std::uint64_t seed);

/// A problem, with its pointer in the tests' file, for each channel that cannot be fitted: no run at the points
/// predicts it, its distance to every prediction overflows, it is a time beyond t_end or a scene parameter that is the
/// same at all points, or all runs have the output in another unit or sense.
[[nodiscard]] std::vector<Problem> unpredictable(std::span<const FitTest> tests, TestRuns& runs,
                                                 std::span<const FitPoint> points);

/// The distance of two modes in standard deviations of the first.
[[nodiscard]] double distance_of(const FitMode& first, const FitMode& second);

} // namespace wingspread
