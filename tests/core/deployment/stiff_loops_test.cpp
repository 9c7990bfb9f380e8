// Loops whose strands go slack, and loops as stiff as cables are, against the dense formulation.
#include "tests/core/deployment/real_runs.hpp"
#include "tests/support/random_cases.hpp"

#include <algorithm>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

constexpr RealFeatures nothing{false, false, false, false, false, false,
                               false, false, false, false, false};

/// A random wing with loops and nothing else that is real.
Scene looped(std::uint64_t seed, const RealFeatures& features) {
  RandomScene options;
  options.bodies = 2 + static_cast<int>(seed % 3);
  options.mass_lower = 1, options.mass_upper = 20;
  options.motion = static_cast<BaseMotion>(seed % 2 * 2);
  Scene scene = with_real_hinges(random_scene(seed, options), seed, features);
  if (scene.synchronisations.empty()) return looped(seed + 1000, features);
  return scene;
}

/// Times at which a strand of any loop goes slack or taut.
int count_kinks(const Scene& scene, const std::vector<Sample>& samples) {
  int kinks = 0;
  for (const Synchronisation& given : scene.synchronisations) {
    const Loop<double> loop(given);
    const DenseWing<double> wing(scene);
    std::optional<bool> before;
    for (const Sample& sample : samples) {
      const bool slack =
          loop.slack(loop.out_of_step(wing.travel(loop.first, sample.angles[loop.first]),
                                      wing.travel(loop.second, sample.angles[loop.second])));
      kinks += before && *before != slack ? 1 : 0;
      before = slack;
    }
  }
  return kinks;
}

/// The largest errors of all outputs: of times, rates and peaks relative, of angles absolute.
struct Errors {
  double time = 0, rate = 0, moment = 0, force = 0, angle = 0;

  void include(const Outcome& out, const ReferenceOutcome& exact) {
    REQUIRE(out.latches.size() == exact.latches.size());
    const auto raise = [](double& worst, double error) {
      worst = std::max(worst, std::abs(error));
    };
    for (std::size_t k = 0; k < exact.latches.size(); ++k) {
      const int hinge = exact.latches[k].hinge;
      REQUIRE(out.latches[k].hinge == hinge);
      raise(time, relative(out.latches[k].time, exact.latches[k].time));
      raise(rate, relative(out.latches[k].rates[hinge], exact.latches[k].rates[hinge]));
    }
    for (std::size_t i = 0; i < exact.peak_moment.size(); ++i) {
      raise(moment, relative(out.peak_moment[i].value, exact.peak_moment[i].value));
      raise(force, relative(out.peak_force[i].value, exact.peak_force[i].value));
      raise(angle, out.final.angles[i] - exact.final.angles(static_cast<int>(i)));
    }
  }
};

} // namespace

TEST_CASE("a strand that goes slack costs no accuracy: default tolerances against the reference",
          "[long]") {
  RealFeatures features = nothing;
  features.loops = features.preloads = true;
  features.softest = 100, features.stiffest = 3e3;
  Errors slack, taut;
  int kinks = 0;
  const int cases = random_cases(24, 6);
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(cases); ++seed) {
    Scene scene = looped(seed, features);
    for (Synchronisation& loop : scene.synchronisations)
      loop.preload = 0.003 * loop.stiffness, loop.damping *= 0.1;
    Integration how; // default tolerances
    how.t_end = 1.5;
    std::vector<Sample> samples;
    const Outcome out = Deployment().run(scene, how, to_the_end,
                                         [&](const Sample& sample) { samples.push_back(sample); });
    CAPTURE(seed, out.latches.size());
    kinks += count_kinks(scene, samples);
    slack.include(out, real_reference(scene, how.t_end));
    for (Synchronisation& loop : scene.synchronisations) loop.preload.reset();
    taut.include(Deployment().run(scene, how, to_the_end), real_reference(scene, how.t_end));
  }
  CAPTURE(kinks, slack.time, slack.rate, slack.moment, slack.force, slack.angle, taut.time,
          taut.rate, taut.moment, taut.force, taut.angle);
  // 167 kinks: times 6e-10, rates 2.8e-8, peaks 1.3e-7, angles 3.2e-8 rad; taut 1e-12, 3e-10, 9e-9,
  // 1e-9. What README promises holds without an event: step control meets a kink as any other error.
  CHECK(kinks > 4 * cases);
  CHECK(slack.time < 1e-7);
  CHECK(slack.rate < 1e-7);
  CHECK(slack.moment < 1e-6);
  CHECK(slack.force < 1e-6);
  CHECK(slack.angle < 2e-7);
  CHECK(taut.rate < 1e-8);
  CHECK(taut.moment < 1e-7);
}

TEST_CASE("random wings with loops as stiff as cables agree with the dense formulation") {
  RealFeatures features = nothing;
  features.loops = features.preloads = features.tables = true;
  features.softest = 1e3, features.stiffest = 1e6;
  double worst[] = {0, 0};
  const auto cases = static_cast<std::uint64_t>(random_cases(150, 30));
  for (std::uint64_t seed = 1; seed <= cases; ++seed) {
    const Scene scene = looped(seed, features);
    ReferenceOptions options;
    options.t_end = 0.15;
    options.rtol = 1e-11, options.atol = 1e-13;
    const ReferenceOutcome exact = cvode_run(scene, options);
    for (const char* method : {"auto", "seulex"}) {
      Integration how; // default tolerances
      how.method = method, how.t_end = options.t_end;
      const Outcome out = Deployment().run(scene, how, to_the_end);
      CAPTURE(seed, method, out.work.steps, out.reason);
      REQUIRE(out.status != Status::failed);
      REQUIRE(out.latches.size() == exact.latches.size());
      for (std::size_t i = 0; i < scene.hinges.size(); ++i) {
        const double off = std::abs(out.final.angles[i] - exact.final.angles(static_cast<int>(i)));
        double& largest = worst[how.method == "auto" ? 0 : 1];
        largest = std::max(largest, off);
        CHECK(off < 1e-6);
      }
    }
  }
  CAPTURE(worst[0], worst[1]);
  CHECK(std::max(worst[0], worst[1]) > 1e-12); // the comparison saw a difference
}
