#include "montecarlo/model/input_checks/bending_check.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

namespace {

/// A uniform panel of 8 kg and 2 m with a first frequency of 1.5 Hz.
Scene bending_scene(int joints, double inertia = 8.0 * 4 / 12) {
  Scene scene;
  Body body{"panel", 8, inertia};
  body.plate = Plate{{-1, 0}, {1, 0}, 1, 0};
  Flexible& flexible = body.flexible.emplace();
  flexible.joints = joints, flexible.frequency = 1.5, flexible.damping_ratio = 0.01;
  scene.bodies = {body};
  return scene;
}

std::string warnings_of(const Scene& scene) {
  InputWarnings warnings(ScenePlace{"wing.json"});
  check_bending(scene, warnings);
  std::string text;
  for (const InputWarning& warning : warnings.list())
    text += warning.pointer + ": " + warning.found + '\n';
  return text;
}

} // namespace

// Source of the errors: studies/FLEXIBILITY.md, by the modes of a clamped rod.
TEST_CASE("a clamped panel's first frequency converges with its segments", "[input_checks]") {
  for (const auto& [joints, error] : {std::pair(4, 1.45e-2), {8, 3.60e-3}, {16, 8.97e-4}})
    CHECK(clamped_frequency(bending_scene(joints).bodies[0]) / 1.5 - 1 ==
          Approx(error).epsilon(5e-3));
}

TEST_CASE("a bending panel with one joint, or with more inertia than a uniform one, is warned of",
          "[input_checks]") {
  CHECK(warnings_of(bending_scene(2)).empty());
  CHECK(
      warnings_of(bending_scene(1)) ==
      "/bodies/0/flexible/joints: 1: the clamped panel vibrates at 2.09 Hz with its segments, and "
      "at 1.5 Hz uncut\n");
  CHECK(warnings_of(bending_scene(8, 3)) == "/bodies/0/inertia: 3 kg·m², 1.12 times m L²/12\n");
  CHECK(warnings_of(bending_scene(8, 2.6)).empty()); // its mass is nearer to the middle
  Scene shifted = bending_scene(8);
  for (const Eigen::Vector2d& by : {Eigen::Vector2d(0.2, 0), Eigen::Vector2d(0, -0.2)}) {
    shifted.bodies[0].plate = Plate{Eigen::Vector2d(-1, 0) + by, Eigen::Vector2d(1, 0) + by, 1, 0};
    CHECK_THAT(warnings_of(shifted), Catch::StartsWith("/bodies/0/plate: ") &&
                                         Catch::Contains("0.2 m from the centre of mass"));
  }
  Scene rigid = bending_scene(1, 3);
  rigid.bodies[0].flexible.reset();
  CHECK(warnings_of(rigid).empty());
}

TEST_CASE(
    "a bending panel with less inertia than a uniform one is warned of it, and not of its joints",
    "[input_checks]") {
  for (const int joints : {4, 8, 32}) {
    const std::string text = warnings_of(bending_scene(joints, 0.8 * 3 / 1.12)); // 0.8 of a rod
    CAPTURE(text);
    CHECK(text.starts_with("/bodies/0/inertia: "));
    CHECK(text.find("joints: ") == std::string::npos);
    // the limit of many joints, whatever the panel's own number
    Body body = bending_scene(64, 0.8 * 3 / 1.12).bodies[0];
    const double stated = std::stod(text.substr(text.find("vibrates at ") + 12));
    CHECK(stated == Approx(clamped_frequency(body)).epsilon(5e-3));
    CHECK(stated > 1.05 * 1.5);
  }
}

TEST_CASE(
    "a hinge on the joint between two segments is warned of, whichever end the plate begins at",
    "[input_checks]") {
  const auto told = [](int joints, double x, bool mirrored, bool own) {
    Scene scene = bending_scene(joints);
    if (mirrored) std::swap(scene.bodies[0].plate->from, scene.bodies[0].plate->to);
    scene.bodies.push_back({"branch", 2, 0.3});
    scene.hinges.resize(2);
    scene.hinges[0].child = 0, scene.hinges[0].child_point = {own ? x : -1, 0.05};
    scene.hinges[1].parent = 0, scene.hinges[1].parent_point = {own ? 1 : x, 0.03};
    scene.hinges[1].child = 1, scene.hinges[1].child_point = {-0.5, 0};
    const std::string text = warnings_of(scene);
    const bool found = text.find(own ? "/hinges/0/child_point: " : "/hinges/1/parent_point: ") !=
                       std::string::npos;
    CHECK((text.find("/hinges/") != std::string::npos) == found); // no other hinge is named
    return found;
  };
  for (const bool mirrored : {false, true})
    for (const bool own : {false, true}) {
      CAPTURE(mirrored, own);
      for (const int joints : {1, 3, 5}) {
        CHECK(told(joints, 0, mirrored, own)); // joints at −1 + 2(j + ½)/N
        CHECK(told(joints, -1 + 1.0 / joints, mirrored, own));
        CHECK_FALSE(told(joints, 0.1, mirrored, own));
      }
      for (const int joints : {2, 4}) CHECK_FALSE(told(joints, 0, mirrored, own));
      CHECK(told(2, 0.5, mirrored, own));
      CHECK(told(2, -0.5 + 1e-4, mirrored, own));
      CHECK_FALSE(told(2, -1, mirrored, own)); // an end is no joint
    }
}
