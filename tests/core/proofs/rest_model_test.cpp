#include "tests/core/proofs/latched_wing.hpp"
#include "tests/support/real_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace wingspread;
using oracle::Draws;
using oracle::Latched;
using oracle::with_latches;

TEST_CASE(
    "a model of power dampers fits rates near those for which it was made, whatever their size") {
  for (const double tuned : {1e-4, 0.02, 1.0, 30.0}) {
    RestModel model;
    model.parents = {0, 1};
    model.remainders.resize(2);
    model.remainders[1].damper = DamperTerms<double>{};
    model.remainders[1].damper->rate = 1e-9; // below it the law is linear
    model.remainders[1].tuned_for = tuned;
    CHECK(model.depends_on_rates());
    HingeVector rates(2);
    rates << 17, 0; // a hinge without such a damper has any rate
    for (const double factor : {0.05, 0.25, 0.4, 1.0, 1.4, 1.6, 2.0, 100.0}) {
      CAPTURE(tuned, factor);
      rates(1) = factor * tuned;
      CHECK(model.is_tuned_for(rates) == (factor > 0.3 && factor < 1.5));
    }
    model.remainders[1].damper->rate = tuned; // slower rates are in the linear part
    rates(1) = 0;
    CHECK(model.is_tuned_for(rates));
    model.remainders[1].tuned_for = 0;
    CHECK((model.is_tuned_for(rates) && !model.depends_on_rates()));
  }
}

TEST_CASE("two bodies load each other by no more than their turns let them, and by little less") {
  for (int trial = 0; trial < 400; ++trial) {
    Draws draws(7700 + trial);
    const double c = draws.chance(0.2) ? 0 : draws.uniform(0, 2),
                 s = draws.chance(0.4) ? 0 : draws.uniform(0, 2);
    RestModel model;
    model.parents = {0, 0};
    model.pushed = Eigen::VectorXd::Zero(3);
    model.pairs = {{1, 2, 0, c, s}};
    HingeVector u(2);
    u << draws.log_uniform(1e-4, 0.2), draws.log_uniform(1e-4, 0.2);
    BodyVector accelerations(3), rates(3);
    for (int k = 0; k < 3; ++k)
      accelerations(k) = draws.uniform(0, 2), rates(k) = draws.uniform(0, 2);
    const double way = u.sum();
    double inertia = 0, turning = 0; // of c cos ω + s sin ω: what ω changes, and the slope
    for (int k = -500; k <= 500; ++k) {
      const double turn = way * k / 500;
      inertia = std::max(inertia, std::abs(c * (1 - std::cos(turn)) + s * std::sin(turn)));
      turning = std::max(turning, std::abs(c * std::sin(turn) + s * std::cos(turn)));
    }
    const RestModel::Turned off = model.bound_turns(u, accelerations, rates);
    CAPTURE(trial, way, c, s);
    const auto check = [&](double bound, double exact) {
      CHECK(bound >= exact * (1 - 1e-12));
      CHECK(bound <= exact * (1 + way * way));
    };
    check(off.moments(1), inertia * accelerations(2) + turning * rates(2) * rates(2));
    check(off.moments(2), inertia * accelerations(1) + turning * rates(1) * rates(1));
    check(off.momentum, inertia * (rates(1) + rates(2)));
  }
}

