/// What a verdict rests on, for the JSON files that hold verdicts.
#pragma once

#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/results/summary/verdict.hpp"

namespace wingspread {

/// {"failures": {"seen", "allowed"}, "observed": {"share", "value"}, "guaranteed": {"share",
/// "value"}}; no values of "deployed".
[[nodiscard]] Json evidence_json(const Verdict& verdict);

} // namespace wingspread
