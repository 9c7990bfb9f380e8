/// Reads and writes synchronisation loops between hinges.
#pragma once

#include "core/scene/scene.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace wingspread {

/// The names of a loop's two hinges; nothing where a name could not be read.
using LoopEnds = std::array<std::optional<std::string>, 2>;

/// Reads a loop. Returns the names of its hinges, for link_synchronisations.
[[nodiscard]] LoopEnds read_synchronisation(const JsonCursor& at, Synchronisation& loop);

/// Sets each loop's hinges from their names. Notes a problem for each unknown name, and for a loop with one hinge
/// twice.
/// @param at   the scene
/// @param ends one for each loop
void link_synchronisations(const JsonCursor& at, const std::vector<LoopEnds>& ends, Scene& scene);

/// The loop with all defaults explicit.
/// @param scene for the hinges' names
[[nodiscard]] Json write_synchronisation(const Scene& scene, const Synchronisation& loop);

} // namespace wingspread
