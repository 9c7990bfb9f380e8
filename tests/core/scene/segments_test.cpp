// A flexible body's segments have its mass, centre of mass and inertia, and its hinges stand where they stood.
#include "core/scene/segments.hpp"
#include "tests/support/bending_scenes.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// Where a body of a straight panel stands in the frame of the panel's body: its centre of mass, by the chain of joints.
Eigen::Vector2d center_in_panel(const Scene& made, int body, int root, const Eigen::Vector2d& own) {
  if (body == root) return own;
  for (const Hinge& hinge : made.hinges)
    if (hinge.child == body)
      return center_in_panel(made, hinge.parent, root, own) + hinge.parent_point -
             hinge.child_point;
  return own;
}

} // namespace

TEST_CASE("segments keep mass, centre of mass and inertia, and a hinge its place") {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    const Scene scene = with_bending(random_scene(seed), seed);
    REQUIRE(unphysical(scene).empty());
    const SegmentedScene made = with_segments(scene);
    REQUIRE(made.joints.size() == scene.bodies.size());
    CHECK(unphysical(made.scene).empty());
    CHECK(outward_order(made.scene).size() == made.scene.bodies.size());
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
      const Body& body = scene.bodies[b];
      if (!body.flexible) {
        CHECK(made.joints[b].empty());
        continue;
      }
      REQUIRE(made.segments[b].size() == made.joints[b].size() + 1);
      const auto& own =
          *std::find_if(scene.hinges.begin(), scene.hinges.end(),
                        [&](const Hinge& h) { return h.child == static_cast<int>(b); });
      const auto& cut =
          *std::find_if(made.scene.hinges.begin(), made.scene.hinges.end(),
                        [&](const Hinge& h) { return h.child == static_cast<int>(b); });
      const Eigen::Vector2d first = own.child_point - cut.child_point; // the root segment's centre
      double mass = 0, inertia = 0;
      Eigen::Vector2d moment(0, 0);
      for (const int segment : made.segments[b]) {
        const Body& part = made.scene.bodies[segment];
        const Eigen::Vector2d r = center_in_panel(made.scene, segment, static_cast<int>(b), first);
        mass += part.mass, moment += part.mass * r;
        inertia += part.inertia + part.mass * r.squaredNorm();
      }
      CHECK(mass == Approx(body.mass).epsilon(1e-14));
      CHECK(moment.norm() < 1e-14 * body.mass);
      CHECK(inertia == Approx(body.inertia).epsilon(1e-13));
      for (std::size_t h = 0; h < scene.hinges.size(); ++h) {
        if (scene.hinges[h].parent != static_cast<int>(b)) continue;
        const Hinge& hinge = made.scene.hinges[h];
        const Eigen::Vector2d place =
            center_in_panel(made.scene, hinge.parent, static_cast<int>(b), first) +
            hinge.parent_point;
        CHECK((place - scene.hinges[h].parent_point).norm() < 1e-13);
      }
    }
  }
}

// In air a segment has its part of the plate, about its own centre of mass.
TEST_CASE("the plates of a panel's segments cover its plate once, from end to end") {
  int cut = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Scene scene = with_bending(random_scene(seed), seed);
    scene.environment.air_density = 1;
    const SegmentedScene made = with_segments(scene);
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
      if (!scene.bodies[b].flexible) continue;
      ++cut;
      const Plate& whole = *scene.bodies[b].plate;
      const auto own = std::ranges::find(scene.hinges, static_cast<int>(b), &Hinge::child);
      const auto on = std::ranges::find(made.scene.hinges, static_cast<int>(b), &Hinge::child);
      const Eigen::Vector2d first = own->child_point - on->child_point;
      Eigen::Vector2d end = whole.from;
      CAPTURE(seed, b);
      for (const int segment : made.segments[b]) {
        const Eigen::Vector2d r = center_in_panel(made.scene, segment, static_cast<int>(b), first);
        REQUIRE(made.scene.bodies[segment].plate);
        const Plate& part = *made.scene.bodies[segment].plate;
        CHECK((r + part.from - end).norm() < 1e-13);
        CHECK((part.to - part.from).norm() <= (whole.to - whole.from).norm());
        CHECK((part.width == whole.width && part.drag_coefficient == whole.drag_coefficient));
        end = r + part.to;
      }
      CHECK((end - whole.to).norm() < 1e-13);
    }
  }
  CHECK(cut >= 20);
}

