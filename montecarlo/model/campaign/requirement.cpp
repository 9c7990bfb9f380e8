#include "montecarlo/model/campaign/requirement.hpp"

#include "montecarlo/foundation/formats/nearest.hpp"
#include "montecarlo/foundation/formats/output_name.hpp"
#include "montecarlo/foundation/formats/printable.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/foundation/statistics/bonferroni.hpp"
#include "montecarlo/model/campaign/outputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

namespace wingspread {
namespace {

bool is_name(const std::string& text) { return !text.empty() && !has_control_characters(text); }

/// The keys that name a requirement for the report's reader.
constexpr std::array<std::pair<const char*, std::string Requirement::*>, 3> words_about{
    {{"id", &Requirement::id},
     {"source", &Requirement::source},
     {"rationale", &Requirement::rationale}}};

bool contains(std::span<const std::string> names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

void refuse_unknown_output(const JsonCursor& at, const std::string& output,
                           const std::vector<std::string>& outputs,
                           std::span<const std::string> all_outputs) {
  if (output == deployed_output || contains(outputs, output)) return;
  if (const auto family = family_of(output); family && contains(all_outputs, output))
    return void(at.refuse(fmt::format("an output that the campaign asks for (\"{}\" is not in its "
                                      "\"outputs\")",
                                      about(*family).name)));
  std::vector<std::string> known = outputs;
  known.emplace_back(deployed_output);
  at.refuse("an output of the campaign, or \"deployed\"" + did_you_mean(output, known));
}

/// Reads a number in the output's unit, or a string with a unit.
bool read_limit(const JsonCursor& at, const std::string& output, double& limit) {
  const std::string unit = parse_output_name(output).unit;
  at.note_quantity("in the output's unit");
  return at.value().is_string() && !unit.empty() ? at.read(limit, Dimension{unit})
                                                 : at.read(limit, "a number, in the output's unit");
}

void read_limits(JsonObject& object, Requirement& requirement) {
  const auto read = [&](const char* key, std::optional<double>& limit) {
    const auto at = object.find(key);
    double value = 0;
    if (at && read_limit(*at, requirement.output, value)) limit = value;
    return at.has_value();
  };
  const bool has_max = read("max", requirement.max), has_min = read("min", requirement.min);
  if (!object.is_object() || requirement.output.empty()) return;
  if (requirement.output == deployed_output) {
    if (has_max || has_min)
      object.at().refuse("a limit", "neither max nor min: a run has deployed or has not");
  } else if (has_max == has_min) {
    object.at().refuse(has_max ? "both max and min" : "neither max nor min",
                       "one of them (write two requirements for both)");
  }
}

void read_absolute(JsonObject& object, Requirement& requirement) {
  const auto at = object.find("abs");
  if (!at) return;
  if (!at->value().is_boolean())
    at->refuse("true or false");
  else if (requirement.output == deployed_output)
    at->refuse("an output with a limit: a run has deployed or has not");
  else
    requirement.absolute = at->value().get<bool>();
}

/// Notes each member of a group with another confidence than the first: a group has one joint confidence.
void check_groups(const JsonCursor& at, std::span<const Requirement> requirements) {
  for (std::size_t i = 0; i < requirements.size(); ++i) {
    const Requirement& own = requirements[i];
    const auto first = std::ranges::find(requirements, own.group, &Requirement::group);
    if (own.group.empty() || own.confidence == first->confidence || own.confidence == 0) continue;
    at.element(i).refuse(
        fmt::format("{}", own.confidence),
        fmt::format("{}, the joint confidence of the group \"{}\"", first->confidence, own.group),
        "/confidence");
  }
}

/// Notes each identifier that an earlier requirement has.
void refuse_repeated_ids(const JsonCursor& at, std::span<const Requirement> requirements) {
  for (std::size_t i = 1; i < requirements.size(); ++i)
    if (const std::string& id = requirements[i].id;
        !id.empty() && std::ranges::count(requirements.first(i), id, &Requirement::id) > 0)
      at.element(i).member("id").refuse_repeated("an identifier of its own");
}

/// Whether both state the same, whatever they are called and where they come from. In another group it is another
/// statement, judged at another confidence.
bool state_the_same(const Requirement& a, const Requirement& b) {
  const auto statement = [](const Requirement& one) {
    return std::tie(one.output, one.max, one.min, one.absolute, one.probability, one.confidence,
                    one.group);
  };
  return statement(a) == statement(b);
}

/// Notes each requirement that an earlier one states.
void refuse_repeated_requirements(const JsonCursor& at, std::span<const Requirement> requirements) {
  for (std::size_t i = 1; i < requirements.size(); ++i) {
    const auto first = std::ranges::find_if(requirements.first(i), [&](const Requirement& other) {
      return state_the_same(other, requirements[i]);
    });
    if (first != requirements.begin() + static_cast<std::ptrdiff_t>(i))
      at.element(i).refuse(fmt::format("the requirement of {}/{} a second time", at.pointer(),
                                       first - requirements.begin()),
                           "each requirement once");
    const std::string& name = requirements[i].name;
    if (!name.empty() && std::ranges::find(requirements.first(i), name, &Requirement::name) !=
                             requirements.begin() + static_cast<std::ptrdiff_t>(i))
      at.element(i).member("name").refuse(fmt::format("\"{}\" a second time", name),
                                          "another name: goals and verdicts go by it");
  }
}

/// Reads a requirement on a static margin. Its only limit is `min`, 0 by default.
void read_static_margin(JsonObject& object, const Scene* scene, Requirement& requirement) {
  requirement.static_margin.emplace();
  read_required_margin(object, scene, *requirement.static_margin);
  requirement.output = name_of(*requirement.static_margin);
  requirement.min = 0;
  object.optional("min", *requirement.min, "a number");
}

void read_output(JsonObject& object, const std::vector<std::string>* outputs,
                 std::span<const std::string> all_outputs, Requirement& requirement) {
  const bool named =
      object.required("output", requirement.output, "a string, an output or \"deployed\"");
  if (named && outputs && object.is_object())
    refuse_unknown_output(object.at().member("output"), requirement.output, *outputs, all_outputs);
  read_limits(object, requirement);
  read_absolute(object, requirement);
}

Requirement read_requirement(const JsonCursor& at, const std::vector<std::string>* outputs,
                             std::span<const std::string> all_outputs, const Scene* scene,
                             Judged judged) {
  Requirement requirement;
  JsonObject object(at, "a requirement: an object");
  object.optional("name", requirement.name, "a string, not empty, without control characters",
                  is_name);
  if (at.value().is_object() && at.value().contains("motorization"))
    read_static_margin(object, scene, requirement);
  else
    read_output(object, outputs, all_outputs, requirement);
  object.optional("group", requirement.group, "a string, not empty, without control characters",
                  is_name);
  for (const auto& [key, member] : words_about)
    object.optional(key, requirement.*member, "a string, not empty, without control characters",
                    is_name);
  object.required("probability", requirement.probability, "a number, > 0 and < 1", is_proper_share);
  object.required("confidence", requirement.confidence, "a number, > 0 and < 1", is_proper_share);
  if (judged == Judged::no || !object.find("verdict")) object.refuse_others();
  return requirement;
}

} // namespace

double confidence_alone(std::span<const Requirement> all, const Requirement& requirement) {
  if (requirement.group.empty()) return requirement.confidence;
  return at_each_of(requirement.confidence,
                    std::ranges::count(all, requirement.group, &Requirement::group));
}

MissingRank missing_rank(std::span<const Requirement> requirements, const std::string& output) {
  const OutputKind* kind = parse_output_name(output).kind;
  bool above = false, below = false;
  for (const Requirement& each : requirements) {
    if (each.output != output) continue;
    const bool both = each.absolute && (!kind || kind->has_sign);
    above = above || each.max || both;
    below = below || each.min || both;
  }
  if (above && below) return MissingRank::either;
  return below ? MissingRank::below : MissingRank::above;
}

const std::string& name_of(const Requirement& requirement) {
  return requirement.name.empty() ? requirement.output : requirement.name;
}

void read_requirements(const JsonCursor& at, const std::vector<std::string>* outputs,
                       std::span<const std::string> all_outputs,
                       std::vector<Requirement>& requirements, const Scene* scene, Judged judged) {
  if (!at.value().is_array()) return void(at.refuse("an array of requirements"));
  requirements.clear();
  const std::size_t before = at.problems().size();
  for (const JsonCursor& element : at.elements())
    requirements.push_back(read_requirement(element, outputs, all_outputs, scene, judged));
  check_groups(at, requirements);
  refuse_repeated_ids(at, requirements);
  if (at.problems().size() == before) refuse_repeated_requirements(at, requirements);
}

bool is_late_limit(const std::string& output, double limit, double t_end) {
  const std::string quantity = parse_output_name(output).quantity;
  return (quantity == "latch_time" || quantity == "deployment_time") && !(limit <= t_end);
}

void refuse_late_limits(const JsonCursor& at, std::span<const Requirement> requirements,
                        double t_end) {
  for (std::size_t i = 0; i < requirements.size(); ++i) {
    const Requirement& own = requirements[i];
    const std::optional<double> limit = own.max ? own.max : own.min;
    if (!limit || !is_late_limit(own.output, *limit, t_end)) continue;
    at.element(i)
        .member(own.max ? "max" : "min")
        .refuse(fmt::format("at most t_end, {} s: a hinge that has not latched by then breaks the "
                            "requirement (raise t_end for a later limit)",
                            t_end));
  }
}

Json write_requirements(std::span<const Requirement> requirements) {
  Json list = Json::array();
  for (const Requirement& requirement : requirements) {
    Json json = Json::object();
    if (!requirement.name.empty()) json["name"] = requirement.name;
    if (requirement.static_margin) {
      json["motorization"] = word_of(*requirement.static_margin);
      json["hinge"] = requirement.static_margin->hinge;
    } else {
      json["output"] = requirement.output;
    }
    if (requirement.max) json["max"] = *requirement.max;
    if (requirement.min) json["min"] = *requirement.min;
    if (requirement.absolute) json["abs"] = true;
    json["probability"] = requirement.probability;
    json["confidence"] = requirement.confidence;
    if (!requirement.group.empty()) json["group"] = requirement.group;
    for (const auto& [key, member] : words_about)
      if (!(requirement.*member).empty()) json[key] = requirement.*member;
    list.push_back(std::move(json));
  }
  return list;
}

std::string to_string(const Requirement& requirement) {
  std::string text = requirement.name.empty() ? "" : requirement.name + ": ";
  text += requirement.absolute ? '|' + requirement.output + '|' : requirement.output;
  const std::string unit = parse_output_name(requirement.output).unit;
  if (requirement.max) text += " ≤ " + as_written(*requirement.max, unit);
  if (requirement.min) text += " ≥ " + as_written(*requirement.min, unit);
  text += fmt::format(", {:.10g} % at {:.10g} %", 100 * requirement.probability,
                      100 * requirement.confidence);
  return requirement.group.empty() ? text : text + " in group " + requirement.group;
}

double in_unit_of_limit(const Requirement& requirement, double value) {
  const std::optional<double> limit = requirement.max ? requirement.max : requirement.min;
  return limit ? value * factor_as_written(*limit, parse_output_name(requirement.output).unit)
               : value;
}

std::string unit_of_limit(const Requirement& requirement) {
  const std::string unit = parse_output_name(requirement.output).unit;
  return in_unit_of_limit(requirement, 1) == 1 ? unit : "deg" + unit.substr(3);
}

} // namespace wingspread
