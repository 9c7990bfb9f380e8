#include "montecarlo/model/input_checks/finality_check.hpp"

#include <algorithm>

namespace wingspread {
namespace {

bool feels_air(const Scene& scene) {
  return scene.environment.air_density > 0 &&
         std::ranges::any_of(scene.bodies, [](const Body& body) { return body.plate.has_value(); });
}

bool stands_still(const Base& base) {
  return base.motion == BaseMotion::fixed ||
         (base.motion == BaseMotion::prescribed && !base.table && base.acceleration.isZero(0) &&
          base.angular_acceleration == 0 && base.rate == 0);
}

/// Whether the hinge swings in its latch's backlash until exact friction holds it, and has none.
bool rattles_on(const Hinge& hinge) {
  return hinge.latch && hinge.latch->backlash > 0 &&
         (hinge.friction.model != FrictionModel::exact || hinge.friction.coulomb == 0);
}

} // namespace

std::string_view why_never_final(const Scene& scene) {
  if (scene.base.motion == BaseMotion::prescribed && scene.base.angular_acceleration != 0)
    return "with a base that turns faster and faster";
  if (feels_air(scene) && !stands_still(scene.base)) return "in air, with a base that moves";
  if (std::ranges::any_of(scene.hinges, rattles_on))
    return "with backlash in a latch whose hinge has no exact friction";
  return "";
}

} // namespace wingspread
