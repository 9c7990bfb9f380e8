// What real_hinge.hpp lists: every law of every random hinge, by what hinge_law.hpp says that a law offers.
// A law that is added to the list is tested here without a further line.
#include "core/laws/real_hinge.hpp"
#include "tests/support/real_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <typeinfo>
#include <vector>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// visit(law, draws, hinge) for every law of a few hundred random hinges in random modes.
/// @return how often each law was visited
template <class Visit> std::map<std::string, int> for_random_laws(Visit&& visit) {
  std::map<std::string, int> seen;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    Draws draws(seed);
    RandomScene options;
    options.bodies = 1;
    Scene scene = with_real_hinges(random_scene(seed, options), seed);
    Hinge& hinge = scene.hinges[0];
    if (draws.chance(0.7)) hinge.friction.model = FrictionModel::exact;
    hinge.friction.regularization_rate = draws.log_uniform(1e-2, 1);
    const double sense = hinge.latched > hinge.stowed ? 1 : -1;
    const RealHingeTerms<double> terms = real_hinge_terms(hinge, sense);
    const auto mode = [&] { return draws.chance(0.8) ? 1.0 : 0.0; };
    const HingeMode<double> now{mode(), mode(), draws.sign(), mode() * draws.sign(), 1};
    for_each_law(terms, now, [&](const auto& law) {
      ++seen[typeid(law).name()];
      CAPTURE(seed, typeid(law).name());
      visit(law, draws, hinge);
    });
  }
  return seen;
}

void check_all_seen(const std::map<std::string, int>& seen, std::size_t laws) {
  CHECK(seen.size() == laws);
  for (const auto& [name, count] : seen) {
    CAPTURE(name, count);
    CHECK(count >= 20);
  }
}

template <class Law> double moment(const Law& law, double angle, double rate) {
  double m = 0;
  law.add_moment(m, angle, rate);
  return m;
}

/// An interval about the hinge's way, over knots, or short.
ValueRange<double> random_angles(Draws& draws, const Hinge& hinge) {
  const double way = hinge.latched - hinge.stowed;
  const double a = hinge.stowed + way * draws.uniform(-0.2, 1.1);
  return {a, a + draws.log_uniform(1e-3, 1)};
}
/// Rates of one sign or of both.
ValueRange<double> random_rates(Draws& draws) {
  const double v = draws.uniform(-2, 2);
  return {v, v + draws.log_uniform(1e-3, 2)};
}

double at(const ValueRange<double>& range, double share) {
  return range.low + share * (range.high - range.low);
}

constexpr int parts = 40; // of an interval

} // namespace

TEST_CASE("every law's range over angles and rates holds its moments there") {
  const auto seen = for_random_laws([](const auto& law, Draws& draws, const Hinge& hinge) {
    const ValueRange<double> angle = random_angles(draws, hinge), rate = random_rates(draws);
    ValueRange<double> range{0, 0};
    law.add_range(range, angle, rate);
    const double close = 1e-12 * (1 + largest_magnitude_of(range));
    for (int k = 0; k <= parts; ++k)
      for (int l = 0; l <= parts; ++l) {
        const double m = moment(law, at(angle, double(k) / parts), at(rate, double(l) / parts));
        REQUIRE(range.low - close <= m);
        REQUIRE(m <= range.high + close);
      }
  });
  check_all_seen(seen, 5);
}

TEST_CASE("every law's slopes over angles and rates hold its difference quotients there") {
  std::map<std::string, int> judged;
  for_random_laws([&](const auto& law, Draws& draws, const Hinge& hinge) {
    const ValueRange<double> angle = random_angles(draws, hinge), rate = random_rates(draws);
    if (!law.has_slopes(angle)) return;
    ++judged[typeid(law).name()];
    MomentSlopes<double> slopes;
    law.add_slopes(slopes, angle, rate);
    MomentSlopes<double> more{{-1, 2}, {-3, 4}}; // a law adds to those before it
    law.add_slopes(more, angle, rate);
    const auto added = [](double sum, double own, double before) {
      REQUIRE(sum == Approx(own + before).epsilon(1e-12).margin(1e-12));
    };
    added(more.by_angle.low, slopes.by_angle.low, -1);
    added(more.by_angle.high, slopes.by_angle.high, 2);
    added(more.by_rate.low, slopes.by_rate.low, -3);
    added(more.by_rate.high, slopes.by_rate.high, 4);
    const auto check = [](const ValueRange<double>& range, double quotient, double rounding) {
      const double close = 1e-9 * largest_magnitude_of(range) + rounding;
      REQUIRE(range.low - close <= quotient);
      REQUIRE(quotient <= range.high + close);
    };
    const double fine_angle = (angle.high - angle.low) / parts;
    const double fine_rate = (rate.high - rate.low) / parts;
    for (int k = 0; k < parts; ++k)
      for (int l = 0; l < parts; ++l) {
        const double x = at(angle, double(k) / parts), v = at(rate, double(l) / parts);
        const double m = moment(law, x, v), rounding = 1e-14 * (1 + std::abs(m));
        check(slopes.by_angle, (moment(law, x + fine_angle, v) - m) / fine_angle,
              rounding / fine_angle);
        check(slopes.by_rate, (moment(law, x, v + fine_rate) - m) / fine_rate,
              rounding / fine_rate);
      }
  });
  check_all_seen(judged, 5);
}

