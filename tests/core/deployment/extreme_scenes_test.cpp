// Scenes on which methods fail. With any method a run gives the right answer or reports a failure; a wrong number
// that looks like an answer fails the test.
//
// More such scenes are tested elsewhere: overflow and NaN (run/ending_test.cpp), the steps at which a ringing latch
// becomes unstable (methods/steppers_stability_test.cpp), and chains of a thousand panels
// (mechanics/recursion_test.cpp, "a thousand bodies agree with a dense solve"; their cost:
// studies/drivers/benchmark.cpp).
#include "core/deployment.hpp"
#include "tests/support/whole_runs.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::oracle;
using std::numbers::pi;

namespace {

/// A chain of two panels: the second hinge is in the second panel's centre of mass, so that each
/// panel's acceleration is constant whatever the masses. Masses and inertias of the seed scene's
/// panels times `root` and `tip`.
struct ChainOfTwo {
  double root, tip;

  [[nodiscard]] double root_inertia() const { return panel_inertia * root + 10 * tip; }
  [[nodiscard]] double root_torque() const { return root_inertia() / 3; }
  [[nodiscard]] double tip_torque() const { return 0.1 * tip; }
  /// Of the first hinge; both turn in the negative sense, the second drives the first back.
  [[nodiscard]] double root_acceleration() const {
    return (root_torque() - tip_torque()) / root_inertia();
  }
  [[nodiscard]] double tip_acceleration() const { // relative
    return tip_torque() / (0.5 * tip) - root_acceleration();
  }

  [[nodiscard]] Scene scene() const {
    Scene scene = latching_panel();
    scene.bodies = {{"root", 10 * root, 0.5 * root}, {"tip", 10 * tip, 0.5 * tip}};
    scene.hinges[0].spring = {root_torque(), root_torque()};
    Hinge second = scene.hinges[0];
    second.name = "second", second.parent = 0, second.child = 1;
    second.parent_point = {0.5, 0}, second.child_point = {0, 0};
    second.spring = {tip_torque(), tip_torque()};
    second.latch.reset();
    scene.hinges.push_back(second);
    return scene;
  }
};

/// The first two panels of the seed scene without latches, masses as above. The tip's spring is
/// scaled with the smaller factor.
Scene two_seed_panels(double root, double tip) {
  Scene scene = seed_scene();
  scene.bodies.pop_back(), scene.hinges.pop_back();
  const double factor[] = {root, tip};
  for (int i = 0; i < 2; ++i) {
    scene.bodies[i].mass *= factor[i], scene.bodies[i].inertia *= factor[i];
    scene.hinges[i].latch.reset();
  }
  for (HingeTorque* torque : {&scene.hinges[1].spring})
    torque->torque_stowed *= std::min(root, tip), torque->torque_latched *= std::min(root, tip);
  return scene;
}

} // namespace

TEST_CASE("mass ratios of a million either way agree with the limits") {
  for (const ChainOfTwo& exact : {ChainOfTwo{1, 1e-6}, ChainOfTwo{1e-6, 1}, ChainOfTwo{1e6, 1},
                                  ChainOfTwo{1, 1e6}, ChainOfTwo{1e-6, 1e6}}) {
    CAPTURE(exact.root, exact.tip);
    const ConstantDrive drive{exact.root_acceleration(), pi / 2};
    with_every_method(exact.scene(), within(1e-9, 10), latches_only, MayGiveUp::fixed_step,
                      [&](const Outcome& out) {
                        check_latch(out, drive, 1e-8);
                        // only relative rates are told: the second's is the whole chain's error
                        CHECK(relative(-out.latches.at(0).rates[1],
                                       exact.tip_acceleration() * drive.time()) < 1e-7);
                      });
  }
}

