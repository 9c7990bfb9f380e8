#include "montecarlo/model/input_checks/bending_check.hpp"

#include "core/scene/segments.hpp"
#include "distributions/decompositions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace wingspread {
namespace {

// Two joints are 6 % off, one is 39 % off: the engineer is to choose the first, and to know of the other.
constexpr double most_off = 0.1;
// Of the frequency, by a body with less inertia than a rod; heuristic: a rounded inertia raises it by less.
constexpr double most_raised = 0.02;
// As a share of m L²/12; heuristic: rounded numbers are nearer, and 2 % lower the fourth frequency by some 10 %.
constexpr double most_beyond_rod = 0.02;
// Heuristic, in lengths: a plate 2 % off the centre changes the frequency of a panel clamped at its end by about 4 %.
constexpr double most_off_centre = 0.02;

double rod_inertia(const Body& body) {
  return body.mass * (body.plate->to - body.plate->from).squaredNorm() / 12;
}

/// The panel with at least a uniform panel's inertia, to see the effect of its joints alone.
Body with_even_mass(Body body) {
  body.inertia = std::max(body.inertia, rod_inertia(body));
  return body;
}

/// The panel cut so finely that more joints change nothing, where its inertia allows it.
std::optional<Body> cut_finely(Body body) {
  constexpr int many = 32; // heuristic: 0.1 % off
  body.flexible->joints = std::max(body.flexible->joints, many);
  return can_be_cut(body) ? std::optional(body) : std::nullopt;
}

double length_of(const Body& body) { return (body.plate->to - body.plate->from).norm(); }

/// Of the panel without segments, from its stiffness [core/scene/segments.hpp, (4)], Hz.
double beam_frequency(const Body& body) {
  constexpr double beta = 1.8751040687119612;
  const double L = length_of(body);
  return beta * beta * std::sqrt(bending_stiffness(body) / (body.mass * L * L * L)) /
         (2 * std::numbers::pi);
}

/// The joint of the body's segments, from 1, on which the point lies; nothing if it lies on a segment.
std::optional<int> joint_at(const Body& body, const Eigen::Vector2d& point) {
  constexpr double on_joint = 0.01; // of an element; heuristic: as near is meant to be there
  const Eigen::Vector2d along = body.plate->to - body.plate->from;
  const double place =
      point.dot(along) / along.squaredNorm() + 0.5; // segments are even about the centre of mass
  const double elements = place * body.flexible->joints + 0.5, joint = std::round(elements);
  const bool is_one = joint >= 1 && joint <= body.flexible->joints;
  return is_one && std::abs(elements - joint) < on_joint ? std::optional(static_cast<int>(joint))
                                                         : std::nullopt;
}

/// Warns of hinges on the joint between two segments: on which of them they hang is the program's choice.
void check_hinges_on_joints(const Scene& scene, InputWarnings& warnings) {
  for (std::size_t h = 0; h < scene.hinges.size(); ++h) {
    const Hinge& hinge = scene.hinges[h];
    const auto check = [&](int b, const Eigen::Vector2d& point, const char* key) {
      if (b < 0) return;
      const Body& body = scene.bodies[static_cast<std::size_t>(b)];
      if (!body.flexible || !body.plate || !can_be_cut(body)) return;
      if (const auto joint = joint_at(body, point))
        warnings.add(
            fmt::format("/hinges/{}/{}", h, key),
            fmt::format(
                "a point on joint {} of the bending panel {}: the hinge hangs on one of the "
                "segments beside it, and on the other the wing would be another",
                *joint, body.name),
            "a point within a segment: another number of joints (an even one for a hinge in the "
            "middle)");
    };
    check(hinge.parent, hinge.parent_point, "parent_point");
    check(hinge.child, hinge.child_point, "child_point");
  }
}

} // namespace

double clamped_frequency(const Body& body) {
  Scene alone;
  alone.bodies = {body};
  alone.hinges.resize(1);
  alone.hinges[0].child = 0, alone.hinges[0].child_point = body.plate->from;
  const SegmentedScene made = with_segments(alone);
  const std::vector<int>& segments = made.segments[0];
  const Eigen::Index n = std::ssize(segments) - 1;
  const double element = length_of(body) / static_cast<double>(n);
  // joint a at (a + ½) of an element; segment j is clamped for j = 0, and the last one is half as long
  const auto joint = [&](Eigen::Index a) { return (static_cast<double>(a) + 0.5) * element; };
  const auto center = [&](Eigen::Index j) {
    return (static_cast<double>(j) - (j == n ? 0.25 : 0.0)) * element;
  };
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index j = 1; j <= n; ++j) {
    const Body& segment = made.scene.bodies[segments[static_cast<std::size_t>(j)]];
    for (Eigen::Index a = 0; a < j; ++a)
      for (Eigen::Index b = 0; b < j; ++b)
        M(a, b) += segment.inertia + segment.mass * (center(j) - joint(a)) * (center(j) - joint(b));
  }
  const double k = static_cast<double>(n) * bending_stiffness(body) / length_of(body);
  const double most = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(M, Eigen::EigenvaluesOnly)
                          .eigenvalues()[n - 1];
  return std::sqrt(k / most) / (2 * std::numbers::pi);
}

void check_bending(const Scene& scene, InputWarnings& warnings) {
  check_hinges_on_joints(scene, warnings);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Body& body = scene.bodies[b];
    if (!body.flexible || !body.plate || !can_be_cut(body)) continue;
    const std::string at = fmt::format("/bodies/{}", b);
    const double off = ((body.plate->from + body.plate->to) / 2).norm();
    if (off > most_off_centre * length_of(body))
      warnings.add(at + "/plate",
                   fmt::format("its middle is {:.3g} m from the centre of mass, about which the "
                               "panel's segments are even",
                               off),
                   "a plate whose middle is the centre of mass, as a uniform panel's is: else a "
                   "hinge at the plate's end is none at the bending panel's, and its frequency "
                   "another");
    const double cut = clamped_frequency(with_even_mass(body)), whole = beam_frequency(body);
    if (std::abs(cut / whole - 1) > most_off)
      warnings.add(at + "/flexible/joints",
                   fmt::format("{}: the clamped panel vibrates at {:.4g} Hz with its segments, and "
                               "at {:.4g} Hz uncut",
                               body.flexible->joints, cut, whole),
                   "more joints: the frequency's error falls as 1/joints²");
    const double rod = rod_inertia(body);
    if (const double fine = clamped_frequency(cut_finely(body).value_or(body));
        body.inertia < rod && fine > (1 + most_raised) * whole)
      warnings.add(at + "/inertia",
                   fmt::format("{:.4g} kg·m², {:.3g} times m L²/12: the clamped panel vibrates at "
                               "{:.4g} Hz, however many joints it has, for {:.4g} Hz",
                               body.inertia, body.inertia / rod, fine, whole),
                   "that of a uniform panel: with less, its mass lies towards the middle");
    if (body.inertia > (1 + most_beyond_rod) * rod)
      warnings.add(
          at + "/inertia",
          fmt::format("{:.4g} kg·m², {:.3g} times m L²/12", body.inertia, body.inertia / rod),
          "that of a uniform panel: what is beyond turns with the segments, and lowers "
          "high frequencies");
  }
}

} // namespace wingspread
