/// One run in full: as JSON, for `simulate --json` and `replay --json`, and for a terminal.
#pragma once

#include "core/deployment.hpp"
#include "montecarlo/foundation/formats/json.hpp"

#include <string>

namespace wingspread {

/// Whether there are peaks, and t_end cut them.
[[nodiscard]] bool has_cut_peaks(const Outcome& outcome);
inline constexpr const char* cut_peaks_warning =
    "t_end cut the peaks: it is not proven that none would be exceeded after it";

/// Strict JSON: what did not happen is null, as is what was not asked for. Latches stand in order
/// of time. Beside the keys of the contract: `reason`, `method` (those of the phases), `phases`,
/// `peaks_final` and `warnings`.
/// Of an invalid run nothing but its status and reason is there; of a failed one no peak is known.
/// @param scene whose run it was
[[nodiscard]] Json outcome_json(const Scene& scene, const Outcome& outcome);

/// In words and tables: how it ended, the latches in order of time, the hinges' peaks and final
/// state, what is to be warned of, energy and work.
[[nodiscard]] std::string outcome_text(const Scene& scene, const Outcome& outcome);

} // namespace wingspread
