#include "core/proofs/rest_model.hpp"

#include "core/laws/driven_base.hpp"
#include "core/proofs/rest_search.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace wingspread {
namespace {

[[nodiscard]] Vec2<double> turned_by(double angle, const Vec2<double>& v) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v.x - s * v.y, s * v.x + c * v.y};
}

class Maker {
public:
  Maker(const Wing<double>& wing, const Workspace<double>& work, double t_end, RestModel& model)
      : wing_(wing), work_(work), t_end_(t_end), m_(model), n_(wing.size()) {}

  bool make(const double* angles, const double* rates) {
    if (!is_modelled()) return false;
    is_bounded_ = true;
    begin(angles);
    find_rest();
    add_damping(rates);
    add_dissipation(), add_loops();
    find_masses();
    find_levers();
    detail::find_remainders(wing_, m_);
    return is_finite();
  }

  bool make_linear(const double* angles, const HoldsAtRest& holds) {
    holds_ = &holds;
    begin(angles);
    const auto balance = [&] { find_balance(holds.rigid); };
    RestSearch search(m_.angles, m_.stiffness, residual_, m_.moment, balance);
    if (!search.converge()) {
      begin(angles);
      if (!search.descend()) return false;
    }
    add_damping(std::vector<double>(n_, 0.0).data());
    add_dissipation(), add_loops();
    find_masses();
    return is_finite();
  }

private:
  void begin(const double* angles) {
    resize();
    for (int i = 1; i <= n_; ++i) {
      m_.parents[i - 1] = wing_.tree.parent_of(i);
      m_.angles(i - 1) = angles[i - 1];
      m_.remainders[i - 1].motor = motor_at_rest(wing_.motors, work_.motors, i);
    }
    sum_masses();
  }

  bool is_finite() { return (m_.stiffness + m_.mass).allFinite() && m_.angles.allFinite(); }

  [[nodiscard]] bool is_modelled() const {
    const BaseTerms<double>& base = wing_.base;
    if (n_ > most_modelled_bodies || !wing_.plates.empty()) return false;
    if (base.motion == BaseMotion::prescribed && !accelerates_constantly(base, work_.driven))
      return false;
    return std::none_of(wing_.real.begin(), wing_.real.end(),
                        [](const auto& real) { return real.has_backlash; });
  }

  void resize() {
    m_.parents.resize(n_);
    for (auto* v : {&m_.angles, &m_.weight, &m_.moment, &m_.room, &residual_}) v->setZero(n_);
    for (Eigen::MatrixXd* v : {&m_.mass, &m_.stiffness, &m_.damping}) v->setZero(n_, n_);
    for (Eigen::MatrixXd* v : {&m_.lever_x, &m_.lever_y}) v->setZero(n_, n_ + 1);
    m_.turns.setZero(n_ + 1, n_);
    for (auto* v : {&m_.pushed, &m_.push_cosine, &m_.push_sine, &m_.dragged}) v->setZero(n_ + 1);
    m_.remainders.assign(n_, {});
    m_.loops.clear(), m_.pairs.clear();
    const bool driven = wing_.base.motion == BaseMotion::prescribed;
    m_.since = wing_.base.table ? work_.driven.from : 0;
    const Drive<double> drive = drive_at(wing_.base, work_.driven, m_.since);
    m_.quickening = driven && is_bounded_ ? std::abs(drive.angular_acceleration) : 0, m_.rigid = 0;
    const double last = driven && is_bounded_ ? drive_at(wing_.base, work_.driven, t_end_).rate : 0;
    m_.spin = driven ? std::max(std::abs(drive.rate), std::abs(last)) : 0;
    m_.turn_rate = driven && m_.quickening == 0 ? drive.rate : 0;
    push_ = driven && m_.quickening == 0 ? drive.felt : Vec2<double>{0, 0};
    felt_ = driven ? length(drive.felt) : 0;
    turn_.assign(n_ + 1, driven ? drive.angle : 0);
    outward_mass_.assign(n_ + 1, 0);
    own_moment_.assign(n_ + 1, {0, 0}), Y_.assign(n_ + 1, {0, 0});
  }

