/// The input checks of a campaign with its draws.
#pragma once

#include "montecarlo/model/campaign/campaign.hpp"
#include "montecarlo/model/input_checks/input_warning.hpp"

#include <filesystem>
#include <vector>

namespace wingspread {

/// Calls check_input with the campaign's own draws.
[[nodiscard]] std::vector<InputWarning> check_campaign(const Campaign& campaign,
                                                       const std::filesystem::path& file);

} // namespace wingspread
