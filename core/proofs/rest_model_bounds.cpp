/// Bounds of the moments that the linear model of a latched wing leaves out: rest_model.hpp.
#include "core/proofs/rest_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wingspread {

namespace {

/// By how much the slope of a curve may differ from that at an angle.
double bend_of(const Curve* curve, double weight, double angle) {
  return curve ? std::abs(weight) * most_change_of_slope(*curve, slope(*curve, angle)) : 0;
}

} // namespace

void detail::find_remainders(const Wing<double>& wing, RestModel& model) {
  model.room.setConstant(std::numeric_limits<double>::infinity());
  for (int i = 1; i <= model.size(); ++i) {
    RestModel::Remainder& left = model.remainders[i - 1];
    left.steady += wing.hinges[i].most_friction();
    if (wing.hinges[i].has_latch) // beyond the stowed angle overtravel may rise
      model.room(i - 1) = std::abs(model.angles(i - 1) - wing.hinges[i].stowed);
    if (wing.real.empty()) continue;
    const RealHingeTerms<double>& real = wing.real[i];
    const double phi = model.angles(i - 1);
    left.bend = bend_of(real.spring.curve, real.spring.weight, phi) +
                bend_of(real.harness.curve, real.harness.weight, phi);
    double& room = model.room(i - 1);
    for (const StopTerms<double>* stop : {&real.stop, &real.far_stop})
      if (stop->present) room = std::min(room, stop->sense * (phi - stop->contact_angle));
    if (real.has_damper && real.has_window)
      for (const double edge : {real.window_low, real.window_high})
        room = std::min(room, std::abs(phi - edge));
  }
}

bool RestModel::is_tuned_for(const HingeVector& rates) const {
  for (int i = 0; i < size(); ++i) {
    const double tuned = remainders[i].tuned_for;
    if (tuned == 0) continue;
    const double rate = std::max(rates(i), remainders[i].damper->rate);
    if (rate > 1.5 * tuned || rate < 0.3 * tuned) return false;
  }
  return true;
}

RestModel::Turned RestModel::bound_turns(const HingeVector& u, const BodyVector& accelerations,
                                         const BodyVector& rates,
                                         const EnergyOfTurns* energy) const {
  const int n = size();
  Turned off{BodyVector::Zero(n + 1), BodyVector::Zero(n + 1)};
  for (int k = 1; k <= n; ++k) {
    off.ways(k) = u(k - 1) + off.ways(parents[k - 1]);
    off.moments(k) =
        pushed(k) * (energy ? std::min(off.ways(k), energy->turn(k, 0, 0)) : off.ways(k));
  }
  for (const Pair& pair : pairs) {
    const int k = pair.first, l = pair.second;
    double way = off.ways(k) + off.ways(l) - 2 * off.ways(pair.meet);
    if (energy) way = std::min(way, energy->turn(k, l, pair.meet));
    const double inertia = way * std::fma(0.5 * pair.cosine, way, pair.sine);
    const double turning = std::fma(pair.cosine, way, pair.sine);
    off.moments(k) += inertia * accelerations(l) + turning * rates(l) * rates(l);
    off.moments(l) += inertia * accelerations(k) + turning * rates(k) * rates(k);
    off.momentum += inertia * (rates(k) + rates(l));
  }
  return off;
}

HingeVector RestModel::bound_remainders(const HingeVector& u, const HingeVector& v) const {
  HingeVector f(size());
  for (int i = 0; i < size(); ++i) {
    const Remainder& left = remainders[i];
    f(i) = left.steady + (left.bend + left.dissipation * v(i)) * u(i);
    if (left.damper) f(i) += beyond_linear(*left.damper, left.taken, v(i));
    f(i) += left.motor.beyond(v(i));
  }
  for (const Loop& loop : loops) {
    const double e = loop.gear * u(loop.first) + u(loop.second);
    const double e_rate = loop.gear * v(loop.first) + v(loop.second);
    const double elastic = loop.stiffness * e, viscous = loop.damping * e_rate;
    double rest =
        loop.gear_changes * (loop.stiffness * u(loop.first) + loop.damping * v(loop.first));
    if (elastic > loop.until_slack) // one strand then carries half of it
      rest += 0.5 * (elastic - std::max(loop.until_slack, 0.0) + viscous);
    f(loop.first) += loop.gear * rest + loop.gear_changes * (loop.torque + elastic + viscous);
    f(loop.second) += rest;
  }
  return f;
}

} // namespace wingspread
