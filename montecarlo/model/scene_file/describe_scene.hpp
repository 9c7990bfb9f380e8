/// What a scene holds, in words: for `wingspread check`.
#pragma once

#include "core/scene/scene.hpp"

#include <string>

namespace wingspread {

/// The scene's name, base, bodies, hinges and loops, a line for each, and what surrounds it.
[[nodiscard]] std::string describe(const Scene& scene);

} // namespace wingspread
