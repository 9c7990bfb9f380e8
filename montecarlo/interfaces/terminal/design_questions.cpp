#include "montecarlo/interfaces/terminal/design_questions.hpp"

#include "montecarlo/foundation/formats/number_text.hpp"
#include "montecarlo/foundation/formats/printable.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <istream>
#include <ostream>

namespace wingspread {
namespace {

/// A number ≥ 0, or > 0, in SI; nothing for any other text.
std::optional<double> read_quantity(std::string_view text, const Dimension& dimension, bool zero) {
  auto value = parse_number<double>(text);
  if (!value) value = in_unit(text, dimension.unit);
  const bool good = value && std::isfinite(*value) && (zero ? *value >= 0 : *value > 0);
  return good ? value : std::nullopt;
}

std::string refusal(std::string_view text, const std::string& expected) {
  return fmt::format("found {}, expected {}", text, expected);
}

constexpr Dimension damper_dimension{"N·m·s/rad", "≥ 0"};

/// Prints a question with its default until `read` accepts the answer: it returns a message or nothing.
/// @return false at the end of the input
bool ask(std::istream& in, std::ostream& out, const std::string& question, const std::string& usual,
         const std::function<std::optional<std::string>(const std::string&)>& read) {
  while (true) {
    out << fmt::format("{} [{}]: ", question, usual) << std::flush;
    std::string answer;
    if (!std::getline(in, answer)) return false;
    while (!answer.empty() && (answer.back() == ' ' || answer.back() == '\r')) answer.pop_back();
    if (answer.empty()) return true;
    const auto message = read(answer);
    if (!message) return true;
    out << "  " << *message << '\n';
  }
}

auto reader_of(int& value, int most) {
  return [&value, most](const std::string& text) -> std::optional<std::string> {
    const auto number = parse_number<int>(text);
    if (!number || *number < 1 || *number > most)
      return refusal(text, fmt::format("1 to {}", most));
    value = *number;
    return std::nullopt;
  };
}

auto reader_of(bool& value) {
  return [&value](const std::string& text) -> std::optional<std::string> {
    if (text != "y" && text != "yes" && text != "n" && text != "no") return refusal(text, "y or n");
    value = text.front() == 'y';
    return std::nullopt;
  };
}

} // namespace

std::optional<std::string> read_design_number(std::string_view text, const DesignNumber& number,
                                              WingDesign& design) {
  const auto value = read_quantity(text, number.dimension, number.may_be_zero);
  if (!value) return refusal(text, expected_quantity(number.dimension));
  design.*number.value = *value;
  return std::nullopt;
}

std::optional<std::string> read_damper(std::string_view text, WingDesign& design) {
  const auto value = read_quantity(text, damper_dimension, true);
  if (!value) return refusal(text, expected_quantity(damper_dimension));
  design.damper = value;
  return std::nullopt;
}

std::optional<WingDesign> ask_design(std::istream& in, std::ostream& out) {
  WingDesign design;
  out << "A new wing. Enter keeps the value in brackets; numbers may have a unit: 1.8 m, 12 "
         "in*lbf\n";
  const auto read_name = [&](const std::string& text) -> std::optional<std::string> {
    if (!is_design_name(text)) return refusal(text, std::string(expected_name));
    design.name = text;
    return std::nullopt;
  };
  bool more =
      ask(in, out, "name", design.name, read_name) &&
      ask(in, out, "wings, 1 or 2", std::to_string(design.wings), reader_of(design.wings, 2)) &&
      ask(in, out, fmt::format("panels of a wing, 1 to {}", most_panels),
          std::to_string(design.panels), reader_of(design.panels, most_panels)) &&
      ask(in, out, "a yoke, y or n", "n", reader_of(design.yoke));
  for (const DesignNumber& number : design_numbers()) {
    if (number.of_yoke && !design.yoke) continue;
    if (number.value == &WingDesign::spring && !has_other_hinges(design)) continue;
    more = more &&
           ask(in, out, std::string(number.what),
               fmt::format("{} {}", design.*number.value, number.dimension.unit),
               [&](const std::string& text) { return read_design_number(text, number, design); });
  }
  more =
      more && ask(in, out, "damper of the root hinge, 0: none",
                  fmt::format("one that doubles the time, to a tenth, {}", damper_dimension.unit),
                  [&](const std::string& text) { return read_damper(text, design); });
  return more ? std::optional(design) : std::nullopt;
}

std::string command_of(const WingDesign& design, const std::string& out) {
  const WingDesign usual;
  std::string text = "wingspread new";
  if (design.name != usual.name) text += " --name " + shell_word(design.name);
  if (design.wings != usual.wings) text += fmt::format(" --wings {}", design.wings);
  if (design.panels != usual.panels) text += fmt::format(" --panels {}", design.panels);
  if (design.yoke) text += " --yoke";
  for (const DesignNumber& number : design_numbers())
    if (design.*number.value != usual.*number.value)
      text += fmt::format(" {} {}", number.option, design.*number.value);
  if (design.damper) text += fmt::format(" {} {}", damper_option, *design.damper);
  if (!out.empty()) text += " --out " + shell_word(out);
  return text;
}

} // namespace wingspread
