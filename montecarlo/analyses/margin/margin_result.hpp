/// The data of the window search: the verdicts at every evaluated scale. A condition is a requirement in a case.
#pragma once

#include "montecarlo/analyses/margin/weaker_springs.hpp"
#include "montecarlo/analyses/margin/window_search.hpp"
#include "montecarlo/model/campaign/campaign.hpp"
#include "montecarlo/results/summary/verdict.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace wingspread {

/// A state of the wing in which the requirements must hold.
struct MarginCase {
  std::string name; ///< "nominal", "root spring out", "cold", "cold, root spring out"
  std::vector<SceneParameter> weakened; ///< torques that lose one spring
  std::size_t campaign = 0;             ///< index into MarginResult::campaigns
};

/// Whether a requirement applies in a case. Requirements on static margins apply only in cases without a lost spring:
/// the standard has another static margin, with other factors, for a lost spring ("NASA_one_spring_out").
[[nodiscard]] bool applies(const Requirement& requirement, const MarginCase& which);

/// The results of one case's runs at one scale.
struct CaseResult {
  std::array<long, 5> statuses{}; ///< in the order of Status
  std::vector<Verdict> verdicts;  ///< one for each requirement that applies
  /// For each verdict the required quantile over the runs with the output; NaN without such runs.
  std::vector<double> quantiles{};
  long open_latches =
      0; ///< deployed runs of which it is not proven that their latches stay engaged
};
using ScaleResult = std::vector<CaseResult>; ///< one per case

/// The share of a case's runs that deployed.
struct DeployedShare {
  long runs = 0;
  double share = 0; ///< NaN without runs
  Interval bounds;  ///< Clopper-Pearson
};
[[nodiscard]] DeployedShare deployed_share(const CaseResult& one, double confidence);

/// Why no scale is recommended.
enum class Withheld {
  nothing,         ///< a scale is recommended
  no_window,       ///< no scale that was run meets all requirements
  no_lower_edge,   ///< nothing fails down to the lowest evaluated scale
  no_upper_edge,   ///< nothing fails up to the highest evaluated scale
  short_of_torque, ///< the window has only weaker springs, and their static margins are below 0
};

/// A stretch of scales.
struct ScaleRange {
  double lower = 0, upper = 0;
};

/// One search: the parameters scaled together, and its results.
struct MarginSearch {
  std::string name; ///< the hinge, or "joint" for all parameters together
  std::vector<SceneParameter> scaled;
  bool of_springs = true;               ///< whether a spring is among them
  std::map<double, ScaleResult> seen{}; ///< by scale
  std::optional<double> recommended{};
  ScaleRange as_good{}; ///< scales with the strain of the recommended one, which is among them
  Withheld withheld = Withheld::nothing;
  std::optional<Shortfall>
      passed_over{}; ///< the scale with less strain whose static margin is below 0
  std::optional<ScaleResult> confirmation{}; ///< runs of another seed at the recommended scale
};

struct MarginResult {
  std::vector<Campaign>
      campaigns; ///< one per case of the campaign; the campaign itself without cases
  std::vector<MarginCase> cases;
  std::vector<MarginSearch> searches;
  std::uint64_t confirmation_seed = 0;
  long runs = 0;   ///< number of runs made
  long failed = 0; ///< number of runs that failed numerically
};

/// A requirement in a case. The window search knows it by its index in conditions_of().
struct MarginCondition {
  std::size_t which_case, requirement;
  std::size_t verdict = 0; ///< index among the case's verdicts
};
[[nodiscard]] std::vector<MarginCondition> conditions_of(const Campaign& campaign,
                                                         const MarginResult& result);

[[nodiscard]] const Verdict& verdict_of(const ScaleResult& cases, const MarginCondition& condition);

/// The quantile of a condition (CaseResult::quantiles); NaN if there is none.
[[nodiscard]] double quantile_of(const ScaleResult& cases, const MarginCondition& condition);

/// The conditions that do not pass at a scale.
[[nodiscard]] Failing failing(const ScaleResult& cases);
[[nodiscard]] FailingByScale failing_by_scale(const MarginSearch& search);

/// Whether the runs of the confirmation seed pass at the recommended scale.
[[nodiscard]] bool is_confirmed(const MarginSearch& search);

/// Numbers of draws that break a condition at a scale but not at the next scale outwards (margin_study.hpp).
struct OutOfOrder {
  long lower = 0; ///< below the recommended scale
  long upper = 0; ///< above the recommended scale
};
[[nodiscard]] OutOfOrder out_of_order(const MarginSearch& search, const MarginCondition& condition,
                                      double middle);

} // namespace wingspread
