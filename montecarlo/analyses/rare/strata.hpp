/// Strata of a campaign's draws: rare values of discrete laws are drawn by themselves.
///
/// Subset simulation climbs from level to level along quantities that vary continuously. It misses an event that needs
/// one rare value, like a release that fails with probability 1e-5. No run of the first level has the value, and the
/// chains climb elsewhere. The probability of such a value is known exactly, so
///
///     P = Σ_s w_s P_s                                                                       (1)
///
///   symbol  meaning
///   s       a stratum: each discrete dispersion has one of its rare values, or any of its common values
///   w_s     the stratum's probability, exact
///   P_s     the event's probability within the stratum, by a subset simulation of its own
///   N, R    runs of a level, repeats
///
/// Rare is a value that a level of N runs draws fewer than 30 times on average.
///
/// A stratum restricts the coordinate y = l·z of a dispersion to the set A of its values' intervals. Here z are the
/// independent normal variables, and l is the dispersion's unit row of the copula's factor. A point z of the whole
/// space becomes a point of the stratum along l:
///
///     y → y' = Φ⁻¹(the point of A with the share Φ(y) of A below it),  z' = z + (y' − y) l   (2)
///
/// z' has the law of z restricted to l·z in A: the part across l is independent of y. Rows l of uncorrelated
/// dispersions are orthogonal, so that several restrictions hold at once. Of two correlated discrete dispersions only
/// the first is restricted; the second counts as `unseen`.
///
/// At most 64 strata have their own simulation, the most probable ones. Up to 1024 others are one stratum together: a
/// further coordinate chooses one of them, by their probabilities.
///
/// Bounds of (1): each stratum's distance to its own bounds, in quadrature. Source: G. Y. Zou, A. Donner, Statistics in
/// Medicine 27 (2008) 1693–1702 (MOVER). Strata without simulation, and strata whose event was not reached, add their
/// whole upper bound.
#pragma once

#include "montecarlo/analyses/rare/subset_simulation.hpp"
#include "montecarlo/engine/runs/run_plan.hpp"
#include "montecarlo/model/campaign/campaign.hpp"

#include <string>
#include <utility>
#include <vector>

namespace wingspread {

/// An interval (from, to] of a uniform coordinate.
struct TailInterval {
  Tails from{0, 1}, to{1, 0};
  double mass = 1;
};

/// A dispersion's coordinate restricted to a set.
struct RestrictedCoordinate {
  std::vector<double> direction;       ///< l, one component for each coordinate
  std::vector<TailInterval> intervals; ///< A, ascending
  double mass = 1;                     ///< of A
};

struct Stratum {
  double probability = 1; ///< w
  std::vector<RestrictedCoordinate> restricted;
  std::vector<std::pair<std::string, double>>
      rare;                      ///< dispersions with a rare value, and the value
  std::vector<Stratum> others{}; ///< disjoint strata that this one has together; else empty
  /// Coordinates of which neighbouring values may have nothing in common (subset_simulation.hpp): those that choose a
  /// row of a table, one of a few values, or one of the others.
  std::vector<std::size_t> labels{};
};

/// "nofire = 1, k = 9000"; "no rare value"; "others with rare values".
[[nodiscard]] std::string describe(const Stratum& stratum);

struct Strata {
  std::vector<Stratum> list; ///< without a rare value first, then by falling probability
  double left_out = 0;       ///< probability of the draws in no stratum of the list
  /// Dispersions with values that the first levels may miss, and how often they draw the rarest value on average.
  std::vector<std::pair<std::string, double>> unseen;
};

struct StrataOptions {
  long samples = 2000; ///< N
  long repeats = 5;    ///< R
  double smallest = 1e-10;
};

/// The strata of a campaign: a single one without discrete laws that have rare values.
[[nodiscard]] Strata strata_of(const Campaign& campaign, const StrataOptions& options);

/// Number of coordinates of a stratum's points. @param own of the campaign's points
[[nodiscard]] std::size_t coordinates_in(const Stratum& stratum, std::size_t own);
/// z' by (2). @param z with coordinates_in coordinates; the last one chooses among `others`
[[nodiscard]] NormalPoint within(const Stratum& stratum, NormalPoint z);

/// A stratum's part of the sum.
struct StratumEstimate {
  Stratum stratum;
  long samples = 0;                      ///< N of its levels
  std::vector<SubsetEstimate> estimates; ///< one per repeat; `inside` is empty
  RareEstimate estimate;                 ///< of P_s
};

/// The estimate (1). `reached`: the strata whose event was not reached add less than 1 % to the estimate.
/// @pre at least one stratum; a single one gives its own estimate
[[nodiscard]] RareEstimate sum_of(const std::vector<StratumEstimate>& strata, double left_out);

} // namespace wingspread
