/// The window of spring strength: between the weakest springs that surely deploy and the strongest
/// that surely keep to the limits.
///
/// At every scale s the same draws are made (common random numbers): run k has the draws that it
/// has in the campaign, and what is to be sized is multiplied by s after all dispersion. So what
/// changes from scale to scale is due to the springs alone, and the runs at a scale are exactly
/// those of the campaign with one dispersion more (`scaled`), a constant factor s. Each requirement
/// is judged at each scale as the campaign judges it (verdict.hpp).
///
/// What an edge's confidence means. A verdict "pass" at a scale that was fixed beforehand holds
/// with the requirement's confidence c. The edge is chosen by looking at many scales. Let s* be the
/// true edge, and let every draw that breaks the requirement at a scale break it at all scales
/// further out. Then the number of draws that break it only grows outwards, and an edge beyond s*
/// takes a pass at s* itself, whose probability is at most 1 − c: so the search costs nothing, and
/// the window lies within the true one with confidence c, requirement by requirement.
/// `out_of_order` counts the draws that behave otherwise; runs of another seed at the recommended
/// scale are looked at besides.
///
/// One spring out: a hinge's torque comes from m equal springs. In one case more for each hinge
/// whose springs are sized, its torque is (m − 1)/m of what was drawn. The requirements hold in all
/// cases.
#pragma once

#include "montecarlo/campaign/campaign.hpp"
#include "montecarlo/margin/window_search.hpp"
#include "montecarlo/runs/evaluator.hpp"
#include "montecarlo/summary/verdict.hpp"

#include <array>
#include <functional>
#include <map>
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

/// The campaign with one dispersion more, after all others: a constant factor on the parameters,
/// `margin_scale` by name (or with a number behind it, if that is taken). Its file says so too.
[[nodiscard]] Campaign scaled(const Campaign& campaign,
                              const std::vector<SceneParameter>& parameters, double scale);
[[nodiscard]] Scene scaled(Scene scene, const std::vector<SceneParameter>& parameters,
                           double scale);

/// Finds the window, or those of every hinge.
/// @param progress told how many runs there have been, one call at a time
/// @param result   filled as it goes on: when stopped it has the scales that were finished
/// @throws SpecError when the campaign asks for no margin or has no requirements, or when so few
///   runs cannot show one; Stopped when the evaluator makes fewer than it is asked for
void find_margin(const Campaign& campaign, Evaluator& evaluator,
                 const std::function<void(long)>& progress, MarginResult& result);

} // namespace wingspread
