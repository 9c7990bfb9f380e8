#include "montecarlo/model/scene_file/scene_json.hpp"
#include "montecarlo/model/starter/starter_scene.hpp"
#include "montecarlo/report/drawing/wing_drawing.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>

#include <string>

using namespace wingspread;
using namespace wingspread::test;

namespace {

long count(const std::string& text, const std::string& part) {
  long found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++found;
  return found;
}

} // namespace

TEST_CASE("a drawing has three views with every hinge, spring and name") {
  WingDesign design;
  design.panels = 4, design.yoke = true, design.wings = 2, design.damper = 0;
  const Scene scene = scene_of(design);
  const std::string svg = draw_wing(scene);
  CHECK(svg == draw_wing(scene));
  CHECK(count(svg, "class=\"hinge\"") == 3 * 10);
  CHECK(count(svg, "class=\"spring\"") == 3 * 10);
  for (const Hinge& hinge : scene.hinges) CHECK(count(svg, ">" + hinge.name + "<") == 3);
  for (const Body& body : scene.bodies) CHECK(count(svg, ">" + body.name + "<") == 3);
  CHECK(svg.find("nan") == std::string::npos);
}

TEST_CASE(
    "an arrow is red where a spring pushes away from its latch, and missing without a torque") {
  Json json = small_scene(); // the second hinge has no spring
  CHECK(count(draw_wing(read_scene(json)), "class=\"spring\"") == 3);
  CHECK(count(draw_wing(read_scene(json)), "#c62828") == 0);
  json["hinges"][0]["spring"]["torque_latched"] = -1;
  CHECK(count(draw_wing(read_scene(json)), "#c62828") == 2); // arc and head of the deployed view
  json["hinges"][0]["name"] = "a<b & c";
  CHECK(draw_wing(read_scene(json)).find(">a&lt;b &amp; c<") != std::string::npos);
}
