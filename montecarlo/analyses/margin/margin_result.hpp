/// What the search for the window of spring strength has seen: plain data, and which conditions (a
/// requirement in a case) hold at which scale.
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

/// A state of the wing in which the requirements have to hold.
struct MarginCase {
  std::string name; ///< "nominal", "root spring out", "cold", "cold, root spring out"
  std::vector<SceneParameter> weakened; ///< torques of which a spring is lost
  std::size_t campaign = 0;             ///< whose wing it is: index into MarginResult::campaigns
};

/// Whether a requirement is held to in a case. Static margins are of whole wings: that of one which has lost a
/// spring is a margin of its own ("NASA_one_spring_out"), with factors of its own.
[[nodiscard]] bool applies(const Requirement& requirement, const MarginCase& which);

/// What the runs of one case at one scale came to.
struct CaseLook {
  std::array<long, 5> statuses{}; ///< in the order of Status
  std::vector<Verdict> verdicts;  ///< one for each requirement that applies
  /// Of each the quantile that is required, over the runs alone that have the output: NaN without any, and of what
  /// is no output of theirs.
  std::vector<double> quantiles{};
};
using ScaleLook = std::vector<CaseLook>; ///< one for each case

/// How many of a case's runs deployed.
struct DeployedShare {
  long runs = 0;
  double share = 0; ///< NaN without runs
  Interval bounds;  ///< of Clopper and Pearson
};
[[nodiscard]] DeployedShare deployed_share(const CaseLook& look, double confidence);

/// Why no scale is recommended.
enum class Withheld {
  nothing,         ///< one is
  no_window,       ///< no scale meets all requirements
  no_lower_edge,   ///< nothing fails as far down as was looked
  no_upper_edge,   ///< nothing fails as far up
  short_of_torque, ///< the whole window is of weaker springs, whose static margins fall short
};

/// What is scaled together, and what was found.
struct MarginSearch {
  std::string name; ///< of the hinge; "joint" for all together
  std::vector<SceneParameter> scaled;
  std::map<double, ScaleLook> seen{}; ///< by scale
  std::optional<double> recommended{};
  Withheld withheld = Withheld::nothing;
  std::optional<Shortfall> passed_over{};  ///< what would strain less, but is not to be advised
  std::optional<ScaleLook> confirmation{}; ///< runs of another seed at the recommended scale
};

struct MarginResult {
  std::vector<Campaign>
      campaigns; ///< one for each of the campaign's cases; itself where it has none
  std::vector<MarginCase> cases;
  std::vector<MarginSearch> searches;
  std::uint64_t confirmation_seed = 0;
  long runs = 0;   ///< made in all
  long failed = 0; ///< numerically
};

/// A requirement in a case: what the window search knows by a number.
struct MarginCondition {
  std::size_t which_case, requirement;
  std::size_t verdict = 0; ///< among those of the case
};
[[nodiscard]] std::vector<MarginCondition> conditions_of(const Campaign& campaign,
                                                         const MarginResult& result);

[[nodiscard]] const Verdict& verdict_of(const ScaleLook& look, const MarginCondition& condition);

/// Of a condition; NaN where there is none.
[[nodiscard]] double quantile_of(const ScaleLook& look, const MarginCondition& condition);

/// The conditions that fail.
[[nodiscard]] Failing failing(const ScaleLook& look);
[[nodiscard]] Looks looks_of(const MarginSearch& search);

/// Whether there is a window, and the runs of another seed pass at the recommended scale.
[[nodiscard]] bool is_confirmed(const MarginSearch& search);

/// How many draws break a condition at a scale although they keep to it at one further out.
struct OutOfOrder {
  long lower = 0; ///< below the middle
  long upper = 0; ///< above it
};
[[nodiscard]] OutOfOrder out_of_order(const MarginSearch& search, const MarginCondition& condition,
                                      double middle);

} // namespace wingspread