  /// Masses, and first moments in each body's own axes.
  void sum_masses() {
    for (int i = n_; i >= 1; --i) {
      const BodyTerms<double>& body = wing_.bodies[i];
      const int p = wing_.tree.parent_of(i);
      outward_mass_[i] += body.mass;
      outward_mass_[p] += outward_mass_[i];
      own_moment_[i] = own_moment_[i] + body.mass_moment;
      own_moment_[p] = fused(outward_mass_[i], body.arm, own_moment_[p]);
    }
    outward_mass_[0] += wing_.bodies[0].mass;
  }

  /// Finds the bodies' angles and first moments at the hinges' angles.
  void place() {
    Y_[0] = turned_by(turn_[0], own_moment_[0]);
    for (int i = 1; i <= n_; ++i) {
      turn_[i] = turn_[wing_.tree.parent_of(i)] + m_.angles(i - 1);
      Y_[i] = turned_by(turn_[i], own_moment_[i]);
    }
  }
  [[nodiscard]] Vec2<double> arm(int i) const {
    return turned_by(turn_[wing_.tree.parent_of(i)], wing_.bodies[i].arm);
  }

  // ---- rest, K and C

  [[nodiscard]] bool is_held_elastically(int i) const { return holds_ && holds_->elastic[i - 1]; }
  [[nodiscard]] LinearLaw<double> law(int i) const {
    const HingeTerms<double>& hinge = wing_.hinges[i];
    if (!is_held_elastically(i)) return linear_law(hinge, hinge.has_latch);
    LinearLaw<double> own = linear_law(hinge, false);
    add_hold(own, hinge.stowed, wing_.releases[i].stiffness, wing_.releases[i].damping);
    return own;
  }

  /// Newton's method for the balance of moments and push. The residual is counted as steady moment: few
  /// passes make bounds poor, not wrong.
  void find_rest() {
    constexpr int passes = 3;
    for (int pass = 0;; ++pass) {
      place();
      find_stiffness();
      if (pass == passes || balances()) break;
      m_.angles += m_.stiffness.partialPivLu().solve(residual_);
    }
    for (int i = 0; i < n_; ++i) m_.remainders[i].steady = std::abs(residual_(i));
  }

  /// Whether another pass would move every hinge by less than rounding.
  [[nodiscard]] bool balances() const {
    constexpr double rounding = 1e-14; // rad
    const auto least = rounding * m_.stiffness.diagonal().array();
    return (residual_.array().abs() <= least).all();
  }

  /// Finds K with the push in it, and the residual of hinges that are not held.
  void find_balance(const std::vector<char>& is_held) {
    place();
    find_stiffness();
    add_stiffness_of_loads();
    for (int i = 0; i < n_; ++i) {
      if (!is_held[i]) continue;
      m_.stiffness.row(i).setZero(), m_.stiffness.col(i).setZero();
      m_.stiffness(i, i) = 1, residual_(i) = 0;
    }
  }

  /// The push on body k, f at each unit of mass, has the stiffness Y_k·f against the turning of body k. A loop's hinge
  /// a bears −s_a g'(x_a) τ: where the gear bends, the torque τ has the stiffness g'' τ.
  void add_stiffness_of_loads() {
    for (int k = 1; k <= n_; ++k) {
      const double own = -dot(Y_[k], push_);
      for (int i = k; own != 0 && i != 0; i = wing_.tree.parent_of(i))
        for (int j = k; j != 0; j = wing_.tree.parent_of(j)) m_.stiffness(i - 1, j - 1) += own;
    }
    for (const LoopTerms<double>& loop : wing_.loops) {
      if (!loop.table) continue;
      const int a = loop.first - 1;
      const double travel = loop.sense_a * (m_.angles(a) - loop.stowed_a);
      m_.stiffness(a, a) +=
          bend(piece_at(*loop.table, travel)) * carried_by_strands(loop, state_of(loop).elastic);
    }
  }

