#include "montecarlo/foundation/formats/spec_error.hpp"
#include "montecarlo/model/input_checks/placement.hpp"
#include "montecarlo/model/starter/starter_scene.hpp"
#include "montecarlo/model/starter/wing_design.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

using namespace wingspread;

namespace {

/// The wings of 1 to 6 panels, with a yoke or without, on one side or two.
template <class Take> void for_each_design(const Take& take) {
  for (int panels = 1; panels <= 6; ++panels)
    for (const bool yoke : {false, true})
      for (const int wings : {1, 2}) {
        WingDesign design;
        design.panels = panels, design.yoke = yoke, design.wings = wings;
        design.damper = 0;
        CAPTURE(panels, yoke, wings);
        take(design);
      }
}

constexpr double quarter = std::numbers::pi / 2;

} // namespace

TEST_CASE("a new wing's panels stack flat when stowed") {
  for_each_design([](const WingDesign& design) {
    const Scene scene = scene_of(design);
    const auto each = static_cast<int>(scene.bodies.size()) / design.wings;
    const auto bodies = place_bodies(scene, stowed_angles(scene));
    const double lowest = design.yoke ? design.yoke_length - design.panel_length : 0;
    for (int b = 0; b < std::ssize(bodies); ++b) {
      CAPTURE(b);
      const bool left = b >= each;
      const int k = b % each + 1; // from the root
      // along the wall, at a distance of (k − 1/2) pitches
      CHECK(std::abs(std::remainder(bodies[b].angle - quarter, 2 * quarter)) < 1e-12);
      const double wall = design.bus_width / 2;
      CHECK(bodies[b].position.x() ==
            Approx((left ? -1 : 1) * (wall + (k - 0.5) * design.pitch)).epsilon(1e-12));
      const bool is_yoke = design.yoke && k == 1;
      CHECK(bodies[b].position.y() ==
            Approx(is_yoke ? design.yoke_length / 2 : lowest + design.panel_length / 2)
                .epsilon(1e-12)); // all panels cover each other
    }
  });
}

TEST_CASE("a new wing is straight when deployed") {
  for_each_design([](const WingDesign& design) {
    const Scene scene = scene_of(design);
    const auto each = static_cast<int>(scene.bodies.size()) / design.wings;
    const auto bodies = place_bodies(scene, latched_angles(scene));
    double inner = design.bus_width / 2;
    for (int b = 0; b < std::ssize(bodies); ++b) {
      CAPTURE(b);
      if (b == each) inner = design.bus_width / 2; // the other wing
      const bool is_yoke = design.yoke && b % each == 0;
      const double length = is_yoke ? design.yoke_length : design.panel_length;
      CHECK(std::remainder(bodies[b].angle, 4 * quarter) == Approx(0).margin(1e-12));
      CHECK(bodies[b].position.x() ==
            Approx((b >= each ? -1 : 1) * (inner + length / 2)).epsilon(1e-12));
      CHECK(bodies[b].position.y() == Approx(-design.pitch / 2).epsilon(1e-12));
      inner += length;
    }
  });
}

TEST_CASE("an impossible wing is refused by its options, all together") {
  WingDesign design;
  design.name = "two words";
  design.wings = 3;
  design.panels = 0;
  design.panel_mass = -1;
  design.harness = -0.1;
  design.friction = 0; // possible
  design.damper = std::nan("");
  try {
    check_design(design);
    FAIL("it is accepted");
  } catch (const SpecError& error) {
    std::vector<std::string> places;
    for (const Problem& problem : error.problems()) places.push_back(problem.pointer);
    CHECK(places == std::vector<std::string>{"--name", "--wings", "--panels", "--panel-mass",
                                             "--harness", "--damper"});
    CHECK(error.problems()[3].found == "-1");
  }
}

TEST_CASE("the name of a design is of letters, digits, \"-\" and \"_\", and may be 60 of them") {
  for (char c = ' '; c <= '~'; ++c) {
    const bool fits = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_';
    CAPTURE(c);
    CHECK(is_design_name(std::string("w") + c) == fits);
  }
  CHECK_FALSE(is_design_name("w\xC3\xA9"));
  CHECK_FALSE(is_design_name("w\n"));
  CHECK_FALSE(is_design_name("-w"));
  CHECK_FALSE(is_design_name(""));
  CHECK(is_design_name(std::string(60, 'w')));
  CHECK_FALSE(is_design_name(std::string(61, 'w')));
}

TEST_CASE("a design's numbers are accepted up to their limits, and no further") {
  const auto is_accepted = [](auto change) {
    WingDesign design;
    change(design);
    return test::message_of([&] { return check_design(design), 0; }).empty();
  };
  const auto with_panels = [&](int panels) {
    return is_accepted([&](WingDesign& design) { design.panels = panels; });
  };
  CHECK((with_panels(1) && with_panels(most_panels)));
  CHECK_FALSE((with_panels(0) || with_panels(most_panels + 1)));
  const auto with_wings = [&](int wings) {
    return is_accepted([&](WingDesign& design) { design.wings = wings; });
  };
  CHECK((with_wings(1) && with_wings(2)));
  CHECK_FALSE((with_wings(0) || with_wings(3)));
  const auto with_damper = [&](double damper) {
    return is_accepted([&](WingDesign& design) { design.damper = damper; });
  };
  CHECK((with_damper(0) && with_damper(5)));
  CHECK_FALSE((with_damper(-1e-9) || with_damper(INFINITY)));
  for (const DesignNumber& number : design_numbers()) {
    CAPTURE(number.option);
    const auto with = [&](double value) {
      return is_accepted([&](WingDesign& design) { design.*number.value = value; });
    };
    CHECK(with(1));
    CHECK(with(0) == number.may_be_zero);
    CHECK_FALSE((with(-1e-9) || with(INFINITY)));
  }
}
