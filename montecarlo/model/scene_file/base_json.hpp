/// Reads and writes a scene's base: its motion, by constants or by a table over time.
#pragma once

#include "core/scene/scene.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"

#include <array>
#include <string_view>

namespace wingspread {

/// The words of `motion`, by BaseMotion.
inline constexpr std::array<std::string_view, 3> base_motion_names{"fixed", "prescribed", "free"};

void read_base(const JsonCursor& at, Base& base);

[[nodiscard]] Json write_base(const Base& base);

} // namespace wingspread
