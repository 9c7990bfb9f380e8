// The bounds by modes in other units: a factor too many or too few in any of their sums would show, and so would a number
// in place of a moment, also where it only guards against rounding.
#include "tests/core/proofs/latched_wing.hpp"
#include "tests/support/similar_scenes.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using oracle::Draws;
using oracle::Latched;
using oracle::Units;

namespace {

/// CHECKs that the bounds are these in other units: bit for bit in a unit of mass or length, to round-off in one of time,
/// whose eigenvalues are found by other roundings. @return whether there are any
bool check_same(const std::optional<HingeBounds>& old, const std::optional<HingeBounds>& made,
                const Units& units) {
  REQUIRE(made.has_value() == old.has_value());
  if (!old) return false;
  const double most = units.time == 1 ? 0 : 1e-5;
  const auto check = [&](const auto& got, const auto& expected) {
    CHECK(((got - expected).array().abs() <= most * expected.array().abs()).all());
  };
  check(made->moment, HingeVector(units.moment() * old->moment));
  check(made->force, HingeVector(units.force() * old->force));
  check(made->way, old->way);
  const auto of_base = [](const BaseBounds& base, double time) {
    return Eigen::Vector3d(base.way, base.rate / time, base.drift / time);
  };
  check(of_base(made->base, 1), of_base(old->base, units.time));
  return true;
}

/// Bounds of every kind of one wing in two units, from random states. @return how many there were
template <BaseMotion M> int check_wing(const Scene& scene, const Units& units, Draws& draws) {
  Latched<M> wing(scene), other(oracle::in_units(scene, units));
  REQUIRE(other.has_model == wing.has_model);
  if (!wing.has_model) return 0;
  int bounded = 0;
  const Layout& at = wing.at;
  for (int k = 0; k < 4; ++k) {
    State<double> x = wing.rest(), y = other.rest();
    for (int i = 1; i <= at.bodies; ++i) {
      const double way = 1e-3 * draws.uniform(-1, 1), rate = 1e-2 * draws.uniform(-1, 1);
      x[at.angle(i)] += way, y[at.angle(i)] = x[at.angle(i)];
      x[at.rate(i)] = rate, y[at.rate(i)] = rate / units.time;
    }
    const double energy = draws.log_uniform(1e-6, 1e2),
                 spin = M == BaseMotion::free ? draws.uniform(0, 1) : 0;
    const double energy_there = energy * units.moment(),
                 spin_there = spin * units.inertia() / units.time;
    const double t = draws.uniform(0, 10), t_there = t * units.time;
    CAPTURE(k, energy, spin, t);
    bounded += check_same(wing.bound(x, t, std::nullopt, spin),
                          other.bound(y, t_there, std::nullopt, spin_there), units);
    bounded += check_same(wing.bound(x, t, energy, spin),
                          other.bound(y, t_there, energy_there, spin_there), units);
    bounded += check_same(wing.bound_in_reach(x, energy, spin),
                          other.bound_in_reach(y, energy_there, spin_there), units);
  }
  return bounded;
}

} // namespace

TEST_CASE("bounds by modes are the same in other units of mass, length and time") {
  int bounded = 0;
  for (int k = 0; k < 60; ++k) {
    Draws draws(k);
    oracle::RandomScene options;
    options.bodies = 1 + k % 6;
    options.motion = static_cast<BaseMotion>(k % 3);
    options.friction = k % 2 == 0;
    options.mass_lower = 1, options.mass_upper = 30;
    Scene scene = oracle::with_latches(oracle::random_scene(900 + k, options), draws);
    scene.base.rate = options.motion == BaseMotion::prescribed ? draws.uniform(-0.1, 0.1) : 0;
    scene.base.angular_acceleration = 0;
    for (const Units& units : {Units{0x1p40, 1, 1}, Units{1, 0x1p3, 1}, Units{1, 1, 0x1p-4}}) {
      CAPTURE(k, units.mass, units.length, units.time);
      switch (*options.motion) {
      case BaseMotion::fixed:
        bounded += check_wing<BaseMotion::fixed>(scene, units, draws);
        break;
      case BaseMotion::free:
        bounded += check_wing<BaseMotion::free>(scene, units, draws);
        break;
      default:
        bounded += check_wing<BaseMotion::prescribed>(scene, units, draws);
      }
    }
  }
  CHECK(bounded > 1000);
}
