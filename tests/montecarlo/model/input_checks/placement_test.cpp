#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/input_checks/placement.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <numbers>

using namespace wingspread;
using namespace wingspread::test;

// By hand, from the drawing: panels of 1.01 m in a stack of 0.04 m steps, upright; deployed in line.
TEST_CASE("the seed scene's bodies stand in a stack, and in line", "[warnings]") {
  const std::string text = describe_placement(read_scene_file(three_panel_file()));
  CHECK(text ==
        "centres of mass                                     stowed                          "
        "deployed\n"
        "                                x, m        y, m       deg        x, m        y, m"
        "       deg\n"
        "  panel_1                     0.0200      0.5050     90.00      0.5050     -0.0200"
        "      0.00\n"
        "  panel_2                     0.0600      0.5050    -90.00      1.5150     -0.0200"
        "      0.00\n"
        "  panel_3                     0.1000      0.5050     90.00      2.5250     -0.0200"
        "      0.00\n"
        "mass of 3 bodies: 30 kg\n");
}

TEST_CASE("a body is where its hinge holds it, on a base that is turned", "[warnings]") {
  Scene scene;
  scene.base.motion = BaseMotion::free;
  scene.base.position = {1, 2};
  scene.base.angle = std::numbers::pi / 2;
  scene.bodies = {{"outer", 1, 1}, {"inner", 2, 1}};
  Hinge second, first; // listed in the other order
  second.parent = 1;
  second.child = 0;
  second.parent_point = {0.5, 0};
  second.child_point = {-0.25, 0};
  first.child = 1;
  first.parent_point = {1, 0};
  first.child_point = {-0.5, 0};
  scene.hinges = {second, first};
  const auto bodies = place_bodies(scene, std::vector{std::numbers::pi / 2, 0.});
  CHECK(bodies[1].position.isApprox(Eigen::Vector2d{1, 3.5}, 1e-15));  // straight up from the base
  CHECK(bodies[0].position.isApprox(Eigen::Vector2d{0.75, 4}, 1e-15)); // then to the left
  CHECK(bodies[0].angle == Approx(std::numbers::pi).epsilon(1e-15));
}
