/// Checks the names in a scene, and links hinges to bodies by name into a tree.
#pragma once

#include "core/scene/scene.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// The names of the bodies that a hinge joins, and of the hinge for which its release waits; nothing where a name could
/// not be read.
struct HingeEnds {
  std::optional<std::string> parent;
  std::optional<std::string> child;
  std::optional<std::string> after{};
};

/// Whether a body or a hinge may have the name: see check_names.
[[nodiscard]] bool may_be_name(std::string_view name);

/// Notes a problem for each name that is empty, used twice, `base` for a body, or has a reserved character. Reserved
/// are the separators of parameter paths ("." and "*"), column headers ("," and quotes), latch orders (">") and JSON
/// pointers ("/").
/// @param at the scene
void check_names(const JsonCursor& at, const Scene& scene);

/// Sets each hinge's parent and child from the names of its ends. Notes a problem for each unknown name, and if the
/// hinges are no tree rooted at base. Does nothing if two bodies share a name.
/// @param at   the scene
/// @param ends one for each hinge
void link_hinges(const JsonCursor& at, const std::vector<HingeEnds>& ends, Scene& scene);

/// Sets the hinge for which each release waits from its name. Notes a problem for each unknown name, and for an event
/// that the other hinge never has.
void link_releases(const JsonCursor& at, const std::vector<HingeEnds>& ends, Scene& scene);

} // namespace wingspread
