/// Checks of a campaign's dispersions, correlations and requirements.
#pragma once

#include "montecarlo/model/campaign/campaign.hpp"
#include "montecarlo/model/input_checks/input_warning.hpp"

#include <set>
#include <string>

namespace wingspread {

/// Warns of each dispersion by the first rule that it breaks (an `each` at its first match):
///
/// - scale: the mean is outside 0.5 to 2;
/// - add: the mean exceeds a quarter of the nominal value, or the central 95 % of the draws exceed the nominal value
///   (for a coordinate: the length of its vector). A factor meant for "scale" breaks this rule;
/// - set: the median is more than 30 times the nominal value or less than 1/30 (inches for metres: 39); draws about 1
///   replace a nominal factor other than 1, or a nominal value that is far from them ("scale" is meant);
/// - an angle's central 95 % are wider than ±0.1 rad, or an angle is set beyond a turn (degrees for radians);
/// - with a probability of 1e-9 or more, a draw (the others nominal) changes a spring's sign or makes a physical size
///   negative;
/// - through: more than 5 % of the draws lie beyond the ends of the table, in the campaign or in a case.
///
/// @param found paths of which check_draws has found unphysical values: no warning of a negative size repeats it
void check_dispersions(const Campaign& campaign, InputWarnings& warnings,
                       const std::set<std::string>& found = {});

/// Warns where several runs are planned but nothing varies, in no case; and of replicates of independent draws, which
/// are ignored.
void check_spread(const Campaign& campaign, InputWarnings& warnings);

/// Warns of correlations of 0.8 and more, and of three dispersions correlated pairwise by 0.5 and more: they probably
/// have one cause, which `through` draws once. Also of correlations of which ties leave less than 90 %, or with a
/// constant. Not of strong ones that come with a covariance: a fit left these dispersions so correlated.
void check_correlations(const Campaign& campaign, InputWarnings& warnings);

/// Warns of families of outputs that the wing does not have: their columns are missing in runs.csv.
void check_outputs(const Campaign& campaign, InputWarnings& warnings);

} // namespace wingspread
