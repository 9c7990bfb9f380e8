// Measures cost and error of runs against the stiffness and damping of the latches, and the cost of ringing.
//
//   build/release/studies/stiffness                      results/stiffness, some ten minutes
//   build/release/studies/stiffness --quick              four latches, three methods
//   /usr/bin/python3 studies/plots/plot_accuracy.py results/stiffness
//
// All three latches of the seed wing get the same stiffness k and damping d; runs go to t = 12 s,
// with peak moments.

#include "studies/support/precision_measurement.hpp"
#include "studies/support/precision_references.hpp"
#include "studies/support/ringing.hpp"
#include "studies/support/study.hpp"
#include "tests/support/reference_run.hpp"

#include <fmt/format.h>

#include <numbers>

using namespace wingspread;
using namespace wingspread::study;

namespace {

/// A latch, and the reference run of the seed wing with it.
struct Point {
  double stiffness, damping; ///< N·m/rad, N·m·s/rad
  Scene scene;
  Figures reference;
};

struct Plan {
  std::vector<double> stiffnesses, dampings, tolerances, loose_tolerances;
  std::vector<std::string> methods;
  std::vector<std::pair<double, double>> corner; ///< (k, d) of wings that ring
  double reference_rtol, cvode_rtol;
};

Plan plan_of(bool quick) {
  if (quick)
    return {{1e4, 1e6},   {1e2, 1e4}, {1e-6, 1e-8}, {1e-2, 1e-5}, {"auto", "dopri5", "seulex"},
            {{1e6, 1e2}}, 1e-11,      1e-9};
  Plan plan{{},
            {1e2, 1e3, 1e4, 1e5},
            {1e-6, 1e-8},
            {},
            {"auto", "dopri5", "cash_karp54", "dop853", "fehlberg78", "bulirsch_stoer",
             "adams_bashforth_moulton", "rosenbrock_w", "seulex"},
            {},
            1e-13,
            1e-12};
  for (int decade = 4; decade <= 9; ++decade) plan.stiffnesses.push_back(std::pow(10., decade));
  for (int decade = 1; decade <= 10; ++decade)
    plan.loose_tolerances.push_back(std::pow(10., -decade));
  for (const double d : {1e2, 1e3})
    for (const double k : {1e7, 1e8, 1e9}) plan.corner.emplace_back(k, d);
  return plan;
}

Integration integration_of(const std::string& method, double rtol) {
  Integration how;
  how.method = method, how.rtol = rtol, how.atol = 1e-2 * rtol, how.t_end = seed_t_end;
  return how;
}

// ---- references

constexpr long reference_steps = 10'000'000;

Figures product_figures(const Scene& scene, const std::string& method, double rtol) {
  Integration how = integration_of(method, rtol);
  how.max_steps = reference_steps;
  Deployment deployment;
  return figures_of(deployment.run(scene, how, goal_of(Extent::moments)), scene.hinges.size());
}

/// The same run by another formulation, in absolute angles, and another integrator.
Figures cvode_figures(const Scene& scene, double damping, double rtol) {
  oracle::ReferenceOptions options;
  options.rtol = rtol, options.atol = 0.1 * rtol, options.t_end = seed_t_end;
  options.stiff = damping > 2e3;
  return figures_of(oracle::cvode_run(scene, options), scene.hinges.size());
}

/// References by dop853; their differences from fehlberg78 and CVODE bound their error.
class References {
public:
  explicit References(const Plan& plan) : plan_(plan) {}

  [[nodiscard]] Point make(double k, double d) {
    Point point{k, d, seed_wing(k, d), {}};
    point.reference = product_figures(point.scene, "dop853", plan_.reference_rtol);
    check(point, "fehlberg78",
          product_figures(point.scene, "fehlberg78", 10 * plan_.reference_rtol));
    check(point, "cvode", cvode_figures(point.scene, d, plan_.cvode_rtol));
    return point;
  }

  void write(const std::filesystem::path& file) const { table_.write(file); }

private:
  void check(const Point& point, const std::string& other, const Figures& figures) {
    const Disagreement off = disagreement(figures, point.reference);
    if (!off.same_order)
      throw std::runtime_error(fmt::format("the references of k = {:g}, d = {:g} differ in order",
                                           point.stiffness, point.damping));
    table_.add({point.stiffness, point.damping, other, off.time, off.rate, off.moment});
    fmt::print("  {:>6.0e} {:>6.0e} {:<10} {:>8.1e} {:>8.1e} {:>8.1e}\n", point.stiffness,
               point.damping, other, off.time, off.rate, off.moment);
    std::fflush(stdout);
  }

