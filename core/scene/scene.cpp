#include "core/scene/scene.hpp"

#include <cmath>
#include <sstream>

namespace wingspread {
namespace {

/// Whose fields are looked at: "hinges.root", "base".
struct Owner {
  const char* kind;
  const std::string& name; ///< may be empty
};

/// Collects faults; formats names and values only when it finds one.
class Inspector {
public:
  void require(bool holds, double value, const Owner& owner, const char* field,
               const char* expected) {
    if (holds && std::isfinite(value)) return;
    std::ostringstream found;
    found.precision(17);
    found << value;
    faults.push_back({owner.kind + (owner.name.empty() ? "" : "." + owner.name) + "." + field,
                      found.str(), std::isfinite(value) ? expected : "a finite number"});
  }
  std::vector<Fault> faults;
};

void inspect(const Base& base, Inspector& check) {
  static const std::string nameless;
  const Owner owner{"base", nameless};
  if (base.motion == BaseMotion::fixed) return;
  check.require(true, base.angle, owner, "angle", "");
  check.require(true, base.rate, owner, "rate", "");
  if (base.motion == BaseMotion::prescribed) {
    check.require(true, base.acceleration.x(), owner, "acceleration.0", "");
    check.require(true, base.acceleration.y(), owner, "acceleration.1", "");
    check.require(true, base.angular_acceleration, owner, "angular_acceleration", "");
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
  check.require(friction.regularization_rate >= 1e-150, friction.regularization_rate, owner,
                "friction.regularization_rate",
                friction.regularization_rate > 0 ? ">= 1e-150"
                                                 : "> 0"); // its square must not vanish
  if (friction.static_level)
    check.require(*friction.static_level >= friction.coulomb, *friction.static_level, owner,
                  "friction.static", ">= friction.coulomb");
}

void inspect(const Hinge& hinge, Inspector& check) {
  const Owner owner{"hinges", hinge.name};
  check.require(true, hinge.parent_point.x(), owner, "parent_point.0", "");
  check.require(true, hinge.parent_point.y(), owner, "parent_point.1", "");
  check.require(true, hinge.child_point.x(), owner, "child_point.0", "");
  check.require(true, hinge.child_point.y(), owner, "child_point.1", "");
  check.require(true, hinge.stowed, owner, "angle.stowed", "");
  check.require(hinge.latched != hinge.stowed, hinge.latched, owner, "angle.latched",
                "different from angle.stowed");
  check.require(true, hinge.initial_rate, owner, "initial_rate", "");
  check.require(true, hinge.spring.torque_stowed, owner, "spring.torque_stowed", "");
  check.require(true, hinge.spring.torque_latched, owner, "spring.torque_latched", "");
  check.require(true, hinge.harness.torque_stowed, owner, "harness.torque_stowed", "");
  check.require(true, hinge.harness.torque_latched, owner, "harness.torque_latched", "");
  inspect(hinge.friction, owner, check);
  if (!hinge.latch) return;
  check.require(hinge.latch->stiffness >= 0, hinge.latch->stiffness, owner, "latch.stiffness",
                ">= 0");
  check.require(hinge.latch->damping >= 0, hinge.latch->damping, owner, "latch.damping", ">= 0");
}

} // namespace

std::vector<Fault> unphysical(const Scene& scene) {
  Inspector check;
  inspect(scene.base, check);
  for (const Body& body : scene.bodies) {
    const Owner owner{"bodies", body.name};
    check.require(body.mass > 0, body.mass, owner, "mass", "> 0");
    check.require(body.inertia > 0, body.inertia, owner, "inertia", "> 0");
  }
  for (const Hinge& hinge : scene.hinges) inspect(hinge, check);
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