  /// Finds K, the moments at rest, and the residual of moments and push.
  void find_stiffness() {
    m_.stiffness.setZero();
    for (int i = 1; i <= n_; ++i) {
      const LinearLaw<double> own = law(i);
      const double phi = m_.angles(i - 1);
      double& k = m_.stiffness(i - 1, i - 1) = own.stiffness;
      m_.moment(i - 1) = linear_moment(own, phi, 0.0) + m_.remainders[i - 1].motor.drive;
      if (wing_.real.empty()) continue;
      const RealHingeTerms<double>& real = wing_.real[i];
      m_.moment(i - 1) += curves_moment(real, phi);
      if (real.spring.curve) k -= real.spring.weight * slope(*real.spring.curve, phi);
      if (real.harness.curve) k -= real.harness.weight * slope(*real.harness.curve, phi);
      if (!is_bounded_) // bounds hold where no stop is touched (RestModel::room)
        for_pressed_stops(i, [&](const auto& stop, double depth) {
          k += stop.stiffness;
          m_.moment(i - 1) += stop.sense * stop.stiffness * depth;
        });
    }
    for (const LoopTerms<double>& loop : wing_.loops) {
      const LoopState<double> at = state_of(loop);
      const double tau = carried_by_strands(loop, at.elastic);
      m_.moment(loop.first - 1) += on_first(loop, at.gear) * tau;
      m_.moment(loop.second - 1) += on_second(loop) * tau;
      add(m_.stiffness, loop, at, taut_share(loop, at.elastic) * loop.stiffness);
    }
    residual_ = m_.moment;
    if (m_.turn_rate != 0) return;
    for (int k = 1; k <= n_; ++k) // the push turns body k, and with it what it hangs on
      for (int i = k; i != 0; i = wing_.tree.parent_of(i))
        residual_(i - 1) += dot(turned(Y_[k]), scaled(-1.0, push_));
  }

  /// Calls take(stop, depth > 0) for the stops that hinge i presses at rest.
  void for_pressed_stops(int i, auto&& take) const {
    const RealHingeTerms<double>& real = wing_.real[i];
    for (const StopTerms<double>* stop : {&real.stop, &real.far_stop}) {
      const double depth =
          stop->present ? stop->sense * (stop->contact_angle - m_.angles(i - 1)) : 0;
      if (depth > 0) take(*stop, depth);
    }
  }

  [[nodiscard]] LoopState<double> state_of(const LoopTerms<double>& loop) const {
    return loop_state(loop, m_.angles(loop.first - 1), 0.0, m_.angles(loop.second - 1), 0.0);
  }

  static void add(Eigen::MatrixXd& to, const LoopTerms<double>& loop, const LoopState<double>& at,
                  double strength) {
    const int a = loop.first - 1, b = loop.second - 1;
    const double on_a = on_first(loop, at.gear), on_b = on_second(loop);
    to(a, a) += strength * on_a * on_a, to(b, b) += strength * on_b * on_b;
    to(a, b) += strength * on_a * on_b, to(b, a) += strength * on_a * on_b;
  }

  void add_damping(const double* rates) {
    for (int i = 1; i <= n_; ++i) {
      double& own = m_.damping(i - 1, i - 1) = law(i).damping + m_.remainders[i - 1].motor.taken;
      if (wing_.real.empty() || !wing_.real[i].has_damper) continue;
      if (!detail::damper_acts_at_rest(wing_.real[i], m_.angles(i - 1))) continue;
      RestModel::Remainder& left = m_.remainders[i - 1];
      left.damper = wing_.real[i].damper;
      left.taken = secant(*left.damper, std::abs(rates[i - 1]));
      if (left.damper->law == DamperLaw::power)
        left.tuned_for = std::max(std::abs(rates[i - 1]), left.damper->rate);
      own += left.taken;
    }
  }

