#include "core/scene/segments.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace wingspread {
namespace {

/// The panel of (1) to (5).
class Panel {
public:
  explicit Panel(const Body& body)
      : joints_(body.flexible->joints), mass_(body.mass), along_(body.plate->to - body.plate->from),
        length_(along_.norm()) {
    along_ /= length_;
    beyond_rod_ = body.inertia - mass_ * length_ * length_ / 12;
    if (beyond_rod_ < 0 && joints_ > 1) taper();
  }

  [[nodiscard]] int joints() const { return joints_; }
  [[nodiscard]] double length() const { return length_; }
  /// l_j/L
  [[nodiscard]] double share(int j) const {
    const bool is_end = j == 0 || j == joints_;
    return (is_end ? 0.5 : 1.0) / joints_;
  }
  /// Shares of the length at which segment j begins and ends.
  [[nodiscard]] double begin(int j) const { return j == 0 ? 0 : (j - 0.5) / joints_; }
  [[nodiscard]] double end(int j) const { return begin(j) + share(j); }
  /// x_j
  [[nodiscard]] double center(int j) const { return (0.5 * (begin(j) + end(j)) - 0.5) * length_; }
  [[nodiscard]] double mass(int j) const { return mass_ * share(j) * weight(j); }
  /// J_j
  [[nodiscard]] double inertia(int j) const { return mass(j) * rod(j) + beyond_rod_ * share(j); }
  /// The least mass of a segment over that of (1).
  [[nodiscard]] double least_weight() const { return weight(0); } // the ends are furthest out

  /// A point of the body's frame from segment j's centre.
  [[nodiscard]] Eigen::Vector2d from_segment(int j, const Eigen::Vector2d& point) const {
    return point - center(j) * along_;
  }
  /// The joint between segments j and j + 1, body's frame.
  [[nodiscard]] Eigen::Vector2d joint(int j) const { return (end(j) - 0.5) * length_ * along_; }
  /// The segment beside a point of the body's frame.
  [[nodiscard]] int segment_at(const Eigen::Vector2d& point) const {
    const double place = point.dot(along_) / length_ + 0.5;
    return static_cast<int>(std::clamp(std::floor(place * joints_ + 0.5), 0.0, double(joints_)));
  }

private:
  /// ρ_j/m_j
  [[nodiscard]] double rod(int j) const { return std::pow(share(j) * length_, 2) / 12; }
  /// 1 + a (s − x_j²)
  [[nodiscard]] double weight(int j) const {
    return 1 + taper_ * (mean_square_ - center(j) * center(j));
  }

  /// (5)
  void taper() {
    for (int j = 0; j <= joints_; ++j) mean_square_ += share(j) * center(j) * center(j);
    double gained = 0; // inertia/m for a = 1
    for (int j = 0; j <= joints_; ++j) {
      const double square = center(j) * center(j);
      gained += share(j) * (mean_square_ - square) * (square + rod(j));
    }
    taper_ = beyond_rod_ / (mass_ * gained);
    beyond_rod_ = 0;
  }

  int joints_;
  double mass_;
  Eigen::Vector2d along_;
  double length_;
  double beyond_rod_;                  ///< J − m L²/12, where (2) holds
  double taper_ = 0, mean_square_ = 0; ///< a, s
};

/// β² of (4); β is the least root of cos β cosh β = −1.
constexpr double beta_square = 1.8751040687119612 * 1.8751040687119612;

Joint joint_of(const Body& body, const Panel& panel) {
  const double EI = bending_stiffness(body), L = panel.length();
  const double omega = beta_square * std::sqrt(EI / (body.mass * L * L * L));
  const double k = panel.joints() * EI / L;
  return {k, 2 * body.flexible->damping_ratio * k / omega};
}

/// @param in_air whether the segment keeps its part of the plate: without air a plate is only the panel's place
Body segment_of(const Body& body, const Panel& panel, int j, bool in_air) {
  Body segment{body.name, panel.mass(j), panel.inertia(j)};
  if (!in_air) return segment;
  const Plate& plate = *body.plate;
  const Eigen::Vector2d way = plate.to - plate.from;
  segment.plate = plate;
  segment.plate->from = panel.from_segment(j, plate.from + panel.begin(j) * way);
  segment.plate->to = panel.from_segment(j, plate.from + panel.end(j) * way);
  return segment;
}

class Cutter {
public:
  explicit Cutter(const Scene& scene) : given_(scene) {
    made_.scene = scene;
    made_.joints.resize(scene.bodies.size()), made_.segments.resize(scene.bodies.size());
  }

