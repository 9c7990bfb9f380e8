#include "montecarlo/model/schema/schema.hpp"

#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/scene_file/scene_json.hpp"

#include <utility>

namespace wingspread {
namespace {

/// @param read reads a specimen's document and records its questions
template <class Read>
RecordedSchema schema_of(std::vector<Json> documents, const char* title, const Read& read) {
  std::vector<Specimen> specimens;
  for (Json& document : documents) specimens.push_back({std::move(document), {}});
  for (Specimen& specimen : specimens) {
    try {
      read(specimen);
    } catch (const SpecError&) {
      // Specimens name files that do not exist; the questions are recorded nevertheless.
    }
  }
  RecordedSchema recorded = recorded_schema(specimens);
  Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", title}};
  schema.update(recorded.schema);
  recorded.schema = std::move(schema);
  return recorded;
}

} // namespace

RecordedSchema scene_schema() {
  return schema_of(scene_specimens(), "wingspread: a scene", [](Specimen& specimen) {
    std::vector<Problem> problems;
    (void)read_scene(JsonCursor(specimen.document, "", problems, &specimen.questions));
  });
}

RecordedSchema campaign_schema() {
  return schema_of(campaign_specimens(), "wingspread: a campaign", [](Specimen& specimen) {
    (void)read_campaign(specimen.document, specimen.questions);
  });
}

} // namespace wingspread
