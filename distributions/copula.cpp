#include "distributions/copula.hpp"

#include "distributions/continuous_law.hpp"
#include "distributions/decompositions.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

template Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>&
Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>::compute(const Eigen::EigenBase<Eigen::MatrixXd>&,
                                                        int);
template Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>&
Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>::compute(const Eigen::MatrixXd&,
                                                                   const Eigen::MatrixXd&, int);

namespace wingspread {
namespace {

using Matrix = Eigen::MatrixXd;

// Of the search for the nearest possible correlations, of which a message shows four digits. Heuristic: alternating
// projections converge linearly, and 2000 suffice for hundreds of columns.
constexpr double converged = 1e-10;
constexpr int most_projections = 2000;

/// Φ⁻¹(u), computed from the smaller tail.
double normal_score(Tails u) { return inverse(Normal{}, u); }

/// The nearest matrix without an eigenvalue below `smallest`.
Matrix with_eigenvalues_from(const Matrix& matrix, double smallest) {
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(matrix);
  const auto raised = solver.eigenvalues().cwiseMax(smallest);
  return solver.eigenvectors() * raised.asDiagonal() * solver.eigenvectors().transpose();
}

} // namespace

double normal_correlation(double spearman) { return 2 * std::sin(std::numbers::pi * spearman / 6); }

double spearman_correlation(double normal_r) {
  return 6 * std::asin(normal_r / 2) / std::numbers::pi;
}

Matrix normal_correlations(std::size_t count, std::span<const RankCorrelation> correlations) {
  const auto size = static_cast<Eigen::Index>(count);
  Matrix matrix = Matrix::Identity(size, size);
  for (const RankCorrelation& pair : correlations) {
    const auto i = static_cast<Eigen::Index>(pair.first),
               j = static_cast<Eigen::Index>(pair.second);
    matrix(i, j) = matrix(j, i) = normal_correlation(pair.spearman);
  }
  return matrix;
}

std::optional<Matrix> cholesky(const Matrix& matrix) {
  const Eigen::Index n = matrix.rows();
  const double rounding = 64 * static_cast<double>(n) * std::numeric_limits<double>::epsilon();
  Matrix factor = Matrix::Zero(n, n);
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = j; i < n; ++i) {
      double rest = matrix(i, j);
      for (Eigen::Index k = 0; k < j; ++k) rest -= factor(i, k) * factor(j, k);
      if (i == j && !(rest > rounding)) return std::nullopt;
      factor(i, j) = i == j ? std::sqrt(rest) : rest / factor(j, j);
    }
  return factor;
}

Matrix nearest_correlations(const Matrix& matrix, double smallest) {
  assert(0 < smallest && smallest < 1);
  Matrix nearest = matrix, correction = Matrix::Zero(matrix.rows(), matrix.cols());
  for (int projection = 0; projection < most_projections; ++projection) {
    const Matrix corrected = nearest - correction;
    const Matrix possible = with_eigenvalues_from(corrected, smallest);
    correction = possible - corrected;
    nearest = possible;
    nearest.diagonal().setOnes();
    if ((nearest - possible).norm() <= converged * nearest.norm()) break;
  }
  return nearest;
}

GaussianCopula::GaussianCopula(std::vector<std::size_t> order,
                               std::span<const RankCorrelation> correlations)
    : independent_(correlations.empty()) {
  if (independent_) return;
  const auto index = [](std::size_t i) { return static_cast<Eigen::Index>(i); };
  const Matrix all = normal_correlations(order.size(), correlations);
  Matrix ordered(all.rows(), all.cols());
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = 0; j < order.size(); ++j)
      ordered(index(i), index(j)) = all(index(order[i]), index(order[j]));
  const std::optional<Matrix> factor = cholesky(ordered);
  assert(factor);
  for (std::size_t i = 1; i < order.size(); ++i) { // the first stays as it is
    Row row{order[i], (*factor)(index(i), index(i)), {}};
    for (std::size_t j = 0; j < i; ++j)
      if (const double weight = (*factor)(index(i), index(j)); weight != 0)
        row.weights.emplace_back(order[j], weight);
    rows_.push_back(std::move(row));
  }
}

void GaussianCopula::couple(std::span<const Tails> u, std::span<Tails> coupled) const {
  std::ranges::copy(u, coupled.begin());
  for (const Row& row : rows_) {
    if (row.weights.empty()) continue;
    double z = row.own * normal_score(u[row.target]);
    for (const auto& [before, weight] : row.weights) z += weight * normal_score(u[before]);
    coupled[row.target] = tails(Normal{}, z);
  }
}

} // namespace wingspread
