/// Whole runs, and their comparison with references: another formulation, other integrators, closed forms.
#pragma once

#include "tests/support/closed_forms.hpp"
#include "tests/support/reference_run.hpp"

#include <catch2/catch.hpp>

#include <cmath>

namespace wingspread::oracle {

inline double relative(double got, double expected) { return std::abs(got / expected - 1); }

/// Runs a scene by the method `auto`, with all peaks.
inline Outcome run(const Scene& scene, double rtol, double t_end, bool to_t_end = true) {
  Integration how;
  how.rtol = rtol, how.atol = 1e-2 * rtol, how.t_end = t_end;
  Goal goal;
  goal.to_t_end = to_t_end;
  return Deployment().run(scene, how, goal);
}

/// Compares times and rates of latches, and peaks, with a reference. `latches` and `peaks` are relative tolerances; that
/// of rates is 10 · latches.
inline void compare(const Outcome& got, const ReferenceOutcome& expected, double latches,
                    double peaks) {
  REQUIRE(got.latches.size() == expected.latches.size());
  for (std::size_t k = 0; k < got.latches.size(); ++k) {
    const LatchEvent& a = got.latches[k];
    const ReferenceLatch& b = expected.latches[k];
    CAPTURE(k, a.hinge);
    REQUIRE(a.hinge == b.hinge);
    CHECK(relative(a.time, b.time) < latches);
    for (std::size_t j = 0; j < a.rates.size(); ++j)
      CHECK(std::abs(a.rates[j] - b.rates[j]) < latches * std::abs(b.rates[a.hinge]) * 10);
  }
  for (std::size_t i = 0; i < got.peak_moment.size(); ++i) {
    CAPTURE(i);
    CHECK(relative(got.peak_moment[i].value, expected.peak_moment[i].value) < peaks);
    CHECK(relative(got.peak_force[i].value, expected.peak_force[i].value) < peaks);
  }
}

/// Compares latches, in order, with those of a reference whose times are first multiplied by `pace`, and whose rates are
/// divided by it.
inline void check_latches(const Outcome& out, const ReferenceOutcome& exact, double tolerance,
                          double pace = 1) {
  REQUIRE(out.latches.size() == exact.latches.size());
  for (std::size_t k = 0; k < exact.latches.size(); ++k) {
    const LatchEvent& got = out.latches[k];
    const ReferenceLatch& expected = exact.latches[k];
    CAPTURE(k);
    REQUIRE(got.hinge == expected.hinge);
    CHECK(relative(got.time, expected.time * pace) < tolerance);
    CHECK(relative(got.rates[got.hinge], expected.rates[got.hinge] / pace) < 10 * tolerance);
  }
}

/// The one latch of a panel under a constant moment.
inline void check_latch(const Outcome& out, const ConstantDrive& exact, double tolerance) {
  REQUIRE(out.latches.size() == 1);
  CHECK(relative(out.latches[0].time, exact.time()) < tolerance);
  CHECK(relative(std::abs(out.latches[0].rates[0]), exact.rate()) < tolerance);
}

/// A reference run in extended precision.
inline ReferenceOutcome reference(const Scene& scene, double t_end) {
  ReferenceOptions options;
  options.t_end = t_end;
  options.rtol = 1e-15, options.atol = 1e-16;
  return high_precision_run<long double>(scene, options);
}

/// The reference run of the seed scene, to just after its last latch.
inline const ReferenceOutcome& seed_reference() {
  static const ReferenceOutcome outcome = reference(seed_scene(), 7);
  return outcome;
}

} // namespace wingspread::oracle
