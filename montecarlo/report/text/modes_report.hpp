/// The natural modes of a deployed wing, as text and as JSON.
#pragma once

#include "core/proofs/natural_modes.hpp"
#include "montecarlo/foundation/formats/json.hpp"

#include <string>

namespace wingspread {

/// A table of all modes, and the notes. Joints of flexible bodies are left out.
[[nodiscard]] std::string modes_text(const WingModes& modes);

/// { "modes": [ { "frequency": Hz, "damping_ratio", "shape": { HINGE: angle } } ], "rest": { HINGE: rad },
/// "notes": [ … ] }, lowest first. Shapes include the joints of flexible bodies, and on a free base "base".
[[nodiscard]] Json modes_json(const WingModes& modes);

} // namespace wingspread
