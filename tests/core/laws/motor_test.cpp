// A motor's moment, damping, range and change over a step, its work, when its command is steady, and bounds of what it
// exerts at rest.
#include "core/laws/motor.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

constexpr double gain = 3, limit = 2;

MotorTerms<double> constant(double rate) { return {true, nullptr, rate, gain, limit}; }

/// From `first` at s = 0 in a straight line to `last` at s = 1.
Quintic<double> line(double first, double last) {
  Quintic<double> p;
  for (int k = 0; k < 6; ++k) p[k] = first + (last - first) * k / 5;
  return p;
}

double clamped(double moment) { return std::clamp(moment, -limit, limit); }

} // namespace

TEST_CASE("a motor's damping is the slope of its moment: its gain within the limit, 0 beyond") {
  const MotorTerms<double> terms = constant(1);
  const MotorPiece<double> piece = motor_piece(terms, 0.0, 0);
  for (const double excess : {-5.0, -0.7, -0.6, 0.0, 0.3, 0.66, 0.67, 4.0}) {
    CAPTURE(excess);
    CHECK(motor_moment(terms, piece, excess) == clamped(gain * excess));
    CHECK(motor_damping(terms, piece, excess) == (std::abs(gain * excess) < limit ? gain : 0));
    CHECK(motor_moment(terms, idle_motor<double>(), excess) == 0);
    CHECK(motor_damping(terms, idle_motor<double>(), excess) == 0);
  }
}

TEST_CASE("a motor's range and change over a step hold its moments and their slopes") {
  const MotorTerms<double> terms = constant(1);
  const MotorPiece<double> piece = motor_piece(terms, 0.0, 0);
  Draws draws(5);
  int within = 0, beyond = 0, crossing = 0;
  for (int k = 0; k < 300; ++k) {
    Quintic<double> excess;
    const double middle = draws.uniform(-1.5, 1.5), spread = draws.log_uniform(0.01, 1);
    for (double& c : excess) c = middle + draws.uniform(-spread, spread);
    const double h = draws.log_uniform(0.01, 1);
    const ValueRange<double> range = motor_range(terms, piece, excess);
    const ValueRange<double> change = motor_change(terms, piece, excess, h);
    double least = limit, most = -limit;
    constexpr int parts = 200;
    for (int j = 0; j < parts; ++j) {
      const double m0 = clamped(gain * value(excess, double(j) / parts));
      const double m1 = clamped(gain * value(excess, double(j + 1) / parts));
      const double slope = (m1 - m0) / (h / parts);
      least = std::min(least, m1), most = std::max(most, m1);
      REQUIRE(range.low <= m0 + 1e-12);
      REQUIRE(m0 <= range.high + 1e-12);
      REQUIRE(change.low <= slope + 1e-9 / h);
      REQUIRE(slope <= change.high + 1e-9 / h);
    }
    const double regime = motor_regime(terms, excess);
    if (regime == 0) CHECK((least > -limit && most < limit));
    if (regime == 1) CHECK(least == limit);
    if (regime == -1) CHECK(most == -limit);
    if (std::abs(regime) == 1) CHECK((change.low == 0 && change.high == 0));
    ++(regime == 0 ? within : regime == 2 ? crossing : beyond);
  }
  CHECK(std::min({within, beyond, crossing}) > 20);
}

TEST_CASE("a motor whose excess rises or falls through its limit has moments that rise or fall, or "
          "rest") {
  const MotorTerms<double> terms = constant(1);
  const MotorPiece<double> piece = motor_piece(terms, 0.0, 0);
  const double h = 0.1, steep = gain * (2 * limit / gain) / h; // slope of M within the limit
  const auto change = [&](double first, double last) {
    return motor_change(terms, piece, line(first, last), h);
  };
  const ValueRange<double> rises = change(0, 2 * limit / gain); // reaches the limit half-way
  CHECK(rises.low == Approx(0).margin(1e-12));
  CHECK(rises.high == Approx(steep).epsilon(1e-12));
  const ValueRange<double> falls = change(2 * limit / gain, 0);
  CHECK(falls.low == Approx(-steep).epsilon(1e-12));
  CHECK(falls.high == Approx(0).margin(1e-12));
  const ValueRange<double> within = change(0, 0.5 * limit / gain);
  CHECK(within.low == Approx(steep / 4).epsilon(1e-12));
  CHECK(within.high == Approx(steep / 4).epsilon(1e-12));
}