TEST_CASE(
    "a hinge on the far end hangs on the outermost segment, whichever end the body hangs on") {
  Scene scene = bending_rod(4, 1e4);
  Hinge next = scene.hinges[0];
  next.name = "next", next.parent = 0, next.child = 1;
  next.parent_point = {0.5, 0.01};
  scene.bodies.push_back({"tip", 1, 0.1});
  scene.hinges.push_back(next);
  SegmentedScene made = with_segments(scene);
  CHECK(made.scene.hinges[1].parent == made.segments[0][4]);
  CHECK(made.segments[0][0] == 0);
  CHECK(made.scene.bodies[made.segments[0][4]].name == "rod segment 5");
  CHECK(made.scene.hinges[made.joints[0][0]].name == "rod joint 1");
  scene.hinges[0].child_point = {0.5, 0}, scene.hinges[1].parent_point = {-0.5, 0.01};
  made = with_segments(scene);
  CHECK(made.scene.hinges[1].parent == made.segments[0][0]);
  CHECK(made.segments[0][4] == 0);
  CHECK(have_same_tree(made.scene, with_segments(scene).scene));
  CHECK_FALSE(have_same_tree(made.scene, scene));
}

TEST_CASE("a hinge hangs on the segment that holds its point, wherever the point lies") {
  Draws draws(41);
  for (const int joints : {1, 2, 3, 8}) {
    const auto half_of = [&](int j) { // a segment's half length: the outermost are half as long
      return (j == 0 || j == joints ? 0.25 : 0.5) / joints;
    };
    for (int k = 0; k < 40; ++k) {
      Scene scene = bending_rod(joints, 1e4); // 1 m long, along x
      scene.hinges[0].child_point = {draws.uniform(-0.5, 0.5), draws.uniform(-0.1, 0.1)};
      Hinge next = scene.hinges[0];
      next.name = "next", next.parent = 0, next.child = 1;
      next.parent_point = {draws.uniform(-0.5, 0.5), draws.uniform(-0.1, 0.1)};
      scene.bodies.push_back({"tip", 1, 0.1});
      scene.hinges.push_back(next);
      const SegmentedScene made = with_segments(scene);
      const auto index_of = [&](int body) {
        return static_cast<int>(std::ranges::find(made.segments[0], body) -
                                made.segments[0].begin());
      };
      CAPTURE(joints, k);
      const Hinge &root = made.scene.hinges[0], &tip = made.scene.hinges[1];
      CHECK(std::abs(root.child_point.x()) < half_of(index_of(root.child)) + 1e-12);
      CHECK(std::abs(tip.parent_point.x()) < half_of(index_of(tip.parent)) + 1e-12);
    }
  }
}

TEST_CASE("a panel with less inertia than a rod has more mass towards the middle") {
  for (const int joints : {1, 2, 5, 16}) {
    for (const double share : {0.99, 0.8}) {
      CAPTURE(joints, share);
      Scene scene = bending_rod(joints, 1);
      scene.bodies[0].inertia = share / 12;
      REQUIRE(unphysical(scene).empty());
      const SegmentedScene made = with_segments(scene);
      double mass = 0, inertia = 0;
      for (int j = 0; j <= joints; ++j) {
        const Body& part = made.scene.bodies[made.segments[0][j]];
        const double from = j == 0 ? 0 : (j - 0.5) / joints,
                     to = j == joints ? 1 : (j + 0.5) / joints;
        mass += part.mass, inertia += part.inertia + part.mass * std::pow((from + to - 1) / 2, 2);
        CHECK(part.inertia > 0);
      }
      CHECK(mass == Approx(1).epsilon(1e-14));
      CHECK(inertia == Approx(share / 12).epsilon(1e-13));
    }
  }
}

