/// What the page's words mean: outputs with units and signs, and terms of statistics. OUTPUTS.md says more of the former.
#pragma once

#include "montecarlo/foundation/formats/json.hpp"

namespace wingspread {

/// By name; those of hinges stand as "HINGE.peak_moment".
[[nodiscard]] Json glossary_json();

} // namespace wingspread
