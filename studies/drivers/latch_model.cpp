// Measures peak moments and latch rates of the smoothed latch against its width ε, and its convergence to the event
// latch.
//
//   build/release/studies/latch_model                    results/latch_model, some minutes
//   build/release/studies/latch_model --quick            three widths
//   /usr/bin/python3 studies/plots/plot_accuracy.py results/latch_model
//
// Runs the seed wing to t = 12 s. The reference with the event latch comes from an oracle (a dense formulation in 64-bit
// precision). The runs with the smoothed latch come from core/; the oracle in double by CVODE checks them.

#include "studies/support/precision_measurement.hpp"
#include "studies/support/precision_references.hpp"
#include "studies/support/study.hpp"
#include "tests/support/reference_run.hpp"

#include <fmt/format.h>

using namespace wingspread;
using namespace wingspread::study;

namespace {

std::vector<double> widths(bool quick) {
  if (quick) return {1e-2, 1e-3, 1e-4};
  std::vector<double> all; // rad, two a decade
  for (int half = 2; half <= 10; ++half) all.push_back(std::pow(10., -0.5 * half));
  return all;
}

constexpr double rtol = 1e-12, atol = 1e-14;

Figures event_figures(const Scene& scene, bool quick) {
  oracle::ReferenceOptions options;
  options.rtol = quick ? 1e-12 : 1e-15, options.atol = 0.1 * options.rtol;
  options.t_end = seed_t_end;
  return figures_of(oracle::high_precision_run<long double>(scene, options), scene.hinges.size());
}

Figures smoothed_figures(const Scene& scene, const std::string& method, double epsilon) {
  Integration how;
  how.method = method, how.rtol = rtol, how.atol = atol;
  how.t_end = seed_t_end, how.smoothing = epsilon;
  Deployment deployment;
  const Outcome outcome = deployment.run(scene, how, goal_of(Extent::moments));
  if (outcome.status != Status::deployed) throw std::runtime_error(outcome.reason);
  return figures_of(outcome, scene.hinges.size());
}

Figures oracle_figures(const Scene& scene, double epsilon) {
  oracle::ReferenceOptions options;
  options.rtol = rtol, options.atol = 1e-13;
  options.t_end = seed_t_end, options.smoothing = epsilon;
  return figures_of(oracle::cvode_run(scene, options), scene.hinges.size());
}

double relative(double got, double expected) { return (got - expected) / std::abs(expected); }

/// One width: changes of peak moment and latch rate at every hinge.
void add_width(Table& table, const Scene& scene, const Figures& event, double epsilon) {
  const Figures smoothed = smoothed_figures(scene, "dop853", epsilon);
  const Disagreement check = disagreement(oracle_figures(scene, epsilon), smoothed);
  fmt::print("  {:>7.0e}", epsilon);
  for (std::size_t i = 0; i < scene.hinges.size(); ++i) {
    const double time = relative(smoothed.time[i], event.time[i]);
    const double rate = relative(std::abs(smoothed.rate[i]), std::abs(event.rate[i]));
    const double moment = relative(smoothed.moment[i], event.moment[i]);
    table.add({epsilon, scene.hinges[i].name, smoothed.time[i], smoothed.rate[i],
               smoothed.moment[i], time, rate, moment, check.time, check.rate, check.moment});
    fmt::print("  {:>+10.2e} {:>+10.2e}", rate, moment);
  }
  fmt::print("  {:>8.0e} {:>8.0e}\n", check.rate, check.moment);
  std::fflush(stdout);
}

void print_header(const Scene& scene) {
  fmt::print("Smoothed against event latch, relative\n  ε, rad ");
  for (const Hinge& hinge : scene.hinges)
    fmt::print("  {:>10} {:>10}", hinge.name + " rate", "peak");
  fmt::print("  CVODE: rate, peak\n");
}

void latch_model(const StudyOptions& options) {
  const Scene scene = seed_wing();
  const Figures event = event_figures(scene, options.quick);
  print_header(scene);
  Table table{"epsilon [rad]",     "hinge",       "latch time [s]", "latch rate [rad/s]",
              "peak moment [N·m]", "time change", "rate change",    "moment change",
              "time check",        "rate check",  "moment check"};
  for (std::size_t i = 0; i < scene.hinges.size(); ++i) // ε = 0: the event latch
    table.add({0., scene.hinges[i].name, event.time[i], event.rate[i], event.moment[i], 0., 0., 0.,
               0., 0., 0.});
  for (const double epsilon : widths(options.quick)) add_width(table, scene, event, epsilon);
  table.write(options.folder / "latch_model.csv");
}

} // namespace

int main(int count, char** arguments) {
  return run_study(count, arguments, "latch_model",
                   "The smoothed latch against the event latch that it tends to", latch_model);
}
