// Elastic joints and flexible bodies in whole runs: closed forms, and random wings against the dense formulation.
#include "tests/core/deployment/real_runs.hpp"
#include "tests/support/bending_scenes.hpp"
#include "tests/support/random_cases.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

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

TEST_CASE("a turning rod clamped at once loads its root as the modes of a cantilever say") {
  // 4/(β_n L)² sin ω_n t, ω_0 L √(EI m/L) = 1e-3 N·m; within the first period of the first mode
  const double rate = 1e-3, period = 2 * pi / std::pow(cantilever_roots[0], 2);
  double most = 0, least = 0;
  for (int step = 0; step <= 20000;
       ++step) { // 16 joints have no more than 16 modes: five are said to be enough
    double sum = 0;
    const double betas[] = {cantilever_roots[0], cantilever_roots[1], cantilever_roots[2], 3.5 * pi,
                            4.5 * pi};
    for (const double beta : betas)
      sum += 4 / (beta * beta) * std::sin(beta * beta * period * step / 20000);
    most = std::max(most, sum), least = std::min(least, sum);
  }
  CHECK(most == Approx(1.2896).epsilon(1e-3));
  CHECK(least == Approx(-1.3256).epsilon(1e-3));
  double before = 1;
  for (const int joints : {8, 16, 32}) {
    Integration how = within(1e-8, 1e-9 / rate + period);
    how.atol = 1e-13;
    Goal goal = to_the_end;
    goal.sample_interval = 1e-3;
    double highest = 0, lowest = 0;
    const Outcome out =
        Deployment().run(bending_rod(joints, 1e5, rate), how, goal, [&](const Sample& sample) {
          highest = std::max(highest, sample.moments[0] / rate);
          lowest = std::min(lowest, sample.moments[0] / rate);
        });
    REQUIRE(out.latches.size() == 1);
    CAPTURE(joints, highest, lowest);
    // 40 modes: 1.2869 and 1.3537, the signs turned: the latch pulls back
    const double error = std::max(std::abs(-lowest - 1.2869), std::abs(highest - 1.3537));
    CHECK(error < 0.08);
    CHECK(error < 1.2 * before);
    before = error;
  }
}

TEST_CASE("random wings with joints and flexible bodies agree with the reference") {
  const auto cases = static_cast<std::uint64_t>(random_cases(200, 6));
  std::size_t latches = 0, bent = 0;
  for (std::uint64_t seed = 1; seed <= cases; ++seed) {
    RandomScene options;
    options.bodies = 1 + static_cast<int>(seed % 4);
    options.mass_lower = 1, options.mass_upper = 20;
    options.motion = static_cast<BaseMotion>(seed % 3);
    const Scene scene = with_bending(random_scene(seed, options), seed);
    CAPTURE(seed, options.bodies, seed % 3);
    const Outcome out = run_everywhere(scene, 1e-11, 1.5, true);
    const Segmented made = in_segments(scene);
    ReferenceOutcome exact = real_reference(made.scene, 1.5);
    const std::vector<ReferencePeak> moments = exact.peak_moment;
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
      double most = 0;
      for (const int joint : made.joints[b]) most = std::max(most, moments[joint].value);
      if (made.joints[b].empty()) continue;
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
