#include "montecarlo/report/text/check_report.hpp"

#include "montecarlo/foundation/formats/output_name.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace wingspread {
namespace {

std::string number(double value) { return std::isnan(value) ? "–" : fmt::format("{:.10g}", value); }

std::string moved_text(const CheckedOutput& output) {
  const char* unit = parse_output_name(output.name).unit;
  const auto with_unit = [&](double value) {
    return std::isnan(value) ? "none" : fmt::format("{:.5g} {}", value, unit);
  };
  const std::string both = fmt::format("{} here, {} by the reference", with_unit(output.value),
                                       with_unit(output.reference));
  if (std::isnan(output.value) || std::isnan(output.reference))
    return fmt::format("{}: {}", output.name, both);
  const double share = std::abs(output.value - output.reference) /
                       std::max(std::abs(output.value), std::abs(output.reference));
  return fmt::format("{} moves by {:.2g} %: {}", output.name, 100 * share, both);
}

/// Whether neither run has the output.
bool is_missing(double value, double reference) {
  return std::isnan(value) && std::isnan(reference);
}

std::vector<std::string> warnings_of(const RunCheck& check) {
  std::vector<std::string> lines;
  if (!check.agrees)
    lines.push_back(fmt::format("the reference {} with the latch order {}",
                                check.status == "deployed"  ? "deploys"
                                : check.status == "stalled" ? "stalls"
                                                            : "runs to t_end",
                                check.latch_order.empty() ? "none" : check.latch_order));
  for (const CheckedOutput& output : check.outputs)
    if (output.moved) lines.push_back(moved_text(output));
  if (!lines.empty())
    lines.emplace_back("the tolerance does not decide these: take a smaller rtol; if they still "
                       "move, the motion is too sensitive for a single value");
  return lines;
}

} // namespace

Json check_json(const std::optional<RunCheck>& check) {
  if (!check) return nullptr;
  Json outputs = Json::array();
  for (const auto& [name, value, reference, digits, moved] : check->outputs)
    outputs.push_back({{"output", name},
                       {"value", json_number(value)},
                       {"reference", json_number(reference)},
                       {"digits", is_missing(value, reference) ? Json(nullptr) : Json(digits)},
                       {"moved", moved}});
  return {{"reference_method", check->method}, {"reference_rtol", check->rtol},
          {"status", check->status},           {"latch_order", check->latch_order},
          {"agrees", check->agrees},           {"outputs", std::move(outputs)},
          {"warnings", warnings_of(*check)}};
}

std::string check_text(const std::optional<RunCheck>& check) {
  if (!check) return "\nCHECK: none: the run failed, or no reference could finish it\n";
  std::string text =
      fmt::format("\n{:<40}{:<6}{:>20}{:>20}{:>8}\n",
                  fmt::format("CHECK by {} at rtol {:g}", check->method, check->rtol), "unit",
                  "value", "reference", "digits");
  for (const auto& [name, value, reference, digits, moved] : check->outputs) {
    text +=
        fmt::format("{}{:<6}{}{}{}\n", in_column("  " + name, 40), parse_output_name(name).unit,
                    right_aligned(number(value), 20), right_aligned(number(reference), 20),
                    right_aligned(is_missing(value, reference) ? "–" : std::to_string(digits), 8));
  }
  const std::vector<std::string> lines = warnings_of(*check);
  if (!lines.empty()) text += "\nWARNING\n";
  for (const std::string& line : lines) text += "  " + wrapped(line, 2) + '\n';
  return text;
}

} // namespace wingspread
