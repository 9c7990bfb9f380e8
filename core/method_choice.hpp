/// `auto`: which method integrates, chosen anew while the run goes on.
///
/// A phase begins with an explicit method, which resolves the shock of a latch best: of order 5,
/// or, below a tolerance measured to be the break-even, of order 8. Once what is fast has died out
/// and its steps are held back by stability and no longer by accuracy, the linearly implicit
/// extrapolation is tried; it keeps the work where it gets further for its cost, and gives it back
/// where it does not.
///
/// Whether stability holds a step back is seen from h·ρ, ρ the spectral radius of the linear model
/// [0 E2; −M⁻¹K −M⁻¹D] of springs, latches and friction at the present configuration.
#pragma once

#include "core/steppers.hpp"

#include <algorithm>
#include <cmath>

namespace wingspread {

/// Power iteration for ρ, with its storage.
template <class T> class SpectralRadius {
public:
  /// Largest |λ| of the linear model at (x, t), 1/s, within about a fifth. From a fixed start; each
  /// pass is one solve of the recursion. Cost about six evaluations.
  template <class AnySystem>
  [[nodiscard]] double estimate(AnySystem& system, const State<T>& x, const T& t) {
    const int size = system.layout().freedoms();
    system.factorize_at(x, t, [](int) { return T(0); });
    q_.assign(size, T(0)), next_.assign(size, T(0)), v_.resize(size);
    for (int k = 0; k < size; ++k) v_[k] = T(k % 2 == 0 ? 1 : -1) / T(k + 1);
    const double first = growth(system, x, 0);
    return first > 0 ? growth(system, x, first) : 0;
  }

private:
  static constexpr int passes = 8;

  /// Geometric mean of the growth over some passes, in the norm max(|v|, weight·|q|): with q one
  /// pass behind v and weight ≈ |λ|, a complex pair does not make it oscillate.
  template <class AnySystem> double growth(AnySystem& system, const State<T>& x, double weight) {
    double logarithm = 0, before = norm(weight);
    for (int pass = 0; pass < passes; ++pass) {
      apply(system, x);
      const double after = norm(weight);
      if (!(after > 1e-200) || !(before > 1e-200)) return 0;
      logarithm += std::log(after / before);
      for (std::size_t k = 0; k < v_.size(); ++k)
        q_[k] = q_[k] / T(after), v_[k] = v_[k] / T(after);
      before = 1;
    }
    return std::exp(logarithm / passes);
  }

  /// (q, v) → (v, −M⁻¹(Kq + Dv))
  template <class AnySystem> void apply(AnySystem& system, const State<T>& x) {
    const Layout& at = system.layout();
    system.solve(
        [&](int i) {
          const auto hinge = system.resistance(x, i);
          const int k = at.angle(i);
          return -fused(hinge.stiffness, q_[k], hinge.damping * v_[k]);
        },
        next_.data());
    std::swap(q_, v_);
    std::swap(v_, next_);
  }

  [[nodiscard]] double norm(double weight) const {
    double largest = 0;
    for (std::size_t k = 0; k < v_.size(); ++k)
      largest = std::max({largest, std::abs(static_cast<double>(v_[k])),
                          weight * std::abs(static_cast<double>(q_[k]))});
    return largest;
  }

  State<T> q_, v_, next_;
};

/// Which method is active, and when that changes.
class MethodChoice {
public:
  /// @param asked a name from `methods()`
  /// @param smoothed whether latches are: their steps have two derivatives, and order 8 gains
  /// nothing
  MethodChoice(const std::string& asked, double rtol, bool smoothed) : automatic_(asked == "auto") {
    explicit_ = rtol < break_even && !smoothed ? Method::dop853 : Method::dopri5;
    for (std::size_t k = 0; k < method_names.size(); ++k)
      if (method_names[k] == asked) explicit_ = static_cast<Method>(k);
    active_ = explicit_;
  }

  [[nodiscard]] Method active() const { return active_; }
  [[nodiscard]] bool automatic() const { return automatic_; }

  /// A phase begins. @param radius ρ there, 1/s
  void restart(double radius) {
    active_ = explicit_;
    radius_ = radius;
    steps_ = 0;
    held_back_ = 0;
    patience_ = first_patience;
    wait_ = 0;
  }

