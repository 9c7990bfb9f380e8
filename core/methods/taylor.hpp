/// Power series of a wing's motion on a base that does not move: a Taylor method.
///
/// Every coefficient follows from those before it by sums of products. In absolute angles θ_j of a chain, with z =
/// e^(iθ) and vectors of the plane as complex numbers, Newton and Euler about each hinge read
///
///     J_j α_j + Re( conj(i z_j) S_j ) = τ_j − τ_(j+1)                                        (1)
///     S_j = Σ_m W_jm z̈_m  over all other bodies m                                            (2)
///     W_jm = conj(l_(j+1)) B_m where m is beyond j,  W_mj = conj(W_jm)                       (3)
///     ż = i ω z,  ω̇ = α                                                                      (4)
///
/// | symbol | meaning                                                                       | unit  |
/// |--------|-------------------------------------------------------------------------------|-------|
/// | l_j    | the way from the parent's hinge to hinge j, in the parent's frame             | m     |
/// | B_j    | first moment about hinge j of body j and of the mass of all bodies beyond it, |       |
/// |        | put at hinge j + 1; body j's frame                                            | kg·m  |
/// | J_j    | moment of inertia of the same masses about hinge j                            | kg·m² |
/// | τ_j    | moment of hinge j                                                             | N·m   |
///
/// (2) is linear with constant coefficients. Each body and order needs four sums of products: two for z, two for (1).
/// In the coefficient of order k of z̈ only i z_0 α_k is unknown, so (1) is a linear system with the same matrix for
/// all orders [Jorba & Zou, A software package for the numerical integration of ODEs by means of high-order
/// Taylor methods, 2005].
///
/// Hinge moments are linear laws.
#pragma once

#include "core/mechanics/system.hpp"
#include "core/methods/method.hpp"
#include "core/number/power.hpp"

#include <array>

