/// Checks a campaign's requirements: those that no run, or every run, meets.
#pragma once

#include "montecarlo/model/campaign/campaign.hpp"
#include "montecarlo/model/input_checks/input_warning.hpp"

#include <string_view>

namespace wingspread {

/// Why no peak of a deployed wing can be proven final, whatever t_end is.
/// @return the reason, to follow "a limit on root.peak_moment"; empty where a proof may exist
[[nodiscard]] std::string_view why_never_final(const Scene& scene);
/// The same for the wings with every draw at either end of its law, and for some random ones.
/// @return where only some of these have the reason, it begins with "for runs"
[[nodiscard]] std::string_view why_never_final(const Campaign& campaign);
/// The same for the wings of both. @pre they have the same hinges
[[nodiscard]] std::string_view why_never_final(const Campaign& campaign, const Campaign& other);

/// Warns of requirements that no run or every run meets, each by the first rule that it breaks:
///
/// - a negative limit of a magnitude, or one on the other side of zero than the nominal value
/// - a limit on an angle or a rate that is in degrees or has been converted twice: about 57.3 from the nominal value
/// - an upper limit on a peak where no peak is ever proven final, in any case: a cut peak breaks it. A cut peak may
///   meet a lower limit
/// - a limit on a final angle or an overtravel of more than half the travel
/// - a limit a hundred times the nominal value, or a hundredth of it, of times, rates and loads
///
/// and of a lower limit above an upper one of the same output.
///
/// @param nominal  the nominal deployment
/// @param warnings with the list of requirements as its place
void check_requirements(const Campaign& campaign, const Outcome& nominal, InputWarnings& warnings);

} // namespace wingspread
