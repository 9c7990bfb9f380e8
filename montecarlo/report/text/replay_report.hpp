/// A replayed run as JSON and text, with its draws and the comparison with the recorded row.
#pragma once

#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/results/results_folder/replay.hpp"

#include <string>

namespace wingspread {

/// outcome_json with `run`, `draws` and `same_as_recorded` (null without a recorded row).
[[nodiscard]] Json replay_json(const Replayed& replayed);

[[nodiscard]] std::string replay_text(const Replayed& replayed);

/// The options of `simulate` that repeat a replayed run with these settings, each after a blank; empty for the defaults.
[[nodiscard]] std::string options_of(const Integration& integration, const Outcome& replayed);

} // namespace wingspread
