/// Sobol' indices: which share of an output's variance each dispersion is behind.
///
///   symbol   meaning
///   d, N     dispersions, rows of the design
///   A, B     two independent points of the unit cube in each row
///   AB_i     A with the coordinate i of B
///   f        an output, at a point; here less its mean over all A and B
///   V        its variance over all A and B, divisor 2N
///   S_i      first-order index: the share of V that x_i alone is behind
///   S_Ti     total index: the share that is left when all but x_i are known; ≥ S_i, and more by
///            what x_i does together with others
///
///   S_i  = mean of f_B (f_ABi − f_A) / V                                                      (1)
///   S_Ti = mean of (f_A − f_ABi)² / 2V                                                        (2)
///
/// (1): A. Saltelli et al., Computer Physics Communications 181 (2010) 259–270, table 2 b; (2): M.
/// J. W. Jansen, the same 117 (1999) 35–43. Both are exactly 0, with no error, for a dispersion
/// that does nothing. Bounds: percentile bootstrap over rows that are independent; of rows that depend
/// on each other the jackknife over the replicates of their design (jackknife.hpp).
///
/// An output that did not happen at some point has no indices: rows without those points are no longer
/// a design (of 26 points a row 2 % that are missing take 41 % of the rows), and what is left of the
/// cube is no product, so that the variance has no shares.
#pragma once

#include "montecarlo/foundation/statistics/bounds.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace wingspread {

/// Where the points of a row stand among the runs: run k is point k mod (d + 2) of row ⌊k/(d + 2)⌋.
struct SaltelliPoint {
  long row = 0;
  /// 0: A, 1: B, 2 + i: AB_i.
  long place = 0;
};
[[nodiscard]] constexpr SaltelliPoint saltelli_point(long run, std::size_t dispersions) {
  const long points = static_cast<long>(dispersions) + 2;
  return {run / points, run % points};
}

/// How bounds come about.
struct SobolBounds {
  double confidence = 0.95;
  int replicates = 0;    ///< R, row k being of replicate k mod R; 0: the rows are independent
  long resamples = 1000; ///< of independent rows
  std::uint64_t seed = 1;
};

struct SobolIndex {
  double value; ///< NaN where V is 0, and where values are missing
  Bounds bounds;
};

struct SobolEffect {
  SobolIndex first, total;
  bool inert = true; ///< f_ABi is f_A, bit for bit, in all rows; missing where that is
};

struct SobolIndices {
  long rows = 0;         ///< N
  long incomplete = 0;   ///< of those, in which some point has no value; no indices unless 0
  double mean, variance; ///< of the values at A and B
  std::vector<SobolEffect> effects; ///< one for each dispersion
};

/// (1) and (2) with their bounds. Pure. Cost O(N d) for each resample.
/// @param values of an output at the design's points, as its runs stand; NaN: it did not happen.
///   A last row that is not complete is left aside
[[nodiscard]] SobolIndices sobol_indices(std::span<const double> values, std::size_t dispersions,
                                         const SobolBounds& how);

} // namespace wingspread
