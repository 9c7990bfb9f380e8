/// `"rtol": "auto"`: the loosest tolerance whose errors are a small share of what the campaign does not know
/// anyway, its sampling error; 1e-6 at most.
///
///     N  the campaign's runs            s   standard deviation of an output      G2  its excess kurtosis
///     P  the pilot's                    q_p its quantile at p                    f   its density there
///
///     of the mean              s / √N                                                                   (1)
///     of the standard deviation  s √((G2 + 2) / (4 N))                                                  (2)
///     of a quantile            √(p (1 − p) / N) / f(q_p)                                                (3)
///     1/f(q_p) ≈ (X_(k+m) − X_(k−m)) P / (2 m),   k = ⌈p P⌉, m = ⌈√P / 2⌉                              (4)
///
/// (4) after M. M. Siddiqui, Journal of Research of the NBS 64B (1960) 145–150, and D. A. Bloch and J. L. Gastwirth,
/// The Annals of Mathematical Statistics 39 (1968) 1083–1085; at the ends of the sample with as many order
/// statistics as there are.
#pragma once

#include "montecarlo/engine/accuracy/accuracy.hpp"

namespace wingspread {

/// The tolerances that may be chosen, the loosest first.
inline constexpr double tolerance_ladder[] = {1e-6, 3e-7, 1e-7,  3e-8, 1e-8,
                                              3e-9, 1e-9, 3e-10, 1e-10};

/// How large the sampling error of an output's statistics is. NaN where it has none: too few values, or all the same.
struct SamplingError {
  double moments = 0;   ///< the smaller of (1) and (2)
  double quantiles = 0; ///< the smallest of (3), over the quantiles that the campaign asks for
};

/// @param sorted values of a pilot, smallest first
/// @param runs   N, times the share of runs in which the output happens
[[nodiscard]] SamplingError sampling_error(std::span<const double> sorted,
                                           std::span<const double> quantiles, double runs);

/// Whether errors are at most this share of the sampling error: their RMS of that of mean and standard deviation,
/// the largest of that of quantiles.
[[nodiscard]] bool is_within(const OutputAccuracy& error, const SamplingError& sampling,
                             double share);

/// How many of N runs the pilot makes: an eighth, from 32 to 256.
[[nodiscard]] long pilot_runs(long runs);

/// Chooses the tolerance of a campaign that leaves it open, by a pilot of its first runs: `integration`,
/// `tolerance` and `resolved` follow. Of a campaign with cases the pilot is of each, and the tightest choice
/// holds for all, so that what differs between cases is never the tolerance. Any other campaign stays what it is.
///
/// The pilot's runs are made at the loosest tolerance, and give the sampling error; up to twelve of them, chosen as
/// chosen_rows does, are made again by a reference, at each tolerance until one will do. Where draws depend on
/// each other (Latin hypercube, Sobol' points) the sampling error is taken for a tenth of that of independent ones.
/// `overtravel`, recorded whether asked for or not, has no say.
/// The same for all threads, shards and interruptions. Cost: that of the pilot and some 200 runs more.
void settle_tolerance(Campaign& campaign, const Crew& crew);

} // namespace wingspread
