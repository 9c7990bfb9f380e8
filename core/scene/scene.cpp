#include "core/scene/scene.hpp"

#include "core/scene/segments.hpp"

#include <cmath>
#include <sstream>
#include <string_view>

namespace wingspread {
namespace {

/// The object whose fields are checked, e.g. "hinges.root" or "base".
struct Owner {
  const char* kind;
  std::string_view name; ///< may be empty
};

/// Collects faults; formats names and values only when it finds one.
class Inspector {
public:
  [[gnu::always_inline]] void require(bool holds, double value, const Owner& owner,
                                      const char* field, const char* expected) {
    if (!(holds && std::isfinite(value))) report(value, owner, field, expected);
  }
  std::vector<Fault> faults;

private:
  [[gnu::noinline]] void report(double value, const Owner& owner, const char* field,
                                const char* expected) {
    std::ostringstream found;
    found.precision(17);
    found << value;
    faults.push_back(
        {owner.kind + (owner.name.empty() ? "" : "." + std::string(owner.name)) + "." + field,
         found.str(), std::isfinite(value) ? expected : "a finite number"});
  }
};

void inspect(const Base& base, Inspector& check) {
  const Owner owner{"base", ""};
  if (base.motion == BaseMotion::fixed) return;
  check.require(true, base.angle, owner, "angle", "");
  check.require(true, base.rate, owner, "rate", "");
  if (base.motion == BaseMotion::prescribed) {
    check.require(true, base.acceleration.x(), owner, "acceleration.0", "");
    check.require(true, base.acceleration.y(), owner, "acceleration.1", "");
    check.require(true, base.angular_acceleration, owner, "angular_acceleration", "");
    check.require(true, base.table_scale, owner, "table.scale", "");
    return;
  }
  check.require(base.mass > 0, base.mass, owner, "mass", "> 0");
  check.require(base.inertia > 0, base.inertia, owner, "inertia", "> 0");
  check.require(true, base.position.x(), owner, "position.0", "");
  check.require(true, base.position.y(), owner, "position.1", "");
  check.require(true, base.velocity.x(), owner, "velocity.0", "");
  check.require(true, base.velocity.y(), owner, "velocity.1", "");
}

void inspect(const Friction& friction, const Owner& owner, Inspector& check) {
  check.require(friction.coulomb >= 0, friction.coulomb, owner, "friction.coulomb", ">= 0");
  check.require(friction.viscous >= 0, friction.viscous, owner, "friction.viscous", ">= 0");
  const double slip = friction.regularization_rate; // its square must neither vanish nor overflow
  check.require(slip >= 1e-150 && slip <= 1e150, slip, owner, "friction.regularization_rate",
                slip > 1   ? "<= 1e150"
                : slip > 0 ? ">= 1e-150"
                           : "> 0");
  if (friction.static_level)
    check.require(*friction.static_level >= friction.coulomb, *friction.static_level, owner,
                  "friction.static", ">= friction.coulomb");
  check.require(friction.scale >= 0, friction.scale, owner, "friction.scale", ">= 0");
}

void inspect(const Damper& damper, const Owner& owner, Inspector& check) {
  const auto not_negative = [&](double value, const char* field) {
    check.require(value >= 0, value, owner, field, ">= 0");
  };
  const auto rate = [&](double value, const char* field) { // its powers must not vanish
    check.require(value >= 1e-150, value, owner, field, value > 0 ? ">= 1e-150" : "> 0");
  };
  if (damper.law == DamperLaw::eddy_current) {
    not_negative(damper.peak_torque, "damper.peak_torque");
    rate(damper.peak_rate, "damper.peak_rate");
  } else {
    not_negative(damper.coefficient, "damper.coefficient");
  }
  if (damper.law == DamperLaw::power) {
    check.require(damper.exponent > 0, damper.exponent, owner, "damper.exponent", "> 0");
    rate(damper.regularization_rate, "damper.regularization_rate");
  }
  if (damper.window) {
    const auto [from, to] = *damper.window;
    check.require(true, from, owner, "damper.window.0", "");
    check.require(from != to, to, owner, "damper.window.1", "different from damper.window.0");
  }
  not_negative(damper.scale, "damper.scale");
}

void inspect(const Stop& stop, const Owner& owner, Inspector& check) {
  check.require(stop.stiffness >= 0, stop.stiffness, owner, "stop.stiffness", ">= 0");
  check.require(stop.dissipation >= 0, stop.dissipation, owner, "stop.dissipation", ">= 0");
  check.require(stop.gap >= 0, stop.gap, owner, "stop.gap", ">= 0");
}

void inspect_far(const Stop& stop, const Owner& owner, Inspector& check) {
  check.require(stop.stiffness >= 0, stop.stiffness, owner, "far_stop.stiffness", ">= 0");
  check.require(stop.dissipation >= 0, stop.dissipation, owner, "far_stop.dissipation", ">= 0");
  check.require(stop.gap >= 0, stop.gap, owner, "far_stop.gap", ">= 0");
}

void inspect(const Release& release, const Hinge& hinge, const Owner& owner, Inspector& check) {
  check.require(release.time >= 0, release.time, owner, "release.time", ">= 0");
  check.require(release.delay >= 0, release.delay, owner, "release.delay", ">= 0");
  check.require(release.fails == 0 || release.fails == 1, release.fails, owner, "release.fails",
                "0 or 1");
  if (release.event == Release::Event::passed)
    check.require(release.angle > 0, release.angle, owner, "release.event.angle", "> 0");
  check.require(hinge.initial_rate == 0, hinge.initial_rate, owner, "initial_rate",
                "0 of a hinge that is held");
}

void inspect(const Latch& latch, const Owner& owner, Inspector& check) {
  check.require(latch.stiffness >= 0, latch.stiffness, owner, "latch.stiffness", ">= 0");
  check.require(latch.damping >= 0, latch.damping, owner, "latch.damping", ">= 0");
  check.require(latch.backlash >= 0, latch.backlash, owner, "latch.backlash", ">= 0");
  if (latch.capture_rate)
    check.require(*latch.capture_rate >= 0, *latch.capture_rate, owner, "latch.capture_rate",
                  ">= 0");
  if (latch.holding_moment)
    check.require(*latch.holding_moment > 0, *latch.holding_moment, owner, "latch.holding_moment",
                  "> 0");
  if (!latch.dissipation) return;
  check.require(*latch.dissipation >= 0, *latch.dissipation, owner, "latch.dissipation", ">= 0");
  check.require(latch.damping == 0, latch.damping, owner, "latch.damping",
                "0 beside latch.dissipation");
}

void inspect(const Hold& hold, const Hinge& hinge, const Owner& owner, Inspector& check) {
  check.require(hold.stiffness > 0, hold.stiffness, owner, "hold.stiffness", "> 0");
  check.require(hold.damping >= 0, hold.damping, owner, "hold.damping", ">= 0");
  check.require(hinge.release.has_value(), 0, owner, "release",
                "the release of a hinge with a hold");
}

void inspect(const Motor& motor, const Owner& owner, Inspector& check) {
  if (motor.table)
    check.require(true, motor.scale, owner, "motor.rate.scale", "");
  else
    check.require(true, motor.rate, owner, "motor.rate", "");
  check.require(motor.gain >= 0, motor.gain, owner, "motor.gain", ">= 0");
  check.require(motor.torque_limit >= 0, motor.torque_limit, owner, "motor.torque_limit", ">= 0");
}

void inspect(const Joint& joint, const Owner& owner, Inspector& check) {
  check.require(joint.stiffness > 0, joint.stiffness, owner, "joint.stiffness", "> 0");
  check.require(joint.damping >= 0, joint.damping, owner, "joint.damping", ">= 0");
}

/// Refuses a hinge that opens against its torque table: the table's angles go from stowed to latched.
void inspect_direction(const HingeTorque& torque, const Hinge& hinge, const Owner& owner,
                       const char* expected, Inspector& check) {
  if (!torque.table || !(std::abs(hinge.latched - hinge.stowed) > 0)) return;
  const std::vector<double>& angle = torque.table->angle();
  const bool same_way = (angle.back() > angle.front()) == (hinge.latched > hinge.stowed);
  check.require(same_way, hinge.latched, owner, "angle.latched", expected);
}

void inspect(const Hinge& hinge, Inspector& check) {
  const Owner owner{"hinges", hinge.name};
  check.require(true, hinge.parent_point.x(), owner, "parent_point.0", "");
  check.require(true, hinge.parent_point.y(), owner, "parent_point.1", "");
  check.require(true, hinge.child_point.x(), owner, "child_point.0", "");
  check.require(true, hinge.child_point.y(), owner, "child_point.1", "");
  check.require(true, hinge.stowed, owner, hinge.joint ? "angle" : "angle.stowed", "");
  check.require(true, hinge.initial_rate, owner, "initial_rate", "");
  if (hinge.joint) return inspect(*hinge.joint, owner, check);
  check.require(hinge.latched != hinge.stowed, hinge.latched, owner, "angle.latched",
                "different from angle.stowed");
  inspect_direction(hinge.spring, hinge, owner,
                    "on the side of angle.stowed to which the spring's table leads", check);
  inspect_direction(hinge.harness, hinge, owner,
                    "on the side of angle.stowed to which the harness's table leads", check);
  check.require(true, hinge.spring.torque_stowed, owner, "spring.torque_stowed", "");
  check.require(true, hinge.spring.torque_latched, owner, "spring.torque_latched", "");
  check.require(true, hinge.spring.scale, owner, "spring.scale", "");
  check.require(true, hinge.spring.offset, owner, "spring.offset", "");
  check.require(true, hinge.harness.torque_stowed, owner, "harness.torque_stowed", "");
  check.require(true, hinge.harness.torque_latched, owner, "harness.torque_latched", "");
  check.require(true, hinge.harness.scale, owner, "harness.scale", "");
  check.require(true, hinge.harness.offset, owner, "harness.offset", "");
  inspect(hinge.friction, owner, check);
  if (hinge.damper) inspect(*hinge.damper, owner, check);
  if (hinge.stop) inspect(*hinge.stop, owner, check);
  if (hinge.far_stop) inspect_far(*hinge.far_stop, owner, check);
  if (hinge.latch) inspect(*hinge.latch, owner, check);
  if (hinge.release) inspect(*hinge.release, hinge, owner, check);
  if (hinge.hold) inspect(*hinge.hold, hinge, owner, check);
  if (hinge.motor) inspect(*hinge.motor, owner, check);
}

/// @pre the body is flexible, and its mass and inertia are > 0
void require_cut(const Body& body, int joints, const Owner& owner, Inspector& check) {
  if (can_be_cut(body)) return;
  std::ostringstream words;
  words << "about mass·length²/12, the inertia of a uniform panel of the plate's length, and with "
        << joints << (joints == 1 ? " joint" : " joints") << " at least " << least_inertia(body);
  check.require(false, body.inertia, owner, "inertia", words.str().c_str());
}

/// @pre the body has a plate
void inspect(const Body& body, const Flexible& flexible, const Owner& owner, Inspector& check) {
  if (flexible.bending_stiffness)
    check.require(*flexible.bending_stiffness > 0, *flexible.bending_stiffness, owner,
                  "flexible.bending_stiffness", "> 0");
  if (flexible.frequency)
    check.require(*flexible.frequency > 0, *flexible.frequency, owner, "flexible.frequency", "> 0");
  check.require(flexible.damping_ratio >= 0, flexible.damping_ratio, owner,
                "flexible.damping_ratio", ">= 0");
  if (body.mass > 0 && body.inertia > 0) require_cut(body, flexible.joints, owner, check);
}

void inspect(const Body& body, Inspector& check) {
  const Owner owner{"bodies", body.name};
  check.require(body.mass > 0, body.mass, owner, "mass", "> 0");
  check.require(body.inertia > 0, body.inertia, owner, "inertia", "> 0");
  check.require(body.plate || !body.flexible, 0, owner, "plate", "the plate of a flexible body");
  if (!body.plate) return;
  const Plate& plate = *body.plate;
  check.require(true, plate.from.x(), owner, "plate.from.0", "");
  check.require(true, plate.from.y(), owner, "plate.from.1", "");
  check.require(true, plate.to.x(), owner, "plate.to.0", "");
  check.require(true, plate.to.y(), owner, "plate.to.1", "");
  check.require(plate.from.x() != plate.to.x() || plate.from.y() != plate.to.y(), plate.to.x(),
                owner, "plate.to", "another point than plate.from");
  check.require(plate.width >= 0, plate.width, owner, "plate.width", ">= 0");
  check.require(plate.drag_coefficient >= 0, plate.drag_coefficient, owner,
                "plate.drag_coefficient", ">= 0");
  if (body.flexible) inspect(body, *body.flexible, owner, check);
}

void inspect(const Synchronisation& loop, Inspector& check) {
  const Owner owner{"synchronisations", loop.name};
  check.require(loop.table || loop.ratio != 0, loop.ratio, owner, "ratio", "a number, not 0");
  check.require(loop.stiffness >= 0, loop.stiffness, owner, "stiffness", ">= 0");
  check.require(loop.damping >= 0, loop.damping, owner, "damping", ">= 0");
  if (loop.preload) check.require(*loop.preload > 0, *loop.preload, owner, "preload", "> 0");
}

void inspect(const Environment& environment, Inspector& check) {
  const Owner owner{"environment", ""};
  check.require(true, environment.gravity.x(), owner, "gravity.0", "");
  check.require(true, environment.gravity.y(), owner, "gravity.1", "");
  check.require(environment.air_density >= 0, environment.air_density, owner, "air_density",
                ">= 0");
}

} // namespace

std::vector<Fault> unphysical(const Scene& scene) {
  Inspector check;
  inspect(scene.base, check);
  for (const Body& body : scene.bodies) inspect(body, check);
  for (const Hinge& hinge : scene.hinges) inspect(hinge, check);
  for (const Synchronisation& loop : scene.synchronisations) inspect(loop, check);
  inspect(scene.environment, check);
  return std::move(check.faults);
}

std::vector<int> outward_order(const Scene& scene) {
  const int n = static_cast<int>(scene.bodies.size());
  if (static_cast<int>(scene.hinges.size()) != n) return {};
  std::vector<std::vector<int>> hinges_of(n + 1); // of a parent; the base's stand last
  std::vector<bool> is_child(n, false);
  for (int h = 0; h < n; ++h) {
    const Hinge& hinge = scene.hinges[h];
    const bool known =
        hinge.parent >= base_index && hinge.parent < n && hinge.child >= 0 && hinge.child < n;
    if (!known || is_child[hinge.child]) return {};
    is_child[hinge.child] = true;
    hinges_of[hinge.parent == base_index ? n : hinge.parent].push_back(h);
  }
  std::vector<int> order, open(hinges_of[n].rbegin(), hinges_of[n].rend());
  while (!open.empty()) {
    const int h = open.back();
    open.pop_back();
    order.push_back(h);
    const std::vector<int>& next = hinges_of[scene.hinges[h].child];
    open.insert(open.end(), next.rbegin(), next.rend());
  }
  return static_cast<int>(order.size()) == n ? order : std::vector<int>{};
}

} // namespace wingspread