  SegmentedScene cut() && {
    for (int b = 0; b < std::ssize(given_.bodies); ++b)
      if (given_.bodies[b].flexible) cut(b);
    return std::move(made_);
  }

private:
  void cut(int b) {
    const Body& body = given_.bodies[b];
    const Panel panel(body);
    const auto own = std::ranges::find(given_.hinges, b, &Hinge::child);
    const int root = panel.segment_at(own->child_point), n = panel.joints();
    std::vector<int>& segments = made_.segments[b];
    for (int j = 0; j <= n; ++j) {
      Body segment = segment_of(body, panel, j, given_.environment.air_density != 0);
      segments.push_back(j == root ? b : static_cast<int>(made_.scene.bodies.size()));
      if (j == root) {
        made_.scene.bodies[b] = std::move(segment);
      } else {
        segment.name += " segment " + std::to_string(j + 1);
        made_.scene.bodies.push_back(std::move(segment));
      }
    }
    attach(b, panel);
    for (int j = 0; j < n; ++j) add_joint(b, panel, j, j < root);
  }

  /// Moves the points of the hinges on body b to its segments.
  void attach(int b, const Panel& panel) {
    for (Hinge& hinge : made_.scene.hinges) {
      if (hinge.child == b)
        hinge.child_point =
            panel.from_segment(panel.segment_at(hinge.child_point), hinge.child_point);
      if (hinge.parent != b) continue;
      const int j = panel.segment_at(hinge.parent_point);
      hinge.parent = made_.segments[b][j];
      hinge.parent_point = panel.from_segment(j, hinge.parent_point);
    }
  }

  /// The joint between segments j and j + 1. @param inward whether j + 1 is the parent
  void add_joint(int b, const Panel& panel, int j, bool inward) {
    const Body& body = given_.bodies[b];
    const int parent = inward ? j + 1 : j, child = inward ? j : j + 1;
    Hinge joint;
    joint.name = body.name + " joint " + std::to_string(j + 1);
    joint.parent = made_.segments[b][parent], joint.child = made_.segments[b][child];
    joint.parent_point = panel.from_segment(parent, panel.joint(j));
    joint.child_point = panel.from_segment(child, panel.joint(j));
    joint.joint = joint_of(body, panel);
    made_.joints[b].push_back(static_cast<int>(made_.scene.hinges.size()));
    made_.scene.hinges.push_back(std::move(joint));
  }

  const Scene& given_;
  SegmentedScene made_;
};

} // namespace

bool can_be_cut(const Body& body) {
  constexpr double least_weight = 0.1; // heuristic: an end of next to no mass would swing at once
  const Panel panel(body);
  return panel.least_weight() > least_weight && panel.inertia(0) > 0;
}

double least_inertia(Body body) {
  const double length = Panel(body).length();
  double low = 0, high = body.mass * length * length / 12; // a rod can be cut
  for (int halving = 0; halving < 30; ++halving) {
    body.inertia = (low + high) / 2;
    (can_be_cut(body) ? high : low) = body.inertia;
  }
  return high;
}

double bending_stiffness(const Body& body) {
  if (body.flexible->bending_stiffness) return *body.flexible->bending_stiffness;
  const double omega = 2 * std::numbers::pi * body.flexible->frequency.value_or(0) / beta_square;
  const double L = Panel(body).length();
  return omega * omega * body.mass * L * L * L;
}

bool has_flexible_bodies(const Scene& scene) {
  return std::ranges::any_of(scene.bodies,
                             [](const Body& body) { return body.flexible.has_value(); });
}

SegmentedScene with_segments(const Scene& scene) { return Cutter(scene).cut(); }

bool have_same_tree(const Scene& a, const Scene& b) {
  return std::ranges::equal(a.hinges, b.hinges, [](const Hinge& one, const Hinge& other) {
    return one.parent == other.parent && one.child == other.child;
  });
}

} // namespace wingspread
