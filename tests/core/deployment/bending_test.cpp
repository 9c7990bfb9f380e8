// Elastic joints and flexible bodies in whole runs: closed forms, and random wings against the dense formulation.
#include "core/scene/segments.hpp"
#include "tests/core/deployment/real_runs.hpp"
#include "tests/support/bending_scenes.hpp"
#include "tests/support/random_cases.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

using namespace wingspread;
using namespace wingspread::oracle;
using std::numbers::pi;

namespace {

/// A disc on an elastic joint at 0.3 rad, thrown at a rate.
Scene thrown_disc(double stiffness, double damping, double rate) {
  Scene scene;
  scene.bodies = {{"disc", 1, 2}};
  Hinge hinge;
  hinge.name = "joint";
  hinge.stowed = hinge.latched = 0.3, hinge.initial_rate = rate;
  hinge.joint = Joint{stiffness, damping};
  scene.hinges = {hinge};
  return scene;
}

/// Whether a hinge is within half an element of an end of body b.
bool is_at_end(const Scene& scene, std::size_t b, const Hinge& hinge) {
  const int body = static_cast<int>(b);
  if (hinge.parent != body && hinge.child != body) return false;
  const Plate& plate = *scene.bodies[b].plate;
  const Eigen::Vector2d way = plate.to - plate.from;
  const Eigen::Vector2d& point = hinge.parent == body ? hinge.parent_point : hinge.child_point;
  const double place = point.dot(way) / way.squaredNorm() + 0.5;
  const double half = 0.5 / scene.bodies[b].flexible->joints;
  return place < half || place >= 1 - half;
}

} // namespace

TEST_CASE("a disc on an elastic joint is a damped oscillator from the start") {
  const double k = 50, d = 1.2, rate = 0.7, J = 2, decay = d / (2 * J);
  const double omega = std::sqrt(k / J - decay * decay);
  const int judged = with_every_method(
      thrown_disc(k, d, rate), within(1e-9, 3), to_the_end, MayGiveUp::fixed_step,
      [&](const Outcome& out) {
        const double e = std::exp(-decay * 3), s = std::sin(omega * 3), c = std::cos(omega * 3);
        CHECK(std::abs(out.final.angles[0] - 0.3 - rate / omega * e * s) < 1e-7);
        CHECK(std::abs(out.final.rates[0] - rate * e * (c - decay / omega * s)) < 1e-6);
        CHECK(out.latches.empty());
        CHECK(out.status == Status::timed_out);
        CHECK(out.overtravel[0] == 0);
      });
  CHECK(judged > 0);
}

TEST_CASE("the moment of an elastic joint peaks where the oscillator's does") {
  const Outcome out = run(thrown_disc(50, 0, 0.7), 1e-10, 3);
  CHECK(out.peak_moment[0].value == Approx(0.7 * std::sqrt(50 * 2.0)).epsilon(1e-9));
  CHECK(out.peak_moment[0].time == Approx(pi / 2 / std::sqrt(50 / 2.0)).epsilon(1e-4));
}

TEST_CASE("a wing that deploys on an elastic root counts its latches alone") {
  Scene scene = seed_scene();
  Hinge root;
  root.name = "bracket", root.child = 3;
  root.joint = Joint{5e4, 50};
  scene.bodies.push_back({"bracket", 2, 0.01});
  scene.hinges.push_back(root);
  scene.hinges[0].parent = 3;
  const Outcome out = run_everywhere(scene, 1e-9, 60);
  CHECK(out.status == Status::deployed);
  CHECK(out.latches.size() == 3);
  CHECK(out.peaks_final);
}

TEST_CASE("a wing that bends ends where no peak can rise, and none does") {
  Scene scene = seed_scene();
  for (Body& body : scene.bodies) {
    body.inertia = 1, body.plate = Plate{{-0.505, 0}, {0.505, 0}};
    body.flexible = Flexible{2, std::nullopt, 15.0, 0.02};
  }
  const Outcome out = Deployment().run(scene, within(1e-7, 40), {});
  REQUIRE(out.peaks_final);
  CHECK(out.t_end < 20);
  const Outcome whole = Deployment().run(scene, within(1e-7, 40), to_the_end);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(whole.peak_moment[i].value == out.peak_moment[i].value);
    CHECK(whole.bending_moment[i].value == out.bending_moment[i].value);
    CHECK(out.bending_moment[i].value > 1);
  }
}

