// Exact (set-valued) Coulomb friction in wings of several hinges, against closed forms and against
// the limit ω_s → 0 of regularized friction, which CVODE integrates on the dense model.
#include "tests/support/closed_forms.hpp"
#include "tests/support/reference_run.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace wingspread;
using namespace wingspread::oracle;
using std::numbers::pi;

namespace {

/// The scene with its exact friction smoothed over `width`.
Scene regularized(Scene scene, double width) {
  for (Hinge& hinge : scene.hinges) {
    if (hinge.friction.model != FrictionModel::exact) continue;
    hinge.friction.model = FrictionModel::regularized;
    hinge.friction.regularization_rate = width;
  }
  return scene;
}

ReferenceOutcome regularized_run(const Scene& scene, double width, double t_end) {
  ReferenceOptions options;
  options.t_end = t_end, options.stiff = true;
  options.rtol = 1e-10, options.atol = 1e-12; // of a rate: far below the width
  return cvode_run(regularized(scene, width), options);
}

/// Latches by time; those within 1e-9 of each other by hinge.
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

/// What is compared of a run: times and rates of its latches, angles and rates at its end.
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

/// The runs of regularized friction at three widths, ten times narrower each.
struct Limit {
  explicit Limit(const Scene& scene, double t_end)
      : hinges(scene.hinges.size()), runs{regularized_run(scene, 1e-5, t_end),
                                          regularized_run(scene, 1e-6, t_end),
                                          regularized_run(scene, 1e-7, t_end)} {}

  /// Checks that the runs converge to `out`, as O(ω_s) or, where a hinge only just moves,
  /// O(ω_s log ω_s): what is left at each width is less than 0.4 of what was left before, down to
  /// what both integrators' own errors (1e-10 and 1e-9 a step) add up to.
  void check(const Outcome& out) const {
    constexpr double floor = 1e-6;
    REQUIRE(latch_order(out) == latch_order(runs[2]));
    const std::vector<double> got = figures(out, hinges);
    for (int width : {1, 2}) {
      if (latch_order(runs[width - 1]) != latch_order(out)) continue;
      const std::vector<double> before = figures(runs[width - 1], hinges),
                                at = figures(runs[width], hinges);
      for (std::size_t k = 0; k < got.size(); ++k) {
        CAPTURE(width, k, before[k], at[k], got[k]);
        CHECK(std::abs(at[k] - got[k]) < 0.4 * std::abs(before[k] - got[k]) + floor);
      }
    }
  }

