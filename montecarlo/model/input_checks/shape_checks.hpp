/// Checks for bodies that overlap, and for wings that do not deploy straight.
///
/// A scene knows a body's centre of mass, hinge points and plate, but not its shape. The checks represent a body by its
/// arms: the straight lines from the centre of mass to each hinge point, and the plate. Arms lie inside the body
/// (unless it is bent like a U), so bodies with crossing arms do overlap. Bodies that touch, or stand side by side in a
/// stack, have no crossing arms. Overlaps outside the arms are missed: the far end of the last panel, the thickness.
#pragma once

#include "montecarlo/model/input_checks/input_warning.hpp"
#include "montecarlo/model/input_checks/placement.hpp"

#include <optional>
#include <span>
#include <utility>

namespace wingspread {

/// The arms of each body, in its own frame.
class Arms {
public:
  explicit Arms(const Scene& scene);

  /// The first two bodies with crossing arms: the crossing point is inside both arms by more than a thousandth of their
  /// length. Cost O(n²) for n bodies.
  [[nodiscard]] std::optional<std::pair<int, int>>
  first_crossing(std::span<const Placement> bodies) const;

  /// The longest arm of a body, m.
  [[nodiscard]] double reach(int body) const { return reach_[body]; }

private:
  using Line = std::pair<Eigen::Vector2d, Eigen::Vector2d>;
  std::vector<std::vector<Line>> of_body_;
  std::vector<double> reach_;
};

/// Warns of:
/// - stowed bodies with crossing arms, or with coinciding centres of mass (except two panels without thickness: hinge
///   points on an axis of their frame);
/// - a body that turns through the body that carries it;
/// - a synchronisation that is out of step where both of its hinges latch: the cable then holds one of them back;
/// - two synchronisations of the same hinges that disagree on the travel;
/// - at joints that latch at angle 0, where a wing should be straight: a child that folds back, and hinge points that
///   are mirror images except for the sign of an offset, which makes a step in the wing.
void check_shape(const Scene& scene, InputWarnings& warnings);

} // namespace wingspread
