/// Timed runs for the throughput study: of campaigns with friction, tables, loops and moving bases, and of chains with an
/// increasing number of panels.
#pragma once

#include "studies/support/study.hpp"

#include <nlohmann/json.hpp>

namespace wingspread::study {

/// Times runs of several campaigns, with all outputs and to the first latch, each alone and in packs. Prints a table and
/// writes campaigns.csv. @return the rows of the table
[[nodiscard]] nlohmann::ordered_json campaign_rates(const StudyOptions& options);

/// Measures evaluations, time and duration of motion of the first n panels of the long chain with friction, with all
/// outputs. Prints a table and writes panels.csv. @return the rows of the table
[[nodiscard]] nlohmann::ordered_json panel_rates(const StudyOptions& options);

} // namespace wingspread::study
