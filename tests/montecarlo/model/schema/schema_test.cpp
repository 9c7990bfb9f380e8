#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/scene_file/scene_json.hpp"
#include "montecarlo/model/schema/schema.hpp"
#include "tests/montecarlo/spec_support.hpp"
#include "tests/support/source_folder.hpp"

#include <catch2/catch.hpp>

#include <set>

using namespace wingspread;
using namespace wingspread::test;

namespace {

const std::filesystem::path studies = std::filesystem::path(source_folder) / "studies";

std::vector<Problem> problems_of_scene(const Json& document) {
  std::vector<Problem> problems;
  (void)read_scene(JsonCursor(document, "", problems));
  return problems;
}

std::vector<Problem> problems_of_campaign(const Json& document) {
  try {
    (void)read_campaign(document.dump(), studies / "campaigns");
    return {};
  } catch (const SpecError& error) {
    return error.problems();
  }
}

std::vector<Json> shipped(const char* folder) {
  std::vector<Json> all;
  for (const auto& entry : std::filesystem::directory_iterator(studies / folder))
    if (entry.path().extension() == ".json") all.push_back(parse_json_file(entry.path()));
  return all;
}

/// A schema, and all documents that its readers take.
struct Subject {
  Json schema;
  std::vector<Json> documents;
  std::vector<Problem> (*problems_of)(const Json&);
};

std::vector<Json> joined(std::vector<Json> a, std::vector<Json> b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

Subject scenes() {
  return {scene_schema().schema, joined(scene_specimens(), shipped("scenes")), problems_of_scene};
}
Subject campaigns() {
  return {campaign_schema().schema, joined(campaign_specimens(), shipped("campaigns")),
          problems_of_campaign};
}

std::set<std::string> keys_of(const Json& object) {
  std::set<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.insert(key);
  return keys;
}

/// Whether a part of a schema may be about the value: by its type and, of an object, by its keys and by the words that
/// decide on them.
bool is_about(const Json& part, const Json& value) {
  if (part.contains("enum")) return value.is_string();
  const std::string type = part.value("type", "");
  if (!value.is_object())
    return (type == "array" && value.is_array()) || (type == "string" && value.is_string()) ||
           ((type == "number" || type == "integer") && value.is_number()) ||
           (type == "boolean" && value.is_boolean());
  if (type != "object" || !part.contains("properties")) return type == "object";
  return std::ranges::all_of(value.items(), [&](const auto& item) {
    const auto property = part["properties"].find(item.key());
    if (property == part["properties"].end()) return false;
    const auto words = property->find("enum");
    return words == property->end() || !item.value().is_string() ||
           std::ranges::find(*words, item.value()) != words->end();
  });
}

/// @param whole the schema, which has the definitions
std::vector<const Json*> parts_about(const Json& schema, const Json& value, const Json& whole) {
  if (const auto named = schema.find("$ref"); named != schema.end())
    return parts_about(whole.at(Json::json_pointer(named->get<std::string>().substr(1))), value,
                       whole);
  if (!schema.contains("anyOf")) return {&schema};
  std::vector<const Json*> parts;
  for (const Json& part : schema["anyOf"])
    if (part.contains("$ref")) {
      if (value.is_object())
        for (const Json* each : parts_about(part, value, whole)) parts.push_back(each);
    } else if (is_about(part, value)) {
      parts.push_back(&part);
    }
  return parts;
}

/// Calls visit(pointer, value, parts of the schema about it) for the document and all that it holds.
template <class Visit> class Walk {
public:
  Walk(const Json& whole, const Visit& visit) : whole_(whole), visit_(visit) {}

  void over(const Json& value, const Json& schema, const std::string& pointer) const {
    const std::vector<const Json*> parts = parts_about(schema, value, whole_);
    visit_(pointer, value, parts);
    if (parts.empty()) return;
    if (value.is_array())
      for (std::size_t i = 0; i < value.size(); ++i)
        over(value[i], parts[0]->at("items"), pointer + '/' + std::to_string(i));
    if (!value.is_object()) return;
    for (const auto& [key, member] : value.items()) {
      const std::string below = pointer + pointer_token(key);
      if (parts[0]->contains("properties"))
        over(member, (*parts[0])["properties"].at(key), below);
      else if (parts[0]->contains("additionalProperties"))
        over(member, (*parts[0])["additionalProperties"], below);
    }
  }

private:
  const Json& whole_;
  const Visit& visit_;
};

template <class Visit> void walk(const Json& document, const Json& schema, const Visit& visit) {
  Walk(schema, visit).over(document, schema, "");
}

/// The keys that the reader itself says it knows at a place, once it is given one that it does not know.
std::set<std::string> known_keys(const Subject& subject, Json document,
                                 const std::string& pointer) {
  const std::string unheard_of = "qqqqqqqqqqqqqqqqqqqqqqqqqqqqqq";
  document[Json::json_pointer(pointer)][unheard_of] = 1;
  std::set<std::string> keys;
  for (const Problem& problem : subject.problems_of(document)) {
    if (problem.pointer != pointer + '/' + unheard_of) continue;
    std::istringstream words(problem.expected);
    for (std::string text, word; std::getline(words, text, '"') && std::getline(words, word, '"');)
      keys.insert(word);
  }
  return keys;
}

} // namespace

TEST_CASE(
    "the specimens of schemas have every key that readers know, and are read without a problem") {
  CHECK(scene_schema().gaps == std::vector<std::string>{});
  CHECK(campaign_schema().gaps == std::vector<std::string>{});
  for (const Json& scene : scene_specimens())
    for (const Problem& problem : problems_of_scene(scene)) CHECK(to_string(problem) == "");
  for (const Json& campaign : campaign_specimens())
    for (const Problem& problem : problems_of_campaign(campaign))
      CHECK(problem.found.find("no_such_file") != std::string::npos);
}

TEST_CASE("at every object of every file, schema and reader know the same keys") {
  for (const Subject& subject : {scenes(), campaigns()}) {
    long objects = 0;
    for (const Json& document : subject.documents) {
      INFO(document.dump().substr(0, 60));
      walk(document, subject.schema,
           [&](const std::string& pointer, const Json& value,
               const std::vector<const Json*>& parts) {
             INFO(pointer);
             REQUIRE_FALSE(parts.empty());
             if (!value.is_object() || !parts[0]->contains("properties")) return;
             const std::set<std::string> known = known_keys(subject, document, pointer);
             CHECK(std::ranges::any_of(
                 parts, [&](const Json* part) { return keys_of((*part)["properties"]) == known; }));
             ++objects;
           });
    }
    CHECK(objects > 100);
  }
}

TEST_CASE("a truth value in place of an object is told once, and nothing of what it lacks") {
  Subject scene = scenes(), campaign = campaigns();
  scene.documents = scene_specimens(), campaign.documents = campaign_specimens();
  for (const Subject& subject : {scene, campaign})
    for (const Json& document : subject.documents)
      walk(document, subject.schema,
           [&](const std::string& pointer, const Json& value, const std::vector<const Json*>&) {
             if (!value.is_object() || pointer == "/wingspread") return; // a stamp may be anything
             Json changed = document;
             changed[Json::json_pointer(pointer)] = true;
             std::vector<std::string> of_it;
             for (const Problem& problem : subject.problems_of(changed))
               if (problem.pointer == pointer || problem.pointer.starts_with(pointer + '/'))
                 of_it.push_back(to_string(problem));
             CAPTURE(pointer, of_it);
             CHECK(of_it.size() == 1);
           });
}

TEST_CASE("what a schema requires the reader misses") {
  for (const Subject& subject : {scenes(), campaigns()})
    for (const Json& document : subject.documents)
      walk(document, subject.schema,
           [&](const std::string& pointer, const Json& value,
               const std::vector<const Json*>& parts) {
             if (!value.is_object() || parts.size() != 1 || !parts[0]->contains("required")) return;
             for (const Json& key : (*parts[0])["required"]) {
               INFO(pointer << " without " << key);
               Json without = document;
               without[Json::json_pointer(pointer)].erase(key.get<std::string>());
               const std::string place =
                   pointer + '/'; // another key may then be the one that is missed
               CHECK(std::ranges::any_of(subject.problems_of(without), [&](const Problem& problem) {
                 return problem.pointer.starts_with(place) && problem.found == "nothing";
               }));
             }
           });
}

TEST_CASE("a number beyond a schema's bounds is one that the reader refuses") {
  long checked = 0;
  for (const Subject& subject : {scenes(), campaigns()})
    for (const Json& document : subject.documents) {
      const std::size_t before = subject.problems_of(document).size();
      walk(document, subject.schema,
           [&](const std::string& pointer, const Json& value,
               const std::vector<const Json*>& parts) {
             if (!value.is_number() || parts.size() != 1) return;
             for (const auto& [keyword, beyond] : {std::pair{"minimum", -1.0},
                                                   {"exclusiveMinimum", 0.0},
                                                   {"maximum", 1.0},
                                                   {"exclusiveMaximum", 0.0}})
               if (parts[0]->contains(keyword)) {
                 INFO(pointer << " " << keyword);
                 Json changed = document;
                 changed[Json::json_pointer(pointer)] = (*parts[0])[keyword].get<double>() + beyond;
                 CHECK(subject.problems_of(changed).size() > before);
                 ++checked;
               }
           });
    }
  CHECK(checked > 300);
}

TEST_CASE("a reader that has learnt a key which no specimen has leaves a gap, and so does a word") {
  const auto recorded = [](const char* text) {
    Specimen specimen{parse_json(text), {}};
    std::vector<Problem> problems;
    constexpr std::array<std::string_view, 2> laws{"round", "flat"};
    JsonObject thing(JsonCursor(specimen.document, "", problems, &specimen.questions), "a thing");
    double size = 0;
    std::size_t law = 0;
    thing.required("size", size, Dimension{"m", "> 0"});
    if (thing.required_choice("law", law, laws) && law == 1)
      thing.required("edge", size, "a number");
    thing.refuse_others();
    return specimen;
  };
  const RecordedSchema half = recorded_schema({recorded(R"({ "size": 1, "law": "flat" })")});
  CHECK(half.gaps == std::vector<std::string>{"/edge: a key that no specimen has"});
  const RecordedSchema both =
      recorded_schema({recorded(R"({ "size": 1, "law": "flat", "edge": 2 })"),
                       recorded(R"({ "size": 1, "law": "round" })")});
  CHECK(both.gaps.empty());
  CHECK(both.schema["anyOf"][0]["properties"]["law"]["enum"] == Json{"flat"});
  CHECK(both.schema["anyOf"][0]["required"] == Json{"edge", "law", "size"});
  CHECK(both.schema["anyOf"][1]["required"] == Json{"law", "size"});
  const Json& size = both.schema["anyOf"][1]["properties"]["size"];
  CHECK(size["description"] == expected_quantity({"m", "> 0"}));
  CHECK(size["anyOf"][0] == Json{{"type", "number"}, {"exclusiveMinimum", 0.0}});
  CHECK(size["anyOf"][1] == Json{{"type", "string"}});
}

namespace {

/// Calls visit(place, property) for every property below a part of a schema.
template <class Visit>
void over_properties(const Json& part, const std::string& place, const Visit& visit) {
  for (const char* key : {"anyOf", "definitions"})
    if (part.contains(key))
      for (const Json& each : part[key]) over_properties(each, place, visit);
  for (const char* key : {"items", "additionalProperties"})
    if (part.contains(key) && part[key].is_object())
      over_properties(part[key], place + "/*", visit);
  if (!part.contains("properties")) return;
  for (const auto& [key, property] : part["properties"].items()) {
    visit(place + '/' + key, property);
    over_properties(property, place + '/' + key, visit);
  }
}

bool has_type(const Json& property, const char* type) {
  return property.contains("anyOf") &&
         std::ranges::any_of(property["anyOf"],
                             [&](const Json& part) { return part.value("type", "") == type; });
}

} // namespace

TEST_CASE("every property of a schema has a description, and a quantity's names its unit") {
  for (const Json& schema : {scene_schema().schema, campaign_schema().schema}) {
    long properties = 0, quantities = 0;
    over_properties(schema, "", [&](const std::string& place, const Json& property) {
      CAPTURE(place, property.dump());
      const std::string text = property.value("description", "");
      CHECK(!text.empty());
      ++properties;
      if (!has_type(property, "number") || !has_type(property, "string")) return;
      CHECK(text.find("unit") != std::string::npos);
      ++quantities;
    });
    CHECK((properties > 80 && quantities > 30));
  }
}

TEST_CASE("where other keys decide the unit, the description says so") {
  const auto text_at = [](const Json& schema, const char* end) {
    std::string text;
    over_properties(schema, "", [&](const std::string& place, const Json& property) {
      if (place.ends_with(end)) text += property["description"].get<std::string>() + '\n';
    });
    return text;
  };
  const Json campaign = campaign_schema().schema, scene = scene_schema().schema;
  for (const char* end : {"requirements/*/max", "until/*/width"})
    CHECK_THAT(text_at(campaign, end), Catch::StartsWith("a number, in the output's unit"));
  CHECK_THAT(text_at(scene, "damper/coefficient"),
             Catch::Contains("N·m·(s/rad)^exponent") && Catch::Contains("N·m·s/rad"));
  CHECK_THAT(text_at(campaign, "/mean"),
             Catch::StartsWith("a number, in the unit of the parameter that is drawn"));
  CHECK_THAT(text_at(campaign, "through/*/table"), Catch::Contains("monotone cubic"));
  for (const char* end : {"spring/table", "rate/table", "ratio/table"})
    CHECK_THAT(text_at(scene, end), Catch::Contains("monotone cubic"));
}

TEST_CASE("bounds are read off what readers expect") {
  CHECK(bounds_of("a number, kg, > 0") == Json{{"exclusiveMinimum", 0.0}});
  CHECK(bounds_of("a number, > 0 and < 1, or \"auto\"") ==
        Json{{"exclusiveMinimum", 0.0}, {"exclusiveMaximum", 1.0}});
  CHECK(bounds_of("a number, ≥ 1e-15 and < 1, or \"auto\"") ==
        Json{{"minimum", 1e-15}, {"exclusiveMaximum", 1.0}});
  CHECK(bounds_of("an integer from 2 to 200") == Json{{"minimum", 2.0}, {"maximum", 200.0}});
  CHECK(bounds_of("an integer from 0 to 2^64 - 1") == Json{{"minimum", 0.0}});
  CHECK(bounds_of("a number, > -1 and < 1") ==
        Json{{"exclusiveMinimum", -1.0}, {"exclusiveMaximum", 1.0}});
  CHECK(bounds_of("a number, N·m, ≥ coulomb") == Json::object());
  CHECK(bounds_of("a number") == Json::object());
}

TEST_CASE("a scene or campaign may name its schema") {
  const auto check = [](Json document, std::vector<Problem> (*problems_of)(const Json&)) {
    document["$schema"] = "a.schema.json";
    CHECK(problems_of(document).empty());
    document["$schema"] = 3;
    const std::vector<Problem> problems = problems_of(document);
    REQUIRE(problems.size() == 1);
    CHECK(problems[0].pointer == "/$schema");
  };
  check(shipped("scenes").front(), problems_of_scene);
  check(shipped("campaigns").front(), problems_of_campaign);
}
