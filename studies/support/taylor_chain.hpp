/// The Taylor series of a chain's motion, coefficient by coefficient, to measure cost and accuracy of a Taylor method.
/// Fixed base, linear hinge moments.
///
/// In absolute angles θ_j, ω = θ̇, α = ω̇, Δ = θ_k − θ_j:
///
///     Σ_k C_jk α_k = Q_j + Σ_k D_jk ω_k²                  (1)
///     C_jk =  a_jk cos Δ + b_jk sin Δ                     (2)
///     D_jk = −b_jk cos Δ + a_jk sin Δ,  D_kj = −D_jk      (3)
///     a_jk = Σ_i m_i d_ij · d_ik,  b_jk = Σ_i m_i d_ij × (d_ik turned by 90°)
///
/// The vector from the root to the centre of mass of body i is a sum of vectors fixed in bodies; d_ij is the one fixed in
/// body j, in j's frame. J_j adds to a_jj. Every product of series is a convolution, (uv)_k = Σ u_l v_(k−l); s = sin Δ and
/// c = cos Δ follow from s' = Δ' c, c' = −Δ' s.
///
/// Cost of order K for N bodies: N (N − 1)/2 · 6 + N/2 convolutions of K²/2 multiply-adds each.
#pragma once

#include "core/laws/linear_law.hpp"
#include "core/mechanics/layout.hpp"
#include "core/mechanics/wing.hpp"

#include <array>

