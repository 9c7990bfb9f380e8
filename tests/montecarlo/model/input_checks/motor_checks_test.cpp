#include "montecarlo/model/input_checks/motor_checks.hpp"
#include "montecarlo/model/scene_file/scene_json.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <memory>

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
