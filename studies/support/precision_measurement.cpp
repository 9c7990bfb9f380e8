#include "studies/support/precision_measurement.hpp"

#include <ctime>

namespace wingspread::study {
namespace {

/// Whether the run has the reference's latches, in the same order, and an expected status.
bool agrees(const Outcome& outcome, const Figures& got, const Figures& expected, int latches,
            Extent extent) {
  if (extent == Extent::first_latch)
    return got.order.size() == 1 && !expected.order.empty() && got.order[0] == expected.order[0];
  const bool deploys = std::ssize(expected.order) == latches;
  return got.order == expected.order && (outcome.status == Status::deployed) == deploys;
}

void score(Measurement& sum, const Scene& scene, const Outcome& outcome, const Figures& expected,
           Extent extent) {
  ++sum.scenes;
  if (outcome.status == Status::failed || outcome.status == Status::invalid) {
    ++sum.failures;
    if (sum.reason.empty()) sum.reason = outcome.reason;
    return;
  }
  const auto latches = std::ranges::count_if(
      scene.hinges, [](const Hinge& hinge) { return hinge.latch.has_value(); });
  const Figures got = figures_of(outcome, scene.hinges.size());
  if (!agrees(outcome, got, expected, static_cast<int>(latches), extent)) {
    ++sum.mismatches;
    return;
  }
  ++sum.scored;
  sum.errors.add(got, expected);
  sum.evaluations += static_cast<double>(outcome.work.rhs_evaluations);
  sum.steps += static_cast<double>(outcome.work.steps);
}

/// The processor time of f, s. Other programs on a busy machine change it less than wall time.
template <class Function> double time_of(const Function& f) {
  const std::clock_t start = std::clock();
  f();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

/// The least time of a pass over all scenes, s. Passes are repeated until there are three and they have taken `patience`
/// seconds, but end early once they have taken 40 times as long.
double best_pass(const Run& run, std::span<const Scene> scenes, const Integration& how,
                 const Goal& goal, double patience) {
  double best = std::numeric_limits<double>::infinity(), total = 0;
  for (int pass = 0; total < 40 * patience && (pass < 3 || total < patience); ++pass) {
    const double taken = time_of([&] {
      for (const Scene& scene : scenes) (void)run(scene, how, goal);
    });
    best = std::min(best, taken), total += taken;
  }
  return best;
}

} // namespace

Goal goal_of(Extent extent) {
  Goal goal{.peak_moment = false, .peak_force = false, .audit = false};
  goal.first_latch_only = extent == Extent::first_latch;
  goal.peak_moment = goal.to_t_end = extent != Extent::first_latch;
  goal.peak_force = extent == Extent::whole;
  return goal;
}

Measurement measure(const Run& run, std::span<const Scene> scenes,
                    std::span<const Figures> references, const Integration& how, Extent extent,
                    double patience) {
  const Goal goal = goal_of(extent);
  const double count = static_cast<double>(scenes.size());
  Measurement sum;
  const double scoring = time_of([&] {
    for (std::size_t k = 0; k < scenes.size(); ++k)
      score(sum, scenes[k], run(scenes[k], how, goal), references[k], extent);
  });
  sum.evaluations /= static_cast<double>(sum.scored), sum.steps /= static_cast<double>(sum.scored);
  const bool long_enough = scoring > 40 * patience; // then scoring itself hardly counts
  sum.microseconds = sum.scored == 0 ? std::numeric_limits<double>::quiet_NaN()
                     : long_enough   ? 1e6 * scoring / count
                                     : 1e6 * best_pass(run, scenes, how, goal, patience) / count;
  return sum;
}

} // namespace wingspread::study
