/// Levers: inputs that a designer can change to make a requirement pass. A lever is one dispersed input, or the same
/// input of all bodies or hinges.
#pragma once

#include "montecarlo/analyses/sensitivity/needed_change.hpp"
#include "montecarlo/model/campaign/campaign.hpp"

#include <string>
#include <vector>

namespace wingspread {

/// Draws that act in the same way on the same quantity, and how to name them.
struct Lever {
  MovedDraws moved;
  std::string words;              ///< "R_root damper peak torque", "friction of all hinges"
  std::vector<std::string> draws; ///< names of the dispersions
  std::vector<std::string>
      paths;        ///< for `scale` of `wingspread margin`; empty if the change is no scaling
  std::string unit; ///< of the draws; empty if scaled
};

/// A lever with the change by which the requirement passes.
struct LeverChange {
  Lever lever;
  NeededChange change;
};

struct LeverChanges {
  NeededFor what = NeededFor::limit;
  long runs = 0;        ///< runs of the estimate
  double explained = 0; ///< adjusted R² of the linear fit
  /// The known ones first, then by the size of the change; one for each quantity.
  /// None where a linear fit of the limited output explains less than half of its variance.
  std::vector<LeverChange> levers;
};

/// The most effective changes for a requirement. One input replaces its group if its change is at most a quarter
/// larger.
/// @param most largest number of levers to return
/// @return nothing if needed_changes() returns nothing
[[nodiscard]] std::optional<LeverChanges> lever_changes(NeededFor what, const Campaign& campaign,
                                                        const Verdict& verdict,
                                                        const Results& results,
                                                        const Replication& replication,
                                                        double confidence, std::size_t most);

} // namespace wingspread
