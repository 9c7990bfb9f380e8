// The first tests for kinks, which lanes make too, against the search for kinks that they stand for.
#include "core/events/kink_search.hpp"
#include "core/events/leaps.hpp"
#include "tests/support/real_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

constexpr double leap_rtol = 1e-6, leap_atol = 1e-8;

/// What the tests say of a step, and what the search finds in it.
struct LeapFinds {
  bool tables, gears, jump, jump_if_refused, kink; ///< the tests
  bool leaps_over_knots = false, leaps_over_strands = false, jumps = false, meets = false;
};

/// visit(finds) for random wings with tables and loops, in steps of any length. @param swing rad in a step
template <class Visit> void for_random_leaps(double least_swing, double most_swing, Visit&& visit) {
  RealFeatures features;
  features.air = features.backlash = false;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    Draws draws(3300 + seed);
    RandomScene options;
    options.bodies = 3, options.motion = BaseMotion::fixed;
    const Scene scene = with_real_hinges(random_scene(seed, options), seed, features);
    Wing<double> wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    Workspace<double> work;
    System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
    Step<double> step;
    step.t = 1, step.h = draws.log_uniform(1e-3, 1);
    system.start(step.x);
    const Layout& at = system.layout();
    for (State<double>* x : {&step.dxdt, &step.x1, &step.dxdt1}) x->assign(at.size(), 0);
    const double swing = draws.log_uniform(least_swing, most_swing);
    for (int i = 1; i <= at.bodies; ++i) {
      const int a = at.angle(i), r = at.rate(i);
      const double whole = wing.hinges[i].latched - wing.hinges[i].stowed;
      step.x[a] += whole * draws.uniform(-0.1, 1.1);
      step.x[r] = draws.uniform(-1, 1) * swing / step.h;
      step.x1[r] = step.x[r] + draws.uniform(-1, 1) * swing / step.h;
      step.x1[a] = step.x[a] + 0.5 * step.h * (step.x[r] + step.x1[r]);
      step.dxdt[a] = step.x[r], step.dxdt1[a] = step.x1[r];
      step.dxdt[r] = step.dxdt1[r] = (step.x1[r] - step.x[r]) / step.h;
    }
    system.find_sides(step.x);
    State<double> dxdt(at.size());
    system(step.x1, dxdt, step.t + step.h); // the tables' pieces are those at the end
    using Search = KinkSearch<double, decltype(system)>;
    const auto is_of_strands = [](const auto& found) {
      return found->kink.of == Kink<double>::Of::strands;
    };
    LeapFinds finds{};
    finds.tables = may_leap_over_tables(system, step);
    finds.gears = may_leap_over_gears(system, step);
    finds.jump = moments_may_jump(system, step, 0.5 * step.h, leap_rtol, leap_atol);
    finds.jump_if_refused = moments_may_jump(system, step, step.h, leap_rtol, leap_atol);
    finds.kink = may_meet_kink(system, step);
    const auto leap = Search(system, step, {leap_rtol, leap_atol, true}).first();
    if (leap) (is_of_strands(leap) ? finds.leaps_over_strands : finds.leaps_over_knots) = true;
    finds.jumps = Search(system, step, {leap_rtol, leap_atol, true, true}).first().has_value();
    finds.meets = Search(system, step, {leap_rtol, leap_atol}).first_of_hinges().has_value();
    CAPTURE(seed, swing);
    visit(finds);
  }
}

} // namespace

TEST_CASE("the first tests for kinks exclude none that the search finds") {
  std::array<int, 4> found{};
  for_random_leaps(1e-3, 2, [&](const LeapFinds& finds) {
    if (finds.leaps_over_knots) CHECK((finds.tables || finds.gears));
    if (finds.leaps_over_strands) CHECK(finds.jump);
    if (finds.jumps) CHECK(finds.jump_if_refused);
    if (finds.meets) CHECK(finds.kink);
    found[0] += finds.leaps_over_knots, found[1] += finds.leaps_over_strands;
    found[2] += finds.jumps, found[3] += finds.meets;
  });
  CAPTURE(found[0], found[1], found[2], found[3]);
  CHECK(std::ranges::min(found) >= 15);
}

TEST_CASE("the first tests for kinks exclude steps that are short") {
  int leaps = 0, kinks = 0;
  for_random_leaps(1e-9, 1e-8, [&](const LeapFinds& finds) {
    leaps += finds.tables || finds.gears || finds.jump || finds.jump_if_refused;
    kinks += finds.kink && !finds.meets;
  });
  CHECK(leaps == 0);
  CHECK(kinks <= 3);
}

// A way visits the pieces of a table in which its samples lie. A step that visits a piece beside those of its ends may
// have leapt over it, and so may one whose ends lie more than one knot apart.
TEST_CASE("a way that turns beyond a knot, or passes two, passes knots twice, and no other does") {
  int turned = 0, passed = 0, plain = 0;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    Draws draws(seed);
    std::vector<double> x{0}, y{0};
    for (int k = 0; k < 4; ++k)
      x.push_back(x.back() + draws.log_uniform(0.02, 1)), y.push_back(draws.uniform(-1, 1));
    const Curve curve(x, y, Interpolation::linear);
    const double from = draws.uniform(-0.2, 2), chord = draws.uniform(-0.5, 0.5),
                 bulge = draws.uniform(-1, 1);
    const auto way = [&](double s) { return from + chord * s + bulge * s * (1 - s); };
    const auto piece = [&](double at) {
      return std::ranges::count_if(x, [&](double knot) { return knot <= at; });
    };
    const auto first = piece(way(0)), last = piece(way(1));
    double low = way(0), high = way(0);
    bool leaves = false; // the pieces of its ends
    for (int k = 0; k <= 5000; ++k) {
      const double at = way(k / 5000.0);
      low = std::min(low, at), high = std::max(high, at);
      leaves = leaves || (piece(at) != first && piece(at) != last);
    }
    const bool twice = leaves || std::abs(first - last) > 1;
    (!twice ? plain : std::abs(first - last) > 1 ? passed : turned) += 1;
    CAPTURE(seed, from, chord, bulge);
    CHECK(detail::passes_knots_twice(curve, way(0), way(1), low, high) == twice);
  }
  CHECK(std::min({turned, passed, plain}) >= 100);
}
