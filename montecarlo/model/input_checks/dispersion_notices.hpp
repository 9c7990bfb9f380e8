/// Dispersions whose law, or what it is applied to, is probably not what was meant.
#pragma once

#include "montecarlo/model/campaign/campaign.hpp"
#include "montecarlo/model/input_checks/notice.hpp"

namespace wingspread {

/// Of each dispersion as the file has it, the first of these that it shows (an `each` at its first match):
///
/// - scale: a factor whose mean is outside 0.5 to 2;
/// - add: its mean beyond half the nominal value, or 95 % of its draws not within ± the nominal value (of a coordinate:
///   the length of its vector). A factor that was meant to scale is among these;
/// - set: a median that is 30 times the nominal value or a thirtieth, and more (inches to metres are 39);
/// - an angle's that is wider than ± a tenth of a radian (its central 95 %), or is set beyond a turn: degrees;
/// - draws that turn a spring's sign, or take below 0 what physics does not let be negative, where that has a
///   probability of 1e-9 or more: each draw for itself, the others nominal;
/// - through: a table that half of the draws lie beyond, on one side.
void notice_dispersions(const Campaign& campaign, Notices& notices);

/// Correlations of 0.8 and more, and three dispersions that are correlated with each other by 0.5 and more: that is
/// one cause, which `through` draws once.
void notice_correlations(const Campaign& campaign, Notices& notices);

/// Requirements that say nothing: a limit on the other side of zero from every value there can be, or from the
/// nominal one; and a peak's on a base that turns faster and faster, where none is ever proven.
/// @param nominal the nominal deployment, with its latches
void notice_requirements(const Campaign& campaign, const Outcome& nominal, Notices& notices);

} // namespace wingspread
