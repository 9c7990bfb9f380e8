/// A run made again: as JSON, and for a terminal, with its draws and whether it is the one recorded.
#pragma once

#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/results/results_folder/replay.hpp"

#include <string>

namespace wingspread {

/// outcome_json with `run`, `draws` and `same_as_recorded`, which is null where there is no record.
[[nodiscard]] Json replay_json(const Replayed& replayed, const Scene& scene);

[[nodiscard]] std::string replay_text(const Replayed& replayed, const Scene& scene);

} // namespace wingspread
