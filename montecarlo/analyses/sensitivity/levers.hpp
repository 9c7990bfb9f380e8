/// What a designer can move to make a requirement pass: a dispersed input, or the same input of all bodies or hinges.
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
  std::vector<std::string> draws; ///< names
  std::vector<std::string>
      paths; ///< for `scale` of `wingspread margin`; empty where scaling them is no such change
  std::string unit; ///< of the draws; empty if scaled
};

/// A lever with the change by which the requirement passes.
struct LeverChange {
  Lever lever;
  NeededChange change;
};

struct LeverChanges {
  NeededFor what = NeededFor::limit;
  long runs = 0;
  double explained = 0;
  /// The most effective first: those within the values drawn, then by the size of the change; one for each quantity.
  /// None where a linear fit of the limited output explains less than a quarter of its variance.
  std::vector<LeverChange> levers;
};

/// The most effective changes for a requirement. A group of inputs gives way to one of its members if the member's
/// change is at most a quarter larger.
/// @param most of them
/// @return nothing where needed_changes gives nothing
[[nodiscard]] std::optional<LeverChanges> lever_changes(NeededFor what, const Campaign& campaign,
                                                        const Verdict& verdict,
                                                        const Results& results,
                                                        const Replication& replication,
                                                        double confidence, std::size_t most);

} // namespace wingspread
