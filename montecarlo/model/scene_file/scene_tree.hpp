/// What the names in a scene have to be, and the tree that they spell.
#pragma once

#include "core/scene/scene.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"

#include <optional>
#include <string>
#include <vector>

namespace wingspread {

/// The names of the bodies that a hinge joins, where they could be read.
struct HingeEnds {
  std::optional<std::string> parent;
  std::optional<std::string> child;
};

/// Notes a problem for each name of a body, hinge or synchronisation that is empty, used twice, `base` for a body,
/// or holds a character with a meaning of its own: names stand in parameter paths ("." and "*"), in
/// column headers ("," and quotes), in latch orders (">") and in JSON pointers ("/").
/// @param at the scene
void check_names(const JsonCursor& at, const Scene& scene);

/// Turns the names of each hinge's ends into the indices that the scene has, and notes a problem
/// for each name that no body has and whatever keeps the hinges from being a tree rooted at base.
/// Does nothing while two bodies share a name.
/// @param at   the scene
/// @param ends as many as hinges
void link_hinges(const JsonCursor& at, const std::vector<HingeEnds>& ends, Scene& scene);

} // namespace wingspread
