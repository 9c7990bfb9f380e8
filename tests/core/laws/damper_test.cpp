// What proofs ask of a damper beyond its moment: each bound holds the samples, and one of them reaches it.
#include "core/laws/damper.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

constexpr std::array damper_laws{DamperLaw::viscous, DamperLaw::power, DamperLaw::eddy_current};

Damper random_damper(DamperLaw law, Draws& draws) {
  Damper damper;
  damper.law = law;
  damper.coefficient = draws.log_uniform(0.1, 10);
  damper.exponent = draws.log_uniform(0.3, 3);
  damper.regularization_rate = draws.log_uniform(1e-3, 0.3);
  damper.peak_torque = draws.log_uniform(0.1, 10), damper.peak_rate = draws.log_uniform(0.1, 10);
  damper.scale = draws.log_uniform(0.5, 2);
  return damper;
}

/// visit(terms, draws) for many random dampers of every law.
template <class Visit> void for_random_dampers(Visit&& visit) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed)
    for (const DamperLaw law : damper_laws) {
      CAPTURE(seed, static_cast<int>(law));
      Draws draws(seed);
      visit(damper_terms<double>(random_damper(law, draws)), draws);
    }
}

/// Rates from 0 to `most`, dense near 0 and about w.
std::vector<double> rates_up_to(double most, const DamperTerms<double>& damper) {
  std::vector<double> rates{0, most};
  for (int k = 1; k < 2000; ++k) rates.push_back(most * k / 2000.0);
  for (int k = -40; k <= 0; ++k) rates.push_back(most * std::exp(0.2 * k));
  for (const double near : {1 - 1e-12, 1.0, 1 + 1e-12}) rates.push_back(near * damper.rate);
  std::erase_if(rates, [&](double rate) { return rate > most; });
  return rates;
}

/// Checks that a bound holds all samples, and that it is no larger than needed.
void check_bound(double bound, double largest) {
  CAPTURE(bound, largest);
  CHECK(largest <= bound * (1 + 1e-12) + 1e-14);
  CHECK(bound <= largest * (1 + 1e-3) + 1e-14);
}

} // namespace

TEST_CASE("a damper opposes the rate by its law, times its scale") {
  for (std::uint64_t seed = 1; seed <= 100; ++seed)
    for (const DamperLaw law : damper_laws) {
      Draws draws(600 + seed);
      const Damper damper = random_damper(law, draws);
      const DamperTerms<double> terms = damper_terms<double>(damper);
      const double v = draws.log_uniform(1e-3, 30), w = damper.regularization_rate;
      double torque = damper.coefficient * v;
      if (law == DamperLaw::power)
        torque =
            damper.coefficient * std::pow(std::max(v, w), damper.exponent) * std::min(1., v / w);
      if (law == DamperLaw::eddy_current)
        torque = 2 * damper.peak_torque / (v / damper.peak_rate + damper.peak_rate / v);
      CAPTURE(seed, static_cast<int>(law), v);
      CHECK(damper_moment(terms, v) == Approx(-damper.scale * torque).epsilon(1e-12));
      CHECK(damper_moment(terms, -v) == Approx(damper.scale * torque).epsilon(1e-12));
    }
}

TEST_CASE("the largest moment of a damper over rates of both signs") {
  for_random_dampers([](const DamperTerms<double>& damper, Draws& draws) {
    const double most = draws.log_uniform(1e-3, 30);
    double largest = 0;
    for (const double rate : rates_up_to(most, damper))
      for (const double v : {rate, -rate})
        largest = std::max(largest, std::abs(damper_moment(damper, v)));
    check_bound(most_of_damper(damper, most), largest);
  });
}

TEST_CASE("the range of a damper's moments over rates holds them, and no more") {
  int braking = 0, driven_back = 0;
  for_random_dampers([&](const DamperTerms<double>& damper, Draws& draws) {
    const double unit = damper.law == DamperLaw::viscous ? 1 : damper.rate;
    const double low = draws.sign() * unit * draws.log_uniform(0.1, 10);
    const double high = low + unit * draws.log_uniform(0.1, 20);
    double least = damper_moment(damper, low), most = least;
    const auto take = [&](double v) {
      if (v < low || v > high) return;
      least = std::min(least, damper_moment(damper, v));
      most = std::max(most, damper_moment(damper, v));
    };
    for (int k = 1; k <= 2000; ++k) take(low + (high - low) * k / 2000.0);
    take(high), take(damper.rate), take(-damper.rate);
    const ValueRange<double> range = damper_range(damper, {low, high});
    const double size = std::max(-least, most), close = 1e-12 * size;
    CHECK(range.low == Approx(least).margin(close));
    CHECK(range.high == Approx(most).margin(close));
    if (damper.law != DamperLaw::eddy_current) return;
    braking += low < damper.rate && damper.rate < high;
    driven_back += low < -damper.rate && -damper.rate < high;
  });
  CHECK(std::min(braking, driven_back) >= 10);
}

TEST_CASE("what a damper exerts beyond the linear part that its secant takes") {
  int steeper = 0, flatter = 0;
  for_random_dampers([&](const DamperTerms<double>& damper, Draws& draws) {
    const double unit = draws.chance(0.5) ? damper.rate : 1; // w, about which the laws of p change
    const double tuned = unit * draws.log_uniform(0.1, 30),
                 most = unit * draws.log_uniform(0.1, 30);
    const double taken = secant(damper, tuned);
    if (damper.law == DamperLaw::power) {
      const double at = std::max(tuned, damper.rate); // there nothing is left
      CHECK(std::abs(damper_moment(damper, at) + taken * at) <= 1e-12 * taken * at);
      ++(most > at ? steeper : flatter);
    } else {
      const double slow = 1e-6 * damper.rate; // at rest the moment is linear
      CHECK(taken == Approx(-damper_moment(damper, slow) / slow).epsilon(1e-9));
    }
    double largest = 0;
    for (const double rate : rates_up_to(most, damper))
      largest = std::max(largest, std::abs(damper_moment(damper, rate) + taken * rate));
    check_bound(beyond_linear(damper, taken, most), largest);
  });
  CHECK(std::min(steeper, flatter) >= 20);
}

TEST_CASE("the range of a damper's damping is that of its slopes, with the jump at w") {
  int jumps = 0, straddles = 0;
  for_random_dampers([&](const DamperTerms<double>& damper, Draws& draws) {
    if (damper.law == DamperLaw::eddy_current) return; // its slope is not bounded
    const double low = draws.sign() * draws.log_uniform(1e-3, 3);
    const double high = low + draws.log_uniform(1e-3, 6);
    const ValueRange<double> range = damping_range(damper, {low, high});
    double least = damper_damping(damper, low), most = least;
    const auto take = [&](double v) {
      if (v < low || v > high) return;
      least = std::min(least, damper_damping(damper, v));
      most = std::max(most, damper_damping(damper, v));
    };
    for (int k = 0; k <= 2000; ++k) take(low + (high - low) * k / 2000.0);
    for (const double edge : {-damper.rate, damper.rate})
      for (const double near : {1 - 1e-12, 1.0, 1 + 1e-12}) take(near * edge);
    straddles += low < 0 && high > 0;
    jumps += damper.law == DamperLaw::power && most > least && range.low <= damper.near_zero &&
             damper.near_zero <= range.high;
    check_bound(range.high, most);
    CHECK(range.low <= least * (1 + 1e-12));
    CHECK(range.low >= least * (1 - 1e-3) - 1e-14);
  });
  CHECK(std::min(jumps, straddles) >= 20);
}
