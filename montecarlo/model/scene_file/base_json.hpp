/// The base from JSON and back: its motion, by constants and by a table of time.
#pragma once

#include "core/scene/scene.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"

#include <array>
#include <string_view>

namespace wingspread {

/// The words for each way in which a base moves, in the order of its values.
inline constexpr std::array<std::string_view, 3> base_motion_names{"fixed", "prescribed", "free"};

void read_base(const JsonCursor& at, Base& base);

[[nodiscard]] Json write_base(const Base& base);

} // namespace wingspread
