#include "montecarlo/model/schema/recorded_schema.hpp"

#include "montecarlo/foundation/formats/number_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>

namespace wingspread {
namespace {

using What = Question::What;
using Questions = std::vector<const Question*>;

/// A value of a specimen with its questions.
struct Instance {
  const Json* value;
  const std::map<std::string, Questions>* by_pointer; ///< questions of the whole specimen
  std::string pointer;

  [[nodiscard]] Questions questions() const {
    const auto found = by_pointer->find(pointer);
    return found == by_pointer->end() ? Questions{} : found->second;
  }
  [[nodiscard]] bool has(What what) const {
    return std::ranges::any_of(questions(),
                               [&](const Question* each) { return each->what == what; });
  }
  /// The kind's name if objects of the kind occur in several places; else empty.
  [[nodiscard]] std::string kind() const {
    for (const Question* each : questions())
      if (each->what == What::object && !each->key.empty()) return each->key;
    return "";
  }
  /// Whether a question was asked of the value or anything inside it.
  [[nodiscard]] bool was_read() const {
    const auto next = by_pointer->lower_bound(pointer);
    return next != by_pointer->end() &&
           (next->first == pointer || next->first.starts_with(pointer + '/'));
  }
  [[nodiscard]] Instance member(const std::string& key) const {
    return {&value->at(key), by_pointer, pointer + pointer_token(key)};
  }
  [[nodiscard]] Instance element(std::size_t i) const {
    return {&value->at(i), by_pointer, fmt::format("{}/{}", pointer, i)};
  }
};
using Instances = std::vector<Instance>;

/// Objects for which the reader knows the same keys.
struct Shape {
  std::set<std::string> keys;
  Instances instances;
};

template <class Test> Instances those(const Instances& all, const Test& test) {
  Instances some;
  std::ranges::copy_if(all, std::back_inserter(some), test);
  return some;
}

Instances with_key(const Instances& all, const std::string& key) {
  Instances values;
  for (const Instance& each : all)
    if (each.value->contains(key)) values.push_back(each.member(key));
  return values;
}

/// Whether all objects have the key and a reader required it of one of them.
bool is_required(const Instances& objects, const std::string& key) {
  const auto says_so = [&](const Instance& object) {
    return std::ranges::any_of(object.questions(), [&](const Question* each) {
      return each->what == What::required_key && each->key == key;
    });
  };
  return std::ranges::any_of(objects, says_so) &&
         std::ranges::all_of(objects,
                             [&](const Instance& each) { return each.value->contains(key); });
}

/// The expectation of the first reader that requires the key; empty if none does.
std::string required_text(const Instances& objects, const std::string& key) {
  for (const Instance& object : objects)
    for (const Question* each : object.questions())
      if (each->what == What::required_key && each->key == key) return each->expected;
  return "";
}

class Builder {
public:
  /// @param kinds all objects of each kind that occurs in several places
  explicit Builder(std::map<std::string, Instances> kinds) : kinds_(std::move(kinds)) {}

  [[nodiscard]] Json definitions() {
    Json all = Json::object();
    for (const auto& [kind, objects] : kinds_) {
      Json parts = Json::array();
      add_shapes(shapes_of(objects), kind, parts);
      all[kind] = as_one(objects, std::move(parts));
    }
    return all;
  }

  [[nodiscard]] Json schema_of(const Instances& all, const std::string& place) {
    Json parts = Json::array();
    const auto add = [&](const Instances& some, auto make) {
      if (!some.empty()) make(some);
    };
    add(those(all, [](const Instance& each) { return each.value->is_boolean(); }),
        [&](const Instances&) {
          parts.push_back({{"type", "boolean"}});
        });
    add_numbers(all, parts);
    add_strings(all, parts);
    add(those(all, [](const Instance& each) { return each.value->is_array(); }),
        [&](const Instances& some) { parts.push_back(array_schema(some, place)); });
    add(those(all, [](const Instance& each) { return each.value->is_object(); }),
        [&](const Instances& some) { add_objects(some, place, parts); });
    return as_one(all, std::move(parts));
  }

  std::vector<std::string> gaps;

private:
  static Json as_one(const Instances& all, Json parts) {
    Json schema = Json::object();
    if (const std::string expected = description_of(all); !expected.empty())
      schema["description"] = expected;
    else if (std::string derived = derived_description(parts); !derived.empty())
      schema["description"] = std::move(derived);
    if (parts.size() == 1)
      schema.update(parts[0]);
    else
      schema["anyOf"] = std::move(parts);
    return schema;
  }

