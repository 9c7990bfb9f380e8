#include "core/proofs/natural_modes.hpp"

#include "core/proofs/rest_model.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace wingspread {
namespace {

/// The scene as small swings see it.
Scene for_small_swings(Scene scene) {
  scene.base.rate = scene.base.angular_acceleration = 0;
  scene.base.table = nullptr;
  scene.environment.air_density = 0;
  for (Hinge& hinge : scene.hinges)
    if (hinge.damper && hinge.damper->law == DamperLaw::power) hinge.damper.reset();
  return scene;
}

bool is_latched(const std::optional<std::vector<int>>& latched, int hinge) {
  return !latched || std::ranges::find(*latched, hinge) != latched->end();
}

/// The wing's linear model, reduced to the hinges that move.
struct Reduced {
  RestModel model;
  std::vector<int> hinge_of; ///< of the model's hinges: index in the scene
  std::vector<int> moving;   ///< the model's hinges that are not held
  Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  bool inverse = false; ///< M v = K v/ω² was solved: a stiff latch costs the low modes no digits

  /// @param is_held by the scene's hinges, rigidly or by an elastic hold @return whether all could be found
  [[nodiscard]] bool make(const Scene& scene, const std::vector<char>& is_held, int options) {
    hinge_of = outward_order(scene);
    Wing<double> wing = make_wing<double>(scene, hinge_of);
    set_parameters(wing, scene);
    std::vector<double> angles;
    HoldsAtRest holds;
    for (const int h : hinge_of) {
      const bool elastic = is_held[h] && scene.hinges[h].hold;
      if (!is_held[h] || elastic) moving.push_back(static_cast<int>(holds.rigid.size()));
      holds.rigid.push_back(is_held[h] && !elastic), holds.elastic.push_back(elastic);
      angles.push_back(is_held[h] ? scene.hinges[h].stowed : scene.hinges[h].latched);
    }
    if (!make_linear_model(wing, angles.data(), holds, model)) return false;
    return moving.empty() || solve(options);
  }

  [[nodiscard]] Eigen::MatrixXd of_moving(const Eigen::MatrixXd& whole) const {
    return whole(moving, moving);
  }
  [[nodiscard]] int size() const { return static_cast<int>(moving.size()); }

  /// ω of mode k, lowest first, 1/s; 0 for what rounding leaves of a mode that nothing holds.
  [[nodiscard]] double omega(int k) const {
    const double value = solver.eigenvalues()(column(k));
    if (inverse) return 1 / std::sqrt(value);
    const double largest = solver.eigenvalues()(size() - 1);
    return value > rounding() * largest ? std::sqrt(value) : 0;
  }
  [[nodiscard]] Eigen::VectorXd shape(int k) const { return solver.eigenvectors().col(column(k)); }

private:
  [[nodiscard]] bool solve(int options) {
    const Eigen::MatrixXd K = of_moving(model.stiffness), M = of_moving(model.mass);
    const Eigen::LLT<Eigen::MatrixXd> factors(K);
    const auto pivots = factors.matrixLLT().diagonal().array().square();
    inverse = factors.info() == Eigen::Success && // no shape without stiffness
              (pivots > rounding() * K.diagonal().array()).all();
    inverse ? solver.compute(M, K, options) : solver.compute(K, M, options);
    return solver.info() == Eigen::Success;
  }
  [[nodiscard]] int column(int k) const { return inverse ? size() - 1 - k : k; }
  [[nodiscard]] double rounding() const {
    return 16 * size() * std::numeric_limits<double>::epsilon();
  }
};

constexpr double whole_turn = 2 * std::numbers::pi;

NaturalMode mode_of(const Reduced& reduced, int k, std::size_t hinges) {
  const Eigen::VectorXd v = reduced.shape(k);
  NaturalMode mode;
  const double omega = reduced.omega(k);
  mode.frequency = omega / whole_turn;
  if (omega > 0)
    mode.damping_ratio = v.dot(reduced.of_moving(reduced.model.damping) * v) /
                         (2 * omega * v.dot(reduced.of_moving(reduced.model.mass) * v));
  Eigen::Index largest = 0;
  v.cwiseAbs().maxCoeff(&largest);
  mode.shape.assign(hinges, 0.0);
  for (std::size_t j = 0; j < reduced.moving.size(); ++j) {
    const double angle = v(static_cast<Eigen::Index>(j)) / v(largest);
    mode.shape[reduced.hinge_of[reduced.moving[j]]] = angle;
    mode.base_angle += reduced.model.turns(0, reduced.moving[j]) * angle;
  }
  return mode;
}

} // namespace

std::optional<WingModes> natural_modes(const Scene& scene,
                                       const std::optional<std::vector<int>>& latched) {
  WingModes found{with_segments(for_small_swings(scene)), {}, {}};
  const Scene& wing = found.wing.scene;
  std::vector<char> is_held(wing.hinges.size(), 0);
  for (int h = 0; latched && h < std::ssize(wing.hinges); ++h)
    is_held[h] = wing.hinges[h].latch && !is_latched(latched, h);
  Reduced reduced;
  if (!reduced.make(wing, is_held, Eigen::ComputeEigenvectors | Eigen::Ax_lBx)) return std::nullopt;
  found.rest.resize(wing.hinges.size());
  for (int i = 0; i < reduced.model.size(); ++i)
    found.rest[reduced.hinge_of[i]] = reduced.model.angles(i);
  for (int k = 0; k < reduced.size(); ++k)
    found.modes.push_back(mode_of(reduced, k, wing.hinges.size()));
  return found;
}

std::vector<double> natural_frequencies(const Scene& scene) {
  std::vector<double> frequencies;
  if (!unphysical(scene).empty()) return frequencies;
  const Scene small = for_small_swings(scene);
  const Scene wing = has_flexible_bodies(small) ? with_segments(small).scene : small;
  Reduced reduced;
  if (!reduced.make(wing, std::vector<char>(wing.hinges.size(), 0),
                    Eigen::EigenvaluesOnly | Eigen::Ax_lBx))
    return frequencies;
  for (int k = 0; k < reduced.size(); ++k) frequencies.push_back(reduced.omega(k) / whole_turn);
  return frequencies;
}

} // namespace wingspread
