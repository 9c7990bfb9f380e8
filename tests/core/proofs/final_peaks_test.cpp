// When a run asks for the energy's box, and how far bounds exceed the peaks seen.
#include "core/deployment.hpp"
#include "core/proofs/final_peaks.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace wingspread;

TEST_CASE(
    "the energy's box is asked for at the third refusal, and again once bounds may have shrunk") {
  ThoroughAttempts<double> attempts;
  CHECK_FALSE(attempts.is_due(8));
  CHECK_FALSE(attempts.is_due(8));
  CHECK(attempts.is_due(8));
  attempts.note_failure(8, 4.0); // loads of four times the peaks: the energy must fall to a quarter
  CHECK_FALSE(attempts.is_due(2.01));
  CHECK(attempts.is_due(2));
  attempts.note_failure(2, 1.0); // only another output lies above what was seen
  CHECK_FALSE(attempts.is_due(1.51));
  CHECK(attempts.is_due(1.5));
  attempts.note_failure(1, std::nullopt); // no box
  CHECK_FALSE(attempts.is_due(0.51));
  CHECK(attempts.is_due(0.5));
  attempts.note_failure(
      0.5,
      2.0); // at the ninth refusal: though the energy stays, the box is asked for at the eighteenth
  int refused = 0;
  while (!attempts.is_due(0.5)) ++refused;
  CHECK(refused == 8);
  attempts.note_failure(0.5, 1e3);
  CHECK_FALSE(attempts.is_due(0.4));
  attempts.end(); // the run ends: no attempt is left to wait for
  for (int last = 0; last < 3; ++last) CHECK(attempts.is_due(0.4));
}

TEST_CASE(
    "the peaks of a free base that turns fast are proven, and are those of the run to t_end") {
  Integration how;
  how.t_end = 100;
  for (const double turning : {0.0, 0.2, 0.5, 1.0, -2.0}) {
    Scene scene = oracle::two_wing_free_spacecraft();
    scene.base.rate = turning;
    CAPTURE(turning);
    const Outcome out = Deployment().run(scene, how, {}),
                  whole = Deployment().run(scene, how, {.to_t_end = true});
    REQUIRE(out.status == Status::deployed);
    CHECK(out.peaks_final);
    CHECK(out.t_end < 60);
    for (std::size_t i = 0; i < scene.hinges.size(); ++i) {
      CHECK(out.peak_moment[i].value == Approx(whole.peak_moment[i].value).epsilon(1e-9));
      CHECK(out.peak_force[i].value == Approx(whole.peak_force[i].value).epsilon(1e-9));
    }
  }
}

TEST_CASE("a wing that is never released does not hide that the other's moments are proven") {
  Scene scene = oracle::two_wing_free_spacecraft();
  scene.base.rate = 0.02;
  scene.hinges[2].release = Release{.fails = 1};
  Integration how;
  how.t_end = 100;
  const Outcome out = Deployment().run(scene, how, {});
  CHECK(out.status == Status::stalled);
  CHECK(out.moments_final);
}

TEST_CASE("the excess of loads is the largest ratio of any bound to its peak") {
  const std::vector<PeakOf<double>> moments{{}, {10, 1}, {20, 1}}, forces{{}, {100, 1}, {50, 1}};
  HingeBounds bounds;
  bounds.moment.resize(2), bounds.force.resize(2);
  bounds.moment << 5, 30;
  bounds.force << 120, 5;
  const auto of = [&](const std::vector<PeakOf<double>>* m, const std::vector<PeakOf<double>>* f) {
    return excess_of_loads(SeenPeaks<double>{m, f, nullptr, nullptr, nullptr}, bounds);
  };
  CHECK(of(&moments, &forces) == 1.5);
  CHECK(of(nullptr, &forces) == 1.2);
  CHECK(of(&moments, nullptr) == 1.5);
  CHECK(of(nullptr, nullptr) == 0);
  bounds.moment << 25, 30;
  CHECK(of(&moments, nullptr) == 2.5);
}

TEST_CASE("a free base's peaks are proven up to the furthest and fastest that hinges and the whole "
          "turn it, no less") {
  for (int trial = 0; trial < 400; ++trial) {
    oracle::Draws draws(5500 + trial);
    BaseExcursion<double> seen;
    seen.first_angle = draws.uniform(-1, 1), seen.first_rate = draws.uniform(-1, 1);
    const BaseBounds bounds{draws.log_uniform(1e-3, 1), draws.log_uniform(1e-3, 1),
                            draws.log_uniform(1e-3, 1)};
    const double at_rest = draws.uniform(-2, 2), mean = draws.uniform(-1, 1),
                 time = draws.chance(0.2) ? 0 : draws.log_uniform(0.01, 10);
    double rate = 0, angle = 0; // the largest changes, over the corners of what is possible
    for (const double side : {-1., 1.})
      for (const double off : {-1., 1.}) {
        const double turning = mean + off * bounds.drift;
        rate = std::max(rate, std::abs(turning + side * bounds.rate - seen.first_rate));
        for (const double later : {0., time})
          angle = std::max(
              angle, std::abs(at_rest + side * bounds.way + turning * later - seen.first_angle));
      }
    const auto proven = [&](double of_rate, double of_angle) {
      seen.rate = of_rate * rate, seen.angle = of_angle * angle;
      return no_base_peak_can_rise(seen, bounds, at_rest, mean, time);
    };
    CAPTURE(trial, rate, angle);
    CHECK(proven(1 + 1e-9, 1 + 1e-9));
    CHECK_FALSE(proven(1 - 1e-9, 1 + 1e-9));
    CHECK_FALSE(proven(1 + 1e-9, 1 - 1e-9));
  }
}