  /// Adds k c |e*|, the damping at rest of a latch that damps by k c |e|, and to the linear model k c δ* of a stop. Off
  /// rest | |e* + u| − |e*| | ≤ |u|, on either side of e = 0: f is at most k c |u| |v|.
  void add_dissipation() {
    for (int i = 1; i < static_cast<int>(wing_.real.size()); ++i) {
      if (!is_bounded_)
        for_pressed_stops(i, [&](const auto& stop, double depth) {
          m_.damping(i - 1, i - 1) += stop.stiffness * stop.dissipation * depth;
        });
      const LatchDissipationTerms<double>& latch = wing_.real[i].dissipation;
      if (!latch.present || is_held_elastically(i)) continue;
      m_.damping(i - 1, i - 1) += latch.strength * std::abs(m_.angles(i - 1) - latch.latched);
      m_.remainders[i - 1].dissipation = latch.strength;
    }
  }

  void add_loops() {
    for (const LoopTerms<double>& loop : wing_.loops) {
      const LoopState<double> at = state_of(loop);
      add(m_.damping, loop, at, taut_share(loop, at.elastic) * loop.damping);
      const double torque = std::abs(carried_by_strands(loop, at.elastic));
      const double until_slack = loop.slack_beyond - std::abs(at.elastic);
      RestModel::Loop kept{loop.first - 1, loop.second - 1, torque,     std::abs(at.gear), 0,
                           loop.stiffness, loop.damping,    until_slack};
      if (loop.table) {
        kept.gear = most_change_of_slope(*loop.table, 0); // from 0
        kept.gear_changes = most_change_of_slope(*loop.table, at.gear);
      }
      m_.loops.push_back(kept);
    }
  }

  // ---- masses

