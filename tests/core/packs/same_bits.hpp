/// Compares runs in lanes with the same runs alone, bit for bit.
#pragma once

#include "core/deployment.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace wingspread::oracle {

/// The goals of these runs: every peak, or latches only.
inline const Goal every_peak{.audit = false};
inline const Goal latches_alone{.peak_moment = false, .peak_force = false, .audit = false};

/// The compared parts of an outcome as bytes: two strings are equal if and only if all bits are.
inline std::string bits_of(const Outcome& outcome) {
  std::string all = std::string(to_string(outcome.status)) + outcome.reason;
  const auto add = [&](double x) {
    std::array<char, sizeof x> bytes{};
    std::memcpy(bytes.data(), &x, sizeof x);
    all.append(bytes.data(), bytes.size());
  };
  for (const LatchEvent& latch : outcome.latches) {
    add(latch.hinge), add(latch.time);
    for (const double rate : latch.rates) add(rate);
  }
  for (const auto* events : {&outcome.missed, &outcome.let_go, &outcome.releases})
    for (const HingeEvent& event : *events) add(event.hinge), add(event.time), add(event.rate);
  for (const double angle : outcome.final_angle) add(angle);
  for (const double energy : outcome.motor_energy) add(energy);
  for (const auto* peaks :
       {&outcome.peak_moment, &outcome.peak_force, &outcome.hold_moment, &outcome.bending_moment})
    for (const Peak& peak : *peaks) add(peak.value), add(peak.time);
  for (const double frequency : outcome.mode_frequencies) add(frequency);
  for (const int hinge : outcome.never_released) add(hinge);
  if (outcome.base_peaks) add(outcome.base_peaks->angle), add(outcome.base_peaks->rate);
  for (const double beyond : outcome.overtravel) add(beyond);
  for (const Phase& phase : outcome.phases) all += phase.method, add(phase.from), add(phase.to);
  for (const auto* v : {&outcome.final.angles, &outcome.final.rates})
    for (const double x : *v) add(x);
  add(outcome.final.base_angle), add(outcome.final.base_rate);
  for (const auto* v : {&outcome.final.base_position, &outcome.final.base_velocity})
    for (const double x : *v) add(x);
  add(outcome.t_end), add(outcome.peaks_final ? 1 : 0);
  add(outcome.moments_final ? 1 : 0), add(outcome.forces_final ? 1 : 0);
  add(outcome.latches_final ? 1 : 0);
  add(outcome.energy.initial), add(outcome.energy.final);
  add(outcome.energy.drift_before_first_latch);
  add(static_cast<double>(outcome.work.steps)), add(static_cast<double>(outcome.work.rejected));
  add(static_cast<double>(outcome.work.rhs_evaluations));
  return all;
}

/// Runs the scenes in lanes. Hands `take` the index of each scene and its outcome.
template <class Take>
Occupancy run_in_lanes(InstructionSet set, const std::vector<Scene>& scenes, const Integration& how,
                       const Goal& goal, const Take& take) {
  long next = 0;
  const auto give = [&](Scene& scene) -> std::optional<long> {
    if (next == std::ssize(scenes)) return std::nullopt;
    scene = scenes[next];
    return next++;
  };
  DeploymentPack pack(set, how, goal);
  return pack.run(scenes.front(), give, take);
}

/// Runs the scenes in lanes. Returns the bits of each outcome by the scene's index.
inline std::map<long, std::string> in_lanes(InstructionSet set, const std::vector<Scene>& scenes,
                                            const Integration& how, const Goal& goal) {
  std::map<long, std::string> outcomes;
  run_in_lanes(set, scenes, how, goal, [&](long name, Outcome&& outcome) {
    REQUIRE(outcomes.emplace(name, bits_of(outcome)).second);
  });
  return outcomes;
}

/// Checks that every run in the lanes of every instruction set equals the run alone.
inline void require_equal_bits(const std::vector<Scene>& scenes, const Integration& how,
                               const Goal& goal) {
  std::map<long, std::string> alone;
  Deployment deployment;
  for (std::size_t k = 0; k < scenes.size(); ++k)
    alone[static_cast<long>(k)] = bits_of(deployment.run(scenes[k], how, goal));
  for (const InstructionSet set : instruction_sets()) {
    CAPTURE(to_string(set));
    REQUIRE((in_lanes(set, scenes, how, goal) == alone));
  }
}

} // namespace wingspread::oracle
