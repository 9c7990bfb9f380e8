/// A scene in words, for `wingspread check`.
#pragma once

#include "core/scene/scene.hpp"

#include <string>

namespace wingspread {

/// One line each for the name, the base, every body, hinge and loop, gravity and air.
[[nodiscard]] std::string describe(const Scene& scene);

} // namespace wingspread
