/// What all runs of a campaign share: where each is drawn, how far it goes, and what is kept of it.
///
///   run k → point of the unit cube → dependence → quantiles → draws (→ scene: campaign.hpp)
#pragma once

#include "distributions/design.hpp"
#include "distributions/prepared_distribution.hpp"
#include "montecarlo/engine/runs/results.hpp"
#include "montecarlo/model/campaign/campaign.hpp"
#include "montecarlo/model/campaign/outputs.hpp"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace wingspread {

/// Another rule than the campaign's design that puts runs into the unit cube; pure.
/// @param u one for each dispersion in their order, to be set, by both of its tails: each > 0
using UnitPoints = std::function<void(long run, std::span<Tails> u)>;

/// One number to take of a run in place of the campaign's outputs.
struct Measure {
  std::string name;
  Goal goal; ///< what a run has to compute for it
  /// Of the scene that was run; pure. Kept as it is, NaN and infinity too.
  std::function<double(const Scene&, const Outcome&)> of;
  std::string recipe{}; ///< what another process makes it of; empty: none can
};

/// Makes a measure from its recipe, in a process that has the campaign and not the measure.
/// @pre the campaign outlives the measure. @throws what making it takes
using MeasureMaker = std::function<Measure(const Campaign& campaign, const std::string& recipe)>;

/// Immutable, so one plan serves all threads.
class RunPlan {
public:
  /// @pre the campaign outlives the plan
  explicit RunPlan(const Campaign& campaign);
  /// The campaign's runs at other points than its own.
  RunPlan(const Campaign& campaign, UnitPoints points);
  /// Besides, all that is kept of them is the measure: the only column of outputs.
  RunPlan(const Campaign& campaign, UnitPoints points, Measure measure);

  [[nodiscard]] const Campaign& campaign() const { return *campaign_; }
  [[nodiscard]] const ResultNames& names() const { return names_; }
  /// The campaign's own columns of outputs, where no measure is in their place.
  [[nodiscard]] const std::vector<OutputColumn>& columns() const { return columns_; }
  [[nodiscard]] const std::optional<Measure>& measure() const { return measure_; }
  /// What a run has to compute.
  [[nodiscard]] const Goal& goal() const { return goal_; }

  /// The draws of run k, one for each dispersion in their order. Pure.
  /// @param draws as many as the campaign has dispersions
  void draw(long k, std::span<double> draws) const;

  /// Whether its points are others than those of the campaign's design.
  [[nodiscard]] bool has_own_points() const { return bool(points_); }
  /// Run k's point of the unit cube. Pure. @param u as many as there are dispersions
  void place(long k, std::span<Tails> u) const;

private:
  const Campaign* campaign_;
  std::vector<OutputColumn> columns_;
  std::optional<Measure> measure_;
  Goal goal_;
  ResultNames names_;
  std::vector<PreparedDistribution> distributions_;
  PreparedDesign design_;
  GaussianCopula copula_;
  UnitPoints points_; ///< empty: the design's
};

} // namespace wingspread
