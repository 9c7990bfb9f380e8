/// States, samples and peaks of a run in the order of the scene's hinges.
#pragma once

#include "core/mechanics/energy.hpp"
#include "core/outcome.hpp"
#include "core/peaks/peak.hpp"

#include <array>
#include <cstdio>
#include <string>

namespace wingspread {

/// A number with four significant digits, for messages.
[[nodiscard]] inline std::string in_words(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4g", value);
  return text.data();
}

template <class T, class Topology, BaseMotion M>
[[nodiscard]] double total_energy(System<T, Topology, M>& system, const State<T>& x, const T& t) {
  return static_cast<double>(T(kinetic_energy(system, x, t) + potential_energy(system, x, t)));
}

/// Fills a sample of the trajectory, whose storage is used again.
/// @param motion_only Goal::sample_motion_only
/// @pre unless motion_only, the last evaluation was at (x, t), if any hinge sticks
template <class T, class Topology, BaseMotion M>
void fill_sample(Sample& sample, System<T, Topology, M>& system, const State<T>& x, const T& t,
                 bool motion_only) {
  const Layout& at = system.layout();
  sample.t = static_cast<double>(t);
  if (!motion_only || M != BaseMotion::fixed) system.place_all(x, t);
  sample.angles.resize(at.bodies), sample.rates.resize(at.bodies), sample.moments.resize(at.bodies);
  for (int i = 1; i <= at.bodies; ++i) {
    const int hinge = system.wing().hinge_of[i];
    sample.angles[hinge] = static_cast<double>(x[at.angle(i)]);
    sample.rates[hinge] = static_cast<double>(x[at.rate(i)]);
    if (!motion_only) sample.moments[hinge] = static_cast<double>(system.moment(x, i));
  }
  sample.base_angle = static_cast<double>(system.work().frames[0].angle);
  sample.base_rate = static_cast<double>(system.work().frames[0].rate);
  if constexpr (M == BaseMotion::free)
    sample.base_position = {static_cast<double>(x[0]), static_cast<double>(x[1])};
  if (motion_only) return;
  sample.kinetic = static_cast<double>(kinetic_energy(system, x, t));
  sample.potential = static_cast<double>(potential_energy(system, x, t));
}

template <class T, class Topology, BaseMotion M>
[[nodiscard]] Configuration configuration_at(System<T, Topology, M>& system, const State<T>& x,
                                             const T& t) {
  const Layout& at = system.layout();
  Configuration c;
  c.angles.resize(at.bodies), c.rates.resize(at.bodies);
  for (int i = 1; i <= at.bodies; ++i) {
    c.angles[system.wing().hinge_of[i]] = static_cast<double>(x[at.angle(i)]);
    c.rates[system.wing().hinge_of[i]] = static_cast<double>(x[at.rate(i)]);
  }
  system.place_all(x, t);
  c.base_angle = static_cast<double>(system.work().frames[0].angle);
  c.base_rate = static_cast<double>(system.work().frames[0].rate);
  if constexpr (M == BaseMotion::free) {
    const int v = at.freedoms();
    c.base_position = {static_cast<double>(x[0]), static_cast<double>(x[1])};
    c.base_velocity = {static_cast<double>(x[v]), static_cast<double>(x[v + 1])};
  }
  return c;
}

template <class T>
[[nodiscard]] std::vector<Peak> in_scene_order(const Wing<T>& wing,
                                               const std::vector<PeakOf<T>>& peaks) {
  std::vector<Peak> out(wing.size());
  for (int i = 1; i <= wing.size(); ++i)
    out[wing.hinge_of[i]] = {static_cast<double>(peaks[i].value),
                             static_cast<double>(peaks[i].time)};
  return out;
}

} // namespace wingspread
