// The bounds by energy are their formulas, computed by hand for panels in line.
#include "core/mechanics/energy.hpp"
#include "core/peaks/base_peaks.hpp"
#include "tests/core/proofs/energy_bounded_wing.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

using namespace wingspread;
using oracle::LatchedWing;

namespace {

/// Two panels in a line, l from hinge to hinge.
Scene two_in_line(double l, double c1, double c2) {
  Scene scene = oracle::latching_panel();
  scene.bodies = {{"inner", 10, 0.5}, {"outer", 4, 0.2}};
  Hinge& root = scene.hinges[0];
  root.spring = {0, 0}, root.child_point = {-c1, 0}, root.latch = Latch{1e4, 10};
  Hinge mid = root;
  mid.name = "mid", mid.parent = 0, mid.child = 1;
  mid.parent_point = {l - c1, 0}, mid.child_point = {-c2, 0}, mid.latch = Latch{6e3, 20};
  scene.hinges.push_back(mid);
  return scene;
}

} // namespace

TEST_CASE("the bounds by energy are (2) to (4)") {
  const double l = 1.5, c1 = 0.7, c2 = 0.4, J1 = 0.5, J2 = 0.2;
  LatchedWing<> wing(two_in_line(l, c1, c2));
  const double E = 100;
  wing.bounds.bound(wing.system, wing.remaining, {E, E});
  const double M1 = std::sqrt(2 * E * (1e4 + 10 * 10 / J1));
  const double M2 = std::sqrt(2 * E * (6e3 + 20 * 20 * (1 / J1 + 1 / J2)));
  CHECK(wing.bounds.moment[1] == Approx(M1));
  CHECK(wing.bounds.moment[2] == Approx(M2));
  const double w1 = 2 * E / J1, w2 = 2 * E / J2; // bounds of ω²
  const double g1 = w1 * c1, g2 = w1 * l + w2 * c2;
  const double Z = 10 * g1 * g1 + 4 * g2 * g2 + (M1 + M2) * (M1 + M2) / J1 + M2 * M2 / J2;
  CHECK(wing.bounds.force[1] == Approx(std::sqrt(14 * Z)));
  CHECK(wing.bounds.force[2] == Approx(std::sqrt(4 * Z)));
}

TEST_CASE("on a tree the bound by energy of a force has all the masses outward of its hinge") {
  for (int k = 0; k < 12; ++k) {
    oracle::RandomScene options;
    options.bodies = 3 + k % 5, options.motion = BaseMotion::fixed, options.friction = false;
    Scene scene = oracle::random_scene(500 + k, options);
    for (Hinge& hinge : scene.hinges) hinge.spring = {}, hinge.harness = {};
    LatchedWing<> wing(scene);
    wing.bounds.bound(wing.system, wing.remaining, {2, 2});
    const auto outward = [&](int i) {
      double mass = 0;
      for (int body = 1; body <= wing.at.bodies; ++body)
        for (int j = body; j != 0; j = wing.system.topology().parent_of(j))
          if (j == i) mass += wing.wing.bodies[body].mass;
      return mass;
    };
    const double Z = std::pow(wing.bounds.force[1], 2) / outward(1);
    for (int i = 1; i <= wing.at.bodies; ++i) {
      CAPTURE(k, i);
      CHECK(wing.bounds.force[i] == Approx(std::sqrt(outward(i) * Z)));
    }
  }
}

