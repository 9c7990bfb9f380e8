// Measures whether a formula of higher order than dop853's 8, or a Taylor series, makes tight runs cheaper: work at
// equal error. The seed wing without friction is integrated from latch to latch, alone and in packs of four, by dop853,
// Verner's pairs 9(8) and 8(7), the method taylor, and the chain's Taylor series of taylor_chain.hpp.
//
//   build/release/studies/higher_orders [--quick]        # seconds; a table and higher_orders.csv

#include "core/deployment.hpp"
#include "core/mechanics/system.hpp"
#include "core/methods/dop853.hpp"
#include "core/methods/taylor.hpp"
#include "core/packs/fields.hpp"
#include "studies/support/study.hpp"
#include "studies/support/taylor_chain.hpp"
#include "studies/support/verner.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <stdexcept>

using namespace wingspread;
using namespace wingspread::study;

namespace {

template <class T> using Verner98Formula = EmbeddedPair<T, Verner98>;
template <class T> using Verner87Formula = EmbeddedPair<T, Verner87>;

/// The motion between two events.
struct Stretch {
  double from, to;
  int engages = 0; ///< the wing's hinge (1 … n) that latches at its start; 0: none
};

/// The stretches from release to the time at which a run for peak moments may end.
std::vector<Stretch> stretches_of(const Scene& scene) {
  Integration how;
  how.method = "dop853", how.rtol = 1e-13, how.atol = 1e-15, how.t_end = seed_t_end;
  const Outcome out = Deployment().run(scene, how, {.peak_force = false, .audit = false});
  const Wing<double> wing = make_wing<double>(scene, outward_order(scene));
  std::vector<Stretch> stretches{{0, 0}};
  for (const LatchEvent& latch : out.latches) {
    stretches.back().to = latch.time;
    int number = 1;
    while (wing.hinge_of[number] != latch.hinge) ++number;
    stretches.push_back({latch.time, 0, number});
  }
  stretches.back().to = out.t_end;
  return stretches;
}

double first_lane(double x) { return x; }
double first_lane(long double x) { return static_cast<double>(x); }
template <int W> double first_lane(const Pack<W>& x) { return x.v[0]; }

/// A scene's wing in any number type; in a pack every lane has the same wing.
template <class T> Wing<T> wing_of(const Scene& scene) {
  Wing<T> wing = make_wing<T>(scene, outward_order(scene));
  if constexpr (is_one_number<T>) {
    set_parameters(wing, scene);
  } else {
    const Wing<double> one = wing_of<double>(scene);
    for (int lane = 0; lane < T::width; ++lane) set_lane(lane, wing, one);
  }
  return wing;
}

/// A wing and its state, integrated stretch by stretch.
template <class T> struct Wanderer {
  static constexpr int bodies = 3;
  using AnySystem = System<T, Chain<bodies>, BaseMotion::fixed>;

  Wing<double> numbers;
  Wing<T> wing;
  Workspace<T> work;
  AnySystem system;
  State<T> x;

  explicit Wanderer(const Scene& scene)
      : numbers(wing_of<double>(scene)), wing(wing_of<T>(scene)), system(wing, std::nullopt, work) {
    system.start(x);
  }
  void start() { system.reset(), system.start(x); }
  void enter(const Stretch& stretch) {
    if (stretch.engages == 0) return;
    const LinearLaw<double> law = linear_law(numbers.hinges[stretch.engages], true);
    work.laws[stretch.engages] = {T(law.latched), T(law.drive), T(law.stiffness), T(law.damping)};
  }
};

/// Cost and end state of a motion from release to a stretch's end.
struct Walk {
  std::vector<long> evaluations, steps;    ///< up to the end of each stretch
  std::vector<std::vector<double>> states; ///< at the end of each stretch

