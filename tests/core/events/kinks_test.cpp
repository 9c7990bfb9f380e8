// Kinks of laws: steps of implicit methods and of extrapolation end there, for their error estimates do not see them.
#include "core/deployment.hpp"
#include "core/events/kinks.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/random_cases.hpp"
#include "tests/support/real_scenes.hpp"
#include "tests/support/whole_runs.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// Every output of a run that a kink may shift: peaks, overtravel, latch times and rates.
std::vector<double> kinked_outputs(const Outcome& out) {
  std::vector<double> all;
  for (const Peak& peak : out.peak_moment) all.push_back(peak.value);
  for (const Peak& peak : out.peak_force) all.push_back(peak.value);
  all.insert(all.end(), out.overtravel.begin(), out.overtravel.end());
  for (const LatchEvent& latch : out.latches) {
    all.push_back(latch.time);
    all.push_back(latch.rates[latch.hinge]);
  }
  return all;
}

std::vector<double> run_outputs(const Scene& scene, const std::string& method, double rtol,
                                double t_end) {
  Integration how = within(rtol, t_end, 1e-2);
  how.method = method;
  const Goal goal{.peak_moment = true, .peak_force = true, .overtravel = true, .to_t_end = true};
  return kinked_outputs(Deployment().run(scene, how, goal));
}

/// The largest difference of two lists, each in units of its value or, if larger, `floor`; infinite if they differ in
/// length.
double difference(const std::vector<double>& a, const std::vector<double>& b, double floor) {
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  double worst = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    worst = std::max(worst, std::abs(a[k] - b[k]) / std::max(std::abs(b[k]), floor));
  return worst;
}

/// Two panels whose loop, with a table and a damping of its own, goes slack whenever they swing; with one more kink each:
/// linear tables, a stop that lets go, a power-law damper, a damper's window, backlash.
Scene kinked_wing(std::uint64_t seed) {
  Draws draws(seed);
  Scene scene = seed_scene();
  scene.bodies.pop_back(), scene.hinges.pop_back();
  for (Hinge& hinge : scene.hinges) {
    hinge.friction = {};
    hinge.latch = Latch{draws.log_uniform(1e3, 1e5), draws.uniform(1, 20)};
  }
  Hinge &root = scene.hinges[0], &outer = scene.hinges[1];
  Synchronisation loop;
  loop.name = "loop", loop.first = 0, loop.second = 1;
  loop.stiffness = draws.log_uniform(100, 1500), loop.damping = draws.uniform(0, 0.5);
  loop.preload = draws.uniform(0.5, 3);
  tabulate(loop, {0, 0.8, 1.6}, {0, draws.uniform(0.2, 1.2), 3.15});
  scene.synchronisations = {loop};
  const double way = root.latched - root.stowed, outer_way = outer.latched - outer.stowed;
  if (draws.chance(0.5))
    root.spring.table = torque_table({root.stowed, root.stowed + 0.3 * way, root.latched},
                                     {2, 0.5, 1.5}, Interpolation::linear);
  if (draws.chance(0.5)) root.stop = Stop{draws.log_uniform(100, 1e4), 2, 0.01};
  if (draws.chance(0.5)) outer.latch->backlash = 0.01;
  if (draws.chance(0.5)) {
    Damper damper;
    damper.law = DamperLaw::power, damper.coefficient = 0.3, damper.exponent = 0.6;
    damper.regularization_rate = 1e-2;
    if (draws.chance(0.5))
      damper.window = {outer.stowed + 0.2 * outer_way, outer.stowed + 0.6 * outer_way};
    outer.damper = damper;
  }
  return scene;
}

} // namespace

TEST_CASE("at kinks implicit methods and extrapolation keep the tolerance in every output") {
  for (int seed = 0; seed < random_cases(60, 5); ++seed) {
    const Scene scene = kinked_wing(static_cast<std::uint64_t>(seed));
    const std::vector<double> exact = run_outputs(scene, "dop853", 1e-12, 4);
    for (const double rtol : {1e-6, 1e-8}) {
      // how strongly the wing amplifies errors of this size
      const double usual = difference(run_outputs(scene, "dop853", rtol, 4), exact, 1e-3);
      for (const std::string method : {"seulex", "rosenbrock_w", "bulirsch_stoer"}) {
        if (method == "rosenbrock_w" && rtol < 1e-7) continue; // slow
        const double error = difference(run_outputs(scene, method, rtol, 4), exact, 1e-3);
        CAPTURE(seed, rtol, method, usual, error);
        CHECK(error < 10 * usual + 300 * rtol);
      }
    }
  }
}

