#include "montecarlo/analyses/sampler/polynomial_map.hpp"

#include <Eigen/LU>
#include <Eigen/QR>

#include <cmath>

namespace wingspread {
namespace {

// Newton's method, which converges in fewer than ten iterations or not at all; heuristic.
constexpr int most_iterations = 30;
constexpr double converged = 1e-10, same = 1e-6;

/// Calls `take(i, j, k)` for each monomial, a product of `degree` factors: z_i, or 1 for i = −1. k is −1 for degree 2.
template <class Take> void for_each_monomial(Eigen::Index d, int degree, const Take& take) {
  for (Eigen::Index i = -1; i < d; ++i)
    for (Eigen::Index j = i; j < d; ++j)
      for (Eigen::Index k = degree == 3 ? j : -1; k < (degree == 3 ? d : 0); ++k) take(i, j, k);
}

Eigen::VectorXd monomials(const Eigen::VectorXd& z, int degree) {
  const auto factor = [&](Eigen::Index i) { return i < 0 ? 1 : z[i]; };
  Eigen::VectorXd all(
      static_cast<Eigen::Index>(PolynomialMap::terms(static_cast<std::size_t>(z.size()), degree)));
  Eigen::Index place = 0;
  for_each_monomial(z.size(), degree, [&](Eigen::Index i, Eigen::Index j, Eigen::Index k) {
    all[place++] = factor(i) * factor(j) * factor(k);
  });
  return all;
}

} // namespace

PolynomialMap::PolynomialMap(const std::vector<Eigen::VectorXd>& z,
                             const std::vector<Eigen::VectorXd>& xi, int degree)
    : degree_(degree) {
  const Eigen::Index rows = std::ssize(z), d = z.front().size();
  Eigen::MatrixXd left(rows, monomials(z.front(), degree).size()), right(rows, d);
  for (Eigen::Index row = 0; row < rows; ++row) {
    const auto k = static_cast<std::size_t>(row);
    const double weight = 1 / (1 + xi[k].squaredNorm() / static_cast<double>(d));
    left.row(row) = weight * monomials(z[k], degree).transpose();
    right.row(row) = weight * xi[k].transpose();
  }
  coefficients_ = left.colPivHouseholderQr().solve(right);
}

Eigen::VectorXd PolynomialMap::operator()(const Eigen::VectorXd& z) const {
  return coefficients_.transpose() * monomials(z, degree_);
}

Eigen::MatrixXd PolynomialMap::derivative(const Eigen::VectorXd& z) const {
  const auto factor = [&](Eigen::Index i) { return i < 0 ? 1 : z[i]; };
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(z.size(), z.size());
  Eigen::Index place = 0;
  for_each_monomial(z.size(), degree_, [&](Eigen::Index i, Eigen::Index j, Eigen::Index k) {
    const auto row = coefficients_.row(place++).transpose();
    if (i >= 0) slopes.col(i) += factor(j) * factor(k) * row;
    if (j >= 0) slopes.col(j) += factor(i) * factor(k) * row;
    if (k >= 0) slopes.col(k) += factor(i) * factor(j) * row;
  });
  return slopes;
}

std::optional<Eigen::VectorXd> PolynomialMap::solve(const Eigen::VectorXd& xi) const {
  Eigen::VectorXd z = xi;
  for (int n = 0; n < most_iterations; ++n) {
    const Eigen::VectorXd change = derivative(z).partialPivLu().solve(xi - (*this)(z));
    z += change;
    if (!z.allFinite()) return std::nullopt;
    if (change.norm() <= converged * (1 + z.norm())) return z;
  }
  return std::nullopt;
}

std::optional<double> PolynomialMap::log_determinant(const Eigen::VectorXd& z) const {
  const auto found = solve((*this)(z));
  if (!found || (*found - z).norm() > same * (1 + z.norm())) return std::nullopt;
  const double determinant = derivative(z).determinant();
  if (!(determinant > 0)) return std::nullopt; // beyond a fold
  return std::log(determinant);
}

std::optional<Eigen::VectorXd> PolynomialMap::inverse(const Eigen::VectorXd& xi) const {
  const auto z = solve(xi);
  return z && log_determinant(*z) ? z : std::nullopt;
}

std::size_t PolynomialMap::terms(std::size_t d, int degree) {
  return degree == 2 ? (d + 1) * (d + 2) / 2 : (d + 1) * (d + 2) * (d + 3) / 6;
}

} // namespace wingspread