TEST_CASE("a turning rod clamped at once loads its root as the modes of a cantilever say") {
  // Σ 4/β² sin ω_n t over 40 modes within the first period of the first, in units of ω_0 L √(EI m/L)
  constexpr double highest = 1.2869, lowest = -1.3537;
  const double rate = 1e-3, period = 2 * pi / std::pow(cantilever_roots[0], 2);
  for (const auto& [joints, inward] : {std::pair(8, false), {8, true}, {16, false}}) {
    // A latch as stiff as half an element and more, and damped so that the first segment alone does not ring on it.
    const double stiffness = 80.0 * joints, half = 0.5 / joints;
    Scene scene = bending_rod(joints, stiffness, rate);
    scene.hinges[0].latch->damping = 2 * std::sqrt(stiffness * std::pow(half, 3) / 3);
    Plate& plate = *scene.bodies[0].plate;
    if (inward) std::swap(plate.from, plate.to); // the root is at the last segment
    Integration how = within(1e-8, 1e-9 / rate + period);
    how.atol = 1e-13;
    Goal goal = to_the_end;
    goal.sample_interval = 1e-3;
    double most = 0, least = 0;
    const Outcome out = Deployment().run(scene, how, goal, [&](const Sample& sample) {
      most = std::max(most, -sample.moments[0] / rate); // the latch pulls back
      least = std::min(least, -sample.moments[0] / rate);
    });
    REQUIRE(out.latches.size() == 1);
    CAPTURE(joints, inward);
    CHECK(most == Approx(highest).margin(0.015));
    CHECK(least == Approx(lowest).margin(0.015));
    // at the clamped end; the first joint, half an element further out, bears 10 % less at eight joints
    CHECK(out.bending_moment[0].value / rate == Approx(-lowest).margin(0.015));
  }
}

TEST_CASE(
    "a beam that is spun up lags by less than its chord, and comes back stiffened [Kane 1987]") {
  // The base turns by Ω_s (t − T/2π sin 2πt/T)/T up to T, then at Ω_s. Kane's beam: EI = 1.4e4, m/L = 1.2 kg/m, L = 10 m,
  // Ω_s = 6 rad/s, T = 15 s; its tip lags by about 0.57 m at half time, and swings about 0 afterwards.
  constexpr double L = 10, T = 15, spin = 6;
  std::vector<double> time, turning;
  for (int k = 0; k <= 60; ++k) {
    time.push_back(T * k / 60);
    turning.push_back(spin / T * (1 - std::cos(2 * pi * k / 60)));
  }
  const auto tip = [&](int joints, double t) {
    Scene scene;
    Body beam{"beam", 12, 12 * L * L / 12};
    beam.plate = Plate{{-L / 2, 0}, {L / 2, 0}};
    beam.flexible = Flexible{joints, 1.4e4};
    scene.bodies = {beam};
    Hinge root;
    root.name = "root", root.child_point = {-L / 2, 0}, root.joint = Joint{1e8, 0};
    scene.hinges = {root};
    scene.base.motion = BaseMotion::prescribed;
    BaseTable::Columns columns;
    columns.time = time, columns.angular_acceleration = turning;
    scene.base.table = std::make_shared<const BaseTable>(columns, Interpolation::monotone);
    const SegmentedScene made = with_segments(scene);
    Integration how = within(1e-7, t);
    const Outcome out = Deployment().run(made.scene, how, to_the_end);
    REQUIRE(out.status == Status::timed_out);
    double angle = 0, lag = 0; // the tip's way off the line of the undeformed beam, its frame
    for (std::size_t h = 0; h < made.scene.hinges.size(); ++h) {
      angle += out.final.angles[h];
      const double length =
          h == 0 || h + 1 == made.scene.hinges.size() ? 0.5 * L / joints : L / joints;
      lag += length * std::sin(angle);
    }
    return lag;
  };
  const double coarse = tip(4, 7.5), fine = tip(8, 7.5);
  CAPTURE(coarse, fine);
  CHECK(fine < -0.4);
  CHECK(fine > -0.7);
  CHECK(std::abs(coarse - fine) < 0.03);
  CHECK(std::abs(tip(4, 16)) < 0.02);
}

