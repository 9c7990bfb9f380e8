#include "core/laws/loop.hpp"
#include "tests/core/laws/loop_over_step.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

constexpr int samples = 400; // of a step

/// The largest |τ|', |τ|'' and gear'' by differences, over their bounds: at most 1.
struct Reached {
  double moment = 0, first = 0, second = 0, gear = 0;
  void take(const Reached& other) {
    moment = std::max(moment, other.moment), first = std::max(first, other.first);
    second = std::max(second, other.second), gear = std::max(gear, other.gear);
  }
};

Reached reached_by(const LoopOverStep& step) {
  const LoopTorqueBounds<double> bounds = loop_torque_bounds(step.loop, step.a, step.b, step.h);
  REQUIRE(bounds.smooth);
  const ValueRange<double> range = loop_moment_range(
      step.loop, 2, step.a, derivative(step.a, step.h), step.b, derivative(step.b, step.h));
  Reached most;
  for (int k = 1; k < 40; ++k) {
    const double s = k / 40.0, ds = 1e-3, dt = ds * step.h;
    const auto second = [&](const auto& of) {
      return std::abs(of(s + ds) - 2 * of(s) + of(s - ds)) / (dt * dt);
    };
    const auto torque = [&](double at) { return step.torque(at); };
    const auto gear = [&](double at) { return step.state(at).gear; };
    const double of_moment = step.moment(2, s) / (step.moment(2, s) < 0 ? range.low : range.high);
    most.take({of_moment, std::abs(torque(s + ds) - torque(s - ds)) / (2 * dt * bounds.first),
               second(torque) / bounds.second, second(gear) / bounds.gear_second});
  }
  return most;
}

} // namespace

TEST_CASE("a loop's moments stay in their range over a step: damped, slack, by a table") {
  int slack = 0, tabled = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    const LoopOverStep step(seed);
    tabled += step.loop.table != nullptr;
    bool slackens = false;
    for (const int i : {1, 2}) {
      const ValueRange<double> range = loop_moment_range(
          step.loop, i, step.a, derivative(step.a, step.h), step.b, derivative(step.b, step.h));
      const double close = 1e-11 * (largest_magnitude_of(range) + step.loop.stiffness);
      CAPTURE(seed, i, range.low, range.high);
      for (int k = 0; k <= samples; ++k) {
        const double s = k / double(samples), m = step.moment(i, s);
        slackens = slackens || taut_share(step.loop, step.state(s).elastic) < 1;
        REQUIRE(range.low - close <= m);
        REQUIRE(m <= range.high + close);
      }
    }
    slack += slackens;
  }
  CHECK(slack >= 50);
  CHECK(tabled >= 100);
}

TEST_CASE("the change of a loop's moment over a step holds its difference quotients") {
  int known = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    const LoopOverStep step(seed);
    for (const int i : {1, 2}) {
      const KnownRange<double> change = loop_moment_change(step.loop, i, step.a, step.b, step.h);
      if (!change.known) continue;
      ++known;
      const double fine = step.h / samples, close = 1e-8 * largest_magnitude_of(change.range);
      for (int k = 0; k < samples; ++k) {
        const double quotient =
            (step.moment(i, (k + 1.0) / samples) - step.moment(i, k / double(samples))) / fine;
        CAPTURE(seed, i, k);
        REQUIRE(change.range.low - close <= quotient);
        REQUIRE(quotient <= change.range.high + close);
      }
    }
  }
  CHECK(known >= 100);
}

