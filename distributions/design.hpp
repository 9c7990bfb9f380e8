/// How a campaign's runs fill the unit cube: the rule that turns (seed, run, name) into u in (0,
/// 1).
///
///   u = uniform(design, run, name)  →  dependence between dispersions  →  quantile(u) = the value
///
/// A dispersion sees only its own u; what couples several of them (a Gaussian copula) works on one
/// run's u, between the design and the quantiles, and leaves each of them uniform.
#pragma once

#include "distributions/random_stream.hpp"

#include <cstdint>

namespace wingspread {

enum class DesignKind {
  random,          ///< independent draws; run k is the same whatever the number of runs
  latin_hypercube, ///< each dispersion once in each of `runs` strata
  sobol            ///< scrambled Sobol' points
};

struct Design {
  DesignKind kind = DesignKind::random;
  std::uint64_t seed = 1;
  std::uint64_t runs = 0; ///< how many in all; only a design that stratifies depends on it
};

/// Whether this version can draw by the rule. What reads a campaign refuses those it cannot.
[[nodiscard]] constexpr bool is_available(DesignKind kind) { return kind == DesignKind::random; }

/// The dispersion's u in the run, strictly within (0, 1); pure, so safe in any thread.
/// Throws std::logic_error for a design that is not available: even a build without assertions must
/// not draw by another rule than the one asked for. Cost: one Philox block, some 20 ns.
[[nodiscard]] double uniform(const Design& design, std::uint64_t run, StreamName dispersion);

} // namespace wingspread
