/// A scene from JSON and back to it.
#pragma once

#include "core/scene/scene.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"

#include <string>

namespace wingspread {

/// Reads a scene that stands somewhere in a document. Its problems go to the cursor's list; when
/// that grew, the scene that is returned is of no use.
[[nodiscard]] Scene read_scene(const JsonCursor& at);

/// Reads a document that is a scene.
/// @param file the name that problems carry
/// @throws SpecError with all that is wrong
[[nodiscard]] Scene read_scene(const Json& document, const std::string& file = "");

/// The scene in full, all defaults explicit, but for what real hinges have more: that is there where it is used.
/// Reads back to the same scene, to the last bit.
[[nodiscard]] Json write_scene(const Scene& scene);

} // namespace wingspread
