/// JSON Schemas of scenes and campaigns, for editors.
#pragma once

#include "montecarlo/model/schema/recorded_schema.hpp"

#include <vector>

namespace wingspread {

/// Documents that together have every key of their readers.
[[nodiscard]] std::vector<Json> scene_specimens();
[[nodiscard]] std::vector<Json> campaign_specimens();

/// JSON Schemas, draft 7. Cost: reads all specimens, some milliseconds.
[[nodiscard]] RecordedSchema scene_schema();
[[nodiscard]] RecordedSchema campaign_schema();

} // namespace wingspread
