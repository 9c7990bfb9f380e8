#include "montecarlo/report/text/modes_report.hpp"
#include "tests/support/bending_scenes.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <sstream>

using namespace wingspread;

TEST_CASE("Modes are told lowest first, in text without the joints of flexible bodies") {
  Scene scene = oracle::bending_rod(3, 50);
  scene.bodies[0].flexible->damping_ratio = 0.01;
  const std::optional<WingModes> modes = natural_modes(scene);
  REQUIRE(modes);
  const Json json = modes_json(*modes);
  REQUIRE(json["modes"].size() == 4);
  CHECK(json["modes"][0]["frequency"] == modes->modes[0].frequency);
  CHECK(json["modes"][0]["frequency"] < json["modes"][1]["frequency"]);
  CHECK(json["modes"][1]["damping_ratio"].get<double>() > 0);
  CHECK(json["modes"][0]["shape"].size() == 4);
  CHECK(json["modes"][0]["shape"].contains("root"));
  CHECK(json["modes"][0]["shape"].contains("rod joint 3"));
  CHECK(json["rest"]["root"] == 0);
  const std::string text = modes_text(*modes);
  CHECK_THAT(text, Catch::Contains("root=") && !Catch::Contains("joint"));
  CHECK(std::count(text.begin(), text.end(), '\n') == 5);
}

TEST_CASE("The base of a free wing is part of a mode's shape") {
  const std::optional<WingModes> modes = natural_modes(oracle::symmetric_tree());
  REQUIRE(modes);
  CHECK(modes_json(*modes)["modes"][0]["shape"].contains("base"));
  CHECK_THAT(modes_text(*modes), Catch::Contains("base="));
  // of a symmetric pair of modes one turns the base, and one does not
  const auto turns = [&](std::size_t k) { return std::abs(modes->modes[k].base_angle); };
  CHECK(std::min(turns(0), turns(1)) < 1e-9);
  CHECK(std::max(turns(0), turns(1)) > 1e-3);
}

TEST_CASE("Every number of the modes' text is the mode's") {
  const std::optional<WingModes> modes = natural_modes(oracle::symmetric_tree());
  REQUIRE(modes);
  REQUIRE(modes->modes.size() > 2);
  std::istringstream text(modes_text(*modes));
  CHECK_FALSE(text.str().find("-0.000") != std::string::npos);
  std::string word;
  std::getline(text, word);
  CHECK(word.find("frequency, Hz") < word.find("damping ratio"));
  for (std::size_t k = 0; k < modes->modes.size(); ++k) {
    const NaturalMode& mode = modes->modes[k];
    double number = 0, frequency = 0, damping = 0;
    text >> number >> frequency >> damping;
    CHECK(number == static_cast<double>(k + 1));
    CHECK(frequency == Approx(mode.frequency).epsilon(1e-4)); // five digits
    CHECK(damping == Approx(mode.damping_ratio).epsilon(1e-4).margin(1e-12));
    std::vector<double> shape = mode.shape;
    shape.push_back(mode.base_angle);
    for (std::size_t h = 0; h < shape.size(); ++h) {
      text >> word;
      const auto equals = word.find('=');
      REQUIRE(equals != std::string::npos);
      const bool is_base = h + 1 == shape.size();
      CHECK(word.substr(0, equals) == (is_base ? "base" : modes->wing.scene.hinges[h].name));
      CHECK(std::stod(word.substr(equals + 1)) == Approx(shape[h]).margin(5.1e-4));
    }
  }
}

TEST_CASE("Modes are told with the stops that the wing presses or touches, and a rest far away") {
  Scene scene = oracle::latching_panel();
  Hinge& hinge = scene.hinges[0];
  const double sense = hinge.latched > hinge.stowed ? 1 : -1;
  hinge.friction = {};
  hinge.spring = {.torque_stowed = 4, .torque_latched = 4};
  hinge.latch = Latch{600, 0.5};
  const auto notes = [&] {
    const std::optional<WingModes> modes = natural_modes(scene);
    REQUIRE(modes);
    const Json json = modes_json(*modes)["notes"];
    const std::string text = modes_text(*modes);
    CHECK(std::count(text.begin(), text.end(), '\n') >= 2 + std::ssize(json));
    CHECK((text.find("note: ") != std::string::npos) == !json.empty());
    return json.get<std::vector<std::string>>();
  };
  CHECK(notes().empty());
  hinge.far_stop = Stop{800, 0, 0.02};
  CHECK(notes().empty());
  hinge.far_stop->gap = 0.002; // pressed by 0.002 rad: (4 + 1.6)/1400 - 0.002
  REQUIRE(notes().size() == 1);
  CHECK_THAT(notes()[0], Catch::Contains(hinge.name) && Catch::Contains("1.6 N·m"));
  hinge.far_stop->gap = 0, hinge.spring = {};
  REQUIRE(notes().size() == 1);
  CHECK_THAT(notes()[0], Catch::Contains("latched side begins"));
  hinge.far_stop.reset(), hinge.latch.reset();
  hinge.spring = {.torque_stowed = 1,
                  .torque_latched = 0.5}; // 0 as far again beyond the latched angle
  REQUIRE(notes().size() == 1);
  CHECK_THAT(notes()[0], Catch::Contains(fmt::format("{:.4g} rad from",
                                                     sense * (hinge.latched - hinge.stowed))));
}
