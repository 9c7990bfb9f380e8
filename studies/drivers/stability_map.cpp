// Finds the largest stable step of each method on the latched seed wing: by stepping near rest, by stepping
// through the motion after the last latch, and from |R(hλ)| ≤ 1.
//
//   build/release/studies/stability_map                  results/stability_map
//   build/release/studies/stability_map --quick          a coarse map
//   /usr/bin/python3 studies/plots/plot_accuracy.py results/stability_map

#include "core/deployment.hpp"
#include "core/mechanics/energy.hpp"
#include "studies/support/fixed_steps.hpp"
#include "studies/support/study.hpp"

#include <fmt/format.h>

using namespace wingspread;
using namespace wingspread::study;

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr double shortest = 1.5e-3, longest = 0.5; ///< s: steps that are tried
constexpr double scan = 1.05;                      ///< ratio of a tried step to the previous one

/// The largest step below which all steps are stable, to five digits; NaN if even the longest is stable.
/// @param stable(h)
template <class Stable> double largest_step(const Stable& stable) {
  double below = shortest, above = shortest;
  while (above <= longest && stable(above)) below = above, above *= scan;
  if (above > longest) return none;
  if (above == shortest) return 0;
  while (above - below > 1e-5 * above) {
    const double middle = 0.5 * (below + above);
    (stable(middle) ? below : above) = middle;
  }
  return below;
}

/// A step limit and the mode that sets it.
struct Limit {
  double h = none; ///< s; NaN: no limit up to the longest step
  Eigenvalue mode{none, none};
};

/// The limit by |R(hλ)| ≤ 1 for every mode of the wing.
Limit theoretical_limit(const FixedStepMethod& method, const std::vector<Eigenvalue>& modes) {
  constexpr double rounding = 1e-9;
  Limit least;
  for (const Eigenvalue& mode : modes) {
    const double h =
        largest_step([&](double step) { return method.growth(step * mode) <= 1 + rounding; });
    if (!std::isnan(h) && !(h >= least.h)) least = {h, mode};
  }
  return least;
}

/// An initial state of the latched wing, and the duration of the test.
struct Motion {
  State<double> x;
  double duration;   ///< s
  long fewest_steps; ///< steps to take at least, even beyond the duration
};

/// Kinetic energy and the energy of latches and springs above rest, J. Exact motions never increase it.
double energy_above(LinearWing& wing, const State<double>& x, double at_rest) {
  return kinetic_energy(wing.system(), x, 0.0) + potential_energy(wing.system(), x, 0.0) - at_rest;
}

/// Whether the mean energy of the last tenth of the steps is below that of the first.
bool stays_bounded(LinearWing& wing, const FixedStepMethod& method, const Motion& motion,
                   double h) {
  const double at_rest = potential_energy(wing.system(), wing.rest(), 0.0);
  const long steps = std::max(motion.fewest_steps, static_cast<long>(motion.duration / h));
  const Step step = method.start();
  State<double> x = motion.x;
  const double first = energy_above(wing, x, at_rest);
  double last = 0;
  for (long k = 0; k < steps; ++k) {
    step(wing.system(), x, h);
    const double energy = energy_above(wing, x, at_rest);
    if (!(energy < 1e6 * first)) return false; // it runs away
    if (10 * k >= 9 * steps) last = std::max(last, energy);
  }
  return last <= first;
}

/// Length of the stable part of a half-axis of the z plane, to 0.01; NaN if all of it is stable. Growth below 1e-6 a
/// step counts as none: on the imaginary axis most explicit formulas grow by a power of |z|.
double axis_limit(const FixedStepMethod& method, const std::complex<double>& direction) {
  constexpr double rounding = 1e-6, step = 0.01, end = 20;
  for (double size = step; size < end; size += step)
    if (method.growth(size * direction) > 1 + rounding) return size - step;
  return none;
}

/// The state just after the last latch.
State<double> after_last_latch(const Scene& scene, const LinearWing& wing) {
  Integration how;
  how.method = "dop853", how.rtol = 1e-12, how.atol = 1e-14;
  Deployment deployment;
  std::vector<Sample> samples;
  const Outcome outcome =
      deployment.run(scene, how, {.peak_moment = false, .peak_force = false, .audit = false},
                     [&](const Sample& sample) { samples.push_back(sample); });
  const auto at = std::ranges::find(samples, outcome.latches.back().time, &Sample::t);
  return wing.state(at->angles, at->rates);
}

/// Near rest: every mode moves, with amplitudes so small that only linear terms matter.
Motion near_rest(const LinearWing& wing, long steps) {
  Motion motion{wing.rest(), 0, steps};
  const std::size_t n = motion.x.size() / 2;
  for (std::size_t i = 0; i < n; ++i) motion.x[n + i] += (i % 2 == 0 ? 1e-5 : -1e-5);
  return motion;
}

/// All limits of one method.
struct Limits {
  double near_rest, moving; ///< measured, s
  Limit theory;
  double real, imaginary; ///< |z| on the half-axes
};

Limits limits_of(LinearWing& wing, const FixedStepMethod& method, const Motion& rest,
                 const Motion& latched) {
  const auto measured = [&](const Motion& motion) {
    return largest_step([&](double h) { return stays_bounded(wing, method, motion, h); });
  };
  return {measured(rest), measured(latched),
          theoretical_limit(method, wing.eigenvalues(wing.rest())), axis_limit(method, -1),
          axis_limit(method, {0, 1})};
}