TEST_CASE("a bending moment turns a panel's ends by M L/EI, and damps its first swing as asked, "
          "however many joints it has") {
  // a rod of 6 kg and 1.8 m whose first swing, 3.51602 √(EI/(m L³)), is at 8 Hz
  const double omega = 2 * std::numbers::pi * 8;
  const double EI = std::pow(omega / 3.5160152685, 2) * 6 * std::pow(1.8, 3);
  for (const bool by_frequency : {true, false})
    for (const int joints : {1, 2, 3, 7}) {
      Scene scene = bending_rod(joints, 1e4);
      Body& rod = scene.bodies[0];
      rod.mass = 6, rod.inertia = 6 * 1.8 * 1.8 / 12;
      rod.plate = Plate{{0.9, 0}, {-0.9, 0}};
      rod.flexible = by_frequency ? Flexible{joints, std::nullopt, 8.0, 0.02}
                                  : Flexible{joints, EI, std::nullopt, 0.02};
      const SegmentedScene made = with_segments(scene);
      CAPTURE(by_frequency, joints);
      REQUIRE(std::ssize(made.joints[0]) == joints);
      double turn = 0; // for a moment of 1 N·m
      for (const int each : made.joints[0]) {
        const Joint& joint = made.scene.hinges[each].joint.value();
        turn += 1 / joint.stiffness;
        CHECK(joint.damping / joint.stiffness == Approx(2 * 0.02 / omega).epsilon(1e-9));
      }
      CHECK(turn == Approx(1.8 / EI).epsilon(1e-9));
    }
}

TEST_CASE("a frequency stands for the bending stiffness of the clamped panel") {
  Body panel{"panel", 6, 2};
  panel.plate = Plate{{-0.9, 0}, {0.9, 0}};
  panel.flexible = Flexible{3, std::nullopt, 8.0, 0.01};
  const double wave = cantilever_roots[0] * cantilever_roots[0]; // f = wave √(EI/(m L³))/2π
  const double EI = bending_stiffness(panel);
  CHECK(wave * std::sqrt(EI / (6 * 1.8 * 1.8 * 1.8)) / (2 * std::numbers::pi) ==
        Approx(8).epsilon(1e-14));
  panel.flexible = Flexible{3, EI, std::nullopt, 0.01};
  CHECK(bending_stiffness(panel) == EI);
}

TEST_CASE("a flexible body needs a plate, a stiffness, and the inertia of its segments") {
  Scene scene = bending_rod(8, 1e4);
  CHECK(unphysical(scene).empty());
  const auto path = [&] {
    const std::vector<Fault> faults = unphysical(scene);
    return faults.empty() ? "" : faults.front().path;
  };
  scene.bodies[0].inertia = 0.65 / 12; // mass towards the middle, at most so
  CHECK(unphysical(scene).empty());
  scene.bodies[0].inertia = 0.5 / 12;
  CHECK(path() == "bodies.rod.inertia");
  for (const auto& [joints, share] : {std::pair(1, 0.75), {2, 0.325}, {3, 0.5}, {8, 0.5875}}) {
    scene.bodies[0].flexible->joints = joints;
    const double least = least_inertia(scene.bodies[0]);
    CHECK(least == Approx(share / 12).epsilon(1e-3));
    scene.bodies[0].inertia = least * (1 + 1e-8);
    CHECK(unphysical(scene).empty());
    scene.bodies[0].inertia = least * (1 - 1e-8);
    REQUIRE(path() == "bodies.rod.inertia");
    std::ostringstream number;
    number << least;
    CHECK_THAT(unphysical(scene).front().expected, Catch::Contains(number.str()));
  }
  scene.bodies[0].inertia = 1.0 / 12;
  scene.bodies[0].flexible->bending_stiffness = 0;
  CHECK(path() == "bodies.rod.flexible.bending_stiffness");
  scene.bodies[0].flexible->bending_stiffness = 1;
  scene.bodies[0].flexible->damping_ratio = -0.1;
  CHECK(path() == "bodies.rod.flexible.damping_ratio");
  scene.bodies[0].flexible->damping_ratio = 0;
  scene.bodies[0].plate.reset();
  CHECK(path() == "bodies.rod.plate");
}