  const Plan& plan_;
  Table table_{"k [N·m/rad]",    "d [N·m·s/rad]",  "checked by",
               "time disagrees", "rate disagrees", "moment disagrees"};
};

// ---- cost and error of the methods

Run run_of(const std::string& method) {
  const auto deployment = std::make_shared<Deployment>();
  return [deployment, method](const Scene& scene, Integration how, const Goal& goal) {
    how.method = method;
    return deployment->run(scene, how, goal);
  };
}

Measurement measure(const Point& point, const std::string& method, double rtol) {
  constexpr double patience = 0.005; // s
  return measure(run_of(method), std::span(&point.scene, 1), std::span(&point.reference, 1),
                 integration_of(method, rtol), Extent::moments, patience);
}

/// The largest relative error of all quantities; NaN where the run has none.
double worst(const Measurement& m) {
  if (m.scored == 0) return std::numeric_limits<double>::quiet_NaN();
  return std::max({m.errors.time.largest, m.errors.rate.largest, m.errors.moment.largest});
}

std::string ending(const Measurement& m) {
  return m.failures > 0 ? "failed" : m.mismatches > 0 ? "other order" : "deployed";
}

/// The number as text, "–" for NaN.
std::string shown(double value, const char* form) {
  return std::isnan(value) ? "–" : fmt::format(fmt::runtime(form), value);
}

class CostTable {
public:
  void add(const Point& point, const std::string& method, double rtol) {
    const Measurement m = measure(point, method, rtol);
    const double none = std::numeric_limits<double>::quiet_NaN();
    const bool scored = m.scored > 0;
    table_.add({point.stiffness, point.damping, method, rtol, ending(m), m.reason,
                scored ? m.evaluations : none, scored ? m.steps : none, m.microseconds,
                scored ? m.errors.time.largest : none, scored ? m.errors.rate.largest : none,
                scored ? m.errors.moment.largest : none});
    fmt::print("  {:>6.0e} {:>6.0e} {:>6.0e} {:<24} {:>9} {:>9} {:>11} {:>9}\n", point.stiffness,
               point.damping, rtol, method, shown(m.evaluations, "{:.0f}"),
               shown(m.steps, "{:.0f}"), shown(m.microseconds, "{:.1f}"),
               shown(worst(m), "{:.1e}"));
    std::fflush(stdout);
  }
  void write(const std::filesystem::path& file) const { table_.write(file); }

private:
  Table table_{"k [N·m/rad]", "d [N·m·s/rad]", "method",      "rtol",
               "ending",      "reason",        "evaluations", "steps",
               "cpu [µs]",    "time error",    "rate error",  "moment error"};
};

void print_cost_header(const char* title) {
  fmt::print("\n{}\n       k      d   rtol {:<24} {:>9} {:>9} {:>11} {:>9}\n", title, "method",
             "evals", "steps", "us", "error");
}

// ---- ringing

/// Evaluations of each method for one cycle of an undamped oscillation.
void measure_price(const Plan& plan, const std::filesystem::path& file) {
  const PureTone tone = pure_tone();
  Table table{"method", "rtol", "evaluations a cycle", "phase error [cycles]"};
  fmt::print("\nThe price of an oscillation, evaluations a cycle\n");
  for (const double rtol : plan.tolerances)
    for (const std::string& method : plan.methods) {
      Integration how = integration_of(method, rtol);
      how.t_end = tone.t_end;
      const Outcome outcome = run_of(method)(tone.scene, how, goal_of(Extent::moments));
      const bool ended = outcome.status == Status::deployed; // else out of steps
      const double none = std::numeric_limits<double>::quiet_NaN();
      const double price =
          ended ? static_cast<double>(outcome.work.rhs_evaluations) / tone.cycles : none;
      // at a whole number of cycles the angle is 0 again, and the rate what it was
      const double phase =
          std::atan2(outcome.final.angles[0] * tone.omega, outcome.final.rates[0]) /
          (2 * std::numbers::pi);
      table.add({method, rtol, price, ended ? phase : none});
      fmt::print("  {:>6.0e} {:<24} {:>8}  off by {} cycles after {:.0f}\n", rtol, method,
                 shown(price, "{:.1f}"), shown(ended ? phase : none, "{:.1e}"), tone.cycles);
    }
  table.write(file);
}

/// Evaluations of `auto` for each oscillation.
void measure_ringing(const std::vector<Point>& points, const Plan& plan,
                     const std::filesystem::path& file) {
  Table table{"k [N·m/rad]",
              "d [N·m·s/rad]",
              "rtol",
              "fastest [rad/s]",
              "cycles",
              "cycles seen",
              "periods",
              "evaluations",
              "cost over nominal",
              "evaluations a cycle",
              "three times nominal a cycle"};
  fmt::print(
      "\nRinging, and what auto spends on it\n       k      d   rtol  fastest   cycles   seen"
      "  periods    evals  over nominal  evals a cycle  in 3x nominal\n");
  for (const double rtol : plan.tolerances) {
    const double nominal = measure(points.front(), "auto", rtol).evaluations;
    for (const Point& point : points) {
      const Ringing ringing = ringing_of(point.scene, integration_of("auto", rtol));
      const double evaluations = measure(point, "auto", rtol).evaluations;
      const double a_cycle = evaluations / ringing.cycles, allowed = 3 * nominal / ringing.cycles;
      table.add({point.stiffness, point.damping, rtol, ringing.fastest, ringing.cycles,
                 ringing.seen, ringing.periods, evaluations, evaluations / nominal, a_cycle,
                 allowed});
      fmt::print("  {:>6.0e} {:>6.0e} {:>6.0e} {:>8.0f} {:>8.1f} {:>6.0f} {:>8.0f} {:>8.0f} "
                 "{:>13.2f} {:>14.1f} {:>14.1f}\n",
                 point.stiffness, point.damping, rtol, ringing.fastest, ringing.cycles,
                 ringing.seen, ringing.periods, evaluations, evaluations / nominal, a_cycle,
                 allowed);
    }
  }
  table.write(file);
}

/// The largest relative changes from one wing's figures to another's.
FigureErrors change(const Figures& from, const Figures& to) {
  FigureErrors errors;
  errors.add(to, from);
  return errors;
}

/// Measures how much ringing changes the later latches: against wings with damped ringing, and with another stiffness.
void measure_worth(const std::vector<Point>& corner, const Plan& plan,
                   const std::filesystem::path& file) {
  Table table{"k [N·m/rad]", "d [N·m·s/rad]", "k scaled by", "d scaled by",
              "time change", "rate change",   "same order"};
  fmt::print("\nWhat the ringing is worth: largest change of a latch time and rate\n"
             "       k      d  k scaled by  d scaled by      time      rate\n");
  const std::vector<std::pair<double, double>> scales{{1 + 1e-6, 1}, {1.001, 1}, {1, 10}, {1, 100}};
  for (const Point& point : corner)
    for (const auto& [k, d] : scales) {
      const Scene scene = seed_wing(k * point.stiffness, d * point.damping);
      const Figures got = product_figures(scene, "dop853", 10 * plan.reference_rtol);
      const FigureErrors off = change(point.reference, got);
      table.add({point.stiffness, point.damping, k, d, off.time.largest, off.rate.largest,
                 got.order == point.reference.order ? "yes" : "no"});
      fmt::print("  {:>6.0e} {:>6.0e} {:>12.6f} {:>12.0f} {:>9.1e} {:>9.1e}\n", point.stiffness,
                 point.damping, k, d, off.time.largest, off.rate.largest);
    }
  table.write(file);
}

// ---- the study

std::vector<Point> make_points(References& references, const Plan& plan) {
  std::vector<Point> points;
  for (const double d : plan.dampings)
    for (const double k : plan.stiffnesses) points.push_back(references.make(k, d));
  return points;
}

std::vector<Point> corner_of(const std::vector<Point>& points, const Plan& plan) {
  std::vector<Point> corner;
  for (const auto& [k, d] : plan.corner)
    corner.push_back(*std::ranges::find_if(
        points, [&](const Point& p) { return p.stiffness == k && p.damping == d; }));
  return corner;
}

void measure_costs(const std::vector<Point>& points, const Plan& plan,
                   const std::filesystem::path& file) {
  print_cost_header("Cost and largest relative error");
  CostTable table;
  for (const double rtol : plan.tolerances)
    for (const Point& point : points)
      for (const std::string& method : plan.methods) table.add(point, method, rtol);
  table.write(file);
}

/// Errors and costs of all methods at all tolerances for wings that ring.
void measure_corner(const std::vector<Point>& corner, const Plan& plan,
                    const std::filesystem::path& file) {
  print_cost_header("Wings that ring, at every tolerance");
  CostTable table;
  for (const Point& point : corner)
    for (const std::string& method : plan.methods)
      for (const double rtol : plan.loose_tolerances) table.add(point, method, rtol);
  table.write(file);
}

void stiffness(const StudyOptions& options) {
  const Plan plan = plan_of(options.quick);
  References references(plan);
  fmt::print("How far the references can be trusted: largest relative disagreement\n"
             "       k      d checked by     time     rate   moment\n");
  const std::vector<Point> points = make_points(references, plan);
  references.write(options.folder / "references.csv");
  const std::vector<Point> corner = corner_of(points, plan);
  measure_costs(points, plan, options.folder / "stiffness.csv");
  measure_ringing(points, plan, options.folder / "ringing.csv");
  measure_price(plan, options.folder / "price.csv");
  measure_worth(corner, plan, options.folder / "worth.csv");
  measure_corner(corner, plan, options.folder / "corner.csv");
}

} // namespace

int main(int count, char** arguments) {
  return run_study(count, arguments, "stiffness",
                   "Cost and error of the methods against the latches' stiffness and damping",
                   stiffness);
}
