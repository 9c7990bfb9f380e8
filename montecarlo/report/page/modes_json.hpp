/// Shapes of the deployed wing's lowest modes: MODES of page/DATA.md.
#pragma once

#include "core/scene/scene.hpp"
#include "montecarlo/foundation/formats/json.hpp"

namespace wingspread {

/// @param scene the nominal wing. Null if it is unphysical or has no rest
[[nodiscard]] Json modes_json(const Scene& scene);

} // namespace wingspread
