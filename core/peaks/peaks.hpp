/// The largest moment and force that a hinge sees, inside steps and not only at their ends.
#pragma once

#include "core/dense/quintic.hpp"
#include "core/mechanics/system.hpp"

#include <array>
#include <optional>
#include <vector>

namespace wingspread {

/// An accepted step and its dense output.
template <class T> struct Step {
  T t, h;
  State<T> x, dxdt;   ///< at t
  State<T> x1, dxdt1; ///< at t + h

  /// Coordinate k of q over the step; its rate stands `freedoms` further.
  [[nodiscard]] Quintic<T> coordinate(int k, int freedoms) const {
    const int r = k + freedoms;
    return hermite<T>(h, {x[k], x[r], dxdt[r]}, {x1[k], x1[r], dxdt1[r]});
  }

  /// Any component by cubic Hermite interpolation; used for the states of smoothed latches.
  [[nodiscard]] T cubic(int k, const T& s) const {
    const T r = T(1) - s;
    return r * r * (x[k] * fused(T(2), s, T(1)) + s * h * dxdt[k]) +
           s * s * (x1[k] * fused(T(2), r, T(1)) - r * h * dxdt1[k]);
  }

  /// The whole state at t + s·h.
  void interpolate(const Layout& at, const T& s, State<T>& out) const {
    const int n = at.freedoms();
    for (int k = 0; k < n; ++k) {
      const T v = h * x[k + n], a = h * h * dxdt[k + n]; // the same quintic about the start
      const T D = (x1[k] - x[k]) - fused(T(0.5), a, v);
      const T V = fused(h, x1[k + n] - x[k + n], -a), A = fused(h * h, dxdt1[k + n], -a);
      const T c3 = fused(T(10), D, fused(T(-4), V, T(0.5) * A));
      const T c4 = fused(T(-15), D, fused(T(7), V, -A));
      const T c5 = fused(T(6), D, fused(T(-3), V, T(0.5) * A));
      const T tail = fused(s, fused(s, c5, c4), c3);
      const T slope = fused(s, fused(s, T(5) * c5, T(4) * c4), T(3) * c3);
      out[k] = fused(s, fused(s, fused(s, tail, T(0.5) * a), v), x[k]);
      out[k + n] = fused(s / h, fused(s, slope, a), x[k + n]);
    }
    if (at.smoothed)
      for (int i = 1; i <= at.bodies; ++i) out[at.latch(i)] = cubic(at.latch(i), s);
  }
};

template <class T> struct PeakOf {
  T value = T(0);
  T time = T(0);

  void raise(const T& candidate, const T& when) {
    if (candidate > value && is_finite(candidate))
      value = candidate, time = when; // what overflows fails the run
  }
};

/// A function's value at a fraction of the step.
template <class T> struct Sampled { T s, value; };

/// The maximum of f near the largest of samples at the ends and at equal distances between them,
/// by parabolas through the best three points, within a bracket [Brent 1973, 5]. Good to
/// √ε, ε of T, where f is smooth, which makes the value good to ε, for f is flat there.
/// @param f f(s) → T
/// @return the best point seen, and where the last parabola has its vertex
template <class T, std::size_t N, class Function>
[[nodiscard]] std::pair<Sampled<T>, T> maximum_near(const std::array<T, N>& samples,
                                                    std::size_t best, Function f) {
  using std::abs, std::sqrt;
  const T close = sqrt(sqrt(T(epsilon_of<T>))); // a parabola over that is good to close²
  const T spacing = T(1) / T(N - 1);
  const auto sampled = [&](std::size_t k) { return Sampled<T>{T(k) * spacing, samples[k]}; };
  Sampled<T> left, middle, right;
  if (best > 0 && best < N - 1) {
    left = sampled(best - 1), middle = sampled(best), right = sampled(best + 1);
  } else { // the largest lies at an end: is there one beside it that is larger?
    const Sampled<T> end = sampled(best), next = sampled(best == 0 ? 1 : N - 2);
    const T s = (end.s + next.s) / T(2);
    middle = {s, f(s)};
    left = best == 0 ? end : next, right = best == 0 ? next : end;
  }
  const auto largest = [&](const T& vertex) -> std::pair<Sampled<T>, T> {
    if (middle.value >= left.value && middle.value >= right.value) return {middle, vertex};
    const Sampled<T>& end = left.value > right.value ? left : right;
    return {end, end.s};
  };
  T last(1), last_but_one(1); // ways from one point to the next
  for (int pass = 0; pass < 40; ++pass) {
    const T before = (middle.value - left.value) * (right.s - middle.s);
    const T after = (middle.value - right.value) * (middle.s - left.s), both = before + after;
    if (!(both > T(0))) break; // no maximum inside, or a plateau
    const T way = (before * (right.s - middle.s) - after * (middle.s - left.s)) / (T(2) * both);
    T s = middle.s + way;
    if (!(s > left.s && s < right.s)) break; // it rises to an end
    const T rightwards = right.s - middle.s, leftwards = middle.s - left.s;
    const T wider = rightwards > leftwards ? rightwards : T(-leftwards);
    if (abs(wider) < T(3) * close) return largest(s);
    if (abs(way) < close) // as it seems: a point beside makes sure
      s = middle.s + (wider > T(0) ? close : T(-close));
    else if (abs(way) > T(0.5) * last_but_one) // parabolas do not settle
      s = middle.s + wider / T(2);
    last_but_one = last, last = abs(s - middle.s);
    const Sampled<T> made{s, f(s)};
    const bool above = made.value > middle.value;
    if (s < middle.s)
      (above ? right : left) = above ? middle : made;
    else
      (above ? left : right) = above ? middle : made;
    if (above) middle = made;
  }
  return largest(middle.s);
}

/// How far below the peak a sample may lie for the maximum beside it to be looked for, times the
/// peak.
inline constexpr double sample_margin = 0.95;

/// The moment of one hinge over a step, by the dense output.
template <class T, class AnySystem> class MomentOverStep {
public:
  MomentOverStep(const AnySystem& system, const Step<T>& step, int i)
      : hinge_(system.wing().hinges[i]), step_(step), latch_state_(system.layout().latch(i)),
        epsilon_(system.epsilon()), smoothed_(system.layout().smoothed && hinge_.has_latch) {
    const Layout& at = system.layout();
    const LinearLaw<T>& law = system.work().laws[i];
    const Quintic<T> angle = step.coordinate(at.angle(i), at.freedoms());
    rate_ = derivative(angle, step.h);
    for (int k = 0; k < 6; ++k) {
      linear_[k] = linear_moment(law, angle[k], rate_[k]);
      latch_[k] = fused(hinge_.stiffness, angle[k] - hinge_.latched, hinge_.damping * rate_[k]);
    }
  }

  /// No |moment| in the step is larger, by the hulls of the polynomials; friction opposes the rate,
  /// so that it adds to one side only where the rate keeps its sign.
  [[nodiscard]] T most() const {
    T low = linear_[0], high = linear_[0], slowest = rate_[0], fastest = rate_[0];
    for (int k = 1; k < 6; ++k) {
      low = smaller(low, linear_[k]), high = larger(high, linear_[k]);
      slowest = smaller(slowest, rate_[k]), fastest = larger(fastest, rate_[k]);
    }
    low = low - select(fastest > T(0), hinge_.coulomb, T(0));
    high = high + select(slowest < T(0), hinge_.coulomb, T(0));
    const T linear = larger(high, T(-low));
    return smoothed_ ? linear + bound(latch_) : linear;
  }

  /// d²/dt² at s, by differences.
  [[nodiscard]] T bend(const T& s) const {
    const T width = T(1) / T(32), at = smaller(larger(s, width), T(T(1) - width));
    const T apart = width * step_.h;
    return ((*this)(T(at + width)) - T(2) * (*this)(at) + (*this)(T(at - width))) / (apart * apart);
  }

  [[nodiscard]] T operator()(const T& s) const {
    T m = value(linear_, s);
    if (hinge_.coulomb > T(0)) m = m + coulomb_moment(hinge_, value(rate_, s));
    if (smoothed_) m = m - smooth_step(step_.cubic(latch_state_, s) / epsilon_) * value(latch_, s);
    return m;
  }

private:
  const HingeTerms<T>& hinge_;
  const Step<T>& step_;
  int latch_state_;
  T epsilon_;
  bool smoothed_;
  Quintic<T> rate_, linear_, latch_;
};

/// Raises `peak` to the largest |moment| over the step as the dense output has it. Most steps are
/// dismissed by the hull; the others are sampled, and refined beside the largest sample.
template <class T, class AnySystem>
void raise_by_interpolant(PeakOf<T>& peak, const MomentOverStep<T, AnySystem>& moment,
                          const Step<T>& step) {
  using std::abs;
  std::array<T, 9> samples;
  std::size_t best = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    samples[k] = abs(moment(T(k) / T(samples.size() - 1)));
    if (samples[k] > samples[best]) best = k;
  }
  if (samples[best] < T(sample_margin) * peak.value) return;
  const auto [found, vertex] =
      maximum_near(samples, best, [&](const T& s) { return T(abs(moment(s))); });
  peak.raise(found.value, step.t + found.s * step.h);
  peak.raise(T(abs(moment(vertex))), step.t + vertex * step.h);
}

