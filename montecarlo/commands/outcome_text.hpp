/// One run in words and a table, for a terminal.
#pragma once

#include "core/deployment.hpp"

#include <string>

namespace wingspread {

/// How it ended, the latches in order of time, the hinges' peaks and final state, energy and work.
[[nodiscard]] std::string outcome_text(const Scene& scene, const Outcome& outcome);

} // namespace wingspread
