/// Extrapolation of the linearly implicit Euler rule, for stiff latches at tight tolerances.
///
/// A step H is taken in n substeps of h = H/n,
///
///     x_{k+1} = x_k + (1 − hJ)⁻¹ h f(x_k)                                                  (1)
///
/// with one J for all of it, that of rosenbrock.hpp. For any fixed J the error has an expansion in
/// powers of h [P. Deuflhard, SIAM Review 27 (1985) 505-535], so that the results of n = 2, 3, 4, …
/// extrapolate to h = 0 by Aitken and Neville: column k is of order k. Order and step follow the
/// work per unit of time [Hairer & Wanner II, IV.9: the code SEULEX, of which this is the W form].
///
/// The increments x_k − x_0 are extrapolated, not the states: weights of up to 1e5 multiply the rounding errors, and
/// the rounding error of a state would exceed the increment of a short step.
#pragma once

#include "core/methods/rosenbrock.hpp"
#include "core/methods/state_algebra.hpp"

#include <algorithm>
#include <utility>

namespace wingspread {

template <class T> class Seulex {
public:
  static constexpr int order = 3; ///< of the first step's estimate
  static constexpr bool fixed_step = false;

  void restart(const Tolerance& tolerance) {
    tolerance_ = tolerance;
    control_.after_rejection = false;
    control_.crawled = 0, control_.crawl_to_leap = shortest_crawl, control_.leaps = false;
    // about the first guess of SEULEX [Hairer & Wanner II, IV.9], −0.6·log10(rtol) + 1.5 columns
    control_.target =
        std::clamp(static_cast<int>(2 - 0.6 * std::log10(tolerance.rtol)), 3, most - 2);
  }

  template <class System>
  [[nodiscard]] StepVerdict attempt(System& system, const Start<T>& from, const T& h, State<T>& x1,
                                    State<T>& dxdt1) {
    for (State<T>& row : table_) row.resize(from.x.size());
    error_.resize(from.x.size());
    at_.resize(from.x.size());
    StepVerdict verdict{2, 0.5};
    int j = 0;
    for (; j < std::min(control_.target + 2, most); ++j) {
      substeps(system, from, h, j, dxdt1);
      extrapolate(j);
      if (j == 0) continue;
      verdict.error = column_error(from.x, j);
      if (!std::isfinite(verdict.error)) return {verdict.error, 0.1};
      if (j + 1 >= control_.target && verdict.error <= 1) break;
      if (j + 1 >= control_.target && hopeless(verdict.error, j)) break;
    }
    j = std::min(j, std::min(control_.target + 2, most) - 1);
    for (std::size_t c = 0; c < x1.size(); ++c) x1[c] = from.x[c] + table_[0][c];
    evaluate_end(system, x1, dxdt1, T(from.t + h));
    if (!is_finite(StateAlgebra::norm_inf(x1)) || !is_finite(StateAlgebra::norm_inf(dxdt1)))
      return {std::numeric_limits<double>::quiet_NaN(), 0.1};
    choose(j, verdict);
    return verdict;
  }

  void accepted(const StepVerdict& /*verdict*/, double /*h*/) {
    control_.target = control_.next_target;
    control_.after_rejection = false;
  }
  void rejected() {
    control_.target = control_.next_target;
    control_.after_rejection = true;
  }
  /// State of the control of order and step.
  [[nodiscard]] auto& control() { return control_; }

private:
  // The error of extrapolation has a hump where a step lasts 1 to 10 time constants of a fast mode that has died out.
  // Below it more rows gain nothing, so that the order stays the lowest and the steps short: thousands of
  // them where a few do beyond the hump. After so many steps of the lowest order that grow little, one is tried `leap`
  // times as long, with rows enough for what is beyond; if it is refused, the next after twice as many. Heuristic:
  // fewer steps, and refused leaps cost more (seven rows, as much as five steps of the lowest order); a shorter leap
  // ends on the hump.
  static constexpr int shortest_crawl = 32, longest_crawl = 1024, target_of_leap = 7;
  static constexpr double leap = 30;

  struct Control {
    int target = 5, next_target = 5; ///< rows
    bool after_rejection = false;
    int crawled = 0;                    ///< steps of the lowest order in a row
    int crawl_to_leap = shortest_crawl; ///< after how many a leap is tried
    bool leaps = false;                 ///< the next trial step does
  };

  static constexpr int most = 12;                                       ///< rows
  [[nodiscard]] static constexpr int count(int row) { return row + 2; } ///< n of a row

  /// Work of the rows up to j, in evaluations: n − 1 evaluations, n solves and a factorization each. A solve, and a
  /// factorization, counts as half an evaluation.
  [[nodiscard]] static constexpr double work(int j) {
    double sum = 1;
    for (int row = 0; row <= j; ++row) sum += 1.5 * count(row) - 0.5;
    return sum;
  }

  /// (1) for a row, into its place of the table.
  template <class System>
  void substeps(System& system, const Start<T>& from, const T& h, int row, State<T>& dxdt) {
    State<T>& way = table_[row];
    const int n = count(row);
    const T part = h / T(n);
    linear_.factorize(system, from, part);
    std::fill(way.begin(), way.end(), T(0));
    for (int k = 0; k < n; ++k) {
      for (std::size_t c = 0; c < way.size(); ++c) at_[c] = from.x[c] + way[c];
      if (k > 0) system(at_, dxdt, from.t + T(k) * part);
      const State<T>& f = k > 0 ? dxdt : from.dxdt;
      for (std::size_t c = 0; c < way.size(); ++c) error_[c] = part * f[c];
      linear_.solve(system, error_, part);
      for (std::size_t c = 0; c < way.size(); ++c) way[c] = way[c] + error_[c];
    }
  }

  /// Adds row j to the table, kept as its last diagonal: T_{j,k} stands in table_[j − k].
  void extrapolate(int j) {
    for (int k = 1; k <= j; ++k) {
      const T factor = T(1) / (T(count(j)) / T(count(j - k)) - T(1));
      State<T>&fine = table_[j - k + 1], &coarse = table_[j - k];
      for (std::size_t c = 0; c < fine.size(); ++c)
        coarse[c] = fine[c] + (fine[c] - coarse[c]) * factor;
    }
  }

  [[nodiscard]] double column_error(const State<T>& x, int j) {
    for (std::size_t c = 0; c < x.size(); ++c) {
      error_[c] = table_[0][c] - table_[1][c];
      at_[c] = x[c] + table_[0][c];
    }
    errors_[j] = in_tolerances(x, at_, at_, error_, tolerance_);
    return errors_[j];
  }

  /// Whether the rows still allowed cannot bring the error down to the tolerance [Hairer & Wanner II, IV.9].
  [[nodiscard]] bool hopeless(double error, int j) const {
    double gain = 1;
    for (int row = j + 1; row < std::min(control_.target + 2, most); ++row)
      gain *= static_cast<double>(count(row)) / count(0);
    return error > gain * gain;
  }

  /// The factor to the step at which row j's error would be half the tolerance, with a safety of 0.9. Heuristic
  /// limits 0.05 and 6: extrapolation knows little of steps that differ more.
  [[nodiscard]] double factor_of(int j) const {
    if (!(errors_[j] < 1e100)) return 0.05;
    const double floored = std::max(errors_[j], 1e-12);
    return std::clamp(0.9 * power_roughly(0.5 / floored, 1.0 / (j + 1)), 0.05, 6.0);
  }

  /// Chooses order and step of the next trial step by the work per unit of time. A higher order must save 5 %
  /// (heuristic: otherwise orders change to and fro).
  void choose(int j, StepVerdict& verdict) {
    if (std::exchange(control_.leaps, false)) {
      if (!verdict.accepted()) {
        control_.crawl_to_leap = std::min(2 * control_.crawl_to_leap, longest_crawl);
        control_.next_target = 3, verdict.factor = 1 / leap;
        return;
      }
      control_.crawl_to_leap = shortest_crawl;
    }
    int best = 1;
    for (int row = 2; row <= j; ++row)
      if (work(row) / factor_of(row) < 0.95 * work(best) / factor_of(best)) best = row;
    verdict.factor = factor_of(best);
    control_.next_target = best + 1;
    if (verdict.accepted() && best == j && j + 1 < most - 1 && !control_.after_rejection) {
      control_.next_target = j + 2; // one row more may pay
      verdict.factor *= work(j + 1) / work(j);
    }
    control_.next_target = std::clamp(control_.next_target, 3, most - 1);
    if (!verdict.accepted())
      verdict.factor = std::min(verdict.factor, 0.7);
    else if (control_.after_rejection)
      verdict.factor = std::min(verdict.factor, 1.0);
    const bool crawls = verdict.accepted() && control_.next_target == 3 && verdict.factor < 1.5;
    control_.crawled = crawls ? control_.crawled + 1 : 0;
    if (control_.crawled < control_.crawl_to_leap) return;
    control_.leaps = true, control_.crawled = 0;
    control_.next_target = target_of_leap, verdict.factor = leap;
  }

  LinearlyImplicit<T> linear_;
  Tolerance tolerance_;
  std::array<State<T>, most> table_; ///< ways from the step's start
  std::array<double, most> errors_{};
  State<T> error_, at_;
  Control control_;
};

} // namespace wingspread
