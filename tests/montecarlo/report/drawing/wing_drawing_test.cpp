#include "montecarlo/model/scene_file/scene_json.hpp"
#include "montecarlo/model/starter/starter_scene.hpp"
#include "montecarlo/report/drawing/wing_drawing.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <Eigen/Core>
#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

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

namespace {

/// The numbers after each of these keys in all lines that have the mark, e.g. the x and y of texts.
std::vector<Eigen::Vector2d> drawn_at(const std::string& svg, const std::string& mark,
                                      const std::string& x, const std::string& y) {
  std::vector<Eigen::Vector2d> found;
  std::istringstream in(svg);
  for (std::string line; std::getline(in, line);) {
    if (line.find(mark) == line.npos) continue;
    const auto number = [&](const std::string& key) {
      return std::stod(line.substr(line.find(' ' + key + "=\"") + key.size() + 3));
    };
    found.emplace_back(number(x), number(y));
  }
  return found;
}

/// A wing of four panels, its drawing, and where hinges and centres of mass stand in it, view after view.
struct DrawnWing {
  Scene scene = scene_of([] {
    WingDesign design;
    design.panels = 4, design.damper = 0;
    return design;
  }());
  std::string svg = draw_wing(scene);
  std::vector<Eigen::Vector2d> hinges = drawn_at(svg, "class=\"hinge\"", "cx", "cy");
  std::vector<Eigen::Vector2d> centres = drawn_at(svg, " r=\"2.5\"", "cx", "cy");
};

} // namespace

TEST_CASE("each name of a drawing stands at what it names, in each view") {
  const DrawnWing drawn;
  const auto& [scene, svg, hinges, centres] = drawn;
  const auto base = drawn_at(svg, "stroke-width=\"6\"", "x1", "y1");
  const std::size_t h = scene.hinges.size(), b = scene.bodies.size();
  REQUIRE((hinges.size() == 3 * h && centres.size() == 3 * b && base.size() == 3));
  const auto check = [&](const std::string& name, const std::vector<Eigen::Vector2d>& places,
                         std::size_t first, std::size_t each) {
    const auto names = drawn_at(svg, '>' + name + '<', "x", "y");
    REQUIRE(names.size() == 3);
    for (std::size_t view = 0; view < 3; ++view) {
      CAPTURE(name, view, names[view].transpose(), places[view * each + first].transpose());
      CHECK((names[view] - places[view * each + first]).norm() < 130); // of 1200 px
    }
  };
  for (std::size_t k = 0; k < h; ++k) check(scene.hinges[k].name, hinges, k, h);
  for (std::size_t k = 0; k < b; ++k) check(scene.bodies[k].name, centres, k, b);
  check("base", base, 0, 1);
  CHECK((base[2] - centres[3 * b - 1]).norm() > 700); // the deployed wing fills the width
}

TEST_CASE("each spring's arc begins beside the child that the spring turns, in each view") {
  const DrawnWing drawn;
  const auto& [scene, svg, hinges, centres] = drawn;
  const std::size_t h = scene.hinges.size(), b = scene.bodies.size();
  REQUIRE(count(svg, "class=\"spring\"") == static_cast<long>(3 * h));
  std::size_t arc = 0;
  std::istringstream in(svg);
  for (std::string line; std::getline(in, line);) {
    const std::size_t at = line.find(" d=\"M ");
    if (line.find("class=\"spring\"") == line.npos) continue;
    Eigen::Vector2d begin;
    std::istringstream(line.substr(at + 6)) >> begin.x() >> begin.y();
    const std::size_t view = arc / h, k = arc % h;
    const auto child = static_cast<std::size_t>(scene.hinges[k].child);
    const Eigen::Vector2d spoke = begin - hinges[arc],
                          arm = centres[view * b + child] - hinges[arc];
    CAPTURE(view, scene.hinges[k].name, spoke.transpose(), arm.transpose());
    CHECK(spoke.dot(arm) > std::cos(0.2) * spoke.norm() * arm.norm()); // 0.15 rad, and rounding
    ++arc;
  }
  CHECK(arc == 3 * h);
}

// A path's sweep flag is 1 for the clockwise arc on the page. Both flags give arcs of one radius between the same two
// ends; only the right one is centred on the hinge.
TEST_CASE("each spring's arc is centred on its hinge, whichever way the spring turns") {
  WingDesign design;
  design.panels = 3, design.wings = 2, design.damper = 0; // mirrored wings turn in opposite senses
  const std::string svg = draw_wing(scene_of(design));
  const auto hinges = drawn_at(svg, "class=\"hinge\"", "cx", "cy");
  std::size_t arc = 0;
  std::array<int, 2> flags{};
  std::istringstream in(svg);
  for (std::string line; std::getline(in, line);) {
    if (line.find("class=\"spring\"") == line.npos) continue;
    std::istringstream path(line.substr(line.find(" d=\"M ") + 6));
    Eigen::Vector2d from, to;
    double rx = 0, ry = 0;
    int rotation = 0, large = 0, clockwise = 0;
    char letter = 0;
    path >> from.x() >> from.y() >> letter >> rx >> ry >> rotation >> large >> clockwise >>
        to.x() >> to.y();
    REQUIRE((letter == 'A' && rx == ry && large == 0));
    const Eigen::Vector2d chord = to - from, across{-chord.y(), chord.x()};
    const double half = chord.norm() / 2;
    const Eigen::Vector2d centre = (from + to) / 2 + (clockwise != 0 ? 1 : -1) *
                                                         std::sqrt(rx * rx - half * half) *
                                                         across.normalized();
    CAPTURE(line);
    CHECK((centre - hinges.at(arc)).norm() < 0.5); // px; ends are rounded to 0.1
    ++flags.at(static_cast<std::size_t>(clockwise));
    ++arc;
  }
  CHECK(arc == hinges.size());
  CHECK((flags[0] > 0 && flags[1] > 0));
}

TEST_CASE("the bar of each view is as long as it says, by the distances of the hinges") {
  for (const double length : {0.013, 0.1, 0.37, 1.0, 2.6, 40.0}) {
    WingDesign design;
    design.panels = 4, design.damper = 0, design.panel_length = length, design.pitch = length / 50;
    const Scene scene = scene_of(design);
    const std::string svg = draw_wing(scene);
    const auto from = drawn_at(svg, "stroke=\"#333\" stroke-width=\"2\"", "x1", "y1"),
               to = drawn_at(svg, "stroke=\"#333\" stroke-width=\"2\"", "x2", "y2");
    const auto hinges = drawn_at(svg, "class=\"hinge\"", "cx", "cy");
    REQUIRE((from.size() == 3 && to.size() == 3 && hinges.size() == 3 * scene.hinges.size()));
    std::vector<double> said;
    for (std::size_t at = svg.find(" m</text>"); at != svg.npos; at = svg.find(" m</text>", at + 1))
      said.push_back(std::stod(svg.substr(svg.rfind('>', at) + 1)));
    REQUIRE(said.size() == 3);
    // hinges of one panel: one panel's length apart along it, and a pitch apart across it, in any pose
    const double apart = std::hypot(length, design.pitch);
    for (std::size_t view = 0; view < 3; ++view) {
      const std::size_t first = view * scene.hinges.size() + 1;
      const double scale = (hinges[first + 1] - hinges[first]).norm() / apart;
      CAPTURE(length, view, said[view]);
      CHECK((to[view] - from[view]).norm() / scale == Approx(said[view]).epsilon(0.01));
      CHECK((to[view] - from[view]).norm() <= 151);
      CHECK((to[view] - from[view]).norm() > 59); // 1, 2, 5 of a power of ten
    }
  }
}