  std::size_t hinges;
  ReferenceOutcome runs[3];
};

/// Whether a hinge that sticks has stayed: to round-off, which is all that a method that adds up
/// weighted copies of a constant can promise.
bool stayed(double angle, double at) { return std::abs(angle - at) < 1e-13 * std::abs(at); }

/// The seed scene with exact friction on root, mid and tip.
Scene rubbed_seed(double root, double mid, double tip) {
  Scene scene = seed_scene();
  rub(scene.hinges[0], root), rub(scene.hinges[1], mid), rub(scene.hinges[2], tip);
  return scene;
}

/// Three panels that are nearly in line. The outer hinges lack the torque to move, and the root's
/// acceleration does not tear them loose; its latch does.
Scene held_until_the_root_latches() {
  Scene scene = rubbed_seed(0.3, 4, 1.5);
  const LinearTorque springs[] = {{5, 5}, {0.2, 0.2}, {0.1, 0.1}};
  for (int i = 0; i < 3; ++i) scene.hinges[i].spring = springs[i];
  scene.hinges[1].stowed = scene.hinges[2].stowed = 0.4;
  return scene;
}

/// The root's motion there as long as the outer hinges hold: a rigid body's.
ConstantDrive held_root(const Scene& scene) {
  const DenseWing<double> wing(regularized(scene, 1));
  WingState<double> state = wing.initial_state();
  state.rates(0) = 1;
  return {(5 - 0.3) / (2 * wing.balance(state).kinetic), pi / 2};
}

/// The scene from time t on, given that all hinges have stuck since its beginning on a base that
/// moves as prescribed; released, so that only the kinetic friction is left.
Scene released(Scene scene, double t) {
  Base& base = scene.base;
  base.angle += base.rate * t + 0.5 * base.angular_acceleration * t * t;
  base.rate += base.angular_acceleration * t;
  for (Hinge& hinge : scene.hinges) hinge.friction.static_level.reset();
  return scene;
}

/// A panel on a prescribed base, without spring:
/// sticks by `static_level`, slides against `kinetic`.
Scene carried_panel(double kinetic, double static_level) {
  Scene scene = latching_panel();
  scene.base.motion = BaseMotion::prescribed;
  scene.hinges[0].spring = {0, 0};
  rub(scene.hinges[0], kinetic, static_level);
  return scene;
}

/// Runs the panel, which is to stick until `release` and then to follow its kinetic friction.
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

TEST_CASE("the closed form of dry friction is the limit of regularized friction") {
  struct Case {
    double viscous, u, rate;
  };
  for (const Case& c : {Case{0, 1.05, 0}, Case{0.4, 0.7, 0.5}, Case{0.2, -0.7, 0.5}}) {
    const CoulombOscillator exact({panel_inertia, panel_inertia, c.viscous, 0.3, 0.3},
                                  {c.u, c.rate});
    Scene scene = unit_oscillator(c.u, c.rate);
    rub(scene.hinges[0], 0.3);
    scene.hinges[0].friction.viscous = c.viscous;
    for (const double t : {1., 4., 7., 12.}) {
      const ReferenceOutcome limit = regularized_run(scene, 1e-8, t);
      CAPTURE(c.viscous, c.u, c.rate, t, exact.stop_time());
      CHECK(std::abs(limit.final.angles(0) - exact.at(t).u) < 3e-7); // some 10 s of creep
      CHECK(std::abs(limit.final.rates(0) - exact.at(t).rate) < 3e-7);
    }
  }
}

TEST_CASE("wings with exact friction are the limit of wings with regularized friction") {
  SECTION("three panels that all deploy") {
    const Scene scene = rubbed_seed(0.3, 0.2, 0.05);
    const Limit limit(scene, 9);
    with_every_method(scene, within(1e-9, 9, 1e-4), to_the_end, MayGiveUp::fixed_step,
                      [&](const Outcome& out) {
                        CHECK(out.status == Status::deployed);
                        limit.check(out);
                      });
  }
  SECTION("three panels, of which one gets stuck on its way") {
    const Scene scene = rubbed_seed(0.3, 1.2, 0.6);
    const Limit limit(scene, 9);
    with_every_method(scene, within(1e-9, 9, 1e-4), to_the_end, MayGiveUp::fixed_step,
                      [&](const Outcome& out) { limit.check(out); });
  }
  SECTION("one hinge exact, its neighbours regularized") {
    Scene scene = rubbed_seed(0.3, 0.2, 0.05);
    for (int i : {0, 2}) {
      scene.hinges[i].friction.model = FrictionModel::regularized;
      scene.hinges[i].friction.regularization_rate = 0.1;
    }
    const Limit limit(scene, 9);
    with_every_method(scene, within(1e-9, 9, 1e-4), to_the_end, MayGiveUp::fixed_step,
                      [&](const Outcome& out) { limit.check(out); });
  }
  SECTION("a free spacecraft, whose momenta friction keeps") {
    Scene scene = symmetric_tree();
    for (Hinge& hinge : scene.hinges) rub(hinge, 0.2);
    const Limit limit(scene, 7);
    const DenseWing<long double> wing(regularized(scene, 1));
    with_every_method(
        scene, within(1e-9, 7, 1e-4), to_the_end, MayGiveUp::implicit, [&](const Outcome& out) {
          limit.check(out);
          // one instant, but for the round-off that extrapolation magnifies
          const bool extrapolated = methods_used(out) == "seulex";
          CHECK(out.latches[1].time - out.latches[0].time <= (extrapolated ? 1e-9 : 0));
          const auto after = wing.balance(state_of(out, wing));
          // parts of up to √(2·240 kg·2.3 J) kg·m/s of which zero is the sum
          CHECK(after.linear_momentum.norm() < 1e-12L * 33);
          CHECK(std::abs(after.angular_momentum) < 1e-12L * 33);
        });
  }
}

TEST_CASE("random wings that stick and slide are the limit of regularized ones") {
  int at_rest = 0, latches = 0;
  for (std::uint64_t seed = 1; seed <= 36; ++seed) {
    RandomScene options;
    options.bodies = 1 + static_cast<int>(seed) % 4;
    options.motion = static_cast<BaseMotion>(seed % 3);
    options.mass_lower = 1, options.mass_upper = 20, options.friction = false;
    Scene scene = random_scene(seed, options);
    Draws draws(seed + 500);
    for (Hinge& hinge : scene.hinges) {
      rub(hinge, draws.uniform(0, 6)); // springs give 1 to 5 N·m
      hinge.latch = Latch{1e3, 30};
      if (draws.chance(0.5)) hinge.initial_rate = 0; // starts at rest: does it move, and which way?
      if (draws.chance(0.3)) hinge.friction.viscous = draws.uniform(0, 1);
    }
    const Limit limit(scene, 3);
    Integration how = within(1e-9, 3);
    const Outcome out = Deployment().run(scene, how, to_the_end);
    CAPTURE(seed, options.bodies, out.reason);
    REQUIRE(out.status != Status::failed);
    REQUIRE(out.status != Status::invalid);
    limit.check(out);
    latches += static_cast<int>(out.latches.size());
    at_rest += static_cast<int>(std::count(out.final.rates.begin(), out.final.rates.end(), 0.));
  }
  CHECK(latches >= 10);
  CHECK(at_rest >= 20); // exactly
}

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

TEST_CASE("the order of the hinges in the file changes nothing about friction") {
  for (const Scene& scene : {rubbed_seed(0.3, 1.2, 0.6), held_until_the_root_latches()}) {
    const Integration how = within(1e-9, 9);
    const Outcome there = Deployment().run(scene, how, to_the_end),
                  back = Deployment().run(reversed(scene), how, to_the_end);
    CHECK(there.status == back.status);
    REQUIRE(there.latches.size() == back.latches.size());
    REQUIRE(there.latches.size() > 0);
    for (std::size_t k = 0; k < there.latches.size(); ++k) {
      CHECK(there.latches[k].hinge == 2 - back.latches[k].hinge);
      CHECK(there.latches[k].time == Approx(back.latches[k].time).epsilon(1e-8));
    }
    for (int i : {0, 1, 2}) {
      CHECK(there.final.angles[i] == Approx(back.final.angles[2 - i]).margin(1e-7));
      CHECK((there.final.rates[i] == 0) == (back.final.rates[2 - i] == 0));
    }
  }
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

TEST_CASE("a wing that sticks from the start is stalled at once") {
  Scene fixed = rubbed_seed(2.5, 2, 1);
  Scene with_static_levels = rubbed_seed(0, 0, 0);
  for (Hinge& hinge : with_static_levels.hinges) hinge.friction.static_level = 2.5;
  Scene tumbling = two_wing_free_spacecraft();
  for (Hinge& hinge : tumbling.hinges) rub(hinge, 2.5);
  Scene turning = carried_panel(0.3, 0.8); // steadily: its load, 2·0.6² N·m, is constant
  turning.hinges[0].parent_point = {0.4, 0};
  turning.base.rate = 0.6;
  for (const Scene& scene : {fixed, with_static_levels, tumbling, turning})
    for (const Goal& goal : {Goal{}, latches_only, to_the_end}) {
      CAPTURE(scene.name, scene.hinges[0].friction.coulomb);
      with_every_method(scene, within(1e-8, 10), goal, MayGiveUp::fixed_step,
                        [&](const Outcome& out) {
                          CHECK(out.status == Status::stalled);
                          CHECK_THAT(out.reason, Catch::Contains("sticks"));
                          CHECK(out.t_end == (goal.to_t_end ? 10 : 0));
                          CHECK(out.latches.empty());
                          for (std::size_t i = 0; i < scene.hinges.size(); ++i) {
                            CHECK(out.final.angles[i] == scene.hinges[i].stowed);
                            CHECK(out.final.rates[i] == 0);
                          }
                        });
    }
}

TEST_CASE("a hinge that still moves, or may, is not stalled") {
  SECTION("the root is not held: it latches first") {
    Scene scene = rubbed_seed(2.5, 2, 1);
    scene.hinges[0].friction = {};
    const Outcome out = Deployment().run(scene, within(1e-9, 60), {});
    REQUIRE(out.latches.size() >= 1);
    CHECK(out.latches[0].hinge == 0);
  }
  SECTION("regularized friction creeps where exact friction sticks") {
    Scene scene = rubbed_seed(2.5, 2, 1);
    scene.hinges[0].friction.model = FrictionModel::regularized;
    const Outcome out = Deployment().run(scene, within(1e-9, 20), {});
    REQUIRE(out.status == Status::timed_out);
    CHECK(out.final.rates[0] < 0);
    CHECK(out.final.rates[1] == 0);
  }
}

TEST_CASE("friction that is nothing changes nothing, and static friction alone only holds") {
  const Integration how = within(1e-9, 12);
  SECTION("no level") {
    const Outcome none = Deployment().run(seed_scene(), how, {}),
                  zero = Deployment().run(rubbed_seed(0, 0, 0), how, {});
    REQUIRE(zero.latches.size() == none.latches.size());
    for (std::size_t k = 0; k < none.latches.size(); ++k)
      CHECK(zero.latches[k].time == Approx(none.latches[k].time).epsilon(1e-8));
  }
  SECTION("a static level alone, which a moving hinge does not feel") {
    Scene scene = latching_panel();
    rub(scene.hinges[0], 0, 3);
    CHECK(Deployment().run(scene, how, {}).status == Status::stalled);
    scene.hinges[0].initial_rate = -0.1;
    const ConstantDrive exact{2 / panel_inertia, pi / 2, 0.1};
    with_every_method(scene, how, latches_only, MayGiveUp::fixed_step, [&](const Outcome& out) {
      REQUIRE(out.latches.size() == 1);
      CHECK(out.latches[0].time == Approx(exact.time()).epsilon(1e-8));
    });
  }
}

TEST_CASE("what energy a wing loses is what its friction takes") {
  for (const Scene& scene : {rubbed_seed(0.3, 1.2, 0.6), held_until_the_root_latches()}) {
    std::vector<Sample> samples;
    with_every_method(
        scene, within(1e-9, 9, 1e-4), to_the_end, MayGiveUp::fixed_step,
        [&](const Outcome& out) {
          REQUIRE(!out.latches.empty());
          const double start = samples[0].kinetic + samples[0].potential;
          double taken = 0; // ∫ τ_c |φ̇| dt: a reversal is where a step ends
          for (std::size_t k = 1; samples[k].t <= out.latches[0].time; ++k) {
            const Sample &before = samples[k - 1], &at = samples[k];
            for (std::size_t i = 0; i < scene.hinges.size(); ++i) {
              taken += scene.hinges[i].friction.coulomb * std::abs(at.angles[i] - before.angles[i]);
              if (before.rates[i] == 0 && at.rates[i] == 0)
                REQUIRE(stayed(at.angles[i], before.angles[i]));
            }
            REQUIRE(std::abs(start - (at.kinetic + at.potential) - taken) < 1e-7 * start);
          }
          CHECK(taken > 0.01 * start);
        },
        &samples);
  }
}
