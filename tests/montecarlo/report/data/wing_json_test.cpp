#include "montecarlo/model/input_checks/placement.hpp"
#include "montecarlo/report/data/wing_json.hpp"
#include "tests/montecarlo/report/data/page_support.hpp"
#include "tests/support/source_folder.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <numbers>

using namespace wingspread;
using namespace wingspread::test;

namespace {

Eigen::Vector2d point_of(const Json& json) {
  return {json[0].get<double>(), json[1].get<double>()};
}

/// Where the page puts the centres of mass: by the rule of DATA.md alone.
std::vector<Eigen::Vector2d> posed(const Json& wing, const std::vector<double>& angles) {
  struct Frame {
    Eigen::Vector2d origin;
    double angle;
  };
  std::map<int, Frame> frames; // by the hinge that carries the body
  std::vector<Eigen::Vector2d> centres;
  for (const Json& body : wing["bodies"]) {
    const int h = body["hinge"];
    Frame frame{{0, 0}, 0};
    if (h >= 0) {
      const Frame& parent = frames.at(wing["hinges"][h]["parent"]);
      frame = {parent.origin + Eigen::Rotation2Dd(parent.angle) * point_of(body["joint_in_parent"]),
               parent.angle + angles[static_cast<std::size_t>(h)]};
    }
    frames[h] = frame;
    if (h >= 0)
      centres.emplace_back(frame.origin +
                           Eigen::Rotation2Dd(frame.angle) * point_of(body["centre"]));
  }
  return centres;
}

} // namespace

TEST_CASE("the page's rule of poses puts bodies where they are", "[page]") {
  for (const char* file : {"three_panel.json", "two_wing_free.json", "yoke_wing.json"}) {
    const auto path = std::filesystem::path(source_folder) / "studies/scenes" / file;
    if (!std::filesystem::exists(path)) continue;
    CAPTURE(file);
    Scene scene = read_scene_file(path);
    scene.base = {}; // in the origin, as the page's base is
    const Json wing = wing_json(scene);
    const std::vector<int> order = outward_order(scene);
    for (const auto& angles : {stowed_angles(scene), latched_angles(scene)}) {
      const auto centres = posed(wing, angles);
      const auto placed = place_bodies(scene, angles);
      REQUIRE(centres.size() == placed.size());
      for (std::size_t k = 0; k < centres.size(); ++k) // to the page's seven digits of each link
        CHECK((centres[k] - placed[static_cast<std::size_t>(
                                       scene.hinges[static_cast<std::size_t>(order[k])].child)]
                                .position)
                  .norm() < 1e-5);
    }
  }
}

TEST_CASE("a panel reaches from hinge to hinge, as thick as these stand off its middle", "[page]") {
  const Scene scene = read_scene_file(three_panel_file()); // hinges at ±0.505, ±0.02
  for (int body = 0; body < 3; ++body) {
    const BodyOutline outline = body_outline(scene, body);
    REQUIRE(outline.points.size() == 4);
    CHECK(outline.closed);
    for (const Eigen::Vector2d& corner : outline.points) {
      CHECK(std::abs(corner.x()) == Approx(0.505));
      CHECK(std::abs(corner.y()) == Approx(0.02));
    }
  }
  CHECK(wing_span(scene) == Approx(3.03).epsilon(1e-12));
}

TEST_CASE("a panel without thickness is drawn 0.8 % of its length thick, on both sides", "[page]") {
  Scene scene = read_scene_file(three_panel_file());
  for (Hinge& hinge : scene.hinges) hinge.parent_point.y() = hinge.child_point.y() = 0;
  scene.hinges[1].parent_point.x() = 0.2; // the outer hinge is nearer to the centre than the inner
  const BodyOutline outline = body_outline(scene, 0);
  REQUIRE(outline.points.size() == 4);
  for (const Eigen::Vector2d& corner : outline.points) {
    CHECK(corner.x() == Approx(corner.x() < 0 ? -0.505 : 0.2));
    CHECK(std::abs(corner.y()) == Approx(0.008 * 0.705));
  }
}

TEST_CASE("a body whose hinges lie off any line is drawn as lines to them", "[page]") {
  Scene scene = read_scene_file(three_panel_file());
  scene.hinges[1].parent_point = {0.2, 0.9};
  const BodyOutline outline = body_outline(scene, 0);
  CHECK(!outline.closed);
  CHECK(outline.points.back() == Eigen::Vector2d(0.2, 0.9));
}

TEST_CASE("bodies are named by the hinge that carries them, in whatever order a scene lists both",
          "[page]") {
  Scene scene = read_scene_file(three_panel_file());
  std::ranges::reverse(scene.hinges); // tip, mid, root carry bodies 2, 1, 0
  const Json wing = wing_json(scene);
  std::vector<int> parents, carriers;
  for (const Json& hinge : wing["hinges"]) parents.push_back(hinge["parent"]);
  for (const Json& body : wing["bodies"]) carriers.push_back(body["hinge"]);
  CHECK(parents == std::vector<int>{1, 2, -1});
  CHECK(carriers == std::vector<int>{-1, 2, 1, 0}); // the base, then from it outwards
  std::vector<double> angles = latched_angles(scene);
  for (double& angle : angles) angle += 0.3;
  const auto centres = posed(wing, angles);
  const auto placed = place_bodies(scene, angles);
  for (std::size_t b = 0; b < 3; ++b) CHECK((centres[b] - placed[b].position).norm() < 1e-5);
}

TEST_CASE("a base is drawn as a box of 0.3 of a panel's length, behind its wing or about its wings",
          "[page]") {
  const auto corners = [](const Scene& scene) {
    Eigen::AlignedBox2d box;
    const Json wing = wing_json(scene);
    for (const Json& point : wing["bodies"][0]["outline"]) box.extend(point_of(point));
    return box;
  };
  Scene scene = read_scene_file(three_panel_file());
  scene.hinges[0].parent_point = {0.04, 0.03};
  const double half = 0.3 * std::hypot(0.505, 0.02); // of twice the way from the root to the centre
  Eigen::AlignedBox2d box = corners(scene);
  CHECK((box.max() - Eigen::Vector2d(0.04, 0.03 + half)).norm() < 1e-6);
  CHECK((box.min() - Eigen::Vector2d(0.04 - 2 * half, 0.03 - half)).norm() < 1e-6);
  scene.hinges[0].parent_point = {0.4, 0.3}; // the joint is off the box: it defines the box
  box = corners(scene);
  CHECK((box.max() - Eigen::Vector2d(0.5, 0.5)).norm() < 1e-6);
  CHECK((box.min() + Eigen::Vector2d(0.5, 0.5)).norm() < 1e-6);
}

TEST_CASE("a wing's span does not depend on where its free base is", "[page]") {
  Scene scene = read_scene_file(three_panel_file());
  scene.hinges[0].parent_point = {-1, 0}; // so the panels reach from -1 to 2.03 m
  const double span = wing_span(scene);
  CHECK(span == Approx(3.03).epsilon(1e-12));
  scene.base.motion = BaseMotion::free, scene.base.mass = scene.base.inertia = 100;
  scene.base.position = {40, -70};
  CHECK(wing_span(scene) == Approx(span).epsilon(1e-12));
  scene.base.angle = std::numbers::pi / 2;
  CHECK(wing_span(scene) == Approx(span).epsilon(1e-12));
}
