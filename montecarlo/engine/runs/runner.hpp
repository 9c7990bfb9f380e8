/// Makes one run of a campaign and its row of results. The evaluator and `replay` both use the runner, so that their
/// rows cannot differ.
///
///   run k → draws → scene → core's Deployment → Outcome → ResultRow
#pragma once

#include "montecarlo/engine/runs/run_plan.hpp"

#include <functional>
#include <map>
#include <optional>
#include <vector>

namespace wingspread {

/// Makes runs one after another; one per thread.
class Runner {
public:
  /// @pre the plan outlives the runner
  explicit Runner(const RunPlan& plan);

  /// Run k's row. Unphysical draws give a row of status `invalid`.
  [[nodiscard]] ResultRow run(long k);

  /// A run's outcome and row, and the scene as the run's draws left it. Observing a run and auditing its energy change
  /// no bit of the row.
  struct Replay {
    Outcome outcome;
    ResultRow row;
    Scene scene{};
  };
  /// @param interval Goal::sample_interval, s; 0: every step
  [[nodiscard]] Replay replay(long k, const Observer& observer, double interval = 0);

  /// Integrates run k with another goal and end, for its samples. The observer may end the run with an exception, which
  /// passes through.
  Outcome watch(long k, const Goal& goal, double t_end, const Observer& observer);

  /// Makes several runs at once: takes run numbers from `next` until `next` returns nothing. Each row has the same bits
  /// as the row of run().
  /// @param done receives rows in the order in which runs end
  Occupancy run_all(InstructionSet set, const std::function<std::optional<long>()>& next,
                    const std::function<void(ResultRow&&)>& done);

private:
  [[nodiscard]] Replay make(long k, const Goal& goal, const Observer& observer);
  /// Draws run k into `draws` and applies the draws to the scene.
  void set_scene(long k, std::vector<double>& draws, Scene& scene) const;
  [[nodiscard]] ResultRow row_of(long k, std::vector<double>&& draws, Outcome& outcome);
  /// Takes the samples of runs, if the plan asks for them.
  [[nodiscard]] DeploymentPack::Watch make_watch();
  [[nodiscard]] std::vector<double> outputs_of(std::span<const double> draws,
                                               const Outcome& outcome);

  const RunPlan* plan_;
  Deployment deployment_;
  Scene scene_; ///< the campaign's scene, with the draws of the latest run applied
  std::optional<SampleTaker> taker_;
  std::map<long, std::vector<double>> samples_; ///< of the runs under way
};

} // namespace wingspread
