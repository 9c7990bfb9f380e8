/// Unphysical draws, found by drawing: runs that would be `invalid`, and so break every requirement.
#pragma once

#include "montecarlo/model/campaign/campaign.hpp"
#include "montecarlo/model/input_checks/input_warning.hpp"

#include <functional>
#include <set>
#include <string>

namespace wingspread {

/// Calls `use` with the scenes of the first runs of a campaign. The caller of the checks provides it, so that this
/// folder does not depend on runs.
using DrawScenes = std::function<void(const Campaign& campaign, long runs,
                                      const std::function<void(const Scene&)>& use)>;

/// The pointer of a dispersion in the file. Copies of an `each` share one pointer; their names begin with its name.
[[nodiscard]] std::string place_of(const Campaign& campaign, const Dispersion& dispersion);

/// Draws the first runs of each case without integrating them, as many as show a share of a thousandth. Warns of each
/// law, or a case's law, with which a scene is unphysical: the share of such draws, by case, and the reason of one.
/// @return the parameters found unphysical
std::set<std::string> check_draws(const Campaign& campaign, const DrawScenes& draw,
                                  InputWarnings& warnings);

} // namespace wingspread
