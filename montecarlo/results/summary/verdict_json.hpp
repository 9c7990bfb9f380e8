/// The evidence of a verdict, for JSON files with verdicts.
#pragma once

#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/results/summary/verdict.hpp"

namespace wingspread {

/// {"failures": {"seen", "allowed"}, "observed": {"share", "value"}, "guaranteed": {"share", "value"}}; without
/// values for "deployed".
[[nodiscard]] Json evidence_json(const Verdict& verdict);

} // namespace wingspread