  [[nodiscard]] bool is_free() const { return wing_.base.motion == BaseMotion::free; }
  /// (1), S and M_0.
  void find_masses() {
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n_ + 1, n_ + 1); // in absolute rates
    Eigen::MatrixXd s = M;                                     // A × Y
    M(0, 0) = wing_.bodies[0].inertia;
    for (int l = 1; l <= n_; ++l) {
      M(l, l) += wing_.bodies[l].inertia;
      const int p = wing_.tree.parent_of(l);
      M(p, p) += outward_mass_[l] * dot(arm(l), arm(l));
      for (int k = p, outer = l;; outer = k, k = wing_.tree.parent_of(k)) {
        const Vec2<double> A = arm(outer);
        M(k, l) = M(l, k) = dot(A, Y_[l]);
        s(k, l) = s(l, k) = cross(A, Y_[l]);
        if (k == 0) break;
      }
    }
    if (m_.quickening != 0)
      for (int k = 1; k <= n_; ++k)
        m_.dragged(k) = m_.quickening * std::abs(M.row(k).sum()) + felt_ * length(Y_[k]);
    if (is_free()) refer_to_center(M, s);
    find_turns(M);
    m_.mass = m_.turns.transpose() * M * m_.turns;
    find_pairs(M, s);
  }
  void refer_to_center(Eigen::MatrixXd& M, Eigen::MatrixXd& s) const {
    const double share = 1 / outward_mass_[0];
    for (int k = 0; k <= n_; ++k)
      for (int l = k; l <= n_; ++l) {
        M(k, l) -= share * dot(Y_[k], Y_[l]), M(l, k) = M(k, l);
        s(k, l) -= share * cross(Y_[k], Y_[l]), s(l, k) = s(k, l);
      }
  }

  void find_turns(const Eigen::MatrixXd& M) {
    for (int k = 1; k <= n_; ++k) {
      m_.turns.row(k) = m_.turns.row(wing_.tree.parent_of(k));
      m_.turns(k, k - 1) = 1;
    }
    if (!is_free()) return;
    m_.rigid = 1 / M.sum();
    const Eigen::RowVectorXd back = m_.rigid * (M.colwise().sum() * m_.turns);
    m_.turns.rowwise() -= back;
  }

  void find_pairs(const Eigen::MatrixXd& M, const Eigen::MatrixXd& s) {
    const bool base_turns = is_free() || m_.spin != 0;
    for (int l = 1; l <= n_; ++l)
      for (int k = base_turns ? 0 : 1; k < l; ++k)
        if (M(k, l) != 0 || s(k, l) != 0)
          m_.pairs.push_back({k, l, meeting(k, l), std::abs(M(k, l)), std::abs(s(k, l))});
  }

  /// The outermost body that is inward of both, or is one of them.
  [[nodiscard]] int meeting(int k, int l) const {
    while (k != l) (k > l ? k : l) = wing_.tree.parent_of(std::max(k, l));
    return k;
  }

  /// Finds Y_ik, the first moment of what is outward of hinge i that body k's turning moves.
  void find_levers() {
    for (int i = 1; i <= n_; ++i) {
      m_.pushed(i) = length(push_) * length(Y_[i]), m_.weight(i - 1) = felt_ * outward_mass_[i];
      if (m_.turn_rate != 0) {
        const Vec2<double> along = turned(Y_[i]), felt = scaled(-1.0, push_);
        m_.push_cosine(i) = dot(along, felt), m_.push_sine(i) = dot(turned(along), felt);
      }
      for (int k = wing_.tree.parent_of(i), outer = i;; outer = k, k = wing_.tree.parent_of(k)) {
        set_lever(i, k, scaled(outward_mass_[i], arm(outer)));
        if (k == 0) break;
      }
      for (int k = i; k != 0; k = wing_.tree.parent_of(k)) set_lever(k, i, Y_[i]);
    }
    if (!is_free()) return;
    for (int i = 1; i <= n_; ++i) // relative to the centre of mass, which nothing accelerates
      for (int k = 0; k <= n_; ++k) {
        const double share = outward_mass_[i] / outward_mass_[0];
        m_.lever_x(i - 1, k) -= share * Y_[k].x, m_.lever_y(i - 1, k) -= share * Y_[k].y;
      }
  }
  void set_lever(int i, int k, const Vec2<double>& v) {
    m_.lever_x(i - 1, k) = v.x, m_.lever_y(i - 1, k) = v.y;
  }

  const Wing<double>& wing_;
  const Workspace<double>& work_;
  double t_end_;                       ///< of bounds
  bool is_bounded_ = false;            ///< not the linear model alone
  const HoldsAtRest* holds_ = nullptr; ///< of the linear model
  RestModel& m_;
  int n_;
  Vec2<double> push_{0, 0}; ///< in the directions that K and the rest know, m/s²
  double felt_ = 0;         ///< |a|, m/s²
  Eigen::VectorXd residual_;
  std::vector<double> outward_mass_, turn_;
  std::vector<Vec2<double>> own_moment_; ///< Y in the body's own axes
  std::vector<Vec2<double>> Y_;          ///< 1 … n
};

} // namespace

bool make_rest_model(const Wing<double>& wing, const Workspace<double>& work, const double* angles,
                     const double* rates, double t_end, RestModel& model) {
  return Maker(wing, work, t_end, model).make(angles, rates);
}

bool make_linear_model(const Wing<double>& wing, const double* angles, const HoldsAtRest& holds,
                       RestModel& model) {
  Workspace<double> at_the_end;
  for (std::size_t i = 0; i < wing.motors.size(); ++i)
    at_the_end.motors.push_back(i > 0 && holds.elastic[i - 1] ? idle_motor<double>()
                                                              : last_motor_piece(wing.motors[i]));
  return Maker(wing, at_the_end, 0, model).make_linear(angles, holds);
}

} // namespace wingspread
