/// Builds a JSON Schema from the questions that readers ask of specimen documents.
///
/// A reader asks a document for keys and states what it expects of each value (JsonObject, JsonCursor). The schema
/// consists of the questions that readers ask of specimens, which together have every key. So a new key of a reader is
/// in the schema at once; if no specimen has the key, that is a gap, and a test fails. Objects at one place with
/// different keys (dampers by their law) become alternatives.
///
/// The schema accepts all that the readers accept, and refuses unknown keys and wrong types. Conditions between values
/// are left to the readers.
#pragma once

#include "montecarlo/foundation/formats/json_reader.hpp"

#include <string>
#include <vector>

namespace wingspread {

/// A document and the questions asked of it.
struct Specimen {
  Json document;
  std::vector<Question> questions;
};

struct RecordedSchema {
  Json schema;
  /// Keys, words that decide on keys, and array elements that no specimen has, each with its place.
  std::vector<std::string> gaps;
};

[[nodiscard]] RecordedSchema recorded_schema(const std::vector<Specimen>& specimens);

/// The bounds in "a number, kg, > 0 and < 1" or "an integer from 2 to 200" as schema keywords.
[[nodiscard]] Json bounds_of(std::string_view expected);

} // namespace wingspread
