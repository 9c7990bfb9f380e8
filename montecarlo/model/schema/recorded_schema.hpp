/// A JSON Schema out of what readers ask of specimens.
///
/// Readers are code; each asks a document for keys, and says of each value what it expects (JsonObject, JsonCursor).
/// Those questions, asked of specimens that have every key there is, are the schema: where a reader learns a new key, the
/// schema has it, and where no specimen has the key, that is a gap. Objects of one place of which readers know different
/// keys (dampers by their law) become alternatives.
///
/// It takes all that the readers take, and refuses unknown keys and wrong types. What holds between values (a sum, a name
/// that has to be another's) the readers alone know.
#pragma once

#include "montecarlo/foundation/formats/json_reader.hpp"

#include <string>
#include <vector>

namespace wingspread {

/// A document and what was asked of it.
struct Specimen {
  Json document;
  std::vector<Question> questions;
};

struct RecordedSchema {
  Json schema;
  /// What no specimen shows, each with its place: a key, a word of a choice that decides on keys, an array's elements.
  std::vector<std::string> gaps;
};

[[nodiscard]] RecordedSchema recorded_schema(const std::vector<Specimen>& specimens);

/// The bounds of "a number, kg, > 0 and < 1" or "an integer from 2 to 200" as keywords of a schema.
[[nodiscard]] Json bounds_of(std::string_view expected);

} // namespace wingspread
