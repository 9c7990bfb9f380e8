#include "montecarlo/model/input_checks/shape_checks.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <catch2/catch.hpp>

#include <memory>
#include <numbers>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// A folded chain of panels whose hinge points are roughly where they should be: about half of them overlap.
Scene random_stack(std::mt19937_64& random) {
  const auto between = [&](double a, double b) { return std::lerp(a, b, uniform(random)); };
  Scene scene;
  const int panels = 2 + static_cast<int>(random() % 3);
  for (int k = 0; k < panels; ++k) {
    scene.bodies.push_back({"panel", 1, 1});
    Hinge hinge;
    hinge.parent = k - 1, hinge.child = k;
    const double side = k % 2 == 0 ? 1 : -1, length = between(0.4, 0.7);
    hinge.parent_point = {k == 0 ? 0 : length, -side * between(-0.01, 0.03)};
    hinge.child_point = {-length, -side * between(-0.01, 0.03)};
    hinge.stowed = (k == 0 ? 0.5 : -side) * std::numbers::pi * between(0.9, 1.1);
    hinge.name = "hinge " + std::to_string(k);
    scene.hinges.push_back(hinge);
  }
  return scene;
}

/// The scene in another unit of length.
Scene scaled(Scene scene, double factor) {
  for (Hinge& hinge : scene.hinges) hinge.parent_point *= factor, hinge.child_point *= factor;
  return scene;
}

std::vector<std::string> places(const Scene& scene) {
  InputWarnings warnings({"wing.json", ""});
  check_shape(scene, warnings);
  std::vector<std::string> pointers;
  for (const InputWarning& warning : warnings.list()) pointers.push_back(warning.pointer);
  return pointers;
}

} // namespace

TEST_CASE("whether bodies overlap depends neither on the unit of length nor on the base's place",
          "[warnings]") {
  std::mt19937_64 random(17);
  int warned = 0, quiet = 0, folded = 0;
  for (int trial = 0; trial < 400; ++trial) {
    Scene scene = random_stack(random);
    // two bodies on one side of a hinge, or two hinges on one side of a body
    if (trial % 4 == 1) scene.hinges[1].child_point.x() *= -1;
    if (trial % 4 == 2) scene.hinges[1].parent_point.x() *= -1;
    const std::vector<std::string> found = places(scene);
    ++(found.empty() ? quiet : warned);
    folded += std::ranges::any_of(
        found, [](const std::string& place) { return place.ends_with("_point"); });
    for (const double factor : {1e-3, 30.0, 1e3}) {
      CAPTURE(trial, factor);
      CHECK(places(scaled(scene, factor)) == found);
    }
    Scene moved = scene;
    moved.base.motion = BaseMotion::free;
    moved.base.position = {1e4 * uniform(random), -300};
    moved.base.angle = 6 * uniform(random);
    CHECK(places(moved) == found);
  }
  CHECK((warned > 50 && quiet > 50)); // or the wings have lost their variety
  CHECK(folded > 150);
}

TEST_CASE("two bodies have one place when stowed only if both are modelled without thickness",
          "[warnings]") {
  // a root and a panel folded back onto it: their hinge points lie on their axes (thin) or beside them
  for (const bool inner_thin : {true, false})
    for (const bool outer_thin : {true, false}) {
      Scene scene;
      scene.bodies = {{"inner", 1, 1}, {"outer", 1, 1}};
      scene.hinges.resize(2);
      Hinge &root = scene.hinges[0], &mid = scene.hinges[1];
      root.name = "root", root.parent = base_index, root.child = 0;
      root.stowed = std::numbers::pi / 2;
      root.child_point = {-0.5, inner_thin ? 0 : 0.02};
      mid.name = "mid", mid.parent = 0, mid.child = 1;
      mid.stowed = std::numbers::pi;
      mid.child_point = {-0.5, outer_thin ? 0 : 1e-4};
      mid.parent_point = {0.5, outer_thin ? 0 : 1e-4};
      if (inner_thin) mid.parent_point.y() = 0;
      CAPTURE(inner_thin, outer_thin);
      InputWarnings warnings({"wing.json", ""});
      check_shape(scene, warnings);
      const bool told = std::ranges::any_of(warnings.list(), [](const InputWarning& warning) {
        return to_string(warning).find("inner and outer have their centres of mass in one place") !=
               std::string::npos;
      });
      CHECK(told == !(inner_thin && outer_thin));
    }
}

TEST_CASE("two loops between the same hinges must agree all along the travel", "[warnings]") {
  Scene scene;
  scene.bodies = {{"a", 1, 1}, {"b", 1, 1}};
  for (int k = 0; k < 2; ++k) {
    Hinge hinge;
    hinge.name = k == 0 ? "r" : "t", hinge.parent = k - 1, hinge.child = k;
    hinge.stowed = k == 0 ? 1.5 : -3, hinge.latched = 0, hinge.latch = Latch{100, 1};
    scene.hinges.push_back(hinge);
  }
  const auto loop = [](int first, int second, std::vector<double> from, std::vector<double> to) {
    Synchronisation made;
    made.name = "L", made.first = first, made.second = second, made.stiffness = 200;
    made.table = std::make_shared<const Curve>(from, to, Interpolation::linear);
    return made;
  };
  const auto straight = loop(0, 1, {0, 1.5}, {0, 3});
  const auto told = [&](Synchronisation other) {
    scene.synchronisations = {straight, std::move(other)};
    InputWarnings warnings({"wing.json", ""});
    check_shape(scene, warnings);
    for (const InputWarning& each : warnings.list())
      if (each.pointer == "/synchronisations/1") return each.found;
    return std::string();
  };
  CHECK(told(straight).empty());
  CHECK(told(loop(1, 0, {0, 3}, {0, 1.5})).empty());
  // 0.4 rad of t, or 0.2 rad of r, apart in the middle
  CHECK_THAT(told(loop(0, 1, {0, 0.75, 1.5}, {0, 1.1, 3})),
             Catch::Contains("22.92 deg of t") && Catch::Contains("42.97 deg"));
  CHECK_THAT(told(loop(1, 0, {0, 1.5, 3}, {0, 0.95, 1.5})), Catch::Contains("11.46 deg of r"));
  CHECK(told(loop(0, 1, {0, 0.75, 1.5}, {0, 1.48, 3})).empty()); // within a hundredth
}
