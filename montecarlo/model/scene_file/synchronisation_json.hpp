/// Synchronisation loops between hinges, from JSON and back.
#pragma once

#include "core/scene/scene.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace wingspread {

/// The names of the two hinges that a loop goes around, where they could be read.
using LoopEnds = std::array<std::optional<std::string>, 2>;

/// Reads a loop but for its hinges, whose names it returns.
[[nodiscard]] LoopEnds read_synchronisation(const JsonCursor& at, Synchronisation& loop);

/// Turns the names of the loops' hinges into the indices that the scene has, and notes a problem for each that
/// no hinge has, and for a loop around one hinge alone.
/// @param at   the scene
/// @param ends as many as loops
void link_synchronisations(const JsonCursor& at, const std::vector<LoopEnds>& ends, Scene& scene);

/// The loop in full.
/// @param scene that knows the names of its hinges
[[nodiscard]] Json write_synchronisation(const Scene& scene, const Synchronisation& loop);

} // namespace wingspread