TEST_CASE("on a base that turns and is pushed the bounds by energy know the apparent forces") {
  // three panels in line; of body k: way from the base's origin to its hinge and to its centre
  const double b = 0.3, l[] = {b, 1.5, 1.2}, c[] = {0.7, 0.4, 0.5}, J[] = {0.5, 0.2, 0.3},
               m[] = {10, 4, 3}, k[] = {1e4, 6e3, 2e3}, d[] = {10, 20, 5}, E = 2;
  Scene scene = two_in_line(l[1], c[0], c[1]);
  scene.hinges[0].parent_point = {b, 0};
  scene.bodies.push_back({"last", m[2], J[2]});
  Hinge end = scene.hinges[1];
  end.name = "end", end.parent = 1, end.child = 2, end.latch = Latch{k[2], d[2]};
  end.parent_point = {l[2] - c[1], 0}, end.child_point = {-c[2], 0};
  scene.hinges.push_back(end);
  scene.base.motion = BaseMotion::prescribed;
  for (const auto& [spin, push] : {std::pair{0.0, 3.0}, {0.8, 0.0}, {-0.8, 3.0}, {5.0, 0.1}}) {
    scene.base.rate = spin, scene.base.acceleration = {0.6 * push, 0.8 * push};
    LatchedWing<BaseMotion::prescribed> wing(scene);
    wing.bounds.bound(wing.system, wing.remaining, {E, E});
    double M[3], Z = 0, outward[3] = {}, to_hinge = 0, gamma = 0, speed = 0;
    for (int i = 0; i < 3; ++i)
      M[i] = std::sqrt(2 * E * (k[i] + d[i] * d[i] * (1 / J[i] + (i > 0 ? 1 / J[i - 1] : 0))));
    for (int i = 0; i < 3; ++i) {
      to_hinge += l[i];
      const double w = std::sqrt(2 * E / J[i]), before = i > 0 ? std::sqrt(2 * E / J[i - 1]) : 0;
      gamma += before * before * l[i], speed += before * l[i];
      const double felt = push + spin * spin * (to_hinge + c[i]);
      const double y = gamma + w * w * c[i] + felt + 2 * std::abs(spin) * (speed + w * c[i]);
      Z += m[i] * y * y;
      double lever = c[i];
      for (int inward = i; inward >= 0; lever += l[inward--]) {
        M[inward] += m[i] * lever * felt; // loads at rest
        outward[inward] += m[i];
      }
    }
    for (int i = 0; i < 3; ++i) Z += std::pow(M[i] + (i < 2 ? M[i + 1] : 0), 2) / J[i];
    for (int i = 0; i < 3; ++i) {
      CAPTURE(spin, push, i);
      CHECK(wing.bounds.moment[i + 1] == Approx(M[i]));
      CHECK(wing.bounds.force[i + 1] == Approx(std::sqrt(outward[i] * Z)));
    }
  }
}

TEST_CASE("on a free base the bounds by energy take the closer bound of each body's turning") {
  const double b = 0.3, l = 1.5, c1 = 0.7, c2 = 0.4, J0 = 3, J1 = 0.5, J2 = 0.2;
  Scene scene = two_in_line(l, c1, c2);
  scene.hinges[0].parent_point = {b, 0};
  scene.base.motion = BaseMotion::free, scene.base.mass = 50, scene.base.inertia = J0;
  LatchedWing<BaseMotion::free> wing(scene);
  for (const auto& [whole, within, whirl] :
       {std::tuple{4.0, 4.0, 0.0}, {4.0, 0.01, 0.2}, {4.0, 3.9, 0.2}, {4.0, 1.0, 1.0}}) {
    wing.bounds.bound(wing.system, wing.remaining, {whole, within, whirl});
    const double M1 = std::sqrt(2 * within * (1e4 + 10 * 10 * (1 / J0 + 1 / J1)));
    const double M2 = std::sqrt(2 * within * (6e3 + 20 * 20 * (1 / J1 + 1 / J2)));
    const auto turning = [&, E = whole, e = within, r = whirl](double J) { // of ω²
      return std::min(2 * E / J, std::pow(r + std::sqrt(2 * e / J), 2));
    };
    const double y1 = turning(J0) * b + turning(J1) * c1;
    const double y2 = turning(J0) * b + turning(J1) * l + turning(J2) * c2;
    const double Z =
        10 * y1 * y1 + 4 * y2 * y2 + M1 * M1 / J0 + (M1 + M2) * (M1 + M2) / J1 + M2 * M2 / J2;
    CAPTURE(whole, within, whirl);
    CHECK(wing.bounds.moment[1] == Approx(M1));
    CHECK(wing.bounds.moment[2] == Approx(M2));
    CHECK(wing.bounds.force[1] == Approx(std::sqrt(14 * Z)));
    CHECK(wing.bounds.force[2] == Approx(std::sqrt(4 * Z)));
  }
}

