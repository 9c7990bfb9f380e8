// Extra steps to a peak inside a step: how a run proceeds if its method refuses one.
#include "core/run/integrator.hpp"
#include "tests/support/whole_runs.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <limits>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

using SeedRun = Integrator<double, Tree, BaseMotion::fixed>;

struct Refused {
  Outcome outcome;
  int probes = 0; ///< steps that were to make sure of a peak
};

/// Runs the seed wing, but refuses every step inside another one and leaves NaN in its result.
Refused run_refusing_probes(const Integration& how) {
  const Scene scene = seed_scene();
  const Goal goal{.audit = false};
  const Observer nobody;
  Wing<double> wing = make_wing<double>(scene, outward_order(scene));
  set_parameters(wing, scene);
  Workspace<double> work;
  SeedRun::AnySystem system(wing, std::nullopt, work);
  SeedRun run(system, how, goal, nobody);
  Refused refused;
  for (run.begin(); !run.ended();) {
    LaneResult place = run.empty_lane_result();
    if (&place.x1 == &place.step.x1) {
      run.make_step();
      continue;
    }
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    place.x1.assign(place.x1.size(), none), place.dxdt1.assign(place.dxdt1.size(), none);
    place.forces_at_end.assign(place.forces_at_end.size(), {none, none});
    place.error = 2, place.judged = {2, 1};
    run.resume(place);
    ++refused.probes;
  }
  refused.outcome = run.outcome();
  return refused;
}

/// How far the largest peaks are off those of the usual run; the end is the same.
double largest_change(const Integration& how) {
  const Outcome usual = Deployment().run(seed_scene(), how, {.audit = false});
  const auto [out, probes] = run_refusing_probes(how);
  CAPTURE(how.method, how.rtol, probes);
  CHECK(probes >= 5);
  REQUIRE(finite(out));
  CHECK(out.status == Status::deployed);
  CHECK(out.t_end == usual.t_end);
  double change = 0;
  for (int i = 0; i < 3; ++i)
    change = std::max({change, relative(out.peak_moment[i].value, usual.peak_moment[i].value),
                       relative(out.peak_force[i].value, usual.peak_force[i].value)});
  return change;
}

} // namespace

TEST_CASE("where a method refuses the step to a peak, shorter ones lead there") {
  Integration how = within(1e-4, 60);
  for (const double rtol : {1e-4, 1e-8})
    for (const char* method : {"dopri5", "dop853", "bulirsch_stoer"}) {
      how.rtol = rtol, how.atol = 1e-2 * rtol, how.method = method;
      CAPTURE(rtol, method);
      CHECK(largest_change(how) < rtol); // what a step may lose, and the way there takes a few
    }
}

TEST_CASE("where the step to a peak is refused to Adams' method, the dense output's word stands") {
  for (const double rtol : {1e-4, 1e-8}) {
    Integration how = within(rtol, 60);
    how.method = "adams_bashforth_moulton";
    CAPTURE(rtol);
    CHECK(largest_change(how) < 1e-2 * std::sqrt(rtol));
  }
}