TEST_CASE("what a motor of constant command exerts beyond its part at rest is bounded") {
  Draws draws(11);
  int inside = 0, limited = 0, left = 0;
  for (int k = 0; k < 400; ++k) {
    MotorTerms<double> terms = constant(draws.sign() * draws.log_uniform(1e-2, 3));
    terms.gain = draws.log_uniform(0.1, 10), terms.limit = draws.log_uniform(0.1, 10);
    const MotorPiece<double> piece = motor_piece(terms, 0.0, 0);
    const MotorAtRest rest = motor_at_rest({terms}, {piece}, 0);
    const double at_rest = std::clamp(terms.gain * terms.rate, -terms.limit, terms.limit);
    const double most = draws.log_uniform(1e-2, 30);
    double largest = 0, braking = 0;
    for (int j = -1000; j <= 1000; ++j) {
      const double v = most * j / 1000;
      const double moment = std::clamp(terms.gain * (terms.rate - v), -terms.limit, terms.limit);
      largest = std::max(largest, std::abs(moment - at_rest + rest.taken * v));
      braking = std::max(braking, std::abs(moment - at_rest));
      REQUIRE((moment - at_rest) * v <= 1e-12);
    }
    CAPTURE(k, terms.rate, terms.gain, terms.limit, most, largest, braking);
    CHECK(rest.drive == Approx(at_rest).epsilon(1e-14));
    CHECK(largest <= rest.beyond(most) * (1 + 1e-12) + 1e-12);
    CHECK(rest.beyond(most) <= largest * (1 + 1e-9) + terms.gain * most * 2e-3); // by the samples
    CHECK(braking <= most_braking(terms, piece, most) * (1 + 1e-12));
    const bool saturates = std::abs(terms.gain * terms.rate) > terms.limit;
    ++(saturates ? limited : inside);
    left += most > rest.until;
    if (!saturates && terms.gain * most <= terms.limit) // the larger part of the way is within it
      CHECK(most_braking(terms, piece, most) == Approx(braking).epsilon(1e-12));
    if (terms.gain * most >
        4 * terms.limit + terms.gain * std::abs(terms.rate)) // beyond both limits
      CHECK(most_braking(terms, piece, most) == Approx(braking).epsilon(1e-12));
  }
  CHECK(std::min({inside, limited, left}) >= 50);
  const MotorAtRest none = motor_at_rest({}, {}, 0);
  CHECK((none.drive == 0 && none.taken == 0 && none.beyond(1e3) == 0));
}

TEST_CASE("a motor's work over a step in which it leaves its limit and reaches the other") {
  // M = T until s = 1/3, then T (2 − 3 s), −T at s = 1: ∫ M ds = T/3
  const MotorTerms<double> terms = constant(1);
  const MotorPiece<double> piece = motor_piece(terms, 0.0, 0);
  const Quintic<double> excess = line(2 * limit / gain, -limit / gain), rate = line(0.4, 0.4);
  const double h = 0.05, exact = h * 0.4 * limit / 3;
  CHECK(motor_work_by_parts(terms, piece, excess, rate, h) == Approx(exact).epsilon(1e-9));
  // within the limit M φ̇ is a polynomial of degree 2: c e v, both straight lines
  const Quintic<double> small = line(0.1, 0.5), rising = line(-1, 2);
  const double power = gain * (0.1 * -1 + (0.1 * 3 + 0.4 * -1) / 2 + 0.4 * 3 / 3);
  CHECK(motor_work_by_parts(terms, piece, small, rising, h) == Approx(h * power).epsilon(1e-13));
  CHECK(motor_work(terms, piece, small, rising, h, 0.0, 1.0) == Approx(h * power).epsilon(1e-13));
}

