#include "montecarlo/foundation/statistics/rank_bias.hpp"

#include <algorithm>
#include <cmath>

namespace wingspread {
namespace {

using Matrix = Eigen::MatrixXd;

Eigen::Index at(std::size_t i) { return static_cast<Eigen::Index>(i); }

double sign(double x) { return static_cast<double>((x > 0) - (x < 0)); }

/// s_ij of a row i with all rows: one column for each column.
Matrix signs_of(const std::vector<std::span<const double>>& columns, std::size_t row,
                std::size_t rows) {
  Matrix signs(at(rows), at(columns.size()));
  for (std::size_t x = 0; x < columns.size(); ++x)
    for (std::size_t j = 0; j < rows; ++j)
      signs(at(j), at(x)) = sign(columns[x][row] - columns[x][j]);
  return signs;
}

} // namespace

RankBias::RankBias(const std::vector<std::span<const double>>& columns)
    : tau_(Matrix::Zero(at(columns.size()), at(columns.size()))), weight_(columns.size(), 0.0) {
  const std::size_t all = columns.empty() ? 0 : columns.front().size();
  const std::size_t rows = std::min(all, rank_bias_rows);
  Matrix same = tau_;                                       // B
  Eigen::VectorXd own = Eigen::VectorXd::Zero(tau_.rows()); // A_xx
  for (std::size_t row = 0; row < rows; ++row) { // sums of whole numbers: exact in any order
    const Matrix signs = signs_of(columns, row, rows);
    same += signs.transpose() * signs;
    own += signs.colwise().sum().transpose().cwiseAbs2();
  }
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