TEST_CASE("chains of unequal masses that do feel each other agree with extended precision") {
  ReferenceOptions options;
  options.t_end = 3, options.rtol = 1e-14, options.atol = 1e-15;
  for (const auto& [root, tip] : {std::pair(1., 1e-6), {1e-6, 1.}, {1e6, 1.}, {1., 1e6}}) {
    const Scene scene = two_seed_panels(root, tip);
    const ReferenceOutcome exact = high_precision_run<long double>(scene, options);
    CAPTURE(root, tip);
    with_every_method(scene, within(1e-10, 3), to_the_end, MayGiveUp::fixed_step,
                      [&](const Outcome& out) {
                        for (int i : {0, 1}) {
                          CHECK(std::abs(out.final.angles[i] - exact.final.angles(i)) < 1e-7);
                          CHECK(std::abs(out.final.rates[i] - exact.final.rates(i)) < 1e-7);
                        }
                      });
  }
}

TEST_CASE("next to no inertia: the right answer or none, never NaN") {
  // light bodies under normal moments, or under moments as light as they are; subnormal ones too
  int judged = 0;
  for (const double light : {1e-12, 1e-24, 1e-30, 1e-60, 1e-150, 1e-290, 1e-310})
    for (const double torque : {2., 2 * light}) {
      Scene scene = latching_panel();
      scene.bodies[0].mass *= light, scene.bodies[0].inertia *= light;
      scene.hinges[0].spring = {torque, torque};
      const ConstantDrive exact{torque / (panel_inertia * light), pi / 2};
      INFO("light " << light << ", torque " << torque << ": exactly " << exact.time() << " s");
      for (const Goal& goal : {latches_only, Goal{}}) {
        Integration how = within(1e-9, exact.time() > 0 ? 10 * exact.time() : 1);
        how.max_steps = 5000;
        judged += with_every_method(scene, how, goal, MayGiveUp::all,
                                    [&](const Outcome& out) { check_latch(out, exact, 1e-6); });
      }
    }
  CHECK(judged >= 139); // of 252
}

TEST_CASE("latches of 1e9 N·m/rad: auto is right, the others right or failed", "[long]") {
  for (const double damping : {1e5, 1e3}) { // over-damped; ringing at some 1e4 rad/s for 10 ms
    Scene scene = seed_scene();
    for (Hinge& hinge : scene.hinges) hinge.latch = Latch{1e9, damping};
    ReferenceOptions options;
    options.t_end = 7, options.rtol = 1e-10, options.atol = 1e-12, options.stiff = true;
    const ReferenceOutcome exact = cvode_run(scene, options);
    REQUIRE(exact.latches.size() == 3);
    Integration how = within(1e-8, 7, 1e-4);
    how.max_steps = 60'000;
    CAPTURE(damping);
    const int judged =
        with_every_method(scene, how, {}, MayGiveUp::all_but_auto, [&](const Outcome& out) {
          CHECK(out.status == Status::deployed);
          check_latches(out, exact, 1e-6); // the reference's own error is a tenth of it
          for (int i = 0; i < 3; ++i)
            CHECK(relative(out.peak_moment[i].value, exact.peak_moment[i].value) < 1e-4);
        });
    CHECK(judged >= (damping > 1e4 ? 8 : 6));
  }
}

TEST_CASE("springs of a million N·m deploy in a thousandth of the time of springs of one N·m") {
  const double times = 1e6, pace = 1 / std::sqrt(times); // moments · times, times · pace
  Scene scene = seed_scene();
  for (Hinge& hinge : scene.hinges) {
    hinge.spring.torque_stowed *= times, hinge.spring.torque_latched *= times;
    hinge.latch->stiffness *= times, hinge.latch->damping *= times * pace;
  }
  with_every_method(scene, within(1e-9, 7 * pace, 1e-4 * pace), {}, MayGiveUp::fixed_step,
                    [&](const Outcome& out) {
                      CHECK(out.status == Status::deployed);
                      check_latches(out, seed_reference(), 1e-7, pace);
                      for (int i = 0; i < 3; ++i) {
                        CHECK(relative(out.peak_moment[i].value,
                                       times * seed_reference().peak_moment[i].value) < 1e-6);
                        CHECK(relative(out.peak_force[i].value,
                                       times * seed_reference().peak_force[i].value) < 1e-6);
                      }
                    });
}
