/// Reads and writes scenes. To add a key: read it and write it here (or in the *_json file of its object), and add its
/// number to scene_parameter.cpp, so that it can be dispersed.
#pragma once

#include "core/scene/scene.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"

#include <string>

namespace wingspread {

/// Reads a scene that is part of a document. Problems go to the cursor's list; with any, the returned scene is not
/// usable.
[[nodiscard]] Scene read_scene(const JsonCursor& at);

/// Reads a document that is a scene.
/// @param file name for the messages
/// @throws SpecError with all problems
[[nodiscard]] Scene read_scene(const Json& document, const std::string& file = "");

/// The scene with all defaults explicit; optional parts (damper, stop, latch, scales) only where used. Reads back to
/// the same scene bit by bit.
[[nodiscard]] Json write_scene(const Scene& scene);

} // namespace wingspread