  /// The description of a value of which no reader states an expectation: by its type, and its elements' descriptions.
  static std::string derived_description(const Json& parts) {
    if (parts.empty()) return "";
    const Json& part = parts.front();
    const std::string type = part.value("type", "");
    const auto of = [&](const char* key) {
      return part.contains(key) ? ": " + part[key].value("description", "") : std::string();
    };
    if (type == "boolean") return "true or false";
    if (type == "array") return "an array; each element" + of("items");
    if (type == "object" && !part.contains("properties"))
      return "an object" + (part.contains("additionalProperties")
                                ? "; each value" + of("additionalProperties")
                                : "");
    return "";
  }
  /// The expectation of the first reader that states one; and of the first that takes units, if the value may have
  /// some.
  static std::string description_of(const Instances& all) {
    std::string first, quantity;
    for (const Instance& each : all)
      for (const Question* question : each.questions()) {
        if (!question->key.empty() || question->expected.empty()) continue;
        if (first.empty()) first = question->expected;
        if (quantity.empty() && question->what == What::quantity) quantity = question->expected;
      }
    if (quantity.empty() || first.find("its unit") != std::string::npos) return first;
    return quantity.starts_with(first) ? quantity : first + "; or " + quantity;
  }
  static bool any_question(const Instances& all, std::initializer_list<What> kinds) {
    return std::ranges::any_of(all, [&](const Instance& each) {
      return std::ranges::any_of(kinds, [&](What kind) { return each.has(kind); });
    });
  }

  static void add_numbers(const Instances& all, Json& parts) {
    const bool given =
        std::ranges::any_of(all, [](const Instance& each) { return each.value->is_number(); });
    const bool real = any_question(all, {What::number, What::quantity});
    if (!given && !real && !any_question(all, {What::integer})) return;
    Json part{{"type", real ? "number" : "integer"}};
    std::set<std::string> bounds; // used only if all readers agree
    for (const Instance& each : all)
      for (const Question* question : each.questions())
        if (question->what == What::number || question->what == What::quantity ||
            question->what == What::integer)
          bounds.insert(bounds_of(question->expected).dump());
    if (bounds.size() == 1) part.update(Json::parse(*bounds.begin()));
    parts.push_back(std::move(part));
  }

  /// Free text, or an enumeration: the words of choices and the strings in specimens.
  static void add_strings(const Instances& all, Json& parts) {
    if (any_question(all, {What::text, What::quantity}))
      return void(parts.push_back({{"type", "string"}}));
    Json words = Json::array();
    const auto add = [&](const std::string& word) {
      if (std::ranges::find(words, Json(word)) == words.end()) words.push_back(word);
    };
    for (const Instance& each : all) {
      for (const Question* question : each.questions())
        if (question->what == What::choice) std::ranges::for_each(question->words, add);
      if (each.value->is_string()) add(each.value->get<std::string>());
    }
    if (!words.empty()) parts.push_back({{"enum", std::move(words)}});
  }

  Json array_schema(const Instances& arrays, const std::string& place) {
    Instances elements;
    for (const Instance& each : arrays)
      for (std::size_t i = 0; i < each.value->size(); ++i) elements.push_back(each.element(i));
    if (elements.empty()) gaps.push_back(place + ": an array without elements");
    Json part{{"type", "array"}, {"items", schema_of(elements, place + "/*")}};
    if (any_question(arrays, {What::pair})) part["minItems"] = part["maxItems"] = 2;
    return part;
  }

  void add_objects(const Instances& all, const std::string& place, Json& parts) {
    std::set<std::string> kinds;
    for (const Instance& each : all) kinds.insert(each.kind());
    for (const std::string& kind : kinds)
      if (!kind.empty()) parts.push_back({{"$ref", "#/definitions/" + kind}});
    const Instances objects = those(all, [](const Instance& each) { return each.kind().empty(); });
    if (objects.empty()) return;
    const bool is_format =
        any_question(objects, {What::object}) && !any_question(objects, {What::names});
    if (is_format) return add_shapes(shapes_of(objects), place, parts);
    Instances values;
    for (const Instance& each : objects)
      if (each.was_read())
        for (const auto& [key, value] : each.value->items()) values.push_back(each.member(key));
    Json part{{"type", "object"}};
    if (!values.empty()) part["additionalProperties"] = schema_of(values, place + "/*");
    parts.push_back(std::move(part));
  }

  static std::vector<Shape> shapes_of(const Instances& objects) {
    std::vector<Shape> shapes;
    for (const Instance& object : objects) {
      std::set<std::string> keys;
      for (const Question* question : object.questions())
        if (question->what == What::key || question->what == What::required_key)
          keys.insert(question->key);
      const auto same = std::ranges::find(shapes, keys, &Shape::keys);
      if (same == shapes.end())
        shapes.push_back({std::move(keys), {object}});
      else
        same->instances.push_back(object);
    }
    return shapes;
  }