  template <class T> void arrive(const State<T>& x, long evaluations_so_far, long steps_so_far) {
    std::vector<double> state;
    for (const T& v : x) state.push_back(first_lane(v));
    states.push_back(state);
    evaluations.push_back(evaluations_so_far), steps.push_back(steps_so_far);
  }
};

constexpr double first_try = 2e-3; ///< s, first trial step of every stretch, for all methods

/// Integrates by a formula with the step control of core/methods.
template <class T, template <class> class Formula>
Walk walk(Wanderer<T>& wing, const std::vector<Stretch>& way, double rtol, int /*order*/) {
  Formula<T> formula;
  Walk made;
  long steps = 0;
  const T now(0); // the equations do not depend on time
  State<T> dxdt(wing.x.size()), x1(wing.x.size()), dxdt1(wing.x.size()), error(wing.x.size());
  wing.start();
  for (const Stretch& stretch : way) {
    wing.enter(stretch);
    StepMemory<double> memory;
    long double t = stretch.from; // in double the sum's rounding would count as error
    double h = first_try;
    wing.system(wing.x, dxdt, now);
    while (t < stretch.to) {
      const auto rest = static_cast<double>(stretch.to - t);
      const bool last = h >= rest * (1 - 1e-9);
      T tried(last ? rest : h);
      estimate(formula, wing.system, Start<T>{now, wing.x, dxdt}, tried, x1, dxdt1, error, T(rtol),
               T(1e-2 * rtol));
      const double step = first_lane(tried);
      const double off =
          first_lane(scaled_error_of(formula, wing.x, x1, dxdt1, error, T(rtol), T(1e-2 * rtol)));
      h = step * factor_of<Formula<T>>(off, step, memory);
      if (!(off <= 1)) {
        memory.rejected();
        continue;
      }
      memory.accepted(off, step);
      std::swap(wing.x, x1), std::swap(dxdt, dxdt1);
      t = last && step == rest ? stretch.to : t + step;
      ++steps;
    }
    made.arrive(wing.x, wing.system.work().evaluations, steps);
  }
  return made;
}

/// Integrates by Taylor series of one order. The last two coefficients decide the step [Jorba & Zou 2005].
template <class T>
Walk walk_by_series(Wanderer<T>& wing, const std::vector<Stretch>& way, double rtol, int order) {
  constexpr int n = Wanderer<T>::bodies;
  TaylorChain<T, n> series(wing.wing);
  Walk made;
  long steps = 0;
  wing.start();
  for (const Stretch& stretch : way) {
    wing.enter(stretch);
    for (long double t = stretch.from; t < stretch.to; ++steps) {
      series.expand(wing.x, wing.work.laws, order);
      double h = 1e300;
      for (const int k : {order - 1, order}) {
        double largest = 0;
        for (int j = 0; j < n; ++j) {
          const double scale = rtol * std::abs(first_lane(wing.x[n + j])) + 1e-2 * rtol;
          largest = std::max(largest, std::abs(first_lane(series.rate_coefficient(j, k))) / scale);
        }
        h = std::min(h, std::pow(largest, -1.0 / k));
      }
      const auto rest = static_cast<double>(stretch.to - t);
      const bool last = h >= rest * (1 - 1e-9);
      if (last) h = rest;
      series.advance(T(h), order, wing.x);
      t = last ? stretch.to : t + h;
    }
    made.arrive(wing.x, steps, steps);
  }
  return made;
}

/// The largest error at the ends of the first `count` stretches: of angles in rad, of rates relative to the fastest.
double error_of(const Walk& got, const Walk& reference, std::size_t count) {
  double worst = 0;
  for (std::size_t s = 0; s < count; ++s) {
    const std::vector<double>&a = got.states[s], &b = reference.states[s];
    const std::size_t n = b.size() / 2;
    double fastest = 0;
    for (std::size_t j = n; j < 2 * n; ++j) fastest = std::max(fastest, std::abs(b[j]));
    for (std::size_t j = 0; j < 2 * n; ++j)
      worst = std::max(worst, std::abs(a[j] - b[j]) / (j < n ? 1 : fastest));
  }
  return worst;
}

/// The parts of the motion that are columns of the table.
struct Extent {
  const char* name;
  std::size_t stretches; ///< number of stretches from release
  std::size_t judged;    ///< number of stretches whose ends are compared
};

struct Point {
  double error, evaluations, alone, in_lanes; ///< the last two in µs a run
};

/// Least time of a call, µs.
template <class Call> double least_time(int rounds, Call&& call) {
  using Clock = std::chrono::steady_clock;
  double best = 1e300;
  for (int round = 0; round < rounds; ++round) {
    const auto start = Clock::now();
    call();
    best = std::min(best, std::chrono::duration<double, std::micro>(Clock::now() - start).count());
  }
  return best;
}

/// One method at all tolerances.
struct Method {
  std::string name;
  int order; ///< of a Taylor series; unused by others
  Walk (*alone)(Wanderer<double>&, const std::vector<Stretch>&, double, int);
  Walk (*in_lanes)(Wanderer<Pack<4>>&, const std::vector<Stretch>&, double, int);
};

std::vector<Method> all_methods() {
  std::vector<Method> all{
      {"dop853", 0, &walk<double, DormandPrince853>, &walk<Pack<4>, DormandPrince853>},
      {"verner98", 0, &walk<double, Verner98Formula>, &walk<Pack<4>, Verner98Formula>},
      {"verner87", 0, &walk<double, Verner87Formula>, &walk<Pack<4>, Verner87Formula>},
      {"taylor", 0, &walk<double, TaylorSeries>, &walk<Pack<4>, TaylorSeries>}}; // the method
  for (const int order : {10, 12, 14, 16, 18, 20, 24, 28})
    all.push_back(
        {fmt::format("taylor{}", order), order, &walk_by_series<double>, &walk_by_series<Pack<4>>});
  return all;
}

using Curve = std::vector<Point>;

/// Work at a given error, interpolated between a curve's points; NaN outside their range.
double at_error(const Curve& curve, double error, double Point::*figure) {
  double best = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t k = 1; k < curve.size(); ++k) {
    const Point &loose = curve[k - 1], &tight = curve[k];
    if (!(loose.error >= error && tight.error <= error)) continue;
    const double part = std::log(loose.error / error) / std::log(loose.error / tight.error);
    const double found = loose.*figure * std::pow(tight.*figure / (loose.*figure), part);
    best = std::fmin(best, found);
  }
  return best;
}

