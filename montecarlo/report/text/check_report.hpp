/// A run's check (`simulate --check`), as JSON and as text.
#pragma once

#include "montecarlo/engine/accuracy/run_check.hpp"
#include "montecarlo/foundation/formats/json.hpp"

#include <optional>
#include <string>

namespace wingspread {

/// Null without a check: no reference could finish the run, or the run itself failed.
[[nodiscard]] Json check_json(const std::optional<RunCheck>& check);

/// The outputs by both methods with the digits that agree, and a warning for each output that moved by more than 1 %.
[[nodiscard]] std::string check_text(const std::optional<RunCheck>& check);

} // namespace wingspread