  /// The keys of choices that decide an object's shape: required by every shape, with no word common to two shapes.
  static std::set<std::string> deciding_keys(const std::vector<Shape>& shapes) {
    std::set<std::string> deciding;
    for (const std::string& key : shapes[0].keys) {
      std::set<Json> seen;
      const auto is_decided = [&](const Shape& shape) {
        const Instances values = with_key(shape.instances, key);
        if (!is_required(shape.instances, key) || !any_question(values, {What::choice}))
          return false;
        std::set<Json> own;
        for (const Instance& each : values) own.insert(*each.value);
        return std::ranges::all_of(own, [&](const Json& word) { return seen.insert(word).second; });
      };
      if (shapes.size() > 1 && std::ranges::all_of(shapes, is_decided)) deciding.insert(key);
    }
    return deciding;
  }

  void add_shapes(const std::vector<Shape>& shapes, const std::string& place, Json& parts) {
    const std::set<std::string> deciding = deciding_keys(shapes);
    Instances everywhere;
    for (const Shape& shape : shapes)
      everywhere.insert(everywhere.end(), shape.instances.begin(), shape.instances.end());
    for (const std::string& key : deciding)
      check_words(with_key(everywhere, key), fmt::format("{}/{}", place, key));
    for (const Shape& shape : shapes) {
      Json part{{"type", "object"}, {"properties", Json::object()}};
      Json required = Json::array();
      for (const std::string& key : shape.keys) {
        Instances values = with_key(shape.instances, key);
        const auto is_object = [](const Instance& each) { return each.value->is_object(); };
        if (values.empty() ||
            std::ranges::any_of(values, is_object)) // all shapes have the same reader
          values = with_key(everywhere, key);
        if (values.empty())
          gaps.push_back(fmt::format("{}/{}: a key that no specimen has", place, key));
        Json& property = part["properties"][key];
        property = deciding.contains(key) ? words_schema(values)
                                          : schema_of(values, fmt::format("{}/{}", place, key));
        if (const std::string expected = required_text(everywhere, key);
            !expected.empty() && description_of(values).empty())
          property["description"] = expected;
        if (is_required(shape.instances, key)) required.push_back(key);
      }
      if (!required.empty()) part["required"] = std::move(required);
      part["additionalProperties"] = false;
      parts.push_back(std::move(part));
    }
  }

  void check_words(const Instances& values, const std::string& place) {
    std::set<std::string> seen;
    for (const Instance& each : values) seen.insert(each.value->get<std::string>());
    for (const Question* question : values[0].questions())
      for (const std::string& word : question->words)
        if (!seen.contains(word))
          gaps.push_back(fmt::format("{}: the word \"{}\" that no specimen has", place, word));
  }

  /// An enumeration of the words in these values.
  static Json words_schema(const Instances& values) {
    Json words = Json::array();
    for (const Instance& each : values)
      if (std::ranges::find(words, *each.value) == words.end()) words.push_back(*each.value);
    return {{"description", description_of(values)}, {"enum", std::move(words)}};
  }

  std::map<std::string, Instances> kinds_;
};

} // namespace

RecordedSchema recorded_schema(const std::vector<Specimen>& specimens) {
  std::vector<std::map<std::string, Questions>> by_pointer(specimens.size());
  Instances roots;
  std::map<std::string, Instances> kinds;
  for (std::size_t i = 0; i < specimens.size(); ++i) {
    const auto& [document, questions] = specimens[i];
    for (const Question& question : questions) by_pointer[i][question.pointer].push_back(&question);
    roots.push_back({&document, &by_pointer[i], ""});
    for (const Question& question : questions)
      if (question.what == What::object && !question.key.empty())
        kinds[question.key].push_back(
            {&document.at(Json::json_pointer(question.pointer)), &by_pointer[i], question.pointer});
  }
  Builder builder(std::move(kinds));
  Json schema = builder.schema_of(roots, "");
  if (Json definitions = builder.definitions(); !definitions.empty())
    schema["definitions"] = std::move(definitions);
  return {std::move(schema), std::move(builder.gaps)};
}

Json bounds_of(std::string_view expected) {
  Json bounds = Json::object();
  const auto number_after = [&](std::string_view mark) -> std::optional<double> {
    const std::size_t at = expected.find(mark);
    if (at == std::string_view::npos) return std::nullopt;
    std::string_view rest = expected.substr(at + mark.size());
    rest = rest.substr(0, rest.find_first_not_of("-0123456789.e"));
    return parse_number<double>(rest);
  };
  constexpr std::pair<const char*, const char*> marks[] = {{"> ", "exclusiveMinimum"},
                                                           {"≥ ", "minimum"},
                                                           {"< ", "exclusiveMaximum"},
                                                           {"≤ ", "maximum"},
                                                           {" from ", "minimum"}};
  for (const auto& [mark, keyword] : marks)
    if (const auto number = number_after(mark)) bounds[keyword] = *number;
  const bool to_a_power = expected.find('^', expected.find(" to ")) != std::string_view::npos;
  if (const auto last = number_after(" to "); last && bounds.contains("minimum") && !to_a_power)
    bounds["maximum"] = *last;
  return bounds;
}

} // namespace wingspread
