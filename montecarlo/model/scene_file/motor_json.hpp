/// Reads and writes motors of hinges.
#pragma once

#include "core/scene/scene.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"

#include <optional>

namespace wingspread {

void read_motor(const JsonCursor& at, std::optional<Motor>& motor);
[[nodiscard]] Json write_motor(const Motor& motor);

} // namespace wingspread
