/// Sample statistics: pure functions of numbers, stable in floating point.
///
/// Symbols: n sample size, m_r = Σ(x − x̄)^r / n central moments, X_(i) i-th smallest (from 1). Undefined results are
/// NaN.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace wingspread {

/// Stands for a number that does not exist.
inline constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

/// Compensated sum: its error does not grow with the number of terms.
/// Source: A. Neumaier, ZAMM 54 (1974) 39–51, method IV.
class Sum {
public:
  void add(double term) {
    const double next = sum_ + term;
    lost_ += std::abs(sum_) >= std::abs(term) ? (sum_ - next) + term : (term - next) + sum_;
    sum_ = next;
  }
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

/// Moments of finite values, in two passes about the middle value (of a sorted sample its median), scaled by the largest
/// deviation. So a standard deviation of 1 about a mean of 1e9 has all the digits that the values themselves have. Cost
/// O(n). Source: D. N. Joanes, C. A. Gill, The Statistician 47 (1998) 183–189.
[[nodiscard]] Moments moments(std::span<const double> values);

/// Sets skewness and kurtosis from central moments m_2 > 0, m_3, m_4 in any one unit. @pre the count is set
void set_shape(double m2, double m3, double m4, Moments& moments);

/// Whether the values differ.
[[nodiscard]] bool varies(std::span<const double> values);

/// The values that are not NaN, smallest first. Cost O(n log n).
[[nodiscard]] std::vector<double> sorted_present(std::span<const double> values);

/// Sorts in place, smallest first, −0 before 0. Cost O(n log n): 25 ms for 10⁶ normal values. std::sort takes 100 to
/// 130 ms, or 5 s more for a campaign of 10⁶ runs with 50 columns. @pre no NaN
void sort_values(std::span<double> values);

/// Cost of sorting the values and of using each once, in operations (operations_worth_threads in thread_pool.hpp).
[[nodiscard]] constexpr double sorting_operations(std::size_t items) {
  return 16 * static_cast<double>(items);
}

/// The rank of the sample quantile: ⌈np⌉, at least 1. If only round-off separates np from a whole number, the rank is
/// that number (100 · 0.07 is 7).
/// @pre n > 0, 0 ≤ p ≤ 1
[[nodiscard]] long quantile_rank(long n, double p);

/// Sample quantile X_(⌈np⌉): the inverse of the empirical distribution function, min{x : F_n(x) ≥ p}. Not
/// interpolated: it is a value that occurred, and the distribution-free bounds (binomial_bounds.hpp) hold for the
/// same order statistics. Definition 1 of R. J. Hyndman, Y. Fan, The American Statistician 50 (1996) 361–365. NaN for
/// an empty sample. Cost O(1).
/// @param sorted smallest first
[[nodiscard]] double quantile(std::span<const double> sorted, double p);

/// Where missing values rank: above every value, below every value, or at either of these ends. In the last case a
/// quantile has them above, and its bounds hold for both ends.
enum class MissingRank { above, below, either };

/// Ranks over a sample of which some values are missing.
struct PartialRanks {
  long present, missing = 0;
  MissingRank end = MissingRank::above;

  [[nodiscard]] long all() const { return present + missing; }
  /// The rank among the present values of a rank among all, both from 1; nothing if a missing value has that rank.
  [[nodiscard]] std::optional<long> among_present(long rank) const {
    const long place = end == MissingRank::below ? rank - missing : rank;
    return place < 1 || place > present ? std::nullopt : std::optional(place);
  }
};

/// The sample quantile over all values, the missing ones too. NaN if a missing value has its rank: the quantile p does
/// not exist if fewer than a share p of the values are present (mirrored if missing values rank below). Cost O(1).
/// @param sorted the present values, smallest first
[[nodiscard]] double quantile(std::span<const double> sorted, const PartialRanks& ranks, double p);

/// Standardises a sample: mean 0 and largest deviation 1, so that sums of powers neither overflow nor vanish.
struct Standard {
  double shift, rest; ///< x̄ = shift + rest; shift is one of the values
  double scale;
  double squares; ///< Σz²
  /// z of a value.
  [[nodiscard]] double of(double value) const { return ((value - shift) - rest) / scale; }
};

/// The standardisation of a sample; nothing for fewer than two values or a constant sample. Cost O(n).
/// @pre the values are finite
[[nodiscard]] std::optional<Standard> standard_of(std::span<const double> values);

/// Σ z_x z_y. Cost O(n). @pre equally long
[[nodiscard]] double sum_of_products(std::span<const double> x, const Standard& of_x,
                                     std::span<const double> y, const Standard& of_y);

/// Pearson's correlation of two samples from the sum of their products, Σ z_x z_y.
[[nodiscard]] double pearson(const Standard& x, const Standard& y, double products);

/// Pearson's product-moment correlation, in [−1, 1]; NaN for fewer than two pairs or when either is
/// constant. Cost O(n).
/// @pre equally long, finite
[[nodiscard]] double pearson(std::span<const double> x, std::span<const double> y);

} // namespace wingspread