TEST_CASE("every law's resistance is its difference quotient, with the sign turned") {
  const auto seen = for_random_laws([](const auto& law, Draws& draws, const Hinge& hinge) {
    for (int k = 0; k < 20; ++k) {
      const double x = at(random_angles(draws, hinge), 0), v = draws.uniform(-2, 2);
      HingeResistance<double> found{0, 0};
      law.add_resistance(found, x, v);
      const double d = 1e-6;
      const auto check = [&](double resistance, double dx, double dv) {
        const double before = (moment(law, x - dx, v - dv) - moment(law, x, v)) / d;
        const double after = (moment(law, x, v) - moment(law, x + dx, v + dv)) / d;
        const double close = 1e-4 * (1 + std::abs(before) + std::abs(after)); // d M''/2, rounding/d
        CAPTURE(x, v, resistance, before, after);
        CHECK(resistance >= std::min(before, after) - close); // between the two at a kink
        CHECK(resistance <= std::max(before, after) + close);
      };
      check(found.stiffness, d, 0), check(found.damping, 0, d);
    }
  });
  check_all_seen(seen, 5);
}

TEST_CASE("a law that stores energy has its moment at rest as the potential's slope") {
  std::map<std::string, int> storing;
  for_random_laws([&](const auto& law, Draws& draws, const Hinge& hinge) {
    const auto potential = [&](double angle) {
      double P = 0;
      law.add_potential(P, hinge.latched, angle);
      return P;
    };
    for (int k = 0; k < 20; ++k) {
      const double x = at(random_angles(draws, hinge), 0), d = 1e-5;
      const double slope = (potential(x - d) - potential(x + d)) / (2 * d);
      const bool stores = potential(x) != 0 || potential(x + 0.1) != 0;
      if (!stores) continue;
      ++storing[typeid(law).name()];
      CAPTURE(x);
      // the curve may bend at a knot within d; rounding of P over d
      CHECK(slope == Approx(moment(law, x, 0.0)).epsilon(1e-4).margin(1e-4));
    }
  });
  check_all_seen(storing, 2); // springs and harnesses by tables, the stop
}

TEST_CASE("the sums over laws are those of the laws") {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Draws draws(seed);
    RandomScene options;
    options.bodies = 1;
    const Scene scene = with_real_hinges(random_scene(seed, options), seed);
    const Hinge& hinge = scene.hinges[0];
    const double sense = hinge.latched > hinge.stowed ? 1 : -1;
    const RealHingeTerms<double> terms = real_hinge_terms(hinge, sense);
    const HingeMode<double> mode{1, 1, 1, 1, 1};
    const ValueRange<double> angle = random_angles(draws, hinge), rate = random_rates(draws);
    const ValueRange<double> acceleration = random_rates(draws);
    const KnownRange<double> change = real_change(terms, mode, angle, rate, acceleration);
    if (!change.known) continue;
    // a motion within the ranges: M by the chain rule, from a difference along it
    for (int k = 0; k < parts; ++k) {
      const double share = double(k) / parts, x = at(angle, share), v = at(rate, share);
      const double a = at(acceleration, share), d = 1e-6;
      TablePiece<double> piece = no_table_piece<double>();
      const auto m = [&](double dt) {
        return real_moment(terms, mode, piece, x + v * dt, v + a * dt);
      };
      const double quotient = (m(d) - m(-d)) / (2 * d);
      const double close =
          1e-4 * (1 + largest_magnitude_of(change.range)); // beyond an interval's end
      CAPTURE(seed, share);
      CHECK(quotient >= change.range.low - close);
      CHECK(quotient <= change.range.high + close);
    }
  }
}

