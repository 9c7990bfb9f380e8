/// Exact Coulomb friction on the dense wing: each hinge slides one way or the other, or sticks.
///
/// The response is linear in the hinge moments, so a linear solve gives the moments that hold the sticking hinges. Which
/// hinges stick is found by trying every combination. core/ uses neither method.
#pragma once

#include "tests/support/dense_wing.hpp"

#include <Eigen/LU>

#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace wingspread::oracle {

template <class Scalar> class DryFriction {
public:
  explicit DryFriction(const Scene& scene) {
    for (const Hinge& hinge : scene.hinges) {
      const bool exact = hinge.friction.model == FrictionModel::exact;
      const double scale = exact ? hinge.friction.scale : 0, coulomb = hinge.friction.coulomb;
      kinetic_.push_back(scale * coulomb);
      static_.push_back(scale * hinge.friction.static_level.value_or(coulomb));
      any_ = any_ || static_.back() > 0;
    }
    contact_.assign(kinetic_.size(), 0);
  }

  /// The scene without its exact friction.
  [[nodiscard]] static Scene removed(Scene scene) {
    for (Hinge& hinge : scene.hinges) {
      if (hinge.friction.model != FrictionModel::exact) continue;
      hinge.friction.model = FrictionModel::regularized;
      hinge.friction.coulomb = 0, hinge.friction.static_level.reset();
    }
    return scene;
  }

  [[nodiscard]] bool any() const { return any_; }
  [[nodiscard]] bool acts(int hinge) const { return static_[hinge] > 0; }
  [[nodiscard]] bool sticks(int hinge) const { return acts(hinge) && contact_[hinge] == 0; }

  /// The wing's response in the present contact states. Its moments include those that hold sticking hinges.
  [[nodiscard]] WingResponse<Scalar> respond(const DenseWing<Scalar>& wing,
                                             const WingState<Scalar>& state) const {
    Vector<Scalar> moments = wing.moments(state);
    std::vector<int> held;
    for (int i = 0; i < wing.size(); ++i) {
      if (sticks(i)) held.push_back(i);
      moments(i) -= contact_[i] * kinetic_[i];
    }
    if (held.empty()) return wing.respond(state, moments);
    const Vector<Scalar> free = wing.respond(state, moments).hinge_accelerations;
    const auto size = static_cast<Eigen::Index>(held.size());
    Matrix<Scalar> yields(size, size); // acceleration of hinge j per moment at hinge k
    Vector<Scalar> unheld(size);
    for (Eigen::Index k = 0; k < size; ++k) {
      Vector<Scalar> pushed = moments;
      pushed(held[k]) += 1;
      const Vector<Scalar> more = wing.respond(state, pushed).hinge_accelerations - free;
      for (Eigen::Index j = 0; j < size; ++j) yields(j, k) = more(held[j]);
      unheld(k) = -free(held[k]);
    }
    const Vector<Scalar> holding = yields.fullPivLu().solve(unheld);
    for (Eigen::Index k = 0; k < size; ++k) moments(held[k]) += holding(k);
    WingResponse<Scalar> response = wing.respond(state, moments);
    for (const int i : held) response.hinge_accelerations(i) = 0;
    return response;
  }

  /// The moment that holds a sticking hinge minus its static friction, N·m; negative: the hinge keeps sticking.
  [[nodiscard]] Scalar excess(const DenseWing<Scalar>& wing, const WingState<Scalar>& state,
                              const WingResponse<Scalar>& response, int hinge) const {
    using std::abs;
    return abs(response.moments(hinge) - wing.moments(state)(hinge)) - static_[hinge];
  }

  /// The sense in which a hinge slides: 1 or −1, the sign of its rate; 0 if it sticks.
  [[nodiscard]] int sense(int hinge) const { return contact_[hinge]; }

  /// Decides which hinges at rest stick, and in which sense the others slide, by trying every combination.
  /// @throws std::runtime_error if no combination is consistent
  void settle(const DenseWing<Scalar>& wing, const WingState<Scalar>& state) {
    std::vector<int> at_rest;
    for (int i = 0; i < wing.size(); ++i) {
      if (!acts(i)) continue;
      const Scalar& rate = state.rates(i);
      contact_[i] = rate > 0 ? 1 : rate < 0 ? -1 : 0;
      if (rate == 0) at_rest.push_back(i);
    }
    int ways = 1;
    for (std::size_t k = 0; k < at_rest.size(); ++k) ways *= 3;
    for (int way = 0; way < ways; ++way) { // way 0: all stick
      int rest = way;
      for (const int i : at_rest) contact_[i] = std::array{0, 1, -1}[rest % 3], rest /= 3;
      if (consistent(wing, state, at_rest)) return;
    }
    throw std::runtime_error("DryFriction: no hinge can do as it must");
  }

private:
  [[nodiscard]] bool consistent(const DenseWing<Scalar>& wing, const WingState<Scalar>& state,
                                const std::vector<int>& at_rest) const {
    const WingResponse<Scalar> response = respond(wing, state);
    for (const int i : at_rest) {
      const bool can = contact_[i] == 0 ? excess(wing, state, response, i) < 0
                                        : response.hinge_accelerations(i) * contact_[i] > 0;
      if (!can) return false;
    }
    return true;
  }

  std::vector<Scalar> kinetic_, static_; ///< by hinge; static 0: no exact friction
  std::vector<int> contact_;             ///< by hinge: 1 forward, −1 backward, 0 sticks
  bool any_ = false;
};

} // namespace wingspread::oracle