// Discs on a loop that goes slack about 25 times a second, at whose jumps steps are refused; and a panel on the same base,
// driven over a detent whose work is known.
TEST_CASE("a step that is refused for a loop's jump does not leap over a detent before the jump") {
  Draws draws(23);
  Scene scene = coaxial_discs(2, 0.5);
  scene.hinges[0].initial_rate = 5;
  Synchronisation loop;
  loop.name = "cable", loop.first = 0, loop.second = 1;
  loop.stiffness = 100, loop.damping = 0.05, loop.preload = 5;
  scene.synchronisations = {loop};
  const Scene panel = free_panel();
  scene.bodies.push_back(panel.bodies[0]), scene.hinges.push_back(panel.hinges[0]);
  Hinge& hinge = scene.hinges[2];
  hinge.child = 2, hinge.latch = Latch{};
  for (int k = 0; k < random_cases(100, 10); ++k) {
    const double half_width = draws.log_uniform(1e-5, 1e-3), middle = draws.uniform(0.05, 0.9);
    const double depth = draws.uniform(0.2, 1) * std::min(100.0, 0.05 / half_width);
    hinge.spring.table = torque_table({0, middle - half_width, middle, middle + half_width, 1},
                                      {1, 1, 1 + depth, 1, 1}, Interpolation::linear);
    const double rate = std::sqrt(2 * (1 + depth * half_width) / panel_inertia);
    for (const std::string method : {"auto", "dop853", "dopri5", "cash_karp54"}) {
      Integration how = within(1e-8, 5);
      how.method = method;
      const Outcome out = Deployment().run(scene, how, latches_only);
      CAPTURE(k, half_width, middle, depth, method, out.reason);
      REQUIRE(out.latches.size() == 1);
      // To leap over the detent, or half of it, costs 5e-4 to 2.5e-2. Over a single knot the error estimate
      // of a step decides, and misses it by up to 500 tolerances: the worst of 400 runs is off by 4.8e-6
      CHECK(relative(out.latches[0].rates[2], rate) < 2e-5);
    }
  }
}

// A panel passes four knots of a table. Steps halved towards them are rejected 11 to 25 times.
TEST_CASE(
    "an explicit method's step that is rejected at a kink of a law is made again up to the kink") {
  Scene scene = free_panel();
  Hinge& hinge = scene.hinges[0];
  hinge.latch.reset();
  hinge.spring.table = torque_table({0, 0.3, 0.5, 0.7, 1}, {1, 1, 4, 1, 1});
  for (const char* method : {"cash_karp54", "dopri5", "dop853"})
    for (const double rtol : {1e-6, 1e-9}) {
      Integration how = within(rtol, 2);
      how.method = method;
      const Work work = Deployment().run(scene, how, {.to_t_end = true}).work;
      CAPTURE(method, rtol, work.steps);
      CHECK(work.rejected <= 10);
    }
}

