// Loads that exact friction holds, and the times at which it releases a hinge.
#include "core/deployment.hpp"
#include "tests/core/events/regularized_limit.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// The scene from time t on, given that all hinges have stuck since its beginning on a base that
/// moves as prescribed; released, so that only the kinetic friction is left.
Scene released(Scene scene, double t) {
  Base& base = scene.base;
  base.angle += base.rate * t + 0.5 * base.angular_acceleration * t * t;
  base.rate += base.angular_acceleration * t;
  for (Hinge& hinge : scene.hinges) hinge.friction.static_level.reset();
  return scene;
}

/// Checks that the panel sticks until `release`, and then moves against its kinetic friction.
void check_release(const Scene& scene, double release, double t_end) {
  const Scene after = released(scene, release);
  const ReferenceOutcome exact = regularized_run(after, 1e-7, t_end - release);
  std::vector<Sample> samples;
  with_every_method(
      scene, within(1e-9, t_end), to_the_end, MayGiveUp::fixed_step,
      [&](const Outcome& out) {
        for (const Sample& sample : samples)
          if (sample.t < release - 1e-6) REQUIRE(stayed(sample.angles[0], scene.hinges[0].stowed));
        REQUIRE(out.latches.size() == exact.latches.size());
        // 1e-7 of the width, times some seconds; the release is located as an event is
        for (std::size_t k = 0; k < exact.latches.size(); ++k)
          CHECK(std::abs(out.latches[k].time - release - exact.latches[k].time) < 1e-6);
        CHECK(std::abs(out.final.angles[0] - exact.final.angles(0)) < 3e-6);
      },
      &samples);
}

} // namespace

TEST_CASE("hinges that stick from the start are torn loose by their neighbour's latch") {
  const Scene scene = held_until_the_root_latches();
  const ConstantDrive root = held_root(scene);
  const Limit limit(scene, 10);
  std::vector<Sample> samples;
  with_every_method(
      scene, within(1e-9, 10, 1e-4), to_the_end, MayGiveUp::fixed_step,
      [&](const Outcome& out) {
        CHECK(out.status == Status::deployed);
        REQUIRE(out.latches.size() == 3);
        limit.check(out);
        CHECK(out.latches[0].time == Approx(root.time()).epsilon(1e-8));
        CHECK(out.latches[0].rates[0] == Approx(-root.rate()).epsilon(1e-8));
        for (int i : {1, 2}) CHECK(out.latches[0].rates[i] == 0); // held until then, exactly
        for (const Sample& sample : samples)
          if (sample.t < out.latches[0].time) REQUIRE(stayed(sample.angles[1], 0.4));
      },
      &samples);
}

TEST_CASE("hinges that hold through a neighbour's latch leave the wing stalled half-way") {
  Scene scene = held_until_the_root_latches();
  for (int i : {1, 2}) scene.hinges[i].friction.static_level = 1e4;
  const ConstantDrive root = held_root(scene);
  for (const Goal& goal : {Goal{}, to_the_end})
    with_every_method(
        scene, within(1e-9, 60, 1e-4), goal, MayGiveUp::fixed_step, [&](const Outcome& out) {
          CHECK(out.status == Status::stalled);
          CHECK_THAT(out.reason, Catch::Contains("sticks") || Catch::Contains("energy"));
          REQUIRE(out.latches.size() == 1);
          CHECK(out.latches[0].time == Approx(root.time()).epsilon(1e-8));
          for (int i : {1, 2}) CHECK(stayed(out.final.angles[i], 0.4));
          for (const double rate : out.final.rates)
            if (goal.to_t_end) CHECK(rate == 0);
        });
}

TEST_CASE("a static level above the kinetic one holds until the load passes it") {
  SECTION("the load of a base that turns faster and faster") {
    // What holds the panel at φ = π/2, R = 0.4 m off the base's origin, is I α + m c R Ω²
    Scene scene = carried_panel(0.3, 0.8);
    scene.hinges[0].parent_point = {0.4, 0};
    scene.base.angular_acceleration = 0.1;
    check_release(scene, std::sqrt((0.8 - panel_inertia * 0.1) / 2) / 0.1, 9);
  }
  SECTION("the load of a steady acceleration, seen from a base that turns steadily") {
    // It is m c a sin Ωt: nothing that the scene names changes with time, and yet it does not stick
    Scene scene = carried_panel(0.3, 0.75);
    scene.base.acceleration = {0, 0.3};
    scene.base.rate = 0.1;
    check_release(scene, std::asin(0.75 / (10 * 0.5 * 0.3)) / 0.1, 9);
  }
  SECTION("the load of a neighbour's spring") {
    // Two discs, the second carried along by the first, which swings on a spring about 0: φ_1 =
    // sin t, the load J_2 sin t. Let loose, the second is slowed by τ_c alone, and the first swings
    // about τ_c/κ.
    const double first = 3, second = 2, kinetic = 0.4, held = 1, stiffness = first + second;
    Scene scene = coaxial_discs(first, second);
    pull_towards(scene.hinges[0], 0, stiffness);
    scene.hinges[0].initial_rate = 1;
    rub(scene.hinges[1], kinetic, held);
    const double release = std::asin(held / second), angle = held / second,
                 rate = std::cos(release), omega = std::sqrt(stiffness / first),
                 centre = kinetic / stiffness;
    std::vector<Sample> samples;
    with_every_method(
        scene, within(1e-9, release + 2), to_the_end, MayGiveUp::fixed_step,
        [&](const Outcome& out) {
          CHECK(out.status == Status::timed_out);
          const double off = astray(within(1e-9, 1), out.work.steps, 2);
          for (const Sample& sample : samples) {
            const double s = sample.t - release;
            const double swing = s < 0 ? std::sin(sample.t)
                                       : centre + (angle - centre) * std::cos(omega * s) +
                                             rate / omega * std::sin(omega * s);
            const double flight = angle + rate * s - kinetic / second * s * s / 2;
            CAPTURE(s);
            CHECK(std::abs(sample.angles[0] - swing) < off);
            if (s < -1e-6) REQUIRE(sample.angles[1] == 0);
            if (s > 0) CHECK(std::abs(sample.angles[1] - (flight - swing)) < off);
          }
        },
        &samples);
  }
}
