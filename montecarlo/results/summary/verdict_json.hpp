/// The evidence of a verdict, for JSON files with verdicts.
#pragma once

#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/results/summary/verdict.hpp"

namespace wingspread {

/// {"failures": {"seen", "allowed"}, "observed": {"share", "value"}, "guaranteed": {"share", "value"}}; without
/// values for "deployed". "failures" has "peaks_cut", "peaks_cut_within_limit" and "without_value" where there are any.
[[nodiscard]] Json evidence_json(const Verdict& verdict);

/// {"true", "false", "missing"; where they differ "moments_cut", "forces_cut"}.
[[nodiscard]] Json peaks_json(const PeaksCount& peaks);

} // namespace wingspread
