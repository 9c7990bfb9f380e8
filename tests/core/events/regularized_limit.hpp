/// Exact friction as the limit ω_s → 0 of regularized friction, which CVODE integrates on the dense
/// model.
#pragma once

#include "tests/core/events/rubbed_wings.hpp"
#include "tests/support/reference_run.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

namespace wingspread::oracle {

inline ReferenceOutcome regularized_run(const Scene& scene, double width, double t_end) {
  ReferenceOptions options;
  options.t_end = t_end, options.stiff = true;
  options.rtol = 1e-10, options.atol = 1e-12; // rad/s, far below the width
  return cvode_run(regularized(scene, width), options);
}

/// Latches by time; latches whose times agree to 1e-9 by hinge.
template <class AnyOutcome> auto in_order(const AnyOutcome& out) {
  auto latches = out.latches;
  auto instant = latches.begin(); // where the present one begins
  for (auto latch = latches.begin(); latch != latches.end(); ++latch) {
    if (latch != latches.begin() && latch->time - (latch - 1)->time > 1e-9 * latch->time)
      instant = latch;
    std::rotate(std::upper_bound(instant, latch, *latch,
                                 [](const auto& a, const auto& b) { return a.hinge < b.hinge; }),
                latch, latch + 1);
  }
  return latches;
}

/// The compared quantities of a run: times and rates of its latches, angles and rates at its end.
template <class AnyOutcome> std::vector<double> figures(const AnyOutcome& out, std::size_t hinges) {
  std::vector<double> result;
  for (const auto& latch : in_order(out))
    result.insert(result.end(), {latch.time, latch.rates[latch.hinge]});
  for (std::size_t i = 0; i < hinges; ++i)
    result.insert(result.end(), {out.final.angles[i], out.final.rates[i]});
  return result;
}

template <class AnyOutcome> std::vector<int> latch_order(const AnyOutcome& out) {
  std::vector<int> result;
  for (const auto& latch : in_order(out)) result.push_back(latch.hinge);
  return result;
}

/// Runs with regularized friction at three widths, each a tenth of the previous one.
struct Limit {
  explicit Limit(const Scene& scene, double t_end)
      : hinges(scene.hinges.size()), runs{regularized_run(scene, 1e-5, t_end),
                                          regularized_run(scene, 1e-6, t_end),
                                          regularized_run(scene, 1e-7, t_end)} {}

  /// Checks that the runs converge to `out`, as O(ω_s) or, where a hinge barely moves, O(ω_s log ω_s). Each width must
  /// reduce the difference to less than 0.4 of that at the width before, plus the sum of both integrators' own errors
  /// (1e-10 and 1e-9 a step).
  void check(const Outcome& out) const {
    constexpr double floor = 1e-6;
    int compared = 0; // widths
    REQUIRE(latch_order(out) == latch_order(runs[2]));
    const std::vector<double> got = figures(out, hinges);
    for (int width : {1, 2}) {
      if (latch_order(runs[width - 1]) != latch_order(out)) continue;
      ++compared;
      const std::vector<double> before = figures(runs[width - 1], hinges),
                                at = figures(runs[width], hinges);
      for (std::size_t k = 0; k < got.size(); ++k) {
        CAPTURE(width, k, before[k], at[k], got[k]);
        CHECK(std::abs(at[k] - got[k]) < 0.4 * std::abs(before[k] - got[k]) + floor);
      }
    }
    CHECK(compared == 2);
  }

  std::size_t hinges;
  ReferenceOutcome runs[3];
};

} // namespace wingspread::oracle