TEST_CASE(
    "an energy bounds the turn of one body against another, and one state attains the bound") {
  for (int trial = 0; trial < 300; ++trial) {
    Draws draws(8800 + trial);
    const int n = 2 + draws.below(6);
    std::vector<int> parents(n + 1, 0);
    Eigen::VectorXd kappa(n + 1), apart(n + 1);
    RestModel::EnergyOfTurns turns{draws.log_uniform(0.1, 10), BodyVector::Zero(n + 1),
                                   BodyVector::Zero(n + 1)};
    for (int i = 1; i <= n; ++i) {
      parents[i] = draws.below(i);
      kappa(i) = draws.log_uniform(0.1, 10),
      apart(i) = draws.chance(0.3) ? 0 : draws.uniform(-1, 1);
      turns.softness(i) = turns.softness(parents[i]) + 1 / kappa(i);
      turns.apart(i) = turns.apart(parents[i]) + std::abs(apart(i));
    }
    const int k = 1 + draws.below(n), l = draws.below(k);
    Eigen::VectorXd sense =
        Eigen::VectorXd::Zero(n + 1); // of each hinge in the turn of k against l
    for (int i = k; i != 0; i = parents[i]) sense(i) += 1;
    for (int i = l; i != 0; i = parents[i]) sense(i) -= 1;
    int meet = k;
    for (int other = l; meet != other;)
      (meet > other ? meet : other) = parents[std::max(meet, other)];
    const double bound = turns.turn(k, l, meet);
    // at the extreme the energy is shared by softness, and the rests are apart in the sense of the turn
    const double soft = (sense.array().square() / kappa.array()).tail(n).sum();
    double most = 0;
    for (int i = 1; i <= n; ++i)
      most += sense(i) *
              (turns.size * sense(i) / kappa(i) / std::sqrt(soft) + sense(i) * std::abs(apart(i)));
    CAPTURE(trial, n, k, l, meet);
    CHECK(bound == Approx(most).epsilon(1e-9));
    for (int state = 0; state < 20; ++state) {
      Eigen::VectorXd way = Eigen::VectorXd::Zero(n + 1);
      for (int i = 1; i <= n; ++i) way(i) = draws.uniform(-1, 1);
      way *= turns.size / std::sqrt((kappa.array() * way.array().square()).tail(n).sum());
      CHECK(std::abs(sense.tail(n).dot((way + apart).tail(n))) <= bound * (1 + 1e-12));
    }
  }
}

namespace {

/// The largest part that moments and rotation from random states take of what (3), (4) and the remainders leave them.
/// Only some hinges are off rest and in motion, so that few terms of a bound stand alone.
template <BaseMotion M> double most_left_out(Latched<M>& wing, Draws& draws, int states) {
  const Layout& at = wing.at;
  const int n = at.bodies;
  const RestModel& m = wing.model;
  double most = 0;
  for (int k = 0; k < states; ++k) {
    const double size = draws.log_uniform(1e-3, 1);
    State<double> x = wing.rest(), dxdt(at.size());
    for (int i = 1; i <= n; ++i) {
      if (draws.chance(0.4)) x[at.angle(i)] += size * draws.uniform(-1, 1);
      if (draws.chance(0.4)) x[at.rate(i)] = draws.uniform(-1, 1);
    }
    if (M == BaseMotion::free && draws.chance(0.3)) x[at.freedoms() + 2] = draws.uniform(-1, 1);
    wing.system(x, dxdt, 0);
    Eigen::VectorXd u(n), v(n), a(n);
    BodyVector rates = BodyVector::Zero(n + 1), accelerations = rates;
    if (M == BaseMotion::free)
      rates(0) = x[at.freedoms() + 2], accelerations(0) = dxdt[at.freedoms() + 2];
    if (M == BaseMotion::prescribed) rates(0) = m.turn_rate;
    for (int i = 1; i <= n; ++i) {
      u(i - 1) = x[at.angle(i)] - m.angles(i - 1), v(i - 1) = x[at.rate(i)],
            a(i - 1) = dxdt[at.rate(i)];
      rates(i) = rates(m.parents[i - 1]) + v(i - 1);
      accelerations(i) = accelerations(m.parents[i - 1]) + a(i - 1);
    }
    const Eigen::VectorXd left = m.mass * a + m.stiffness * u + m.damping * v;
    const auto off = m.bound_turns(u.cwiseAbs(), accelerations.cwiseAbs(), rates.cwiseAbs());
    const Eigen::VectorXd bound = m.turns.cwiseAbs().transpose() * off.moments +
                                  m.bound_remainders(u.cwiseAbs(), v.cwiseAbs());
    const Eigen::VectorXd terms = m.mass.cwiseAbs() * a.cwiseAbs() +
                                  m.stiffness.cwiseAbs() * u.cwiseAbs() +
                                  m.damping.cwiseAbs() * v.cwiseAbs();
    const double rounding = 1e-12 * (m.stiffness.maxCoeff() + terms.maxCoeff());
    for (int i = 0; i < n; ++i) most = std::max(most, std::abs(left(i)) / (bound(i) + rounding));
    if (M != BaseMotion::free) continue;
    const double spin = std::abs(total_motion(wing.system, x, 0.).spin());
    const double rigid = std::abs(rates(0) - m.turns.row(0) * v);
    most = std::max(most, (rigid - 1e-12) / (m.rigid * (spin + off.momentum)));
  }
  return most;
}

/// The same over random trees; with loops whose tables fall if `loops`.
template <BaseMotion M> double most_left_out(std::uint64_t seed, bool loops, double turning = 0) {
  double most = 0;
  for (int k = 0; k < 60; ++k) {
    Draws draws(seed + k);
    oracle::RandomScene options;
    options.bodies = 2 + k % 4, options.motion = M, options.friction = false;
    options.mass_lower = 1, options.mass_upper = 30;
    Scene scene = with_latches(oracle::random_scene(seed + k, options), draws);
    scene.base.acceleration = {0, 0}, scene.base.angular_acceleration = 0;
    scene.base.rate = turning * draws.uniform(-1, 1);
    for (Hinge& hinge : scene.hinges)
      hinge.spring = {}, hinge.harness = {}; // at rest without a moment
    if (loops) {
      Synchronisation loop;
      loop.name = "loop", loop.first = 0, loop.second = 1;
      loop.stiffness = draws.log_uniform(1e2, 1e4), loop.damping = draws.log_uniform(1, 1e2);
      const double end = std::abs(scene.hinges[0].latched - scene.hinges[0].stowed), top = end / 2,
                   to = std::abs(scene.hinges[1].latched - scene.hinges[1].stowed);
      if (k % 2 == 0)
        oracle::tabulate(loop, {0, top, 2 * end},
                         {0, to + draws.uniform(1, 4) * end, to - draws.uniform(0, 9) * end});
      else // falls everywhere, and is at rest where both hinges latch
        oracle::tabulate(
            loop, {0, end, 2 * end},
            {to + draws.log_uniform(0.1, 8) * end, to, to - draws.log_uniform(0.1, 8) * end});
      if (draws.chance(0.5)) loop.preload = draws.log_uniform(1, 1e3);
      scene.synchronisations.push_back(loop);
    }
    Latched<M> wing(scene);
    CAPTURE(k);
    REQUIRE(wing.model.size() == options.bodies);
    const double own = most_left_out(wing, draws, 40);
    CHECK(own <= 1 + 1e-6);
    most = std::max(most, own);
  }
  return most;
}

} // namespace

