#include "montecarlo/model/input_checks/motor_checks.hpp"
#include "montecarlo/model/scene_file/scene_json.hpp"
#include "tests/montecarlo/campaign_support.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <memory>
#include <random>

using namespace wingspread;

TEST_CASE("a gain that keeps a motor within a billionth of its command is warned of",
          "[warnings]") {
  Scene scene = read_scene_file(test::three_panel_file());
  Motor& motor = scene.hinges[1].motor.emplace();
  motor.rate = 0.1, motor.torque_limit = 5;
  const auto told = [&](double gain) {
    motor.gain = gain;
    InputWarnings warnings(ScenePlace{"scene.json"});
    check_motors(scene, Integration(), Outcome(), warnings);
    return warnings.list();
  };
  CHECK(told(5e10 * 0.99).empty());
  const std::vector<InputWarning> warned = told(5e10 * 1.01);
  REQUIRE(warned.size() == 1);
  CHECK(warned[0].pointer == "/hinges/1/motor/gain");
  CHECK_THAT(warned[0].usual, Catch::Contains("5e+07"));
}

TEST_CASE("a motor that bends its latch is warned of by what is commanded while it is engaged",
          "[warnings]") {
  Scene scene = read_scene_file(test::three_panel_file());
  Motor& motor = scene.hinges[0].motor.emplace();
  motor.gain = 1e6, motor.torque_limit = 5000;
  Outcome nominal;
  nominal.latches = {{0, 20, {0.1, 0, 0}}};
  const auto told = [&](std::vector<double> time, std::vector<double> rates) {
    motor.table = std::make_shared<Curve>(time, rates, Interpolation::linear);
    motor.time = std::move(time), motor.rates = std::move(rates);
    InputWarnings warnings(ScenePlace{"scene.json"});
    check_motors(scene, Integration(), nominal, warnings);
    std::string text;
    for (const InputWarning& each : warnings.list())
      text += each.pointer + ": " + each.found + '\n';
    return text;
  };
  CHECK_THAT(told({0, 30}, {0.1, 0.1}), Catch::Contains("bends its engaged latch by 0.5 rad"));
  CHECK_THAT(told({0, 30}, {0.1, 0}), Catch::Contains("bends its engaged latch by 0.5 rad"));
  CHECK(told({0, 15, 18}, {0.1, 0.1, 0}).empty()); // as the warning advises
  nominal.latches.clear();                         // does not latch: the last command counts
  CHECK(told({0, 50, 55}, {0.1, 0.1, 0}).empty());
}

TEST_CASE("a motor's table and its scale are warned of as the scaled table is", "[warnings]") {
  std::mt19937_64 random(4);
  const Scene plain = read_scene_file(test::three_panel_file());
  Outcome nominal;
  nominal.latches = {{0, 5, {0.1, 0, 0}}};
  std::size_t warned = 0;
  for (int k = 0; k < 200; ++k) {
    const double scale = std::exp2(std::floor(8 * test::uniform(random)) - 4); // rounds nothing
    const std::vector<double> time{0, 4, 8, 12};
    std::vector<double> rates, scaled;
    for (std::size_t i = 0; i < time.size(); ++i) {
      rates.push_back(2 * test::uniform(random) - 0.5);
      scaled.push_back(scale * rates.back());
    }
    const double gain = std::pow(10, 12 * test::uniform(random));
    const auto told = [&](const std::vector<double>& values, double factor) {
      Scene scene = plain;
      for (Hinge& hinge : scene.hinges) {
        hinge.spring = {};
        Motor& motor = hinge.motor.emplace();
        motor.gain = gain, motor.torque_limit = 5, motor.scale = factor;
        motor.time = time, motor.rates = values;
        motor.table = std::make_shared<Curve>(time, values, Interpolation::linear);
      }
      InputWarnings warnings(ScenePlace{"scene.json"});
      check_motors(scene, Integration(), nominal, warnings);
      std::vector<std::string> lines;
      for (const InputWarning& each : warnings.list())
        lines.push_back(each.pointer + ": " + each.found + each.usual);
      return lines;
    };
    CHECK(told(rates, scale) == told(scaled, 1));
    warned += told(scaled, 1).size();
  }
  CHECK(warned > 100);
}

TEST_CASE("the time that a hold keeps a hinge does not change what is said of its motor",
          "[warnings]") {
  std::mt19937_64 random(11);
  const Scene plain = read_scene_file(test::three_panel_file());
  std::size_t warned = 0;
  for (int k = 0; k < 200; ++k) {
    const double held = 60 * test::uniform(random), latched = 1 + 20 * test::uniform(random);
    const std::vector<double> time{0, 5, 10, 15, 20, 40};
    std::vector<double> rates;
    for (std::size_t i = 0; i < time.size(); ++i) rates.push_back(test::uniform(random) - 0.4);
    const bool latches = k % 4 != 0;
    const auto told = [&](double released) {
      Scene scene = plain;
      scene.hinges[1].spring = {};
      scene.hinges[1].latch->holding_moment = 20;
      Motor& motor = scene.hinges[1].motor.emplace();
      motor.gain = 100, motor.torque_limit = 500;
      motor.time = time, motor.rates = rates;
      motor.table = std::make_shared<Curve>(time, rates, Interpolation::linear);
      Outcome nominal;
      if (released > 0) nominal.releases = {{1, released}};
      if (latches) nominal.latches = {{1, released + latched, {0, 0.1, 0}}};
      Integration how;
      how.t_end = released + 30;
      InputWarnings warnings(ScenePlace{"scene.json"});
      check_motors(scene, how, nominal, warnings);
      std::vector<std::string> lines;
      for (const InputWarning& each : warnings.list()) lines.push_back(each.pointer + each.found);
      return lines;
    };
    CHECK(told(held) == told(0));
    warned += told(0).size();
  }
  CHECK(warned > 50);
}
