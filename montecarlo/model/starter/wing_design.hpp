/// The few numbers from which `wingspread new` makes a wing, and the geometry of its Z-fold.
///
/// | symbol | meaning                                                                            | unit |
/// |--------|------------------------------------------------------------------------------------|------|
/// | k      | a body of the wing, 1 is at the root                                               |      |
/// | L_k    | its length, from hinge to hinge                                                    | m    |
/// | p      | pitch of the stack: the distance from one stowed body to the next                  | m    |
/// | s_k    | the face of body k with its inner hinge: +1, −1, +1, …                             |      |
///
/// Body k has its inner hinge at (−L_k/2, s_k p/2) and its outer hinge at (L_k/2, −s_k p/2), from its centre of mass.
/// The next body has its inner hinge at height s_{k+1} p/2 = −s_k p/2: deployed at angles 0, all centres are in one
/// line. Stowed, the root turns by 90°, and hinge k by s_k 180° back over body k − 1, on the face of their hinge: body
/// k lies flat at a distance of (k − 1/2) p from the wall. The wing on the other side is the mirror image.
#pragma once

#include "montecarlo/foundation/formats/quantity.hpp"

#include <Eigen/Core>

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

inline constexpr int most_panels = 20;

struct WingDesign {
  std::string name = "my_wing";
  int wings = 1;
  int panels = 3;
  bool yoke = false;
  double panel_length = 1.8; ///< from hinge to hinge, m
  double panel_width = 1.2;  ///< along the hinge lines, m
  double panel_mass = 9.5;   ///< kg
  double yoke_length = 0.8;  ///< m
  double yoke_mass = 3.5;    ///< kg
  double bus_width = 1;      ///< of the spacecraft, from root to root, m
  double pitch = 0.025;      ///< p, m
  double root_spring = 2.6;  ///< of the root hinge, stowed, N·m
  double spring = 1.5;       ///< of every other hinge, stowed, N·m
  double friction = 0.02;    ///< Coulomb level of a hinge, N·m
  double harness = 0.15;     ///< largest torque of a hinge's cables, N·m
  std::optional<double>
      damper{}; ///< of the root hinge, N·m·s/rad; 0: none; not given: suggested_damper()
  bool damper_suggested = false; ///< whether suggested_damper() gave it
};

/// Whether a wing has hinges beside its root.
[[nodiscard]] inline bool has_other_hinges(const WingDesign& design) {
  return design.panels > 1 || design.yoke;
}

/// A number that the user may give, as an option or as the answer to a question.
struct DesignNumber {
  std::string_view option; ///< "--panel-length"
  std::string_view what;   ///< "length of a panel, from hinge to hinge"
  Dimension dimension;
  double WingDesign::*value;
  bool of_yoke = false; ///< asked, and accepted, only with a yoke
  bool may_be_zero = false;
};
[[nodiscard]] std::span<const DesignNumber> design_numbers();

/// The options and their conditions, in one place each.
inline constexpr std::string_view damper_option = "--damper";
inline constexpr std::string_view expected_name =
    "a name of letters, digits, - and _, at most 60 characters";
[[nodiscard]] bool is_design_name(std::string_view name);

/// @throws SpecError that names the option of each impossible number
void check_design(const WingDesign& design);

/// A body of one wing, seen from the root.
struct DesignedBody {
  std::string name;
  double mass = 0, length = 0, width = 0; ///< kg, m, m
  /// About the centre of mass, a uniform plate: m L²/12, kg·m².
  [[nodiscard]] double inertia() const { return mass * length * length / 12; }
};

/// The hinge that carries the body of the same index.
struct DesignedHinge {
  std::string name, parent, child;
  Eigen::Vector2d parent_point{0, 0}, child_point{0, 0}; ///< m
  int stowed = 0;                                        ///< degrees; latched at 0
};

struct DesignedWing {
  std::vector<DesignedBody> bodies; ///< from the root outwards
  std::vector<DesignedHinge> hinges;
};

/// One wing; with two, names begin with R_ or L_. @param left the mirror image on the other side
[[nodiscard]] DesignedWing designed_wing(const WingDesign& design, bool left);
[[nodiscard]] std::vector<DesignedWing> designed_wings(const WingDesign& design);

} // namespace wingspread
