#include "montecarlo/model/campaign/stopping_rule.hpp"

#include "montecarlo/foundation/formats/csv.hpp"
#include "montecarlo/foundation/formats/nearest.hpp"
#include "montecarlo/foundation/formats/output_name.hpp"
#include "montecarlo/model/campaign/outputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace wingspread {
namespace {

constexpr long first_interim_analysis = 1000;
constexpr std::string_view decision_prefix = "requirement ";
constexpr const char* quantile_expected = "a number, > 0 and < 1: the quantile that is meant";
constexpr const char* share_expected =
    "a width > 0 and < 1 for a share of runs: 0.01 is one in a hundred of all runs";

void refuse_unknown_output(const JsonCursor& at, const std::string& output,
                           const std::vector<std::string>& outputs) {
  if (status_named(output) || std::ranges::find(outputs, output) != outputs.end()) return;
  std::vector<std::string> known = outputs;
  for (const Status status : statuses) known.emplace_back(to_string(status));
  at.refuse("an output of the campaign, or a status" + did_you_mean(output, known));
}

/// Reads `width` or `relative_width`; exactly one is required.
void read_width(JsonObject& object, WidthGoal& goal) {
  const bool absolute = object.find("width").has_value();
  goal.relative = object.find("relative_width").has_value();
  if (!object.is_object()) return;
  if (absolute == goal.relative)
    object.at().refuse(absolute ? "both width and relative_width"
                                : "neither width nor relative_width",
                       "one of them");
  const auto width = object.find("width");
  const std::string unit = parse_output_name(goal.output).unit;
  if (width) width->note_quantity("in the output's unit", "> 0");
  if (width && width->value().is_string() && !unit.empty())
    object.optional("width", goal.width, Dimension{unit, "> 0"}, is_positive);
  else if (is_share(goal.output))
    object.optional("width", goal.width, share_expected, is_proper_share);
  else
    object.optional("width", goal.width, "a number, in the output's unit, > 0", is_positive);
  object.optional("relative_width", goal.width, "a number, > 0", is_positive);
}

/// Reads the quantile: required for an output, refused for a share of runs.
void read_quantile(JsonObject& object, WidthGoal& goal) {
  const auto quantile = object.find("quantile");
  if (!object.is_object() || goal.output.empty()) return;
  if (!is_share(goal.output)) {
    goal.quantile.emplace();
    object.required("quantile", *goal.quantile, quantile_expected, is_proper_share);
    return;
  }
  if (quantile) quantile->refuse("no quantile of a share of runs");
  if (goal.relative) object.at().refuse("a relative_width", share_expected);
}

DecisionGoal read_decision_goal(JsonObject& object, const std::vector<std::string>* requirements) {
  DecisionGoal goal;
  const bool named =
      object.required("requirement", goal.requirement, "a string, the name of a requirement");
  if (named && requirements &&
      std::ranges::find(*requirements, goal.requirement) == requirements->end())
    object.at()
        .member("requirement")
        .refuse("a requirement of the campaign, by its name or its output" +
                did_you_mean(goal.requirement, *requirements));
  return goal;
}

WidthGoal read_width_goal(JsonObject& object, const std::vector<std::string>* outputs) {
  WidthGoal goal;
  const bool named = object.required("output", goal.output, "a string, an output or a status");
  if (named && outputs && object.is_object())
    refuse_unknown_output(object.at().member("output"), goal.output, *outputs);
  read_width(object, goal);
  read_quantile(object, goal);
  return goal;
}

StoppingGoal read_goal(const JsonCursor& at, const std::vector<std::string>* outputs,
                       const std::vector<std::string>* requirements) {
  JsonObject object(at, "a width to be reached, or a requirement to be decided: an object");
  const bool decision = object.is_object() && at.value().contains("requirement");
  StoppingGoal goal = decision ? StoppingGoal(read_decision_goal(object, requirements))
                               : read_width_goal(object, outputs);
  object.refuse_others();
  return goal;
}

Json write_goal(const WidthGoal& goal) {
  Json json{{"output", goal.output}};
  if (goal.quantile) json["quantile"] = *goal.quantile;
  json[goal.relative ? "relative_width" : "width"] = goal.width;
  return json;
}

Json write_goal(const DecisionGoal& goal) { return {{"requirement", goal.requirement}}; }

std::string text_of(const WidthGoal& goal) {
  const std::string quantile = goal.quantile ? fmt::format("@{}", *goal.quantile) : "";
  if (goal.relative) return fmt::format("{}{} {:.10g}%", goal.output, quantile, 100 * goal.width);
  const std::string unit = goal.quantile ? parse_output_name(goal.output).unit : "";
  return fmt::format("{}{} {}{}{}", goal.output, quantile, goal.width, unit.empty() ? "" : " ",
                     unit);
}

std::string text_of(const DecisionGoal& goal) {
  return fmt::format("{}{}", decision_prefix, goal.requirement);
}

/// Removes the last `mark` and the text after it from `text`; returns that text, nothing without a mark.
std::optional<std::string_view> split_last(std::string_view& text, char mark) {
  const std::size_t at = text.rfind(mark);
  if (at == std::string_view::npos) return std::nullopt;
  const std::string_view last = text.substr(at + 1);
  text = text.substr(0, at);
  return last;
}

/// Whether the text is a finite number and then a unit, which nobody has looked at yet: "5N*m".
bool is_number_with_unit(std::string_view text) {
  double number = 0;
  const auto [last, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && std::isfinite(number) && last != text.data() + text.size();
}

/// Removes the width at the end of a goal's text: "5", "5 N*m" or "5N*m". Nothing if there is none.
std::optional<Json> take_width(std::string_view& text) {
  const auto last = split_last(text, ' ');
  if (!last) return std::nullopt;
  if (const auto number = parse_csv_number(*last)) return Json(*number);
  if (is_number_with_unit(*last)) return Json(*last);
  const auto before = split_last(text, ' ');
  if (!before || !parse_csv_number(*before)) return std::nullopt;
  return Json(fmt::format("{} {}", *before, *last));
}

/// The share of a number of per cent, nearest to it in decimals: 0.007 of 0.7, while 0.7 / 100 is another double.
double share_of_percent(double percents) {
  const std::string text = fmt::format("{}", percents);
  const std::size_t mark = std::min(text.find('e'), text.size());
  const int power = mark < text.size() ? std::stoi(text.substr(mark + 1)) : 0;
  return parse_csv_number(fmt::format("{}e{}", text.substr(0, mark), power - 2)).value_or(0);
}

} // namespace

bool is_share(std::string_view output) {
  return status_named(output) || parse_output_name(output).quantity == "held";
}

void read_stopping_rule(const JsonCursor& at, const std::vector<std::string>* outputs,
                        const std::vector<std::string>* requirements, StoppingRule& rule) {
  if (!at.value().is_array())
    return void(at.refuse("an array of widths to be reached and requirements to be decided"));
  rule.clear();
  for (const JsonCursor& element : at.elements())
    rule.push_back(read_goal(element, outputs, requirements));
}

Json write_stopping_rule(const StoppingRule& rule) {
  Json list = Json::array();
  for (const StoppingGoal& goal : rule)
    list.push_back(std::visit([](const auto& each) { return write_goal(each); }, goal));
  return list;
}

std::optional<Json> parse_stopping_goal(std::string_view text) {
  if (text.starts_with(decision_prefix) && text.size() > decision_prefix.size())
    return Json{{"requirement", text.substr(decision_prefix.size())}};
  const bool percent = text.ends_with('%');
  std::string_view name = text.substr(0, text.find_last_not_of("% ") + 1);
  const auto width = take_width(name);
  if (!width || (percent && !width->is_number())) return std::nullopt;
  Json goal{{"output", ""}};
  if (name.find('@') != std::string_view::npos) {
    const auto quantile = parse_csv_number(*split_last(name, '@'));
    if (!quantile) return std::nullopt;
    goal["quantile"] = *quantile;
  }
  goal["output"] = std::string(name);
  const bool relative = percent && !is_share(name); // a share's own unit is %
  goal[relative ? "relative_width" : "width"] =
      percent ? Json(share_of_percent(width->get<double>())) : *width;
  return goal;
}

std::string to_string(const StoppingGoal& goal) {
  return std::visit([](const auto& each) { return text_of(each); }, goal);
}

long next_interim_analysis(long done, long runs) {
  long next = first_interim_analysis;
  while (next <= done && next < runs) next = next > runs / 2 ? runs : 2 * next;
  return std::min(next, runs);
}

bool is_interim_analysis(long done, long runs) {
  return done > 0 && next_interim_analysis(done - 1, runs) == done;
}

long count_interim_analyses(const StoppingRule& rule, long runs) {
  if (rule.empty()) return 1;
  long analyses = 0;
  for (long done = 0; done < runs; done = next_interim_analysis(done, runs)) ++analyses;
  return analyses;
}

} // namespace wingspread
