#include "montecarlo/model/starter/wing_design.hpp"

#include "montecarlo/foundation/formats/spec_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace wingspread {

std::span<const DesignNumber> design_numbers() {
  static constexpr std::array numbers{
      DesignNumber{"--panel-length",
                   "length of a panel, from hinge to hinge",
                   {"m", "> 0"},
                   &WingDesign::panel_length},
      DesignNumber{"--panel-width",
                   "width of a panel, along the hinges",
                   {"m", "> 0"},
                   &WingDesign::panel_width},
      DesignNumber{"--panel-mass", "mass of a panel", {"kg", "> 0"}, &WingDesign::panel_mass},
      DesignNumber{"--yoke-length",
                   "length of the yoke, from hinge to hinge",
                   {"m", "> 0"},
                   &WingDesign::yoke_length,
                   true},
      DesignNumber{"--yoke-mass", "mass of the yoke", {"kg", "> 0"}, &WingDesign::yoke_mass, true},
      DesignNumber{"--bus-width",
                   "width of the spacecraft, between both root hinges",
                   {"m", "> 0"},
                   &WingDesign::bus_width},
      DesignNumber{"--pitch",
                   "distance from one stowed panel to the next",
                   {"m", "> 0"},
                   &WingDesign::pitch},
      DesignNumber{"--root-spring",
                   "torque of the root hinge's spring, stowed",
                   {"N·m", "> 0"},
                   &WingDesign::root_spring},
      DesignNumber{"--spring",
                   "torque of every other hinge's spring, stowed",
                   {"N·m", "> 0"},
                   &WingDesign::spring},
      DesignNumber{"--friction",
                   "friction torque of a hinge",
                   {"N·m", "≥ 0"},
                   &WingDesign::friction,
                   false,
                   true},
      DesignNumber{"--harness",
                   "largest torque of the cables across a hinge",
                   {"N·m", "≥ 0"},
                   &WingDesign::harness,
                   false,
                   true}};
  return numbers;
}

bool is_design_name(std::string_view name) {
  constexpr std::size_t longest = 60;
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_';
  };
  return !name.empty() && name.size() <= longest && name.front() != '-' &&
         std::ranges::all_of(name, fits);
}

void check_design(const WingDesign& design) {
  std::vector<Problem> problems;
  const auto refuse = [&](std::string_view option, std::string found, std::string expected) {
    problems.push_back({"", std::string(option), std::move(found), std::move(expected)});
  };
  if (!is_design_name(design.name))
    refuse("--name", '"' + design.name + '"', std::string(expected_name));
  if (design.wings < 1 || design.wings > 2)
    refuse("--wings", std::to_string(design.wings), "1 or 2");
  if (design.panels < 1 || design.panels > most_panels)
    refuse("--panels", std::to_string(design.panels), fmt::format("1 to {}", most_panels));
  for (const DesignNumber& number : design_numbers()) {
    const double value = design.*number.value;
    if (!std::isfinite(value) || value < 0 || (value == 0 && !number.may_be_zero))
      refuse(number.option, fmt::format("{}", value), expected_quantity(number.dimension));
  }
  if (!has_other_hinges(design) && design.spring != WingDesign().spring)
    refuse("--spring", fmt::format("{}, with one panel and no yoke", design.spring),
           "--root-spring: the root hinge is the only one");
  if (design.damper && !(std::isfinite(*design.damper) && *design.damper >= 0))
    refuse(damper_option, fmt::format("{}", *design.damper),
           expected_quantity({"N·m·s/rad", "≥ 0"}));
  if (!problems.empty()) throw SpecError(std::move(problems));
}

DesignedWing designed_wing(const WingDesign& design, bool left) {
  const std::string prefix = design.wings == 1 ? "" : left ? "L_" : "R_";
  const double mirror = left ? -1 : 1; // of x, and of every angle
  DesignedWing wing;
  if (design.yoke)
    wing.bodies.push_back({prefix + "yoke", design.yoke_mass, design.yoke_length,
                           0.1 * design.panel_width}); // a yoke is a frame; only air sees its width
  for (int panel = 1; panel <= design.panels; ++panel)
    wing.bodies.push_back({fmt::format("{}panel_{}", prefix, panel), design.panel_mass,
                           design.panel_length, design.panel_width});
  std::string parent = "base";
  Eigen::Vector2d parent_point{mirror * design.bus_width / 2, 0};
  int face = 1; // s_k
  for (const DesignedBody& body : wing.bodies) {
    const bool root = wing.hinges.empty();
    const double height = face * design.pitch / 2, half = mirror * body.length / 2;
    wing.hinges.push_back(
        {root ? prefix + "root" : fmt::format("{}hinge_{}", prefix, wing.hinges.size()),
         parent,
         body.name,
         parent_point,
         {-half, height},
         static_cast<int>(mirror) * (root ? 90 : face * 180)});
    parent = body.name;
    parent_point = {half, -height};
    face = -face;
  }
  return wing;
}

std::vector<DesignedWing> designed_wings(const WingDesign& design) {
  std::vector<DesignedWing> wings{designed_wing(design, false)};
  if (design.wings == 2) wings.push_back(designed_wing(design, true));
  return wings;
}

} // namespace wingspread
