/// One run in full, for `simulate --json` and `replay --json`.
///
/// Strict JSON: what did not happen is null, as is what was not asked for. Latches stand in order
/// of time. Beside the keys of the contract: `reason`, `method` (those of the phases) and
/// `phases`.
#pragma once

#include "core/deployment.hpp"
#include "montecarlo/formats/json.hpp"

namespace wingspread {

/// @param scene whose run it was
/// Of an invalid run nothing but its status and reason is there; of a failed one no peak is known.
[[nodiscard]] Json outcome_json(const Scene& scene, const Outcome& outcome);

} // namespace wingspread
