/// Bodies in each other's place, and wings that do not come out straight.
///
/// Of a body's shape nothing is known but its centre of mass, its hinge points and, where it has one, its plate. Taken
/// for its matter are its arms: the straight lines from the centre of mass to each hinge point, and the plate. They
/// lie within the body unless it is bent like a U, so that bodies whose arms cross do pass through each other; bodies
/// that touch, or stand a gap apart as panels in a stack do, have arms that do not cross. What is missed is what the
/// arms do not reach: the far end of the last panel, the thickness.
#pragma once

#include "montecarlo/model/input_checks/notice.hpp"
#include "montecarlo/model/input_checks/placement.hpp"

#include <optional>
#include <span>
#include <utility>

namespace wingspread {

/// The arms of each body, in its own frame.
class Arms {
public:
  explicit Arms(const Scene& scene);

  /// The first two bodies whose arms cross properly: in a point that is inside of both, by more than a thousandth of
  /// their length. Cost O(n²) for n bodies.
  [[nodiscard]] std::optional<std::pair<int, int>>
  first_crossing(std::span<const Placement> bodies) const;

  /// The longest arm of a body, m.
  [[nodiscard]] double reach(int body) const { return reach_[body]; }

private:
  using Line = std::pair<Eigen::Vector2d, Eigen::Vector2d>;
  std::vector<std::vector<Line>> of_body_;
  std::vector<double> reach_;
};

/// Stowed bodies whose arms cross, or whose centres of mass are in one place (panels without any thickness, whose
/// hinge points lie on an axis of their frame, may); a body that turns through the one that carries it; and of joints that are latched at 0, in which a wing goes straight
/// on: a child that folds back, and hinge points that are mirror images but for the sign of an offset, which makes a
/// step in the wing.
void notice_shape(const Scene& scene, Notices& notices);

} // namespace wingspread