TEST_CASE("bounds of a loop's torque, of its gear and of their derivatives hold samples of them") {
  int smooth = 0, kinked = 0, tabled = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    const LoopOverStep step(seed);
    const LoopTorqueBounds<double> bounds = loop_torque_bounds(step.loop, step.a, step.b, step.h);
    const double fine = step.h / samples, close = 1 + 1e-6;
    ++(bounds.smooth ? smooth : kinked);
    tabled += bounds.smooth && step.loop.table;
    CAPTURE(seed, bounds.smooth, step.loop.damping);
    std::array<double, samples + 1> tau, gear;
    for (int k = 0; k <= samples; ++k)
      tau[k] = step.torque(k / double(samples)), gear[k] = step.state(k / double(samples)).gear;
    const double rounding = 1e-13 * (bounds.torque + step.loop.stiffness);
    const double gear_rounding = 1e-13 * (1 + bounds.gear);
    for (int k = 0; k <= samples; ++k) {
      REQUIRE(std::abs(tau[k]) <= bounds.torque * close + rounding);
      REQUIRE(std::abs(gear[k]) <= bounds.gear * close + gear_rounding);
      if (k == samples) break;
      // where a strand goes slack the torque drops by up to `drop`
      REQUIRE(std::abs(tau[k + 1] - tau[k]) <=
              bounds.first * fine * close + bounds.drop + rounding);
      if (!bounds.smooth) continue;
      REQUIRE(std::abs(gear[k + 1] - gear[k]) <= bounds.gear_first * fine * close + gear_rounding);
      if (k == 0) continue;
      REQUIRE(std::abs(tau[k + 1] - 2 * tau[k] + tau[k - 1]) <=
              bounds.second * fine * fine * close + 4 * rounding);
      REQUIRE(std::abs(gear[k + 1] - 2 * gear[k] + gear[k - 1]) <=
              bounds.gear_second * fine * fine * close + 4 * gear_rounding);
    }
  }
  CAPTURE(smooth, kinked, tabled);
  CHECK(smooth >= 100);
  CHECK(kinked >= 50);
  CHECK(tabled >= 20);
}

TEST_CASE("bounds of a loop whose gear changes hold its torque and its derivatives, and are nearly "
          "reached") {
  Reached most;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    CAPTURE(seed);
    const Reached own = reached_by(bent_loop(seed));
    CAPTURE(own.moment, own.first, own.second, own.gear);
    CHECK(own.moment <= 1 + 1e-6);
    CHECK(own.first <= 1 + 1e-4);
    CHECK(own.second <= 1 + 1e-3);
    CHECK(own.gear <= 1 + 1e-3);
    most.take(own);
  }
  CAPTURE(most.moment, most.first, most.second, most.gear);
  CHECK(std::min({most.moment, most.first, most.second, most.gear}) > 0.9);
}

TEST_CASE("a loop's torque at rest is the slope of its energy, and its rate follows the motion") {
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    const LoopOverStep step(seed);
    const LoopTerms<double>& loop = step.loop;
    const double e = step.state(0.3).elastic, d = 1e-6 * (1 + std::abs(e));
    CAPTURE(seed, e);
    // P as a function of K e: dP/d(K e) = τ/K
    if (std::abs(std::abs(e) - loop.slack_beyond) > d)
      CHECK((loop_energy(loop, e + d) - loop_energy(loop, e - d)) / (2 * d) ==
            Approx(carried_by_strands(loop, e) / loop.stiffness).epsilon(1e-6).margin(1e-9));
    if (loop.table) continue; // its gear's change is neglected
    const double s = 0.6, fine = 1e-6;
    const auto states = [&](const Quintic<double>& p) { return value(p, s); };
    const Quintic<double> va = derivative(step.a, step.h), vb = derivative(step.b, step.h);
    const double rate =
        loop_torque_rate(loop, step.state(s), {states(va), states(vb)},
                         {states(derivative(va, step.h)), states(derivative(vb, step.h))});
    const double before = taut_share(loop, step.state(s - fine).elastic);
    if (before != taut_share(loop, step.state(s + fine).elastic)) continue;
    const double quotient = (step.torque(s + fine) - step.torque(s - fine)) / (2 * fine * step.h);
    CHECK(rate == Approx(quotient).epsilon(1e-5).margin(1e-5 * loop.stiffness));
  }
}

// Without stiffness the loop's rate alone makes its moment, and nothing bounds how the rate changes.
TEST_CASE("the moment of a loop that only damps is not said to keep its direction where it turns") {
  int turns = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    LoopOverStep step(seed);
    step.given.table = nullptr, step.loop.table = nullptr;
    step.loop.stiffness = 0, step.loop.damping = 1 + static_cast<double>(seed % 3);
    step.loop.slack_beyond = seed % 2 ? 1e300 : 1;
    for (const int i : {1, 2}) {
      const KnownRange<double> change = loop_moment_change(step.loop, i, step.a, step.b, step.h);
      double least = 0, most = 0; // of the moment's differences
      for (int k = 0; k < samples; ++k) {
        const double rise =
            step.moment(i, (k + 1.0) / samples) - step.moment(i, k / double(samples));
        least = std::min(least, rise), most = std::max(most, rise);
      }
      turns += least < 0 && most > 0;
      CAPTURE(seed, i, least, most);
      if (!change.known) continue;
      CHECK(change.range.low * step.h / samples <= least * (1 - 1e-6));
      CHECK(most * (1 - 1e-6) <= change.range.high * step.h / samples);
    }
  }
  CHECK(turns >= 100);
}
