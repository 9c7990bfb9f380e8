/// One run in full: as JSON (`simulate --json`, `replay --json`) and as text.
#pragma once

#include "core/deployment.hpp"
#include "montecarlo/foundation/formats/json.hpp"

#include <string>
#include <vector>

namespace wingspread {

/// Whether the run reached t_end before its peaks were proven final.
[[nodiscard]] bool has_cut_peaks(const Outcome& outcome);
/// "t_end cut the peaks: …", or the peak forces, or the peak moments.
[[nodiscard]] std::string cut_peaks_warning(const Outcome& outcome);

/// Warnings of one run: overtravel, latches whose damping decides the peak, cut peaks, latches that may let go after
/// t_end. In this order, each on one line.
[[nodiscard]] std::vector<std::string> outcome_warnings(const Scene& scene, const Outcome& outcome);

/// The run as JSON: latches in order of time; null for values that do not exist or were not requested. An invalid run
/// has only its status and reason; a failed run has no peaks.
/// @param scene the run's scene
[[nodiscard]] Json outcome_json(const Scene& scene, const Outcome& outcome);

/// The run as text: outcome, latches in order of time, peaks and final state of the hinges, warnings, energy and work.
[[nodiscard]] std::string outcome_text(const Scene& scene, const Outcome& outcome);

} // namespace wingspread
