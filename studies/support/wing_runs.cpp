#include "studies/support/wing_runs.hpp"

#include <algorithm>
#include <ctime>
#include <optional>
#include <random>

namespace wingspread::study {
namespace {

double seconds_of(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

} // namespace

double thread_seconds() { return seconds_of(CLOCK_THREAD_CPUTIME_ID); }
double wall_seconds() { return seconds_of(CLOCK_MONOTONIC); }

void Units::set(Scene& scene, long k) const {
  std::minstd_rand engine(static_cast<unsigned>(k + 1));
  std::uniform_real_distribution<double> one(-1, 1);
  (void)one(engine);
  for (std::size_t i = 0; i < scene.hinges.size(); ++i) {
    const double share = 1 + 0.05 * one(engine);
    scene.hinges[i].spring.torque_stowed = share * drawing_.hinges[i].spring.torque_stowed;
    scene.hinges[i].spring.torque_latched = share * drawing_.hinges[i].spring.torque_latched;
  }
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const double share = 1 + 0.02 * one(engine);
    scene.bodies[i].mass = share * drawing_.bodies[i].mass;
    scene.bodies[i].inertia = share * drawing_.bodies[i].inertia;
  }
}

Integration within(double rtol, const What& what) {
  Integration how;
  how.rtol = rtol, how.atol = 1e-2 * rtol, how.t_end = what.t_end;
  return how;
}

Made make(const Scene& drawing, const SetScene& set_scene, InstructionSet set,
          const Integration& how, const Goal& goal, long count, int times) {
  Made made;
  made.us = 1e30;
  for (int time = 0; time < times; ++time) {
    const bool last = time + 1 == times;
    if (last) made.outcomes.assign(static_cast<std::size_t>(count), {});
    long next = 0;
    DeploymentPack pack(set, how, goal);
    const double start = thread_seconds();
    made.lanes = pack.run(
        drawing,
        [&](Scene& scene) -> std::optional<long> {
          if (next == count) return std::nullopt;
          set_scene(scene, next);
          return next++;
        },
        [&](long k, Outcome&& out) {
          if (last) made.outcomes[static_cast<std::size_t>(k)] = std::move(out);
        });
    made.us = std::min(made.us, 1e6 * (thread_seconds() - start) / static_cast<double>(count));
  }
  for (const Outcome& out : made.outcomes) {
    made.steps += static_cast<double>(out.work.steps) / static_cast<double>(count);
    made.evaluations += static_cast<double>(out.work.rhs_evaluations) / static_cast<double>(count);
  }
  return made;
}

Made make(const Units& units, InstructionSet set, const Integration& how, const Goal& goal,
          long count, int times) {
  return make(
      units.drawing(), [&](Scene& scene, long k) { units.set(scene, k); }, set, how, goal, count,
      times);
}

} // namespace wingspread::study
