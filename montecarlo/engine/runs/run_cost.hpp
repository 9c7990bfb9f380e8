/// What runs cost, estimated from one nominal run.
#pragma once

#include "core/deployment.hpp"
#include "montecarlo/model/campaign/campaign.hpp"

#include <string>

namespace wingspread {

/// Runs the scene once and measures it; gives up after 50,000 trial steps. @return "the nominal run takes 1240
/// evaluations, 3 ms"
[[nodiscard]] std::string describe_cost(const Scene& scene, const Integration& integration);

/// The same for the campaign, its cases and runs, and the time of all of them on this machine's threads: an upper
/// estimate, because runs in packs are cheaper.
[[nodiscard]] std::string describe_cost(const Campaign& campaign);

} // namespace wingspread
