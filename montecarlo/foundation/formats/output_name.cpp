#include "montecarlo/foundation/formats/output_name.hpp"

#include <algorithm>
#include <array>

namespace wingspread {

namespace {

struct Quantity {
  std::string_view name;
  const char* unit;
};

constexpr std::array per_hinge{
    Quantity{"latch_time", "s"},    Quantity{"latch_rate", "rad/s"},
    Quantity{"peak_moment", "N·m"}, Quantity{"peak_force", "N"},
    Quantity{"overtravel", "rad"},  Quantity{"hold_moment", "N·m"},
    Quantity{"captures", ""},       Quantity{"held", ""},
    Quantity{"final_angle", "rad"}, Quantity{"peak_bending_moment", "N·m"}, // of a body
    Quantity{"motor_energy", "J"},  Quantity{"frequency", "Hz"}};           // of a mode
constexpr std::array of_base{Quantity{"base.peak_angle", "rad"},
                             Quantity{"base.peak_rate", "rad/s"}};
constexpr std::string_view rate_at = ".rate_at.";
constexpr std::array<std::string_view, 12> never_negative{
    "latch_time",  "deployment_time", "peak_moment", "peak_force", "peak_bending_moment",
    "hold_moment", "overtravel",      "captures",    "held",       "frequency",
    "peak_angle",  "peak_rate"};

} // namespace

OutputName parse_output_name(std::string_view name) {
  if (name == "deployment_time") return {"", std::string(name), "", "s"};
  for (const Quantity& quantity : of_base)
    if (name == quantity.name)
      return {"base", std::string(name.substr(name.find('.') + 1)), "", quantity.unit};
  const std::size_t dot = name.rfind('.');
  for (const Quantity& quantity : per_hinge)
    if (dot != std::string_view::npos && name.substr(dot + 1) == quantity.name)
      return {std::string(name.substr(0, dot)), std::string(quantity.name), "", quantity.unit};
  if (const std::size_t at = name.find(rate_at); at != std::string_view::npos)
    return {std::string(name.substr(0, at)), "rate_at",
            std::string(name.substr(at + rate_at.size())), "rad/s"};
  return {"", std::string(name), "", ""};
}

bool is_never_negative(const OutputName& name) {
  return std::ranges::find(never_negative, name.quantity) != never_negative.end();
}

} // namespace wingspread