struct Study {
  Scene scene = seed_wing();
  std::vector<Stretch> way = stretches_of(scene);
  Walk reference = {};
  std::vector<double> tolerances = {};
  int rounds;
};

Curve measure(const Study& study, const Method& method, const Extent& extent) {
  const std::vector<Stretch> way(study.way.begin(), study.way.begin() + extent.stretches);
  Wanderer<double> one(study.scene);
  Wanderer<Pack<4>> four(study.scene);
  Curve curve;
  for (const double rtol : study.tolerances) {
    Walk walk;
    const double alone =
        least_time(study.rounds, [&] { walk = method.alone(one, way, rtol, method.order); });
    const double lanes =
        least_time(study.rounds, [&] { (void)method.in_lanes(four, way, rtol, method.order); });
    curve.push_back({error_of(walk, study.reference, extent.judged),
                     static_cast<double>(walk.evaluations.back()), alone, lanes / 4});
  }
  return curve;
}

void print_extent(const Study& study, const Extent& extent, Table& table) {
  constexpr std::array errors{1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13};
  fmt::print("\n{}: evaluations (series: steps) at an error | µs a run in packs of four | alone\n",
             extent.name);
  for (const Method& method : all_methods()) {
    const Curve curve = measure(study, method, extent);
    for (std::size_t k = 0; k < curve.size(); ++k)
      table.add({extent.name, method.name, study.tolerances[k], curve[k].error,
                 curve[k].evaluations, curve[k].alone, curve[k].in_lanes});
    std::string line = fmt::format("  {:<9}", method.name);
    for (const double error : errors)
      line += fmt::format("{:>7.0f}", at_error(curve, error, &Point::evaluations));
    line += "  |";
    for (const double error : errors)
      line += fmt::format("{:>7.1f}", at_error(curve, error, &Point::in_lanes));
    line += "  |";
    for (const double error : errors)
      line += fmt::format("{:>7.0f}", at_error(curve, error, &Point::alone));
    fmt::print("{}\n", line);
    std::fflush(stdout);
  }
}

/// The largest violation of a pair's order conditions: row sums and quadratures of t^k.
template <class Pair> double residual() {
  double worst = 0;
  for (int i = 0; i < Pair::stages; ++i) {
    double sum = -Pair::nodes[i];
    for (const double a : Pair::a[i]) sum += a;
    worst = std::max(worst, std::abs(sum));
  }
  for (int k = 0; k < Pair::order; ++k) {
    double sum = -1.0 / (k + 1);
    for (int i = 0; i < Pair::stages; ++i) sum += Pair::b[i] * std::pow(Pair::nodes[i], k);
    worst = std::max(worst, std::abs(sum));
  }
  return worst;
}

void carry_out(const StudyOptions& options) {
  fmt::print("order conditions: 9(8) to {:.0e}, 8(7) to {:.0e}\n", residual<Verner98>(),
             residual<Verner87>());
  Study study{.rounds = options.quick ? 3 : 20};
  Wanderer<long double> fine(study.scene);
  study.reference = walk_by_series(fine, study.way, 1e-18, 30);
  Wanderer<long double> other(study.scene);
  const Walk check = walk<long double, DormandPrince853>(other, study.way, 1e-15, 0);
  const double doubt = error_of(check, study.reference, study.way.size() - 1);
  fmt::print("reference: order 30 in extended precision; dop853 at 1e-15 is {:.0e} off\n", doubt);
  if (!(doubt < 1e-14)) throw std::runtime_error("the references disagree");
  for (double exponent = -5; exponent >= -14; exponent -= options.quick ? 1 : 0.5)
    study.tolerances.push_back(std::pow(10, exponent));
  const std::size_t all = study.way.size();
  Table table({"extent", "method", "rtol", "error", "evaluations", "alone [us]", "in packs [us]"});
  for (const Extent& extent :
       {Extent{"A: to the first latch", 1, 1}, Extent{"to the last latch", all - 1, all - 1},
        Extent{"B: with the early stop", all, all - 1}})
    print_extent(study, extent, table);
  table.write(options.folder / "higher_orders.csv");
}

} // namespace

int main(int count, char** arguments) {
  return run_study(count, arguments, "higher_orders",
                   "What formulas of higher order and Taylor series would cost at equal error",
                   carry_out);
}