namespace wingspread::study {

template <class T, int N> class TaylorChain {
public:
  static constexpr int most = 32; ///< highest order
  using Series = std::array<T, most + 2>;

  explicit TaylorChain(const Wing<T>& wing) {
    for (int j = 0; j < N; ++j)
      for (int k = 0; k < N; ++k) {
        a_[j][k] = b_[j][k] = T(0);
        for (int i = larger_index(j, k); i < N; ++i) {
          const Vec2<T> u = way(wing, i, j), v = way(wing, i, k);
          const T& m = wing.bodies[i + 1].mass;
          a_[j][k] = a_[j][k] + m * (u.x * v.x + u.y * v.y);
          b_[j][k] = b_[j][k] + m * (u.y * v.x - u.x * v.y);
        }
        if (j == k) a_[j][j] = a_[j][j] + wing.bodies[j + 1].central_inertia;
      }
  }

  /// Computes the coefficients of the angles up to t^(order + 1), and of the rates up to t^order, from a state (φ, φ̇).
  /// @param laws those of hinges 1 … N
  void expand(const State<T>& x, const std::vector<LinearLaw<T>>& laws, int order) {
    T sum(0), rate(0);
    for (int j = 0; j < N; ++j) {
      sum = sum + x[j], rate = rate + x[N + j];
      theta_[j][0] = sum, omega_[j][0] = rate;
    }
    for (int k = 0; k < order; ++k) {
      turn(k);
      for (int j = 0; j < N; ++j) square_[j][k] = square(omega_[j], k);
      if (k == 0) invert();
      accelerate(k, laws);
      for (int j = 0; j < N; ++j) {
        theta_[j][k + 1] = omega_[j][k] * T(1.0 / (k + 1));
        omega_[j][k + 1] = alpha_[j][k] * T(1.0 / (k + 1));
      }
    }
  }

  /// d^k φ̇_j/dt^k / k! of the last expansion, j from 0.
  [[nodiscard]] T rate_coefficient(int j, int k) const {
    return j == 0 ? omega_[0][k] : T(omega_[j][k] - omega_[j - 1][k]);
  }
  [[nodiscard]] T angle_coefficient(int j, int k) const {
    return j == 0 ? theta_[0][k] : T(theta_[j][k] - theta_[j - 1][k]);
  }

  /// The state after h, by the series up to `order`.
  void advance(const T& h, int order, State<T>& x) const {
    for (int j = 0; j < N; ++j) {
      T angle = angle_coefficient(j, order), rate = rate_coefficient(j, order);
      for (int k = order - 1; k >= 0; --k) {
        angle = fused(angle, h, angle_coefficient(j, k));
        rate = fused(rate, h, rate_coefficient(j, k));
      }
      x[j] = angle, x[N + j] = rate;
    }
  }

private:
  static constexpr int larger_index(int j, int k) { return j > k ? j : k; }

  /// d_ij.
  [[nodiscard]] static Vec2<T> way(const Wing<T>& wing, int i, int j) {
    return i == j ? wing.bodies[i + 1].center : wing.bodies[j + 2].arm;
  }

  [[nodiscard]] static T square(const Series& u, int k) {
    T sum(0);
    for (int l = 0; 2 * l < k; ++l) sum = fused(u[l], u[k - l], sum);
    sum = sum + sum;
    return k % 2 == 0 ? fused(u[k / 2], u[k / 2], sum) : sum;
  }

  /// Computes coefficient k of sin, cos, C and D of all pairs.
  void turn(int k) {
    using std::sin, std::cos;
    for (int j = 0; j < N; ++j)
      for (int m = j + 1; m < N; ++m) {
        Series &s = sine_[j][m], &c = cosine_[j][m], &turning = turning_[j][m];
        if (k == 0) {
          const SineCosine<T> start = sine_cosine(T(theta_[m][0] - theta_[j][0]));
          s[0] = start.sine, c[0] = start.cosine;
        } else {
          turning[k - 1] = omega_[m][k - 1] - omega_[j][k - 1];
          T up(0), down(0);
          for (int l = 0; l < k; ++l) {
            up = fused(turning[l], c[k - 1 - l], up);
            down = fused(turning[l], s[k - 1 - l], down);
          }
          s[k] = up * T(1.0 / k), c[k] = down * T(-1.0 / k);
        }
        C_[j][m][k] = fused(a_[j][m], c[k], b_[j][m] * s[k]);
        D_[j][m][k] = fused(a_[j][m], s[k], -b_[j][m] * c[k]);
      }
  }

  /// α_k from (1).
  void accelerate(int k, const std::vector<LinearLaw<T>>& laws) {
    std::array<T, N> right;
    for (int j = 0; j < N; ++j) {
      right[j] = moment(laws[j + 1], j, k);
      if (j > 0) right[j - 1] = right[j - 1] - right[j];
    }
    for (int j = 0; j < N; ++j)
      for (int m = j + 1; m < N; ++m) {
        const Series &C = C_[j][m], &D = D_[j][m];
        T on_j = D[k] * square_[m][0], on_m = D[k] * square_[j][0], of_m(0), of_j(0);
        for (int l = 0; l < k; ++l) {
          on_j = fused(D[l], square_[m][k - l], on_j);
          on_m = fused(D[l], square_[j][k - l], on_m);
          of_m = fused(C[k - l], alpha_[m][l], of_m);
          of_j = fused(C[k - l], alpha_[j][l], of_j);
        }
        right[j] = right[j] + (on_j - of_m);
        right[m] = right[m] - (on_m + of_j);
      }
    for (int j = 0; j < N; ++j) {
      T sum = inverse_[j][0] * right[0];
      for (int m = 1; m < N; ++m) sum = fused(inverse_[j][m], right[m], sum);
      alpha_[j][k] = sum;
    }
  }

  [[nodiscard]] T moment(const LinearLaw<T>& law, int j, int k) const {
    const T angle = angle_coefficient(j, k), rate = rate_coefficient(j, k);
    if (k == 0) return linear_moment(law, angle, rate);
    return -fused(law.stiffness, angle, law.damping * rate);
  }

  /// Inverts C at the start of the step, by elimination.
  void invert() {
    std::array<std::array<T, N>, N> m;
    for (int j = 0; j < N; ++j)
      for (int k = 0; k < N; ++k) {
        m[j][k] = j == k ? a_[j][j] : j < k ? C_[j][k][0] : C_[k][j][0];
        inverse_[j][k] = T(j == k ? 1 : 0);
      }
    for (int p = 0; p < N; ++p) {
      const T scale = T(1) / m[p][p];
      for (int k = 0; k < N; ++k)
        m[p][k] = m[p][k] * scale, inverse_[p][k] = inverse_[p][k] * scale;
      for (int j = 0; j < N; ++j) {
        if (j == p) continue;
        const T f = -m[j][p];
        for (int k = 0; k < N; ++k) {
          m[j][k] = fused(f, m[p][k], m[j][k]);
          inverse_[j][k] = fused(f, inverse_[p][k], inverse_[j][k]);
        }
      }
    }
  }

  std::array<std::array<T, N>, N> a_, b_, inverse_;
  std::array<Series, N> theta_, omega_, alpha_, square_;
  std::array<std::array<Series, N>, N> sine_, cosine_, turning_, C_, D_;
};

} // namespace wingspread::study