/// dM/dt of hinge i, which slides or has no exact friction, at a state and its derivative; without
/// a smoothed latch, N·m/s.
template <class T, class AnySystem>
[[nodiscard]] T moment_rate(const AnySystem& system, const State<T>& x, const State<T>& dxdt,
                            int i) {
  const Layout& at = system.layout();
  const LinearLaw<T>& law = system.work().laws[i];
  const T& rate = x[at.rate(i)];
  const T damping = system.wing().hinges[i].coulomb > T(0)
                        ? law.damping + coulomb_damping(system.wing().hinges[i], rate)
                        : law.damping;
  return -fused(law.stiffness, rate, damping * dxdt[at.rate(i)]);
}

/// A maximum of |moment| inside a step, known by the dense output alone.
template <class T> struct DoubtfulMoment {
  T s;    ///< fraction of the step
  T bend; ///< d²M/dt² there
  int corrections = 0;
};

/// Raises `peak` to the largest |moment| of hinge i over the step where that lies at one of its
/// ends. A maximum inside that the dense output finds must be made sure of by a step of the method
/// that ends there: then the peak has the method's accuracy, not the interpolant's.
/// @return where; `settle_moment` takes it from there
template <class T, class AnySystem>
[[nodiscard]] std::optional<DoubtfulMoment<T>>
raise_moment(PeakOf<T>& peak, const AnySystem& system, const Step<T>& step, int i) {
  using std::abs;
  const MomentOverStep<T, AnySystem> moment(system, step, i);
  if (!(moment.most() > peak.value)) return std::nullopt;
  PeakOf<T> candidate = peak;
  raise_by_interpolant(candidate, moment, step);
  if (!(candidate.value > peak.value)) return std::nullopt;
  const T s = (candidate.time - step.t) / step.h;
  constexpr double at_an_end = 1e-5; // there the interpolant is right to round-off
  if (s < T(at_an_end) || s > T(1 - at_an_end)) {
    peak = candidate;
    return std::nullopt;
  }
  peak.raise(T(abs(moment(T(0)))), step.t);
  peak.raise(T(abs(moment(T(1)))), step.t + step.h);
  return DoubtfulMoment<T>{s, moment.bend(s)};
}

