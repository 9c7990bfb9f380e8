/// Bounds of the moments that the linear model of a latched wing leaves out: rest_model.hpp.
#include "core/proofs/rest_model.hpp"

#include <algorithm>
#include <cmath>

namespace wingspread {

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