TEST_CASE(
    "what the linear model leaves out stays inside its bounds, on trees and with falling loops") {
  CHECK(most_left_out<BaseMotion::fixed>(5000, false) > 0.99);
  CHECK(most_left_out<BaseMotion::free>(5100, false) > 0.9);
  CHECK(most_left_out<BaseMotion::prescribed>(5200, false, 1) > 0.9);
  CHECK(most_left_out<BaseMotion::fixed>(5300, true) > 0.5);
  CHECK(most_left_out<BaseMotion::free>(5400, true) > 0.5);
}

TEST_CASE("a damper with a window damps a rest inside, on whichever side the hinge is now") {
  Scene scene = oracle::latching_panel(); // from 90 deg to 0; its spring holds it at −2/1e4 rad
  Hinge& hinge = scene.hinges[0];
  hinge.damper.emplace().coefficient = 7; // viscous
  const double rest = -2e-4;
  struct Window {
    double low, high;
    bool acts;
  };
  for (const auto& [low, high, acts] : {Window{0, 1, false},
                                        {-1, 0, true},
                                        {rest - 1e-5, 1, true},
                                        {rest + 1e-5, 1, false},
                                        {-1, rest - 1e-5, false},
                                        {-1, rest + 1e-5, true},
                                        {rest, 1, false},
                                        {-1, rest, false}}) {
    hinge.damper->window = {high, low};
    Latched<BaseMotion::fixed> wing(scene);
    for (const bool above_low : {false, true})
      for (const bool above_high : {false, true}) {
        wing.system.note_crossing(1, Edge::window_low, above_low);
        wing.system.note_crossing(1, Edge::window_high, above_high);
        CAPTURE(low, high, above_low, above_high);
        REQUIRE(wing.tune(&wing.still[wing.at.rate(1)]));
        CHECK(wing.model.angles(0) == Approx(rest));
        CHECK(wing.model.damping(0, 0) ==
              hinge.latch->damping + hinge.friction.viscous + (acts ? 7 : 0));
        CHECK(wing.model.room(0) <= std::min(std::abs(rest - low), std::abs(rest - high)) + 1e-12);
      }
  }
}