TEST_CASE("the bound on what holds a hinge rigidly is (5), whichever hinge is held") {
  const double l = 1.5, c1 = 0.7, c2 = 0.4, J1 = 0.5, J2 = 0.2, E = 3;
  for (const int held : {1, 2}) {
    Scene scene = two_in_line(l, c1, c2);
    scene.hinges[held - 1].release = Release{.fails = 1};
    LatchedWing<> wing(scene);
    wing.system.set_contact(held, Contact::held);
    wing.remaining.prepare(wing.system), wing.bounds.prepare(wing.system);
    wing.bounds.bound(wing.system, wing.remaining, {E, E});
    const double w1 = held == 1 ? 0 : 2 * E / J1, w2 = 2 * E / J2; // of ω²
    const double M1 = held == 1 ? 0 : std::sqrt(2 * E * (1e4 + 10 * 10 / J1));
    const double M2 = held == 2 ? 0 : std::sqrt(2 * E * (6e3 + 20 * 20 * (1 / J1 + 1 / J2)));
    const double g1 = w1 * c1, g2 = w1 * l + w2 * c2, L1 = M1 + M2;
    const double turns1 = held == 1 ? 0 : L1 * L1 / J1; // a body that stands still takes none
    const double Z = 10 * g1 * g1 + 4 * g2 * g2 + turns1 + M2 * M2 / J2;
    const double levers = held == 1 ? 10 * c1 * c1 + 4 * (l + c2) * (l + c2) : 4 * c2 * c2;
    const double inertias = held == 1 ? J1 + J2 : J2, loads = held == 1 ? L1 + M2 : M2;
    const double most = (std::sqrt(levers) + std::sqrt(inertias)) * std::sqrt(Z) + loads;
    CAPTURE(held);
    CHECK(wing.bounds.moment[held] == Approx(most));
    CHECK(wing.bounds.moment[3 - held] == Approx(M1 + M2));
    CHECK(wing.bounds.force[1] == Approx(std::sqrt(14 * Z)));
    CHECK(wing.bounds.force[2] == Approx(std::sqrt(4 * Z)));
  }
}

TEST_CASE("dampers, motors, loops and dissipating latches add their most to the bounds by energy") {
  const double J1 = 0.5, J2 = 0.2, E = 7, gear = 3, K = 50, D = 4, c = 2;
  Scene scene = two_in_line(1.5, 0.7, 0.4);
  Damper damper;
  damper.coefficient = c, damper.scale = 1.5;
  scene.hinges[0].damper = damper;
  Synchronisation cable;
  cable.name = "loop", cable.first = 0, cable.second = 1, cable.ratio = gear;
  cable.stiffness = K, cable.damping = D;
  scene.synchronisations = {cable};
  const double v1 = std::sqrt(2 * E / J1), v2 = std::sqrt(2 * E * (1 / J1 + 1 / J2)); // (2)
  const double M1 = std::sqrt(2 * E * (1e4 + 10 * 10 / J1)) + 1.5 * c * v1;
  const double M2 = std::sqrt(2 * E * (6e3 + 20 * 20 * (1 / J1 + 1 / J2)));
  const double loop = std::sqrt(2 * K * E) + D * (gear * v1 + v2);
  for (const double limit : {1e9, 3.}) {
    scene.hinges[1].motor = Motor{.rate = 0, .gain = 0.8, .torque_limit = limit};
    LatchedWing<> wing(scene);
    wing.bounds.bound(wing.system, wing.remaining, {E, E});
    CAPTURE(limit);
    CHECK(wing.bounds.moment[1] == Approx(M1 + gear * loop));
    CHECK(wing.bounds.moment[2] == Approx(M2 + loop + std::min(0.8 * v2, limit)));
  }
  scene = two_in_line(1.5, 0.7, 0.4);
  scene.hinges[1].latch = Latch{.stiffness = 6e3, .dissipation = 0.4};
  LatchedWing<> wing(scene);
  wing.bounds.bound(wing.system, wing.remaining, {E, E});
  const double way = std::sqrt(2 * E / 6e3);
  CHECK(wing.bounds.moment[2] == Approx(6e3 * way * (1 + 0.4 * v2)));
}

TEST_CASE("a held hinge rests only if all that it carries does") {
  // the root is held; of the two panels on its body one swings and the other is held, in either order
  for (const bool first_swings : {true, false}) {
    Scene scene = two_in_line(1.5, 0.7, 0.4);
    scene.bodies.push_back({"other", 4, 0.2});
    Hinge other = scene.hinges[1];
    other.name = "other", other.child = 2;
    scene.hinges.push_back(other);
    const int held = first_swings ? 2 : 1;
    scene.hinges[0].release = scene.hinges[held].release = Release{.fails = 1};
    for (const bool all : {false, true}) {
      if (all) scene.hinges[3 - held].release = Release{.fails = 1};
      LatchedWing<> wing(scene);
      for (int i = 1; i <= 3; ++i)
        if (all || wing.wing.hinge_of[i] != 3 - held) wing.system.set_contact(i, Contact::held);
      wing.remaining.prepare(wing.system), wing.bounds.prepare(wing.system);
      wing.bounds.bound(wing.system, wing.remaining, {3., 3.});
      CAPTURE(first_swings, all);
      for (int i = 1; i <= 3; ++i) {
        const bool still = all || wing.wing.hinge_of[i] == held;
        CHECK((wing.bounds.moment[i] == 0) == still);
        CHECK((wing.bounds.force[i] == 0) == still);
      }
    }
  }
}

