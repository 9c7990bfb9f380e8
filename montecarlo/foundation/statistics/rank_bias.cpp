#include "montecarlo/foundation/statistics/rank_bias.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace wingspread {
namespace {

using Matrix = Eigen::MatrixXd;

Eigen::Index at(std::size_t i) { return static_cast<Eigen::Index>(i); }

/// s_ij of a row i with all rows, of one column: a bit for each row j, set where s is 1 and where it is −1. A product
/// of two columns is then a count of bits, some 30 times as fast as one of numbers.
class Signs {
public:
  Signs(std::span<const double> column, std::size_t row, std::size_t rows) {
    for (std::size_t j = 0; j < rows; ++j) {
      const std::uint64_t bit = std::uint64_t{1} << j % 64;
      if (column[row] > column[j]) above_[j / 64] |= bit;
      if (column[row] < column[j]) below_[j / 64] |= bit;
    }
  }
  [[nodiscard]] long sum() const { return product(above_, above_) - product(below_, below_); }
  /// Σ_j s_ij s'_ij
  [[nodiscard]] long times(const Signs& other) const {
    return product(above_, other.above_) + product(below_, other.below_) -
           product(above_, other.below_) - product(below_, other.above_);
  }

private:
  using Bits = std::array<std::uint64_t, (rank_bias_rows + 63) / 64>;
  static long product(const Bits& a, const Bits& b) {
    long common = 0;
    for (std::size_t i = 0; i < a.size(); ++i) common += std::popcount(a[i] & b[i]);
    return common;
  }

  Bits above_{}, below_{};
};

} // namespace

RankBias::RankBias(const std::vector<std::span<const double>>& columns)
    : tau_(Matrix::Zero(at(columns.size()), at(columns.size()))), weight_(columns.size(), 0.0) {
  const std::size_t all = columns.empty() ? 0 : columns.front().size();
  const std::size_t rows = std::min(all, rank_bias_rows);
  Matrix same = tau_;                                       // B
  Eigen::VectorXd own = Eigen::VectorXd::Zero(tau_.rows()); // A_xx
  for (std::size_t row = 0; row < rows; ++row) { // sums of whole numbers: exact in any order
    std::vector<Signs> signs;
    for (const std::span<const double> column : columns) signs.emplace_back(column, row, rows);
    for (std::size_t x = 0; x < signs.size(); ++x) {
      for (std::size_t y = 0; y <= x; ++y)
        same(at(x), at(y)) += static_cast<double>(signs[x].times(signs[y]));
      const auto sum = static_cast<double>(signs[x].sum());
      own(at(x)) += sum * sum;
    }
  }
  same = Matrix(same.selfadjointView<Eigen::Lower>());
  // w is proportional to 1/(n + 1)
  const double fewer = static_cast<double>(rows + 1) / static_cast<double>(all + 1);
  for (Eigen::Index x = 0; x < tau_.rows(); ++x) {
    if (!(same(x, x) > 0)) continue;
    weight_[static_cast<std::size_t>(x)] = std::min(1.0, same(x, x) / own(x)) * fewer;
    for (Eigen::Index y = 0; y < tau_.rows(); ++y)
      if (same(y, y) > 0) tau_(x, y) = same(x, y) / std::sqrt(same(x, x) * same(y, y));
  }
}

double RankBias::in_sample(std::size_t x, std::size_t y, double correlation) const {
  const double a = weight_[x], b = weight_[y];
  return std::sqrt((1 - a) * (1 - b)) * correlation + std::sqrt(a * b) * tau_(at(x), at(y));
}

} // namespace wingspread