TEST_CASE("the tables of a hinge summed between knots give the sum of its laws, whatever piece was "
          "known before") {
  int tables = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    Draws draws(seed);
    RandomScene options;
    options.bodies = 1;
    Scene scene = with_real_hinges(random_scene(seed, options), seed);
    Hinge& hinge = scene.hinges[0];
    if (draws.chance(0.7)) hinge.friction.model = FrictionModel::exact;
    hinge.friction.regularization_rate = draws.log_uniform(1e-2, 1);
    const RealHingeTerms<double> terms =
        real_hinge_terms(hinge, hinge.latched > hinge.stowed ? 1.0 : -1.0);
    const HingeMode<double> mode{1, 1, draws.sign(), draws.sign(), 1};
    tables += terms.has_tables() ? 1 : 0;
    std::vector<double> angles; // in any order, at knots, just below and beyond them
    for (int k = 0; k < parts; ++k)
      angles.push_back(hinge.stowed + (hinge.latched - hinge.stowed) * draws.uniform(-0.2, 1.2));
    for (const Curve* curve : {terms.spring.curve, terms.harness.curve, terms.friction.level})
      for (std::size_t k = 0; curve && k < curve->knots().size(); ++k)
        for (const double off : {0.0, -1e-15, 1e-15, -0.01, 0.01})
          angles.push_back(curve->knots()[k] + off);
    TablePiece<double> piece = no_table_piece<double>();
    for (const double angle : angles) {
      const double rate = draws.uniform(-2, 2);
      double sum = 0, size = 0;
      for_each_law(terms, mode, [&](const auto& law) {
        sum += moment(law, angle, rate), size += std::abs(moment(law, angle, rate));
      });
      TablePiece<double> fresh = no_table_piece<double>();
      const double found = real_moment(terms, mode, piece, angle, rate);
      CAPTURE(seed, angle, rate);
      CHECK(std::abs(found - sum) <= 1e-13 * size);
      CHECK(found == real_moment(terms, mode, fresh, angle, rate));
    }
  }
  CHECK(tables > 100);
}

TEST_CASE("a latch that dissipates exerts −k c |e| φ̇, e its deflection beyond the backlash") {
  constexpr double k = 700, c = 0.4, latched = 0.3, backlash = 0.02;
  Hinge hinge;
  hinge.stowed = -1, hinge.latched = latched;
  hinge.latch = Latch{.stiffness = k, .backlash = backlash, .dissipation = c};
  const LatchDissipationTerms<double> terms = dissipation_terms<double>(hinge);
  for (const double side : {-1.0, 0.0, 1.0})
    for (const double depth : {0.0, 0.01, 0.05}) {
      const double angle = latched + side * (backlash / 2 + depth);
      const LatchDissipation<double> law{terms, side};
      CAPTURE(side, depth);
      CHECK(moment(law, angle, 0.7) ==
            Approx(-k * c * std::abs(side) * depth * 0.7).epsilon(1e-12).margin(1e-12));
    }
}

TEST_CASE(
    "the rates at which a damper's law or a stop's has a kink are those where its damping jumps") {
  int dampers = 0, stops = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    Draws draws(seed);
    RandomScene options;
    options.bodies = 1;
    const Scene scene = with_real_hinges(random_scene(seed, options), seed);
    const Hinge& hinge = scene.hinges[0];
    const double sense = hinge.latched > hinge.stowed ? 1 : -1;
    const RealHingeTerms<double> terms = real_hinge_terms(hinge, sense);
    const HingeMode<double> now{double(draws.chance(0.5)), double(draws.chance(0.5)), 0, 0,
                                double(draws.chance(0.5))};
    int listed = 0;
    std::vector<double> of_damper;
    for_each_kink_of_rate(terms, now, [&](double rate, bool acts, const HingeStop<double>* stop) {
      CAPTURE(seed, rate, acts, stop != nullptr);
      ++listed;
      if (!stop) of_damper.push_back(rate);
      if (!acts) return;
      // angles inside the stop's contact; a damper's moment does not depend on the angle
      const double angle = stop ? stop->terms.contact_angle - stop->terms.sense * 0.01 : 0;
      const auto damping = [&](double v) {
        HingeResistance<double> r{0, 0};
        if (stop)
          stop->add_resistance(r, angle, v);
        else
          r.damping = damper_damping(terms.damper, v);
        return r.damping;
      };
      const double below = damping(rate - 1e-9 * std::abs(rate)),
                   above = damping(rate + 1e-9 * std::abs(rate));
      ++(stop ? stops : dampers);
      if (stop) CHECK(std::min(below, above) == 0); // it pushes on one side only
      CHECK(std::abs(above - below) > 1e-6 * std::max(below, above));
    });
    const bool power = terms.has_damper && terms.damper.law == DamperLaw::power;
    CHECK(listed == 2 * power + terms.stop.present + terms.far_stop.present);
    if (power) CHECK(of_damper == std::vector{-terms.damper.rate, terms.damper.rate});
  }
  CHECK(std::min(dampers, stops) >= 20);
}