TEST_CASE("a command is steady after the last knot of its table, and from the start without one") {
  CHECK(is_steady(motor_piece(constant(0.3), 1.0, 0)));
  const Curve table({0, 1, 3}, {0.1, 0.4, 0.4}, Interpolation::linear);
  MotorTerms<double> terms = constant(2);
  terms.table = &table;
  MotorPiece<double> piece = started_motor(terms, 5.0);
  CHECK_FALSE(is_steady(piece)); // rises until 6, is constant until 8: a knot is still to come
  CHECK(commanded_rate(piece, 5.5) == Approx(2 * 0.25).epsilon(1e-14));
  REQUIRE(enter_piece(terms, 6.0, piece));
  CHECK_FALSE(is_steady(piece));
  CHECK(commanded_rate(piece, 7.0) == Approx(0.8).epsilon(1e-14));
  REQUIRE(enter_piece(terms, 8.0, piece));
  CHECK(is_steady(piece));
  CHECK(commanded_rate(piece, 100.0) == Approx(0.8).epsilon(1e-14));
  CHECK_FALSE(enter_piece(terms, 100.0, piece));
  const MotorPiece<double> last = last_motor_piece(terms);
  CHECK(is_steady(last));
  CHECK(commanded_rate(last, 50.0) == Approx(0.8).epsilon(1e-14));
}

// A command by a table is any cubic of time: its moment's excess, and its rate, against values and differences of the cubic.
TEST_CASE("a motor follows a command that changes as a cubic of time") {
  Draws draws(17);
  int within = 0, beyond = 0;
  for (int k = 0; k < 300; ++k) {
    MotorTerms<double> terms = constant(1);
    terms.gain = draws.log_uniform(0.1, 10), terms.limit = draws.log_uniform(1, 10);
    MotorPiece<double> piece = motor_piece(terms, 0.0, 0);
    piece.from = draws.uniform(-2, 2);
    for (double& c : piece.rate) c = draws.uniform(-2, 2);
    const double t = piece.from + draws.uniform(0, 1), h = draws.log_uniform(1e-2, 1);
    Quintic<double> rate;
    for (double& c : rate) c = draws.uniform(-1, 1);
    const auto command = [&](double at) {
      const double u = at - piece.from;
      return piece.rate[0] + u * (piece.rate[1] + u * (piece.rate[2] + u * piece.rate[3]));
    };
    const auto moment = [&](double s) {
      return std::clamp(terms.gain * (command(t + s * h) - value(rate, s)), -terms.limit,
                        terms.limit);
    };
    const Quintic<double> excess = motor_excess(piece, t, h, rate);
    for (const double s : {0.0, 0.2, 0.5, 0.9, 1.0}) {
      const double at = t + s * h, ds = 1e-5;
      CAPTURE(k, s);
      CHECK(value(excess, s) == Approx(command(at) - value(rate, s)).margin(1e-12));
      if (std::abs(std::abs(moment(s)) - terms.limit) < 1e-3 && std::abs(moment(s)) < terms.limit)
        continue; // the difference may reach beyond the limit
      const double slope = (moment(s + ds) - moment(s - ds)) / (2 * ds * h);
      const double found =
          motor_moment_rate(terms, piece, at, value(rate, s), value(derivative(rate, h), s));
      CHECK(found == Approx(slope).epsilon(1e-6).margin(1e-6));
      ++(slope == 0 ? beyond : within);
    }
  }
  CHECK(std::min(within, beyond) > 100);
}
