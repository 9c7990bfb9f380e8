/// Dormand and Prince's explicit Runge-Kutta formula of order 8 with estimates of order 5 and 3
/// [Hairer, Nørsett & Wanner I, II.5 and II.10; coefficients as in E. Hairer's DOP853].
///
/// Its error estimates weigh stages all over the step, so they notice friction that changes sign inside.
/// Fehlberg's 8(7) uses the ends of the step only.
#pragma once

#include "core/methods/method.hpp"

#include <array>
#include <utility>

namespace wingspread {

namespace dop853 {

inline constexpr int stages = 12;
using Row = std::array<double, stages>;

inline constexpr Row nodes{0,
                           0.526001519587677318785587544488e-1,
                           0.789002279381515978178381316732e-1,
                           0.118350341907227396726757197510,
                           0.281649658092772603273242802490,
                           0.333333333333333333333333333333,
                           0.25,
                           0.307692307692307692307692307692,
                           0.651282051282051282051282051282,
                           0.6,
                           0.857142857142857142857142857142,
                           1};

inline constexpr std::array<Row, stages> a{
    {{},
     {5.26001519587677318785587544488e-2},
     {1.97250569845378994544595329183e-2, 5.91751709536136983633785987549e-2},
     {2.95875854768068491816892993775e-2, 0, 8.87627564304205475450678981324e-2},
     {2.41365134159266685502369798665e-1, 0, -8.84549479328286085344864962717e-1,
      9.24834003261792003115737966543e-1},
     {3.7037037037037037037037037037e-2, 0, 0, 1.70828608729473871279604482173e-1,
      1.25467687566822425016691814123e-1},
     {3.7109375e-2, 0, 0, 1.70252211019544039314978060272e-1, 6.02165389804559606850219397283e-2,
      -1.7578125e-2},
     {3.70920001185047927108779319836e-2, 0, 0, 1.70383925712239993810214054705e-1,
      1.07262030446373284651809199168e-1, -1.53194377486244017527936158236e-2,
      8.27378916381402288758473766002e-3},
     {6.24110958716075717114429577812e-1, 0, 0, -3.36089262944694129406857109825,
      -8.68219346841726006818189891453e-1, 2.75920996994467083049415600797e1,
      2.01540675504778934086186788979e1, -4.34898841810699588477366255144e1},
     {4.77662536438264365890433908527e-1, 0, 0, -2.48811461997166764192642586468,
      -5.90290826836842996371446475743e-1, 2.12300514481811942347288949897e1,
      1.52792336328824235832596922938e1, -3.32882109689848629194453265587e1,
      -2.03312017085086261358222928593e-2},
     {-9.3714243008598732571704021658e-1, 0, 0, 5.18637242884406370830023853209,
      1.09143734899672957818500254654, -8.14978701074692612513997267357,
      -1.85200656599969598641566180701e1, 2.27394870993505042818970056734e1,
      2.49360555267965238987089396762, -3.0467644718982195003823669022},
     {2.27331014751653820792359768449, 0, 0, -1.05344954667372501984066689879e1,
      -2.00087205822486249909675718444, -1.79589318631187989172765950534e1,
      2.79488845294199600508499808837e1, -2.85899827713502369474065508674,
      -8.87285693353062954433549289258, 1.23605671757943030647266201528e1,
      6.43392746015763530355970484046e-1}}};

inline constexpr Row b{5.42937341165687622380535766363e-2,
                       0,
                       0,
                       0,
                       0,
                       4.45031289275240888144113950566,
                       1.89151789931450038304281599044,
                       -5.8012039600105847814672114227,
                       3.1116436695781989440891606237e-1,
                       -1.52160949662516078556178806805e-1,
                       2.01365400804030348374776537501e-1,
                       4.47106157277725905176885569043e-2};

inline constexpr Row error_5{0.1312004499419488073250102996e-1,
                             0,
                             0,
                             0,
                             0,
                             -0.1225156446376204440720569753e1,
                             -0.4957589496572501915214079952,
                             0.1664377182454986536961530415e1,
                             -0.3503288487499736816886487290,
                             0.3341791187130174790297318841,
                             0.8192320648511571246570742613e-1,
                             -0.2235530786388629525884427845e-1};

/// b less the weights of order 3.
inline constexpr Row error_3 = [] {
  Row e = b;
  e[0] -= 0.244094488188976377952755905512;
  e[8] -= 0.733846688281611857341361741547;
  e[11] -= 0.220588235294117647058823529412e-1;
  return e;
}();

} // namespace dop853

template <class T> class DormandPrince853 {
public:
  static constexpr int order = 8, error_order = 7, evaluations = 12;
  static constexpr bool ends_with_stage = false; ///< its last stage is not at the step's end
  static constexpr double stable_real = 6.394, stable_imaginary = 5.960;

  /// @param error h ε5, the estimate of order 5
  template <class System>
  void estimate(System& system, const Start<T>& from, const T& h, State<T>& x1, State<T>& dxdt1,
                State<T>& error) {
    const std::size_t size = from.x.size();
    k_[0] = from.dxdt;
    [&]<std::size_t... I>(std::index_sequence<I...>) __attribute__((always_inline)) {
      (stage<I + 1>(system, from, h, x1), ...);
    }
    (std::make_index_sequence<dop853::stages - 1>{});
    error_3_.resize(size);
    for (std::size_t c = 0; c < size; ++c) {
      x1[c] = fused(h, weighted(dop853::b, c), from.x[c]);
      error[c] = h * weighted(dop853::error_5, c);
      error_3_[c] = h * weighted(dop853::error_3, c);
    }
    evaluate_end(system, x1, dxdt1, T(from.t + h));
  }

  /// Scaled error of the last trial step: ε5²/√(ε5² + 0.01 ε3²) of the largest scaled ε5 and ε3 [Hairer,
  /// Nørsett & Wanner I, II.10], of order 8 in h. NaN as from `wingspread::scaled_error`.
  [[nodiscard]] T scaled_error(const State<T>& x, const State<T>& x1, const State<T>& dxdt1,
                               const State<T>& error, const T& rtol, const T& atol) const {
    using std::abs, std::sqrt;
    T e5(0), e3(0), poison(0);
    for (std::size_t c = 0; c < x.size(); ++c) {
      const T scale = T(1) / fused(rtol, larger(T(abs(x[c])), T(abs(x1[c]))), atol);
      e5 = larger(e5, T(abs(error[c]) * scale));
      e3 = larger(e3, T(abs(error_3_[c]) * scale));
      poison =
          poison + (x1[c] - x1[c]) + (dxdt1[c] - dxdt1[c]) + (error[c] - error[c]); // 0, or NaN
    }
    const T both = fused(e5, e5, T(0.01) * e3 * e3);
    return select(both > T(0), T(e5 * e5 / sqrt(both)), both) + poison;
  }

private:
  template <std::size_t I, class System>
  void stage(System& system, const Start<T>& from, const T& h, State<T>& x) {
    for (std::size_t c = 0; c < x.size(); ++c)
      x[c] = fused(h, weighted(dop853::a[I], c), from.x[c]);
    if (k_[I].size() != x.size()) k_[I].resize(x.size());
    const T t = from.t + T(dop853::nodes[I]) * h;
    if constexpr (requires { system.stage(x, k_[I], t); })
      system.stage(x, k_[I], t);
    else
      system(x, k_[I], t);
  }

  /// Σ_j w_j k_j of component c, without the terms whose w_j is 0. Without the attributes GCC 12 leaves the sum a call:
  /// runs with friction take 49 % more instructions in AVX2 lanes, and twice as many alone (callgrind).
  [[nodiscard, gnu::always_inline]] T weighted(const dop853::Row& w, std::size_t c) const {
    T sum = T(w[0]) * k_[0][c]; // w_0 is never 0
    [&]<std::size_t... J>(std::index_sequence<J...>) __attribute__((always_inline)) {
      ((w[J + 1] != 0 ? void(sum = fused(T(w[J + 1]), k_[J + 1][c], sum)) : void()), ...);
    }
    (std::make_index_sequence<dop853::stages - 1>{});
    return sum;
  }

  std::array<State<T>, dop853::stages> k_;
  State<T> error_3_;
};

} // namespace wingspread