/// A step of the method to `doubt.s` gave (x, dxdt): raises the peak, and corrects the instant by
/// Newton's method. @return whether a step to the new `doubt.s` is worth making
template <class T, class AnySystem>
[[nodiscard]] bool settle_moment(DoubtfulMoment<T>& doubt, PeakOf<T>& peak, const AnySystem& system,
                                 const Step<T>& step, int i, const State<T>& x,
                                 const State<T>& dxdt) {
  using std::abs;
  const T M = system.moment(x, i);
  peak.raise(T(abs(M)), step.t + doubt.s * step.h);
  const T late = system.layout().smoothed ? T(0) : T(moment_rate(system, x, dxdt, i) / doubt.bend);
  const T gain = T(0.5) * late * late * abs(doubt.bend);
  doubt.s = doubt.s - late / step.h;
  return M * doubt.bend < T(0) && gain > T(1e-12) * abs(M) && doubt.s > T(0) && doubt.s < T(1) &&
         ++doubt.corrections < 4;
}

/// The same for a hinge that sticks, whose moment takes an evaluation to know: it is at most its
/// linear part and the static limit; what that does not dismiss is sampled.
/// @param hold hold(s) evaluates on the dense output; s = 1 last
template <class T, class AnySystem, class Hold>
void raise_held_moment(PeakOf<T>& peak, const AnySystem& system, const Step<T>& step, int i,
                       Hold&& hold) {
  using std::abs;
  const T most = MomentOverStep<T, AnySystem>(system, step, i).most();
  if (!(most + system.wing().hinges[i].limit > peak.value)) return;
  for (int k = 1; k <= 4; ++k) {
    const T s = T(k) / T(4);
    peak.raise(T(abs(system.moment(hold(s), i))), step.t + s * step.h);
  }
}

