/// Whole runs of whole campaigns, for the throughput study: with friction, tables, loops and moving bases, and of
/// chains of more and more panels.
#pragma once

#include "studies/support/study.hpp"

#include <nlohmann/json.hpp>

namespace wingspread::study {

/// Runs of several campaigns with all outputs, and to their first latch: alone and in packs. Prints a table, and writes
/// campaigns.csv. @return the same rows
[[nodiscard]] nlohmann::ordered_json campaign_rates(const StudyOptions& options);

/// The first n panels of the long chain with friction, all outputs: evaluations, time, how long they move.
/// Prints a table, and writes panels.csv. @return the same rows
[[nodiscard]] nlohmann::ordered_json panel_rates(const StudyOptions& options);

} // namespace wingspread::study