namespace wingspread {

/// Whether a wing's motion has power series: a chain of up to longest_static_chain bodies on a fixed base, with linear
/// laws only: no air, Coulomb friction, motors, loops or real hinges. (Viscous friction is linear.) Regularized
/// friction is smooth, but there the last terms do not bound the rest of the series. Holds are excluded too.
template <class T> [[nodiscard]] bool has_series(const Wing<T>& wing) {
  return wing.base.motion == BaseMotion::fixed && wing.size() <= longest_static_chain &&
         is_chain(wing.tree) && !wing.is_nonlinear() && wing.plates.empty() && !wing.can_stick &&
         wing.releases.empty();
}

template <class T> class TaylorSeries {
public:
  static constexpr int order = 16, error_order = 15;
  static constexpr bool ends_with_stage = false;
  static constexpr int evaluations = order + 1; ///< each order counts as one evaluation
  static constexpr double longest_growth = 4;   ///< from step to step
  /// As in runge_kutta.hpp; steppers_stability_test.cpp measures them.
  static constexpr double stable_real = 6.080, stable_imaginary = 3.325;

  TaylorSeries() {
    for (int k = 0; k < static_cast<int>(inverse_of_.size()); ++k) {
      number_[k] = T(k), inverse_of_[k] = T(1) / T(k);
      minus_number_[k] = -number_[k], minus_inverse_of_[k] = -inverse_of_[k];
    }
  }

  /// @param h the step to try; made shorter where the last terms would exceed the tolerance
  /// @param error of the rates and of the angles: twice the larger of the last two terms (`margin`). One of the two
  ///              may vanish, as those of odd or of even order do in some motions
  /// @pre has_series(system.wing()), and latches are not smoothed
  template <class AnySystem>
  void estimate(AnySystem& system, const Start<T>& from, T& h, State<T>& x1, State<T>& dxdt1,
                State<T>& error, const T& rtol, const T& atol) {
    if constexpr (AnySystem::base_motion == BaseMotion::fixed) {
      expand(system, from);
      h = smaller(h, longest(system.layout(), from.x, rtol, atol));
      sum(system, from.x, h, x1, error);
      system.writable_workspace().evaluations += order;
    }
    evaluate_end(system, x1, dxdt1, T(from.t + h));
  }

  /// The state at h inside a step. @pre h is not beyond the accepted step from `from`
  template <class AnySystem>
  void inside(const AnySystem& system, const Start<T>& from, const T& h, State<T>& x) {
    if constexpr (AnySystem::base_motion == BaseMotion::fixed) {
      expand(system, from);
      error_.resize(from.x.size());
      sum(system, from.x, h, x, error_);
    }
  }

private:
  /// Coefficients of t^0, t^1, … of one body.
  struct Series {
    std::array<T, order + 2> cosine, sine;
    std::array<T, order + 1> rate;       ///< ω
    std::array<T, order + 1> relative;   ///< φ̇
    std::array<T, order + 2> angle;      ///< φ, but for order 0
    std::array<T, order> pull_x, pull_y; ///< S
  };

  /// Constants of all orders: the inverse of (1)'s matrix, W of (3), and i W_jm z_m0, by which α_m enters S_j last.
  template <int N> struct Constants {
    std::array<std::array<T, N>, N> inverse;
    std::array<std::array<Vec2<T>, N>, N> W, by_alpha;
  };

  template <class AnySystem> void expand(const AnySystem& system, const Start<T>& from) {
    using Topology = std::decay_t<decltype(system.topology())>;
    if constexpr (is_static<Topology>) {
      expand_chain<Topology::bodies()>(system, from);
    } else {
      static_assert(longest_static_chain == 4, "a case for each length that has_series allows");
      switch (system.topology().bodies()) {
      case 1:
        return expand_chain<1>(system, from);
      case 2:
        return expand_chain<2>(system, from);
      case 3:
        return expand_chain<3>(system, from);
      case 4:
        return expand_chain<4>(system, from);
      default:
        return;
      }
    }
  }

  /// All coefficients of a chain of N bodies.
  template <int N, class AnySystem>
  void expand_chain(const AnySystem& system, const Start<T>& from) {
    Constants<N> constant;
    set_first_orders<N>(system, from);
    prepare(system.wing(), constant);
    for (int k = 0; k < order; ++k) add_order(system, constant, from, k);
  }

  /// Order 0, and z of order 1.
  template <int N, class AnySystem>
  void set_first_orders(const AnySystem& system, const Start<T>& from) {
    const Layout& at = system.layout();
    T angle(0), rate(0);
    for (int j = 0; j < N; ++j) {
      Series& own = bodies_[j];
      own.relative[0] = own.angle[1] = from.x[at.rate(j + 1)];
      angle = j == 0 ? from.x[at.angle(1)] : T(angle + from.x[at.angle(j + 1)]);
      rate = j == 0 ? own.relative[0] : T(rate + own.relative[0]);
      own.rate[0] = rate;
      const SineCosine<T> start = sine_cosine(angle);
      own.cosine[0] = start.cosine, own.sine[0] = start.sine;
      own.cosine[1] = -(rate * start.sine), own.sine[1] = rate * start.cosine;
    }
  }

  /// W_jm = conj(l_(j+1)) B_m where m hangs on j, and conj(W_mj). The matrix of (1) is Re(conj(z_j) W_jm z_m) beside
  /// J, positive definite.
  template <int N> void prepare(const Wing<T>& wing, Constants<N>& constant) const {
    T mass(0);
    Vec2<T> moment{T(0), T(0)}; // of what hangs on a body, and its own
    std::array<std::array<T, N>, N>& m = constant.inverse;
    for (int j = N - 1; j >= 0; --j) {
      const BodyTerms<T>& own = wing.bodies[j + 1];
      m[j][j] = own.inertia;
      moment = own.mass_moment;
      if (j + 1 < N) {
        const Vec2<T>& arm = wing.bodies[j + 2].arm;
        moment = fused(mass, arm, moment);
        m[j][j] = fused(mass, dot(arm, arm), m[j][j]);
      }
      mass = mass + own.mass;
      for (int i = 0; i < j; ++i) {
        const Vec2<T>& arm = wing.bodies[i + 2].arm;
        const Vec2<T> w = conjugate_times(arm, moment, {T(0), T(0)});
        constant.W[i][j] = w, constant.W[j][i] = {w.x, -w.y};
      }
    }
    for (int j = 0; j < N; ++j)
      for (int i = 0; i < N; ++i) {
        if (i == j) continue;
        const Series &of = bodies_[i], &on = bodies_[j];
        const Vec2<T> turned_by = times(constant.W[j][i], {of.cosine[0], of.sine[0]}, {T(0), T(0)});
        constant.by_alpha[j][i] = {-turned_by.y, turned_by.x};
        m[j][i] = fused(on.cosine[0], turned_by.x, on.sine[0] * turned_by.y);
      }
    invert(m);
  }

  /// Inverts in place by Gauss–Jordan elimination, without pivoting: the matrix is positive definite.
  template <std::size_t N> static void invert(std::array<std::array<T, N>, N>& m) {
    for (std::size_t p = 0; p < N; ++p) {
      const T scale = T(1) / m[p][p];
      m[p][p] = T(1);
      for (T& v : m[p]) v = v * scale;
      for (std::size_t r = 0; r < N; ++r) {
        if (r == p) continue;
        const T f = -m[r][p];
        m[r][p] = T(0);
        for (std::size_t c = 0; c < N; ++c) m[r][c] = fused(f, m[p][c], m[r][c]);
      }
    }
  }

  /// Computes order k of S, k + 1 of ω and k + 2 of z. Terms with the newest coefficients are added last, so that the
  /// processor need not wait for them in the sums before.
  // Without the attributes of this class and of sine_cosine.hpp seed wings in lanes take 6 % more instructions
  // (callgrind, AVX2).
  template <class AnySystem, int N>
  [[gnu::always_inline]] void add_order(const AnySystem& system, const Constants<N>& constant,
                                        const Start<T>& from, int k) {
    Series* const body = bodies_.data();
    // x, y: order k + 1 of ω sin θ, ω cos θ, without ω_(k+1); up, down: order k of S_x sin θ, S_y cos θ, without S_k
    std::array<T, N> x, y, up, down, load, resistance, alpha;
    std::array<Vec2<T>, N> bent, pull; // z̈ of order k, without α_k
#pragma GCC unroll 4
    for (int j = 0; j < N; ++j) x[j] = y[j] = up[j] = down[j] = T(0);
    for (int l = 1; l < k; ++l)
#pragma GCC unroll 4
      for (int j = 0; j < N; ++j) {
        const Series& own = body[j];
        const T &sine = own.sine[k + 1 - l], &cosine = own.cosine[k + 1 - l];
        x[j] = fused(own.rate[l], sine, x[j]);
        y[j] = fused(own.rate[l], cosine, y[j]);
        up[j] = fused(own.pull_x[l - 1], sine, up[j]);
        down[j] = fused(own.pull_y[l - 1], cosine, down[j]);
      }
#pragma GCC unroll 4
    for (int j = 0; j < N; ++j) {
      const Series& own = body[j];
      x[j] = fused(own.rate[0], own.sine[k + 1], x[j]);
      y[j] = fused(own.rate[0], own.cosine[k + 1], y[j]);
      if (k > 0) {
        x[j] = fused(own.rate[k], own.sine[1], x[j]);
        y[j] = fused(own.rate[k], own.cosine[1], y[j]);
        up[j] = fused(own.pull_x[k - 1], own.sine[1], up[j]);
        down[j] = fused(own.pull_y[k - 1], own.cosine[1], down[j]);
      }
      bent[j] = {minus_number_[k + 1] * x[j], number_[k + 1] * y[j]};
      resistance[j] = resistance_of(system, from, j, k);
    }
#pragma GCC unroll 4
    for (int j = 0; j < N; ++j) {
      const Series& own = body[j];
      pull[j] = {T(0), T(0)};
#pragma GCC unroll 4
      for (int m = 0; m < N; ++m)
        if (m != j) pull[j] = times(constant.W[j][m], bent[m], pull[j]);
      T due = (up[j] - down[j]) - resistance[j];
      if (j + 1 < N) due = due + resistance[j + 1];
      load[j] = fused(own.sine[0], pull[j].x, fused(T(-own.cosine[0]), pull[j].y, due));
    }
#pragma GCC unroll 4
    for (int j = 0; j < N; ++j) {
      alpha[j] = constant.inverse[j][0] * load[0];
#pragma GCC unroll 4
      for (int m = 1; m < N; ++m) alpha[j] = fused(constant.inverse[j][m], load[m], alpha[j]);
    }
#pragma GCC unroll 4
    for (int j = 0; j < N; ++j) {
      Series& own = body[j];
#pragma GCC unroll 4
      for (int m = 0; m < N; ++m)
        if (m != j) pull[j] = fused(alpha[m], constant.by_alpha[j][m], pull[j]);
      own.pull_x[k] = pull[j].x, own.pull_y[k] = pull[j].y;
      const T rate = alpha[j] * inverse_of_[k + 1];
      own.rate[k + 1] = rate;
      own.relative[k + 1] = j == 0 ? rate : T(rate - body[j - 1].rate[k + 1]);
      own.angle[k + 2] = own.relative[k + 1] * inverse_of_[k + 2];
      own.cosine[k + 2] = fused(rate, own.sine[0], x[j]) * minus_inverse_of_[k + 2];
      own.sine[k + 2] = fused(rate, own.cosine[0], y[j]) * inverse_of_[k + 2];
    }
  }

  /// Order k of −τ_j.
  template <class AnySystem>
  [[nodiscard, gnu::always_inline]] T resistance_of(const AnySystem& system, const Start<T>& from,
                                                    int j, int k) {
    const LinearLaw<T>& law = system.work().laws[j + 1];
    const Series& own = bodies_[j];
    if (k == 0) return -linear_moment(law, from.x[system.layout().angle(j + 1)], own.relative[0]);
    return fused(law.stiffness, own.angle[k], law.damping * own.relative[k]);
  }

  /// a·b + c of complex numbers.
  [[nodiscard, gnu::always_inline]] static Vec2<T> times(const Vec2<T>& a, const Vec2<T>& b,
                                                         const Vec2<T>& c) {
    return {fused(a.x, b.x, fused(T(-a.y), b.y, c.x)), fused(a.x, b.y, fused(a.y, b.x, c.y))};
  }
  /// conj(a)·b + c.
  [[nodiscard, gnu::always_inline]] static Vec2<T>
  conjugate_times(const Vec2<T>& a, const Vec2<T>& b, const Vec2<T>& c) {
    return {fused(a.x, b.x, fused(a.y, b.y, c.x)), fused(a.x, b.y, fused(T(-a.y), b.x, c.y))};
  }

  /// Sums the series: the state after a step h, and its error as `estimate` states it.
  template <class AnySystem>
  [[gnu::always_inline]] void sum(const AnySystem& system, const State<T>& x, const T& h,
                                  State<T>& x1, State<T>& error) const {
    using std::abs;
    const Layout& at = system.layout();
    const T h2 = h * h, h4 = h2 * h2, h8 = h4 * h4;
    const T last = h8 * h8, before = h8 * h4 * h2 * h;
    for (int i = 1; i <= at.bodies; ++i) {
      const auto& r = bodies_[i - 1].relative;
      const auto& a = bodies_[i - 1].angle;
      T angle = a[order + 1], rate = r[order];
      for (int k = order - 1; k >= 0; --k) {
        rate = fused(rate, h, r[k]);
        angle = fused(angle, h, a[k + 1]);
      }
      const T term = larger(T(abs(r[order]) * last), T(abs(r[order - 1]) * before));
      x1[at.rate(i)] = rate, x1[at.angle(i)] = fused(h, angle, x[at.angle(i)]);
      error[at.rate(i)] = term * T(margin);
      error[at.angle(i)] = term * (h * T(margin / order));
    }
  }

  /// The longest step at which the larger of the last two terms is still its share of the tolerance, less 1 %. The two
  /// terms before must be small as well, because three of four terms vanish for a wing that is folded straight and set
  /// in motion from rest by constant moments.
  [[nodiscard]] T longest(const Layout& at, const State<T>& x, const T& rtol, const T& atol) const {
    using std::abs;
    // Heuristic, in tolerances. In motions without vanishing terms the last two terms set the step, and the two before
    // stay below this value. Smaller: they set it, and steps get shorter.
    constexpr double small = 4;
    std::array<T, 4> terms;
    for (T& term : terms) term = T(1e-300);
    for (int i = 1; i <= at.bodies; ++i) {
      const auto& r = bodies_[i - 1].relative;
      const T per_tolerance = T(1) / fused(rtol, T(abs(x[at.rate(i)])), atol);
      for (int k = 0; k < 4; ++k) terms[k] = larger(terms[k], T(abs(r[order - k]) * per_tolerance));
    }
    T h(1e300);
    for (int k = 0; k < 4; ++k)
      h = smaller(h, root(T(terms[k] * T(k < 2 ? margin / share : 1 / small)), order - k));
    return T(0.99) * h;
  }

  /// v^(−1/n), to 1e-6.
  [[nodiscard]] static T root(const T& v, int n) {
    const T bounded = smaller(v, T(1e300));
    if constexpr (is_one_number<T>)
      return T(power_roughly(static_cast<double>(bounded), -1.0 / n));
    else
      return exp2_roughly(T(T(-1.0 / n) * log2_roughly(bounded)));
  }

  static constexpr double margin = 2; ///< the terms left out may be as large as the last two
  /// Share of the tolerance to which steps are fitted. Heuristic: errors of 18,000 steps from random states of random
  /// chains then were at most 0.12 tolerances (measured once; no driver repeats it). Larger: errors nearer to the tolerance,
  /// steps longer by the 16th root.
  static constexpr double share = 1.0 / 32;

  std::array<T, order + 3> number_, inverse_of_, minus_number_,
      minus_inverse_of_; ///< k, 1/k, −k, −1/k
  std::array<Series, longest_static_chain> bodies_;
  State<T> error_; ///< scratch
};

} // namespace wingspread
