/// Sample statistics: pure functions of numbers, stable in floating point.
///
/// Symbols: n sample size, m_r = Σ(x − x̄)^r / n central moments, X_(i) i-th smallest (from 1).
/// What is undefined for a sample comes back as NaN.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace wingspread {

/// What has no value.
inline constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

/// Compensated sum: its error does not grow with the number of terms.
/// Source: A. Neumaier, ZAMM 54 (1974) 39–51, method IV.
class Sum {
public:
  void add(double term);
  [[nodiscard]] double value() const { return sum_ + lost_; }

private:
  double sum_ = 0, lost_ = 0;
};

struct Moments {
  long count = 0; ///< n
  double mean;    ///< NaN for n = 0
  double std;     ///< √(n m_2 / (n − 1)), divisor n − 1; NaN for n < 2
  double min, max;
  /// Adjusted Fisher–Pearson coefficient G_1 = m_3/m_2^{3/2} · √(n(n − 1))/(n − 2); NaN for n < 3
  /// and for a constant sample.
  double skewness;
  /// Excess kurtosis G_2 = (n − 1)/((n − 2)(n − 3)) · ((n + 1)(m_4/m_2² − 3) + 6), 0 for a normal
  /// distribution and unbiased there; NaN for n < 4 and for a constant sample.
  double kurtosis;
};

/// Moments of finite values. Two passes about the first value, scaled by the largest deviation: a
/// mean of 1e9 costs a standard deviation of 1 no digits beyond those the values have lost.
/// Cost O(n). Source: D. N. Joanes, C. A. Gill, The Statistician 47 (1998) 183–189.
[[nodiscard]] Moments moments(std::span<const double> values);

/// The values that are not NaN, smallest first. Cost O(n log n).
[[nodiscard]] std::vector<double> sorted_present(std::span<const double> values);

/// ⌈np⌉, at least 1: the rank of the sample quantile. An np that round-off alone keeps from a whole
/// number counts as that number (100 · 0.07 is 7).
/// @pre n > 0, 0 ≤ p ≤ 1
[[nodiscard]] long quantile_rank(long n, double p);

/// Sample quantile X_(⌈np⌉): the inverse of the empirical distribution function, min{x : F_n(x) ≥
/// p}. No interpolation: it is a value that occurred, and the distribution-free bounds
/// (confidence.hpp) hold for the same order statistics. Definition 1 of R. J. Hyndman, Y. Fan, The
/// American Statistician 50 (1996) 361–365. NaN for an empty sample. Cost O(1).
/// @param sorted smallest first.
[[nodiscard]] double quantile(std::span<const double> sorted, double p);

/// Pearson's product-moment correlation, in [−1, 1]; NaN for fewer than two pairs or when either is
/// constant. Cost O(n).
/// @pre equally long, finite
[[nodiscard]] double pearson(std::span<const double> x, std::span<const double> y);

/// A column made ready to be correlated with many others: sorted and ranked once.
/// Keeps a view of the values.
class RankedColumn {
public:
  /// Cost O(n log n). NaN marks what is missing.
  explicit RankedColumn(std::span<const double> values);

  [[nodiscard]] std::span<const double> values() const { return values_; }
  [[nodiscard]] bool complete() const { return order_.size() == values_.size(); }
  /// Mid-ranks from 1 of the values at which `keep` is true, in their order; ties share the mean of
  /// their ranks. Cost O(n).
  /// @pre no kept value is missing
  [[nodiscard]] std::vector<double> ranks_where(const std::vector<bool>& keep) const;
  /// Mid-ranks of all values. @pre complete()
  [[nodiscard]] const std::vector<double>& ranks() const { return ranks_; }

private:
  std::span<const double> values_;
  std::vector<std::uint32_t> order_; ///< indices of the present values, smallest first
  std::vector<double> ranks_;        ///< of all values; empty when some are missing
};

/// How two columns go together, over the rows in which both have a value.
struct Correlation {
  long count = 0;  ///< those rows
  double pearson;  ///< linear
  double spearman; ///< Pearson's of the mid-ranks: monotone
};

/// Both correlations, NaN as for pearson(). Cost O(n).
/// @pre equally long
[[nodiscard]] Correlation correlation(const RankedColumn& x, const RankedColumn& y);

} // namespace wingspread