// Each part of a remainder by itself: what the law exerts at the corners of the box, less what the linear model has of it.
TEST_CASE("what dampers, dissipating latches and motors leave out of the model is their law less "
          "its part") {
  RestModel model;
  model.parents = {0};
  model.remainders.resize(1);
  RestModel::Remainder& left = model.remainders[0];
  const HingeVector u = HingeVector::Constant(1, 0.3), v = HingeVector::Constant(1, 2.0);
  const auto bound = [&] { return model.bound_remainders(u, v)(0); };
  CHECK(bound() == 0);
  left.steady = 5;
  CHECK(bound() == 5);
  left = {}, left.bend = 7;
  CHECK(bound() == Approx(7 * 0.3));
  left = {}, left.dissipation = 11;
  CHECK(bound() == Approx(11 * 0.3 * 2));
  left = {}, left.damper = DamperTerms<double>{};
  left.damper->law = DamperLaw::eddy_current, left.damper->strength = 4, left.damper->rate = 1;
  left.taken = 4; // of S r/(1 + r²)
  CHECK(bound() == Approx(4 * 2 - 4 * 2 / 5.0));
  left = {}, left.motor.gain = 3, left.motor.until = 0.5, left.motor.most = 100;
  CHECK(bound() == Approx(3 * 1.5));
}

TEST_CASE("what a loop leaves out of the model is its torque less its linear part, with a strand "
          "slack or not") {
  for (int trial = 0; trial < 300; ++trial) {
    Draws draws(6600 + trial);
    const double G = draws.uniform(0.5, 2),
                 dG = draws.chance(0.3) ? 0 : G * draws.log_uniform(1e-3, 0.1);
    const double K = draws.log_uniform(1, 100),
                 D = draws.chance(0.3) ? 0 : draws.log_uniform(0.1, 10);
    const double torque = draws.log_uniform(0.1, 10);
    HingeVector u(2), v(2);
    u << draws.log_uniform(0.01, 1), draws.log_uniform(0.01, 1);
    v << draws.log_uniform(0.01, 1), draws.log_uniform(0.01, 1);
    const double elastic = K * (G * u(0) + u(1)), viscous = D * (G * v(0) + v(1));
    const double until = draws.chance(0.4) ? 1e9 : elastic * draws.uniform(-0.5, 1.5);
    RestModel model;
    model.parents = {0, 1};
    model.remainders.resize(2);
    model.loops = {{0, 1, torque, G, dG, K, D, until}};
    const HingeVector bound = model.bound_remainders(u, v);
    double most[2] = {0, 0};
    for (const double now : {G - dG, G})
      for (const double rest : {G - dG, G}) {
        const double of_model = K * (rest * u(0) + u(1)) + D * (rest * v(0) + v(1));
        const double stretched = K * (now * u(0) + u(1)), damped = D * (now * v(0) + v(1));
        const bool slack = stretched > until; // half of what goes beyond, and half of the damping
        const double change =
            slack ? stretched - 0.5 * (stretched - std::max(until, 0.0)) + 0.5 * damped
                  : stretched + damped;
        most[1] = std::max(most[1], std::abs(change - of_model));
        most[0] = std::max(most[0], std::abs(now * (torque + change) - rest * (torque + of_model)));
      }
    CAPTURE(trial, G, dG, until, elastic, viscous, most[0], most[1]);
    const double rounding = 1e-13 * G * (torque + elastic + viscous); // of the differences
    for (const int i : {0, 1}) CHECK(bound(i) >= most[i] - rounding);
    const bool taut = until > elastic;
    if (taut || dG == 0)
      for (const int i : {0, 1}) CHECK(bound(i) <= 1.15 * most[i] + 1e-12);
  }
}

TEST_CASE(
    "the model of a wing on a base that turns faster or slower knows its largest rate to the end") {
  for (int k = 0; k < 100; ++k) {
    Draws draws(8800 + k);
    Scene scene = oracle::latching_panel();
    scene.base.motion = BaseMotion::prescribed;
    scene.base.rate = draws.uniform(-2, 2), scene.base.angular_acceleration = draws.uniform(-2, 2);
    const double end = draws.log_uniform(0.01, 10);
    const Latched<BaseMotion::prescribed> wing(scene, end);
    double fastest = 0;
    for (int n = 0; n <= 200; ++n)
      fastest = std::max(
          fastest, std::abs(scene.base.rate + scene.base.angular_acceleration * end * n / 200));
    CAPTURE(k, scene.base.rate, scene.base.angular_acceleration, end);
    CHECK(wing.model.spin == Approx(fastest));
  }
}