void print_header(const std::vector<Eigenvalue>& modes) {
  fmt::print("Modes of the latched wing, 1/s:");
  for (const Eigenvalue& mode : modes) fmt::print("  {:.3f} ± {:.3f}i", mode.real(), mode.imag());
  fmt::print("\n\nLargest stable step, ms, and |hλ| on the half-axes\n  {:<24} order  near rest  "
             "after the latch  |R| ≤ 1   real  imaginary\n",
             "method");
}

/// "none" where there is no limit.
std::string shown(double limit) {
  return std::isnan(limit) ? "none" : fmt::format("{:.2f}", limit);
}

void print(const FixedStepMethod& method, const Limits& limits) {
  fmt::print("  {:<24} {:>5} {:>10} {:>16} {:>8} {:>6} {:>10}\n", method.name, method.order,
             shown(1e3 * limits.near_rest), shown(1e3 * limits.moving),
             shown(1e3 * limits.theory.h), shown(limits.real), shown(limits.imaginary));
  std::fflush(stdout);
}

std::vector<Limits> find_limits(const std::vector<FixedStepMethod>& methods, const Scene& scene,
                                long steps) {
  LinearWing wing(scene);
  wing.engage_all();
  const Motion rest = near_rest(wing, steps);
  const Motion latched{after_last_latch(scene, wing), 5.2, 10};
  print_header(wing.eigenvalues(wing.rest()));
  std::vector<Limits> all;
  for (const FixedStepMethod& method : methods) {
    all.push_back(limits_of(wing, method, rest, latched));
    print(method, all.back());
  }
  return all;
}

void write_limits(const std::vector<FixedStepMethod>& methods, const std::vector<Limits>& limits,
                  const std::filesystem::path& file) {
  Table table{"method",
              "order",
              "evaluations a step",
              "near rest [s]",
              "after the last latch [s]",
              "theory [s]",
              "limiting mode re [1/s]",
              "limiting mode im [1/s]",
              "real axis |z|",
              "imaginary axis |z|"};
  for (std::size_t k = 0; k < methods.size(); ++k) {
    const Limits& its = limits[k];
    table.add({methods[k].name, static_cast<double>(methods[k].order), methods[k].evaluations,
               its.near_rest, its.moving, its.theory.h, its.theory.mode.real(),
               its.theory.mode.imag(), its.real, its.imaginary});
  }
  table.write(file);
}

/// Window of a method's map. Implicit methods are unstable in the right half-plane, so their window is larger.
struct Window {
  double left, right, top;
};
Window window_of(const std::string& method) {
  if (method == "rosenbrock_w") return {-4, 12, 8};
  if (method == "seulex") return {-20, 80, 50};
  if (method == "bulirsch_stoer") return {-10, 4, 9};
  if (method == "adams_bashforth_moulton") return {-3, 1, 2};
  return {-7, 3, 7};
}

/// |R| over the upper half of the window; the lower one is its mirror image.
void write_regions(const std::vector<FixedStepMethod>& methods, int points,
                   const std::filesystem::path& file) {
  Table table{"method", "order", "re z", "im z", "growth a step"};
  for (const FixedStepMethod& method : methods) {
    const Window window = window_of(method.name);
    for (int column = 0; column < points; ++column)
      for (int row = 0; row < points; ++row) {
        const double re = window.left + (window.right - window.left) * column / (points - 1);
        const double im = window.top * row / (points - 1);
        table.add(
            {method.name, static_cast<double>(method.order), re, im, method.growth({re, im})});
      }
  }
  table.write(file);
}

/// The modes at each method's limit.
void write_modes(const std::vector<FixedStepMethod>& methods, const std::vector<Limits>& limits,
                 const std::vector<Eigenvalue>& modes, const std::filesystem::path& file) {
  Table table{"method", "order", "re λ [1/s]", "im λ [1/s]", "re hλ", "im hλ", "growth a step"};
  for (std::size_t k = 0; k < methods.size(); ++k)
    for (const Eigenvalue& mode : modes) {
      const double h = limits[k].theory.h;
      const Eigenvalue z = h * mode;
      table.add({methods[k].name, static_cast<double>(methods[k].order), mode.real(), mode.imag(),
                 z.real(), z.imag(), std::isnan(h) ? none : methods[k].growth(z)});
    }
  table.write(file);
}

void stability_map(const StudyOptions& options) {
  const Scene scene = seed_wing();
  const std::vector<FixedStepMethod> methods = fixed_step_methods();
  const std::vector<Limits> limits = find_limits(methods, scene, options.quick ? 300 : 4000);
  LinearWing wing(scene);
  wing.engage_all();
  write_limits(methods, limits, options.folder / "limits.csv");
  write_modes(methods, limits, wing.eigenvalues(wing.rest()), options.folder / "modes.csv");
  write_regions(methods, options.quick ? 41 : 161, options.folder / "regions.csv");
}

} // namespace

int main(int count, char** arguments) {
  return run_study(count, arguments, "stability_map",
                   "The largest stable step of every method on the latched seed wing",
                   stability_map);
}
