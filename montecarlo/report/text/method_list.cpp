#include "montecarlo/report/text/method_list.hpp"

#include "montecarlo/foundation/formats/text_layout.hpp"

#include <fmt/format.h>

#include <cmath>

namespace wingspread {
namespace {

std::string order(int value) { return value == 0 ? "–" : std::to_string(value); }

/// "3.307", "∞", or "–" if not applicable.
std::string limit(double value) {
  if (value == 0) return "–";
  return std::isinf(value) ? "∞" : fmt::format("{:.4g}", value);
}

Json limit_json(double value) {
  if (value == 0) return nullptr;
  return std::isinf(value) ? Json("unbounded") : Json(value);
}

std::string row(const MethodInfo& method) {
  return fmt::format("{:<26}{:>5}{:>10}{:>11}   {}\n", method.name, order(method.order),
                     limit(method.real_limit), limit(method.imaginary_limit), method.kind);
}

std::string remarks(const MethodInfo& method) {
  std::string text = fmt::format("\n{}\n", method.name) + paragraph(method.note);
  if (!method.interpolation.empty()) text += paragraph("within a step: " + method.interpolation);
  return text;
}

} // namespace

std::string methods_text(std::span<const MethodInfo> methods) {
  std::string text =
      fmt::format("{:<26}{:>5}{:>10}{:>11}   {}\n", "METHOD", "order", "real", "imaginary", "kind");
  for (const MethodInfo& method : methods) text += row(method);
  text += "\nreal, imaginary: the largest |hλ| on the negative real and on the imaginary axis at "
          "which\na step h is stable; – if not applicable.\n";
  for (const MethodInfo& method : methods) text += remarks(method);
  return text;
}

Json methods_json(std::span<const MethodInfo> methods) {
  Json json = Json::array();
  for (const MethodInfo& method : methods)
    json.push_back({{"name", method.name},
                    {"kind", method.kind},
                    {"order", method.order == 0 ? Json(nullptr) : Json(method.order)},
                    {"real_limit", limit_json(method.real_limit)},
                    {"imaginary_limit", limit_json(method.imaginary_limit)},
                    {"interpolation", method.interpolation},
                    {"note", method.note}});
  return json;
}

} // namespace wingspread
