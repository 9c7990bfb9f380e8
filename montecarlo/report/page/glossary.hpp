/// The page's glossary: outputs with units and signs (see OUTPUTS.md), and terms of statistics.
#pragma once

#include "montecarlo/foundation/formats/json.hpp"

namespace wingspread {

/// The entries by name; outputs of hinges have names like "HINGE.peak_moment".
[[nodiscard]] Json glossary_json();

} // namespace wingspread
