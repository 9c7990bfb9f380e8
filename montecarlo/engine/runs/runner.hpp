/// One run of a campaign, and the row of the results that it gives. The evaluator that makes all
/// runs and the replay that makes one again both go through here, so they cannot differ.
///
///   run k → draws → scene → core's Deployment → Outcome → ResultRow
#pragma once

#include "montecarlo/engine/runs/run_plan.hpp"

#include <functional>
#include <optional>
#include <vector>

namespace wingspread {

/// Makes runs one after another; each thread has its own.
class Runner {
public:
  /// @pre the plan outlives the runner
  explicit Runner(const RunPlan& plan);

  /// Run k's row. An unphysical draw gives a row of status `invalid`.
  [[nodiscard]] ResultRow run(long k);

  /// Run k in full, with its row: watched, and with its energy audited, neither of which changes a
  /// bit of the row.
  struct Replay {
    Outcome outcome;
    ResultRow row;
  };
  [[nodiscard]] Replay replay(long k, const Observer& observer);

  /// The rows of the runs that `next` names until it names none, several at once; each row is that
  /// of `run`. @param done takes them in the order in which they end
  Occupancy run_all(InstructionSet set, const std::function<std::optional<long>()>& next,
                    const std::function<void(ResultRow&&)>& done);

private:
  [[nodiscard]] Replay make(long k, const Goal& goal, const Observer& observer);
  /// Draws for run k into `draws` and sets the scene to it.
  void set_scene(long k, std::vector<double>& draws, Scene& scene) const;
  [[nodiscard]] ResultRow row_of(long k, std::vector<double>&& draws, Outcome& outcome);
  [[nodiscard]] std::vector<double> outputs_of(std::span<const double> draws,
                                               const Outcome& outcome);

  const RunPlan* plan_;
  Deployment deployment_;
  Scene scene_; ///< of some run: the campaign's, as `apply` left it
};

} // namespace wingspread
