/// One run of a campaign, and the row of the results that it gives. The engine that makes all runs
/// and the replay that makes one again both go through here, so they cannot differ.
///
///   run k → draws → scene → core's Deployment → Outcome → ResultRow
#pragma once

#include "distributions/design.hpp"
#include "distributions/prepared_distribution.hpp"
#include "montecarlo/campaign/campaign.hpp"
#include "montecarlo/campaign/outputs.hpp"
#include "montecarlo/runs/results.hpp"

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace wingspread {

/// Another rule than the campaign's design that puts runs into the unit cube; pure.
/// @param u one for each dispersion in their order, to be set; each strictly within (0, 1)
using UnitPoints = std::function<void(long run, std::span<double> u)>;

/// What all runs of a campaign share, worked out once. Immutable, so one plan serves all threads.
class RunPlan {
public:
  /// @pre the campaign outlives the plan
  explicit RunPlan(const Campaign& campaign);
  /// The campaign's runs at other points than its own.
  RunPlan(const Campaign& campaign, UnitPoints points);

  [[nodiscard]] const Campaign& campaign() const { return *campaign_; }
  [[nodiscard]] const ResultNames& names() const { return names_; }
  [[nodiscard]] const std::vector<OutputColumn>& columns() const { return columns_; }

  /// The draws of run k, one for each dispersion in their order. Pure.
  /// @param draws as many as the campaign has dispersions
  void draw(long k, std::span<double> draws) const;

  /// From a point of the unit cube to the draws there, in place: dependence, then quantiles. Pure.
  void to_draws(std::span<double> point) const;

private:
  const Campaign* campaign_;
  std::vector<OutputColumn> columns_;
  ResultNames names_;
  std::vector<PreparedDistribution> distributions_;
  PreparedDesign design_;
  GaussianCopula copula_;
  UnitPoints points_; ///< empty: the design's
};

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
  [[nodiscard]] ResultRow row_of(long k, std::vector<double>&& draws, Outcome& outcome) const;

  const RunPlan* plan_;
  Goal goal_;
  Deployment deployment_;
  Scene scene_; ///< of the last run
};

} // namespace wingspread