  /// Whether ρ should be measured anew before the next step.
  [[nodiscard]] bool wants_radius() const { return automatic_ && steps_ % 64 == 63; }
  /// Whether it should be after the next step.
  [[nodiscard]] bool radius_is_due() const { return automatic_ && steps_ % 64 == 62; }
  void set_radius(double radius) { radius_ = radius; }

  /// Whether after a step of h another method may have to be thought of: `after_step` then needs to
  /// know how quickly things change.
  [[nodiscard]] bool may_leave(double h) const {
    return automatic_ && (active_ != explicit_ || (held_back_ + 1 >= enough && wait_ <= 1 &&
                                                   h > held_back * stable_step()));
  }

  /// A step of h was accepted. @param evaluations of the run so far
  /// @param quickness by how much the motion changes in a unit of time, 1/s
  /// @return whether another method goes on from here
  [[nodiscard]] bool after_step(double h, long evaluations, double quickness) {
    if (!automatic_) return false;
    ++steps_;
    return active_ == explicit_ ? leave_explicit(h, evaluations, quickness)
                                : leave_implicit(h, evaluations);
  }

  /// The step that the method now active should try first.
  [[nodiscard]] double first_step(double h) const {
    return active_ == explicit_ ? std::min(h, 0.5 * stable_step()) : h;
  }

private:
  static constexpr double break_even = 5e-3; // rtol; see the work-precision study
  static constexpr int enough = 10;          // steps in a row held back by stability
  static constexpr int long_enough = 100;    // to try without promise
  static constexpr double held_back = 0.4;   // of the stable step: what such a step has at least
  /// An implicit step costs as much as about ten explicit ones, and cannot be much longer than the
  /// motion takes to change: where the stable step is a larger part of that, it cannot pay.
  static constexpr double worth_trying = 0.02;
  static constexpr int trial = 5; // steps that the implicit method has to get going
  static constexpr int first_patience =
      64; // steps before it is tried again, doubled each time up to
  static constexpr int longest_patience = 512;
  /// Cost of an evaluation with the solves that go with it, in those of an explicit method
  /// (measured).
  static constexpr double implicit_cost = 1.5;

  [[nodiscard]] double stable_step() const {
    const double limit = explicit_ == Method::dop853 ? DormandPrince853<double>::stable_real
                                                     : DormandPrince5<double>::stable_real;
    return radius_ > 0 ? limit / radius_ : 1e300;
  }

  /// Starts to measure how far a stretch of steps gets.
  void measure_from(long evaluations) {
    travelled_ = 0;
    evaluations_ = evaluations;
  }
  [[nodiscard]] double speed_until(long evaluations) const {
    return travelled_ / static_cast<double>(std::max(evaluations - evaluations_, 1L));
  }

  [[nodiscard]] bool leave_explicit(double h, long evaluations, double quickness) {
    if (wait_ > 0) --wait_;
    travelled_ += h;
    if (!(h > held_back * stable_step())) {
      held_back_ = 0;
      measure_from(evaluations);
      return false;
    }
    if (++held_back_ < enough || wait_ > 0) return false;
    if (!(stable_step() * quickness < worth_trying) && held_back_ < long_enough) {
      wait_ = enough;
      return false;
    }
    explicit_speed_ = speed_until(evaluations);
    active_ = Method::seulex;
    tried_ = 0;
    return true;
  }

  [[nodiscard]] bool leave_implicit(double h, long evaluations) {
    travelled_ += h;
    ++tried_;
    if (tried_ == trial - 2) measure_from(evaluations); // it has found its order and step
    if (tried_ < trial) return false;
    const bool pays = speed_until(evaluations) / implicit_cost > explicit_speed_;
    tried_ = trial - 3;
    if (pays) return false;
    active_ = explicit_;
    held_back_ = 0;
    wait_ = patience_;
    patience_ = std::min(2 * patience_, longest_patience);
    return true;
  }

  bool automatic_;
  Method explicit_ = Method::dopri5, active_ = Method::dopri5;
  double radius_ = 0, travelled_ = 0, explicit_speed_ = 0;
  long steps_ = 0, evaluations_ = 0;
  int held_back_ = 0, tried_ = 0, wait_ = 0, patience_ = first_patience;
};

} // namespace wingspread