TEST_CASE("random wings with joints and flexible bodies agree with the reference", "[long]") {
  const auto cases = static_cast<std::uint64_t>(random_cases(200, 3));
  std::size_t latches = 0, bent = 0;
  for (std::uint64_t seed = 1; seed <= cases; ++seed) {
    RandomScene options;
    options.bodies = 1 + static_cast<int>(seed % 4);
    options.mass_lower = 1, options.mass_upper = 20;
    options.motion = static_cast<BaseMotion>(seed % 3);
    const Scene scene = with_bending(random_scene(seed, options), seed);
    CAPTURE(seed, options.bodies, seed % 3);
    const Outcome out = run_everywhere(scene, 1e-11, 2, true);
    const Segmented made = in_segments(scene);
    ReferenceOutcome exact = real_reference(made.scene, 2);
    const std::vector<ReferencePeak> moments = exact.peak_moment;
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
      double most = 0;
      for (const int joint : made.joints[b]) most = std::max(most, moments[joint].value);
      if (made.joints[b].empty()) continue;
      for (std::size_t i = 0; i < scene.hinges.size(); ++i)
        if (is_at_end(scene, b, scene.hinges[i])) most = std::max(most, moments[i].value);
      ++bent;
      CHECK(out.bending_moment[b].value == Approx(most).epsilon(1e-6));
    }
    compare(out, exact, 1e-8, 1e-6);
    for (std::size_t i = 0; i < scene.hinges.size(); ++i)
      CHECK(std::abs(out.final.angles[i] - exact.final.angles(static_cast<Eigen::Index>(i))) <
            1e-7);
    latches += out.latches.size();
  }
  CHECK(latches > 0);
  CHECK(bent >= cases / 2);
}

TEST_CASE("every output of a flexible wing has one entry for each of its hinges or bodies, none "
          "for joints") {
  Scene scene = bending_rod(3, 100, 0.5);
  scene.hinges[0].motor = Motor{.rate = 0.2, .gain = 5, .torque_limit = 3};
  scene.hinges[0].release = Release{.time = 0.1}, scene.hinges[0].initial_rate = 0;
  REQUIRE(with_segments(scene).scene.hinges.size() == 4);
  const Outcome out = run(scene, 1e-8, 1);
  REQUIRE(out.status != Status::failed);
  for (const auto* values :
       {&out.final_angle, &out.motor_energy, &out.overtravel, &out.final.angles, &out.final.rates})
    CHECK(values->size() == 1);
  for (const auto* peaks :
       {&out.peak_moment, &out.peak_force, &out.hold_moment, &out.bending_moment})
    CHECK(peaks->size() == 1);
  for (const LatchEvent& latch : out.latches) CHECK(latch.rates.size() == 1);
}

TEST_CASE("a sample of a flexible wing has one entry for each of its hinges, alone and in a lane") {
  const Scene scene = bending_rod(3, 100, 0.5);
  REQUIRE(with_segments(scene).scene.hinges.size() == 4);
  long samples = 0;
  const auto check = [&samples](const Sample& sample) {
    ++samples;
    for (const auto* values : {&sample.angles, &sample.rates, &sample.moments})
      CHECK(values->size() == 1);
  };
  const Integration how = within(1e-6, 1);
  REQUIRE(Deployment().run(scene, how, every_peak, check).status != Status::failed);
  const long alone = samples;
  CHECK(alone > 2);
  for (const InstructionSet set : instruction_sets()) {
    bool given = false;
    DeploymentPack(set, how, every_peak)
        .run(
            scene,
            [&](Scene& drawn) -> std::optional<long> {
              if (std::exchange(given, true)) return std::nullopt;
              drawn = scene;
              return 0;
            },
            [](long, Outcome&&) {}, [&](long, const Sample& sample) { check(sample); });
    samples -= alone;
    CHECK(samples == alone); // the same steps
  }
}
