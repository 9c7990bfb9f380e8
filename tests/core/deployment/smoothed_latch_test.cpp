// The smoothed latch: against CVODE on the dense model, and the event latch that it tends to.
#include "core/deployment.hpp"
#include "tests/support/whole_runs.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// The seed scene with a smoothed latch, by CVODE, to just after its second latch.
ReferenceOutcome smoothed_reference(std::optional<double> smoothing) {
  ReferenceOptions options;
  options.t_end = 6.3, options.rtol = 1e-11, options.atol = 1e-13, options.max_step = 1e-2;
  options.smoothing = smoothing;
  return cvode_run(seed_scene(), options);
}

} // namespace

TEST_CASE("a smoothed latch is as wrong as its width, and no wronger", "[long]") {
  const ReferenceOutcome event = smoothed_reference({});
  std::vector<double> root_errors;
  for (const double epsilon : {1e-4, 1e-3, 1e-2}) {
    const ReferenceOutcome exact = smoothed_reference(epsilon);
    root_errors.push_back(exact.peak_moment[0].value / event.peak_moment[0].value - 1);
    Integration how = within(1e-9, 6.3, 1e-4);
    how.smoothing = epsilon;
    CAPTURE(epsilon);
    with_every_method(
        seed_scene(), how, to_the_end, MayGiveUp::all_but_auto, [&](const Outcome& out) {
          // the reference is good to 1e-7 (its own tests); the kinks of the smooth steps cost explicit
          // methods of high order more than their error estimates see, still far less than the
          // smoothing itself does. Methods whose estimates expect smooth laws end steps at the kinks:
          // over them seulex loses up to 3e-5, whatever the tolerance
          const std::string& method = out.phases.front().method;
          const bool ends_at_kinks = method == "seulex" || method == "rosenbrock_w" ||
                                     method == "bulirsch_stoer" || method == "fehlberg78";
          const double most = ends_at_kinks ? 2e-7 : 1e-5;
          for (int hinge : {0, 1})
            CHECK(relative(out.peak_moment[hinge].value, exact.peak_moment[hinge].value) < most);
        });
  }
  // the smoothing itself changes the peak by about 15 ε, at first linearly
  CHECK(root_errors[0] == Approx(0.00154).epsilon(0.01));
  CHECK(root_errors[1] / root_errors[0] == Approx(10).epsilon(0.1));
  CHECK(root_errors[2] == Approx(0.219).epsilon(0.01));
}

TEST_CASE("the smoothed latch tends to the event latch") {
  const double exact = run(oracle::seed_scene(), 1e-9, 9).peak_moment[0].value;
  double before = 1;
  for (const double epsilon : {1e-2, 1e-3, 1e-4, 1e-5}) {
    Integration how;
    how.t_end = 9;
    how.smoothing = epsilon;
    const Outcome out = Deployment().run(oracle::seed_scene(), how, {});
    REQUIRE(out.status == Status::deployed);
    const double deviation = relative(out.peak_moment[0].value, exact);
    CHECK(deviation < before);
    before = deviation;
  }
  CHECK(before < 1e-3);
}

TEST_CASE("the smoothed latch agrees with CVODE on the dense model") {
  oracle::ReferenceOptions options;
  options.t_end = 9, options.rtol = 1e-10, options.atol = 1e-12, options.max_step = 1e-3,
  options.smoothing = 1e-3;
  const oracle::ReferenceOutcome exact = oracle::cvode_run(oracle::seed_scene(), options);
  Integration how;
  how.rtol = 1e-9, how.atol = 1e-12, how.t_end = 9, how.smoothing = 1e-3;
  Goal goal;
  goal.to_t_end = true;
  compare(Deployment().run(oracle::seed_scene(), how, goal), exact, 1e-7, 1e-5);
}

TEST_CASE("a run with smoothed latches is refused where a latch needs its event, and says so") {
  const Scene plain = latching_panel();
  Integration how = within(1e-6, 4);
  how.smoothing = 1e-3;
  CHECK(hinge_with_event_latch(plain) == nullptr);
  CHECK(Deployment().run(plain, how, {}).status != Status::failed);
  Latch loose, hasty, weak;
  loose.backlash = 0.01, hasty.capture_rate = 0.5, weak.holding_moment = 10;
  for (Latch latch : {loose, hasty, weak}) {
    latch.stiffness = 1e4, latch.damping = 100;
    Scene scene = plain;
    scene.bodies.push_back({"other_panel", 10, 0.5}); // the second hinge's
    Hinge other = scene.hinges[0];
    other.name = "other", other.child = 1, other.parent_point = {3, 1}, other.latch = latch;
    scene.hinges.push_back(other);
    CAPTURE(latch.backlash, latch.can_miss());
    CHECK(hinge_with_event_latch(scene) == &scene.hinges[1]);
    const Outcome out = Deployment().run(scene, how, {});
    CHECK(out.status == Status::failed);
    CHECK(out.reason == needs_event_latches);
  }
}

TEST_CASE("the trajectory inside long steps has the moments of smoothed latches") {
  Goal goal = to_the_end;
  goal.sample_interval = 2e-3;
  const auto moments = [&](const char* method, double rtol) {
    Integration how = within(rtol, 6.3, 1e-4);
    how.method = method, how.smoothing = 0.02;
    std::vector<double> found;
    const Outcome out = Deployment().run(seed_scene(), how, goal, [&](const Sample& sample) {
      found.insert(found.end(), sample.moments.begin(), sample.moments.end());
    });
    REQUIRE(out.status != Status::failed);
    return found;
  };
  const std::vector<double> exact = moments("dopri5", 1e-13);
  const double size =
      std::abs(*std::ranges::max_element(exact, {}, [](double m) { return std::abs(m); }));
  for (const char* method : {"auto", "dop853", "bulirsch_stoer", "fehlberg78", "seulex"})
    for (const double rtol : {1e-7, 1e-10}) {
      const std::vector<double> found = moments(method, rtol);
      REQUIRE(found.size() == exact.size());
      double worst = 0;
      for (std::size_t k = 0; k < found.size(); ++k)
        worst = std::max(worst, std::abs(found[k] - exact[k]) / size);
      CHECK(worst < 3e-5);
    }
}