TEST_CASE(
    "the energy left on a base that is pushed or turns is (2) of remaining_energy.hpp, and none is "
    "known if it does both") {
  const double b = 0.3, l = 1.5, c1 = 0.7, c2 = 0.4;
  for (const auto& [spin, push] : {std::pair{0.0, 3.0}, {0.8, 0.0}, {-0.8, 3.0}, {0.4, 8.0}}) {
    Scene scene = two_in_line(l, c1, c2);
    scene.hinges[0].parent_point = {b, 0};
    scene.base.motion = BaseMotion::prescribed;
    scene.base.rate = spin, scene.base.acceleration = {0.6 * push, 0.8 * push};
    LatchedWing<BaseMotion::prescribed> wing(scene);
    const double f1 = push + spin * spin * (b + c1), f2 = push + spin * spin * (b + l + c2);
    const double g[] = {10 * c1 * f1 + 4 * (l + c2) * f2, 4 * c2 * f2}, kappa[] = {1e4, 6e3};
    double offset = 0;
    for (const int i : {0, 1}) offset += g[i] * g[i] / (2 * kappa[i]);
    const auto left = wing.remaining.energy(wing.system, wing.rest, 2.);
    CAPTURE(spin, push);
    REQUIRE(left.has_value() == (spin == 0 || push == 0));
    if (!left) continue;
    CHECK(left->whole == Approx(offset).epsilon(1e-9));
    CHECK(left->within == left->whole);
    double elastic = 0; // (4)
    for (const int i : {0, 1})
      elastic += g[i] * (g[i] / kappa[i] + std::sqrt(2 * offset / kappa[i]));
    CHECK(left->elastic == Approx(elastic).epsilon(1e-9));
    for (const int i : {1, 2})
      CHECK(wing.remaining.furthest(i, left->within) ==
            Approx(g[i - 1] / kappa[i - 1] + std::sqrt(2 / kappa[i - 1] * offset)));
  }
}

TEST_CASE("of a free base's energy the turning of the largest inertia is left out, by (3)") {
  const double b = 0.3, l = 1.5, c1 = 0.7, c2 = 0.4, J[] = {3, 0.5, 0.2}, m[] = {50, 10, 4};
  Scene scene = two_in_line(l, c1, c2);
  scene.hinges[0].parent_point = {b, 0};
  scene.base.motion = BaseMotion::free, scene.base.mass = m[0], scene.base.inertia = J[0];
  LatchedWing<BaseMotion::free> wing(scene);
  const double d01 = b + c1, d12 = l - c1 + c2, d02 = b + l + c2; // along the bodies
  const double most =
      (m[0] * m[1] * d01 * d01 + m[1] * m[2] * d12 * d12 + m[0] * m[2] * d02 * d02) /
          (m[0] + m[1] + m[2]) +
      J[0] + J[1] + J[2];
  for (const double u : {0.0, 0.02, -0.05}) { // bent by the second hinge
    State<double> x = wing.rest;
    x[wing.at.angle(2)] += u;
    x[BaseExcursion<double>::coordinate + wing.at.freedoms()] = 0.7;
    const TotalMotion<double> now = total_motion(wing.system, x, 0.);
    const auto left = wing.remaining.energy(wing.system, x, 0.);
    REQUIRE(left);
    const double whole = 0.5 * 6e3 * u * u + now.central_kinetic(), H = std::abs(now.spin());
    CAPTURE(u);
    CHECK(left->whole == Approx(whole).epsilon(1e-9));
    CHECK(left->within == Approx(whole - H * H / (2 * most)).epsilon(1e-6).margin(1e-7));
    CHECK(left->whirl == Approx(2 * whole / H).epsilon(1e-9));
  }
}
