/// What the search for the window of spring strength has seen: plain data, and which conditions (a
/// requirement in a case) hold at which scale.
#pragma once

#include "montecarlo/campaign/campaign.hpp"
#include "montecarlo/margin/window_search.hpp"
#include "montecarlo/summary/verdict.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace wingspread {

/// A state of the wing in which the requirements have to hold.
struct MarginCase {
  std::string name;                     ///< "nominal", "root spring out"
  std::vector<SceneParameter> weakened; ///< torques of which a spring is lost
};

/// What the runs of one case at one scale came to.
struct CaseLook {
  std::array<long, 5> statuses{}; ///< in the order of Status
  std::vector<Verdict> verdicts;  ///< one for each requirement
};
using ScaleLook = std::vector<CaseLook>; ///< one for each case

/// How many of a case's runs deployed.
struct DeployedShare {
  long runs = 0;
  double share = 0; ///< NaN without runs
  Interval bounds;  ///< of Clopper and Pearson
};
[[nodiscard]] DeployedShare deployed_share(const CaseLook& look, double confidence);

/// What is scaled together, and what was found.
struct MarginSearch {
  std::string name; ///< of the hinge; "joint" for all together
  std::vector<SceneParameter> scaled;
  std::map<double, ScaleLook> seen; ///< by scale
  std::optional<double> recommended;
  std::optional<ScaleLook> confirmation; ///< runs of another seed at the recommended scale
};

struct MarginResult {
  std::vector<MarginCase> cases;
  std::vector<MarginSearch> searches;
  std::uint64_t confirmation_seed = 0;
  long runs = 0;   ///< made in all
  long failed = 0; ///< numerically
};

/// A requirement in a case: what the window search knows by a number.
struct MarginCondition {
  std::size_t which_case, requirement;
};
[[nodiscard]] std::vector<MarginCondition> conditions_of(const Campaign& campaign,
                                                         const MarginResult& result);

[[nodiscard]] const Verdict& verdict_of(const ScaleLook& look, const MarginCondition& condition);

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
