#include "core/scene/torque.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace wingspread {
namespace {

double angle_at(const Hinge& hinge, double travel) {
  return std::lerp(hinge.stowed, hinge.latched, travel); // exact at the ends
}

} // namespace

double value_at(const Curve& curve, double x) {
  const std::vector<double>& knots = curve.knots();
  const auto behind = std::ranges::upper_bound(knots, x) - knots.begin(); // knots at or before x
  const Curve::Piece& piece = curve.pieces()[static_cast<std::size_t>(behind)];
  const double u = x - (behind == 0 ? knots.front() : piece.from);
  return piece.c[0] + u * (piece.c[1] + u * (piece.c[2] + u * piece.c[3]));
}

double torque_at(const HingeTorque& torque, const Hinge& hinge, double travel) {
  const double law = torque.table ? value_at(torque.table->drive(), angle_at(hinge, travel))
                                  : std::lerp(torque.torque_stowed, torque.torque_latched, travel);
  return torque.scale * law + torque.offset;
}

double measured_friction_at(const Hinge& hinge, double travel) {
  const TorqueTable* table = hinge.spring.table.get();
  if (!table || !table->both_ways()) return 0;
  return hinge.friction.scale * std::max(value_at(table->friction(), angle_at(hinge, travel)), 0.0);
}

double static_level_at(const Hinge& hinge, double travel) {
  const Friction& friction = hinge.friction;
  const bool exact = friction.model == FrictionModel::exact;
  const double level = exact ? friction.static_level.value_or(friction.coulomb) : friction.coulomb;
  return friction.scale * level + measured_friction_at(hinge, travel);
}

} // namespace wingspread