/// Raises every hinge's `peaks` to its largest |reaction| over the step, given those at both ends.
/// A step with an end within a quarter of a peak is sampled at three inner points by evaluating the
/// recursion on the dense output, and refined beside the largest.
template <class T, class AnySystem> class ForcePeaks {
public:
  std::vector<PeakOf<T>> peaks; ///< 1 … n

  void start(int bodies) {
    peaks.assign(bodies + 1, {});
    before_.assign(bodies + 1, T(0));
    inner_.assign(bodies + 1, {});
    doubts_.clear();
  }

  /// |reaction| at the start of the next step, 1 … n, N.
  [[nodiscard]] std::vector<T>& before() { return before_; }

  /// The last evaluation of `system` was at t: takes the forces as they stand.
  void observe(const AnySystem& system, const T& t) {
    for (std::size_t i = 1; i < peaks.size(); ++i) {
      before_[i] = magnitude(system, static_cast<int>(i));
      peaks[i].raise(before_[i], t);
    }
  }

  /// The last evaluation was at the step's end. What lies inside the step is left in doubt.
  void over_step(AnySystem& system, const Step<T>& step, State<T>& x, State<T>& dxdt) {
    bool promising = false;
    for (std::size_t i = 1; i < peaks.size(); ++i) {
      const T end = magnitude(system, static_cast<int>(i));
      inner_[i] = {before_[i], T(0), T(0), T(0), end};
      promising = promising || T(1.25) * larger(before_[i], end) > peaks[i].value;
      before_[i] = end;
    }
    if (!promising) return;
    for (int k = 1; k <= 3; ++k) {
      evaluate(system, step, T(k) / T(4), x, dxdt);
      for (std::size_t i = 1; i < peaks.size(); ++i)
        inner_[i][k] = magnitude(system, static_cast<int>(i));
    }
    for (std::size_t i = 1; i < peaks.size(); ++i)
      raise(system, step, static_cast<int>(i), x, dxdt);
  }

  /// Where a step of the method must make sure of a maximum found by the dense output, as a
  /// fraction of the step; none if nothing is in doubt.
  [[nodiscard]] std::optional<T> doubtful() const {
    if (doubts_.empty()) return std::nullopt;
    return doubts_.back().s;
  }

  /// That step has been made, and its last evaluation was there.
  void settle(const AnySystem& system) {
    const Doubt doubt = doubts_.back();
    doubts_.pop_back();
    peaks[doubt.hinge].raise(magnitude(system, doubt.hinge), doubt.time);
  }

private:
  struct Doubt {
    int hinge;
    T s, time;
  };

  [[nodiscard]] static T magnitude(const AnySystem& system, int i) {
    using std::sqrt;
    const Vec2<T>& f = system.work().forces[i];
    return sqrt(dot(f, f));
  }

  static void evaluate(AnySystem& system, const Step<T>& step, const T& s, State<T>& x,
                       State<T>& dxdt) {
    step.interpolate(system.layout(), s, x);
    system(x, dxdt, step.t + s * step.h);
  }

  void raise(AnySystem& system, const Step<T>& step, int i, State<T>& x, State<T>& dxdt) {
    std::size_t best = 0;
    for (std::size_t k = 1; k <= 4; ++k)
      if (inner_[i][k] > inner_[i][best]) best = k;
    if (inner_[i][best] < T(sample_margin) * peaks[i].value) return;
    peaks[i].raise(inner_[i][0], step.t);
    peaks[i].raise(inner_[i][4], step.t + step.h);
    if (at_an_end_for_sure(inner_[i], best)) return;
    const auto [found, vertex] = maximum_near(inner_[i], best, [&](const T& s) {
      evaluate(system, step, s, x, dxdt);
      return magnitude(system, i);
    });
    if (found.value > peaks[i].value) doubts_.push_back({i, vertex, T(step.t + vertex * step.h)});
  }

  /// The samples rise or fall towards an end so steeply that a parabola through the last three has
  /// its vertex well outside the step.
  [[nodiscard]] static bool at_an_end_for_sure(const std::array<T, 5>& f, std::size_t best) {
    using std::abs;
    if (best != 0 && best != 4) return false;
    const T a = best == 0 ? f[0] : f[4], b = best == 0 ? f[1] : f[3], c = f[2];
    const T slope = T(3) * a - T(4) * b + c; // towards the end, times 2 spacings
    const T curvature = a - T(2) * b + c;
    return slope > T(2) * abs(curvature);
  }

  std::vector<T> before_;
  std::vector<std::array<T, 5>> inner_;
  std::vector<Doubt> doubts_; ///< last in, first out
};

} // namespace wingspread