TEST_CASE("a state is moved across a kink of strands by two roundings, whichever hinge is locked") {
  int moved_first = 0, moved_second = 0;
  RealFeatures features;
  features.loops = true;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Draws draws(seed);
    RandomScene options;
    options.bodies = 2 + static_cast<int>(seed % 4), options.motion = BaseMotion::fixed;
    const Scene scene = with_real_hinges(random_scene(seed, options), seed, features);
    Wing<double> wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    Workspace<double> work;
    System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
    State<double> x;
    system.start(x);
    const Layout& at = system.layout();
    for (int i = 1; i <= at.bodies; ++i) x[at.angle(i)] += draws.uniform(-1, 1);
    for (int k = 0; k < static_cast<int>(wing.loops.size()); ++k) {
      const LoopTerms<double>& loop = wing.loops[k];
      for (const int locked : {0, loop.first, loop.second}) {
        for (int i = 1; i <= at.bodies; ++i)
          system.set_contact(i, i == locked ? Contact::stuck : Contact::none);
        const auto elastic = [&](const State<double>& state) {
          return system.state_of(loop, state).elastic;
        };
        const Kink<double> kink{Kink<double>::Of::strands, k, elastic(x), draws.sign()};
        const double rounding = beyond_rounding(system, kink, x);
        const double gear = system.state_of(loop, x).gear;
        if (std::abs(gear) < 0.05) continue; // one rounding of the angle may be more than the way
        State<double> y = x;
        cross(system, kink, 1.0, y, State<double>(y.size(), 0.0));
        CAPTURE(seed, k, locked, gear);
        CHECK(kink.way * (elastic(y) - elastic(x)) > rounding);
        CHECK(kink.way * (elastic(y) - elastic(x)) < 4 * rounding);
        const int moves = locked == loop.second ? loop.first : loop.second;
        y[at.angle(moves)] = x[at.angle(moves)];
        CHECK(y == x);
        ++(moves == loop.first ? moved_first : moved_second);
      }
    }
  }
  CHECK(std::min(moved_first, moved_second) > 50);
}

TEST_CASE("loops whose strands go slack within an instant of each other cross together") {
  Scene scene = symmetric_tree();
  Synchronisation loop;
  loop.stiffness = 100, loop.damping = 1, loop.preload = 2;
  for (const int root : {0, 2}) {
    loop.first = root, loop.second = root + 1;
    scene.synchronisations.push_back(loop);
  }
  Wing<double> wing = make_wing<double>(scene, outward_order(scene));
  set_parameters(wing, scene);
  Workspace<double> work;
  System<double, Tree, BaseMotion::free> system(wing, std::nullopt, work);
  const double t = 2, slack = wing.loops[0].slack_beyond;
  const auto elastic = [&](int l, const State<double>& x) {
    return system.state_of(wing.loops[l], x).elastic;
  };
  for (const double late : {0.5, 20.}) { // instants by which the second loop is later
    State<double> x, dxdt;
    system.start(x);
    for (const int l : {0, 1})
      x[system.layout().rate(wing.loops[l].second)] = -0.3 * wing.loops[l].sense_b;
    dxdt.assign(x.size(), 0.0);
    for (int i = 1; i <= wing.size(); ++i)
      dxdt[system.layout().angle(i)] = x[system.layout().rate(i)];
    for (const int l : {0, 1}) {
      const Kink<double> kink{Kink<double>::Of::strands, l, slack, 1};
      const double rate = argument(system, kink, x, dxdt, t).first;
      REQUIRE(rate > 0);
      const double before =
          l == 0 ? beyond_rounding(system, kink, x) : late * one_instant_of_latches(t) * rate;
      move_strands(system, kink, slack - before - elastic(l, x), x);
    }
    cross(system, {Kink<double>::Of::strands, 0, slack, 1}, t, x, dxdt);
    CAPTURE(late);
    CHECK(elastic(0, x) > slack);
    CHECK((elastic(1, x) > slack) == (late < 1));
  }
}

namespace {

/// A wing with every kind of kink, in a random state of motion.
struct KinkedMotion {
  explicit KinkedMotion(std::uint64_t seed)
      : scene(with_motors(seed)), wing(make_wing<double>(scene, outward_order(scene))),
        system(with_numbers(wing, scene), epsilon, work) {
    Draws draws(seed + 100);
    system.start(x);
    const Layout& at = system.layout();
    for (int i = 1; i <= at.bodies; ++i) {
      x[at.angle(i)] += draws.uniform(-0.5, 1);
      x[at.rate(i)] = draws.uniform(-2, 2);
      x[at.latch(i)] = draws.uniform(0, epsilon);
    }
    t = draws.uniform(0.1, 3);
    system.enter_piece(t);
    system.find_sides(x);
    dxdt = x;
    system(x, dxdt, t);
  }