namespace {

enum class KindOfHold { rigid, without_latch, elastic, in_loop };

/// Whether the seed wing's holds and loads are proven final where its root is held, the others have latched and swing a
/// little. @param most what the root's hold has borne, N·m
bool proves_with_hold(KindOfHold kind, double most, double* bound = nullptr) {
  Scene scene = oracle::seed_scene();
  Hinge& root = scene.hinges[0];
  root.release = Release{.fails = 1};
  root.spring = {2, 2}, root.harness = {}, root.friction = {};
  if (kind == KindOfHold::without_latch) root.latch.reset();
  if (kind == KindOfHold::in_loop) {
    Synchronisation loop;
    loop.name = "loop", loop.first = 0, loop.second = 1, loop.stiffness = 10;
    scene.synchronisations = {loop};
  }
  using Held = System<double, Tree, BaseMotion::fixed>;
  Wing<double> wing = make_wing<double>(scene, outward_order(scene));
  set_parameters(wing, scene);
  Workspace<double> work;
  Held system(wing, std::nullopt, work);
  for (int i = 1; i <= 3; ++i)
    if (wing.hinge_of[i] != 0) system.engage(i);
  int held = 1;
  while (wing.hinge_of[held] != 0) ++held;
  if (kind == KindOfHold::elastic)
    system.restrain(held, true);
  else
    system.set_contact(held, Contact::held);
  RemainingEnergy<double> remaining;
  EnergyBounds<double> bounds;
  remaining.prepare(system), bounds.prepare(system);
  State<double> x = remaining.rest();
  x[system.layout().rate(held == 1 ? 2 : 1)] = 1e-2;
  if (bound) {
    bounds.bound(system, remaining, remaining.energy(system, x, 0.).value());
    *bound = bounds.moment[held] + 2; // what turns the root itself: its spring
  }
  std::vector<PeakOf<double>> holds(4);
  for (PeakOf<double>& peak : holds) peak.value = most;
  FinalPeaks<double, Held> proofs;
  proofs.reset();
  return proofs.prove(system, x, 0., 10., {nullptr, nullptr, nullptr, nullptr, &holds}, false);
}

} // namespace

TEST_CASE("a hold's peak is final once it exceeds the bound of what crosses the hinge and the "
          "hinge's own moment") {
  double bound = 0;
  (void)proves_with_hold(KindOfHold::rigid, 0, &bound);
  CHECK(bound > 2);
  CHECK(proves_with_hold(KindOfHold::rigid, bound * (1 + 1e-9)));
  CHECK_FALSE(proves_with_hold(KindOfHold::rigid, bound * (1 - 1e-9)));
}

TEST_CASE(
    "no peaks are proven where a hold is elastic, in a loop, or of a hinge that has no latch") {
  CHECK(proves_with_hold(KindOfHold::rigid, 1e9));
  CHECK_FALSE(proves_with_hold(KindOfHold::elastic, 1e9));
  CHECK_FALSE(proves_with_hold(KindOfHold::in_loop, 1e9));
  CHECK_FALSE(proves_with_hold(KindOfHold::without_latch, 1e9));
}

TEST_CASE("loads are final where each hinge's own bound lies below its own peak, of moments and of "
          "forces") {
  const std::vector<PeakOf<double>> moments{{}, {10, 1}, {20, 1}, {5, 1}},
      forces{{}, {100, 1}, {50, 1}, {200, 1}};
  const SeenPeaks<double> seen{&moments, &forces, nullptr, nullptr, nullptr};
  for (const int first : {0, 1}) // the index of hinge 1 is 1 − first
    for (int loud = 0; loud <= 3; ++loud)
      for (const bool by_moment : {false, true}) {
        std::vector<double> moment(4, 1e9), force(4, 1e9); // what is no hinge's counts for nothing
        for (int i = 1; i <= 3; ++i) {
          moment[i - first] = moments[i].value * (by_moment && i == loud ? 1.01 : 1);
          force[i - first] = forces[i].value * (!by_moment && i == loud ? 1.01 : 1);
        }
        const FinalLoads all = final_loads(seen, 3, moment, force, first);
        CAPTURE(first, loud, by_moment);
        CHECK(all.moments == !(by_moment && loud > 0));
        CHECK(all.forces == !(!by_moment && loud > 0));
        const FinalLoads none = final_loads(SeenPeaks<double>{}, 3, moment, force, first);
        CHECK((none.moments && none.forces));
      }
}
