/// The input checks of a campaign with its draws.
#pragma once

#include "montecarlo/model/campaign/campaign.hpp"
#include "montecarlo/model/input_checks/input_warning.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace wingspread {

/// Calls check_input with the campaign's own draws. @param wings names of the cases that are made; empty: those of `run`
[[nodiscard]] std::vector<InputWarning> check_campaign(const Campaign& campaign,
                                                       const std::filesystem::path& file,
                                                       std::span<const std::string> wings = {});

} // namespace wingspread