  /// The argument of a kink after dt, along the parabolas of all angles.
  [[nodiscard]] double after(const Kink<double>& kink, double dt) const {
    const Layout& at = system.layout();
    State<double> there = x;
    for (int i = 1; i <= at.bodies; ++i) {
      const double acceleration = dxdt[at.rate(i)];
      there[at.angle(i)] += dt * (x[at.rate(i)] + 0.5 * dt * acceleration);
      there[at.rate(i)] += dt * acceleration;
      there[at.latch(i)] += dt * dxdt[at.latch(i)];
    }
    return argument(system, kink, there, dxdt, t + dt).value;
  }

  /// A time in which no hinge turns by more than 1e-4 rad or so, s.
  [[nodiscard]] double soon() const {
    double most = 1;
    for (int i = 1; i <= wing.size(); ++i)
      most = std::max(most, std::abs(dxdt[system.layout().rate(i)]));
    return 1e-4 / std::sqrt(most);
  }

  static constexpr double epsilon = 0.1;
  Scene scene; ///< the wing refers to its tables
  Wing<double> wing;
  Workspace<double> work;
  System<double, Tree, BaseMotion::fixed> system;
  State<double> x, dxdt;
  double t = 0;

private:
  [[nodiscard]] static Scene with_motors(std::uint64_t seed) {
    Draws draws(seed);
    RandomScene options;
    options.bodies = 2 + static_cast<int>(seed % 3), options.motion = BaseMotion::fixed;
    Scene scene = with_real_hinges(random_scene(seed, options), seed);
    for (Hinge& hinge : scene.hinges) {
      Motor motor{.time = {0, 1, 2.5, 4}, .interpolation = Interpolation::monotone};
      for (int k = 0; k < 4; ++k) motor.rates.push_back(draws.uniform(-2, 2));
      motor.table = std::make_shared<Curve>(motor.time, motor.rates, motor.interpolation);
      motor.gain = draws.uniform(0.1, 5), motor.torque_limit = draws.uniform(0.1, 5);
      hinge.motor = motor;
    }
    return scene;
  }
  [[nodiscard]] static const Wing<double>& with_numbers(Wing<double>& wing, const Scene& scene) {
    set_parameters(wing, scene);
    return wing;
  }
};

} // namespace

TEST_CASE("what passes a kink has the derivatives of its value along the motion") {
  int strands = 0, bent = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const KinkedMotion motion(seed);
    const auto check = [&](Kink<double>::Of of, int index) {
      const Kink<double> kink{of, index, 0, 1};
      const Jet<double> u = argument(motion.system, kink, motion.x, motion.dxdt, motion.t);
      CAPTURE(seed, static_cast<int>(of), index);
      const auto u_after = [&](double dt) { return motion.after(kink, dt); };
      CHECK(u.value == u_after(0));
      // between the differences ahead and behind, which differ at a knot
      const double size = 1 + std::abs(u.value) + std::abs(u.first), d = 0.1 * motion.soon(),
                   wide = motion.soon();
      const auto is_between = [&](double value, double ahead, double behind, double rounding) {
        return value >= std::min(ahead, behind) - rounding &&
               value <= std::max(ahead, behind) + rounding;
      };
      CHECK(is_between(u.first, (u_after(d) - u.value) / d, (u.value - u_after(-d)) / d,
                       1e-8 * size));
      const auto bend = [&](double dt) {
        return (u_after(2 * dt) - 2 * u_after(dt) + u.value) / (dt * dt);
      };
      const double ahead = bend(wide), behind = bend(-wide), rounding = 1e-9 / (wide * wide);
      const bool passes_knot = std::abs(ahead - behind) > 0.1 * std::abs(u.second) + rounding;
      if (u.second == 0 || passes_knot) return; // 0: unknown
      CHECK(is_between(u.second, ahead, behind, 1e-3 * std::abs(u.second) + rounding));
      ++bent;
    };
    for (int i = 1; i <= motion.wing.size(); ++i)
      for (const auto of : {Kink<double>::Of::angle, Kink<double>::Of::rate,
                            Kink<double>::Of::excess, Kink<double>::Of::latch})
        check(of, i);
    for (int l = 0; l < static_cast<int>(motion.wing.loops.size()); ++l, ++strands)
      check(Kink<double>::Of::strands, l);
  }
  CHECK(strands > 30);
  CHECK(bent > 300);
}
