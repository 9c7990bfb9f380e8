/// A polynomial map of z to ξ, both with d coordinates, near the identity. It bends a law of ξ along a curved density
/// of z.
#pragma once

#include <Eigen/Core>

#include <optional>
#include <span>
#include <vector>

namespace wingspread {

class PolynomialMap {
public:
  /// Least squares through points, with less weight where ξ is improbable for a standard normal law.
  /// @param degree 2 or 3
  /// @pre the points determine all coefficients
  PolynomialMap(const std::vector<Eigen::VectorXd>& z, const std::vector<Eigen::VectorXd>& xi,
                int degree);

  [[nodiscard]] Eigen::VectorXd operator()(const Eigen::VectorXd& z) const;
  /// log det ∂ξ/∂z. Nothing if solve() does not lead from ξ(z) back to z, because several z have this ξ.
  [[nodiscard]] std::optional<double> log_determinant(const Eigen::VectorXd& z) const;
  /// The z of an ξ; nothing if there is none with a log_determinant().
  [[nodiscard]] std::optional<Eigen::VectorXd> inverse(const Eigen::VectorXd& xi) const;

  /// Number of monomials of d coordinates up to a degree.
  [[nodiscard]] static std::size_t terms(std::size_t d, int degree);

private:
  int degree_;
  Eigen::MatrixXd coefficients_; ///< one row per monomial, one column per coordinate of ξ

  [[nodiscard]] Eigen::MatrixXd derivative(const Eigen::VectorXd& z) const;
  /// A z of the ξ by Newton's method, started at z = ξ; nothing if it does not converge.
  [[nodiscard]] std::optional<Eigen::VectorXd> solve(const Eigen::VectorXd& xi) const;
};

} // namespace wingspread
