/// Sobol' indices: the shares of an output's variance that each dispersion causes.
///
///   symbol   meaning
///   d, N     dispersions, rows of the design
///   A, B     two independent points of the unit cube in each row
///   AB_i     A with the coordinate i of B
///   f        an output at a point, minus its mean over all A and B
///   V        its variance over all A and B, divisor 2N
///   S_i      first-order index: the share of V that x_i causes alone
///   S_Ti     total index: the share of V that remains if all but x_i are known: S_i plus the interactions of x_i
///
///   S_i  = mean of f_B (f_ABi − f_A) / V                                                      (1)
///   S_Ti = mean of (f_A − f_ABi)² / 2V                                                        (2)
///
/// (1): A. Saltelli et al., Computer Physics Communications 181 (2010) 259–270, table 2 b; (2): M.
/// J. W. Jansen, ibid. 117 (1999) 35–43. Both are exactly 0 for a dispersion
/// without effect. Bounds, from 16 rows on: percentile bootstrap over independent rows; for dependent rows the jackknife over the
/// replicates of the design (jackknife.hpp).
///
/// An output with a missing value has no indices. Dropping the affected rows is no remedy: with 26 points per row, 2 %
/// missing points affect 41 % of the rows. In the other rows the inputs are not independent, so the variance has no
/// shares.
#pragma once

#include "montecarlo/foundation/statistics/bounds.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace wingspread {

/// The place of a run in the design: run k is point k mod (d + 2) of row ⌊k/(d + 2)⌋.
struct SaltelliPoint {
  long row = 0;
  /// 0: A, 1: B, 2 + i: AB_i.
  long place = 0;
};
[[nodiscard]] constexpr SaltelliPoint saltelli_point(long run, std::size_t dispersions) {
  const long points = static_cast<long>(dispersions) + 2;
  return {run / points, run % points};
}

/// With fewer rows an index has no bounds: nominal 95 % ones held it in about 50, 70 and 85 % of the designs of 2, 3 and 7
/// rows, and in 88 to 93 % of 20 rows and more.
inline constexpr long least_rows_for_bounds = 16;

/// The method of the bounds.
struct SobolBounds {
  double confidence = 0.95;
  int replicates = 0;    ///< R: row k belongs to replicate k mod R; 0: independent rows
  long resamples = 1000; ///< bootstrap samples of independent rows
  std::uint64_t seed = 1;
};

struct SobolIndex {
  double value; ///< NaN if V is 0 or values are missing
  Bounds bounds;
};

struct SobolEffect {
  SobolIndex first, total;
  bool inert = true; ///< in all rows f_ABi equals f_A bit for bit, or both are missing
};

struct SobolIndices {
  long rows = 0;                    ///< N
  long incomplete = 0;              ///< rows with a missing value; no indices unless 0
  double mean, variance;            ///< of the values at A and B
  std::vector<SobolEffect> effects; ///< one for each dispersion
};

/// (1) and (2) with their bounds. Pure. Cost O(N d) for each resample.
/// @param values of an output in the order of the design's runs; NaN: missing. An incomplete last row is ignored
[[nodiscard]] SobolIndices sobol_indices(std::span<const double> values, std::size_t dispersions,
                                         const SobolBounds& how);

} // namespace wingspread
