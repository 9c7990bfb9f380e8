/// The plan that all runs of a campaign share: how to draw them, what to compute, and which outputs to keep.
///
///   run k → point of the unit cube → copula → quantiles → draws (→ scene: campaign.hpp)
#pragma once

#include "distributions/design.hpp"
#include "distributions/prepared_distribution.hpp"
#include "montecarlo/engine/runs/results.hpp"
#include "montecarlo/engine/runs/sampled_motion.hpp"
#include "montecarlo/model/campaign/campaign.hpp"
#include "montecarlo/model/campaign/outputs.hpp"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace wingspread {

/// A rule that places runs in the unit cube, in place of the campaign's design. Pure.
/// @param u output, in the order of coordinates_of(dispersions), each given by both tail probabilities, > 0
using UnitPoints = std::function<void(long run, std::span<Tails> u)>;

/// The coordinate of a point z of the standard normal law, by both tails: Φ(z) and 1 − Φ(z), both above 0. Both are
/// needed: beyond z = 8.2, Φ rounds to 1, and only 1 − Φ distinguishes points.
[[nodiscard]] Tails unit_point(double z);

/// A single number computed from a run, in place of the campaign's outputs.
struct Measure {
  std::string name;
  Goal goal; ///< what a run has to compute for it
  /// Computes the number from the scene that was run and its outcome; pure. NaN and infinity are kept.
  std::function<double(const Scene&, const Outcome&)> of;
  /// Text from which a MeasureMaker rebuilds the measure in another process; empty: the measure cannot be rebuilt.
  std::string recipe{};
};

/// Rebuilds a measure from its recipe in another process.
/// @pre the campaign outlives the measure
/// @throws what the measure's constructor throws
using MeasureMaker = std::function<Measure(const Campaign& campaign, const std::string& recipe)>;

/// Immutable, so all threads share one plan.
class RunPlan {
public:
  /// @pre the campaign outlives the plan
  explicit RunPlan(const Campaign& campaign);
  /// The campaign's runs at these points instead of those of its design.
  RunPlan(const Campaign& campaign, UnitPoints points);
  /// As above, with the measure as the only output column.
  RunPlan(const Campaign& campaign, UnitPoints points, Measure measure);
  /// As above, with samples of the motion instead of outputs. ResultRow::outputs then has the numbers of a SampleTaker,
  /// and is empty if the run failed or was invalid.
  RunPlan(const Campaign& campaign, UnitPoints points, SampledColumns samples);

  [[nodiscard]] const Campaign& campaign() const { return *campaign_; }
  [[nodiscard]] const ResultNames& names() const { return names_; }
  /// The campaign's output columns; empty if a measure replaces them.
  [[nodiscard]] const std::vector<OutputColumn>& columns() const { return columns_; }
  [[nodiscard]] const std::optional<Measure>& measure() const { return measure_; }
  /// The columns that runs sample instead of outputs; nothing if runs have outputs.
  [[nodiscard]] const std::optional<SampledColumns>& samples() const { return samples_; }
  /// How runs are integrated: as the campaign says, to the end of their samples.
  [[nodiscard]] const Integration& integration() const { return integration_; }
  /// The goal of every run: which results `core` computes.
  [[nodiscard]] const Goal& goal() const { return goal_; }

  /// The draws of run k. Pure. @throws std::out_of_range where a Latin hypercube has fewer runs
  /// @param draws output, one per dispersion in order
  void draw(long k, std::span<double> draws) const;

  /// Whether UnitPoints replace the campaign's design.
  [[nodiscard]] bool has_own_points() const { return bool(points_); }
  /// The coordinates of the unit cube.
  [[nodiscard]] const Coordinates& coordinates() const { return coordinates_; }
  /// Run k's point of the unit cube. Pure. @param u output, one per coordinate
  void place(long k, std::span<Tails> u) const;

private:
  const Campaign* campaign_;
  std::vector<OutputColumn> columns_;
  std::optional<Measure> measure_;
  std::optional<SampledColumns> samples_;
  Integration integration_;
  Goal goal_;
  ResultNames names_;
  Coordinates coordinates_;
  std::vector<PreparedDistribution> distributions_;
  PreparedDesign design_;
  GaussianCopula copula_;
  bool has_rows_ = false; ///< a dispersion is a column of `rows`
  UnitPoints points_;     ///< empty: the campaign's design
};

} // namespace wingspread
