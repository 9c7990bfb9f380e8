/// A replayed run as JSON and text, with its draws and the comparison with the recorded row.
#pragma once

#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/results/results_folder/replay.hpp"

#include <string>

namespace wingspread {

/// outcome_json with `run`, `draws` and `same_as_recorded` (null without a recorded row).
[[nodiscard]] Json replay_json(const Replayed& replayed, const Scene& scene);

[[nodiscard]] std::string replay_text(const Replayed& replayed, const Scene& scene);

} // namespace wingspread
