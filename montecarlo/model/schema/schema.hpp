/// JSON Schemas of scenes and campaigns, for editors.
#pragma once

#include "montecarlo/model/schema/recorded_schema.hpp"

#include <vector>

namespace wingspread {

/// Documents that have, all together, every key that their readers know.
[[nodiscard]] std::vector<Json> scene_specimens();
[[nodiscard]] std::vector<Json> campaign_specimens();

/// Draft 7, made of what the readers ask of the specimens. Cost: question these, some milliseconds.
[[nodiscard]] RecordedSchema scene_schema();
[[nodiscard]] RecordedSchema campaign_schema();

} // namespace wingspread
