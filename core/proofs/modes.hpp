/// The modes of the linear model of a latched wing, M ü + C u̇ + K u = 0.
///
/// Where few bodies take part they are found one by one, each from that
/// without damping, of a shape that creeps two: with Q(λ) = λ² M + λ C + K, x the mode and λ its eigenvalue so far,
///
///     Q(λ) y = Q'(λ) x,   λ ← λ − yᵀQ'(λ)x / yᵀQ'(λ)y,   x ← y                                  (1)
///
/// which is Newton's way to a root of yᵀQ(λ)y. Of symmetric matrices that root is off by the square of
/// what y is off, so that two or three passes reach round-off [Lancaster, Lambda-matrices and vibrating systems, 1966]. Else, and where two
/// of them come to the same, a library's QR algorithm finds all at once. What follows from the modes
/// holds them against the model (modal_bounds.hpp): nothing here is believed.
#pragma once

#include "core/proofs/rest_model.hpp"

#include <Eigen/Eigenvalues>

#include <complex>
#include <optional>
#include <vector>

namespace wingspread {

/// Sizes of what belongs to n hinges, as a library's matrices take them.
template <int N> struct SizesFor { static constexpr int bodies = N + 1, states = 2 * N; };
template <> struct SizesFor<Eigen::Dynamic> {
  static constexpr int bodies = Eigen::Dynamic, states = Eigen::Dynamic;
};

/// A matrix of a model of any size as one whose size the compiler knows.
template <class Fixed> [[nodiscard]] auto seen_as(const Eigen::MatrixXd& matrix) {
  return Eigen::Map<const Fixed>(matrix.data(), matrix.rows(), matrix.cols());
}

/// @tparam N of hinges, 1 … longest_static_chain, where the compiler knows; else any
template <int N = Eigen::Dynamic> class Modes {
public:
  using Of = SizesFor<N>;
  using Square = Eigen::Matrix<double, N, N>;
  using Matrix = Eigen::Matrix<double, Of::states, Of::states>;
  using Complex = std::complex<double>;

  /// @param first_order L of ż = L z, z = (u, u̇)
  /// @return whether they could be found
  [[nodiscard]] bool find(const RestModel& model, const Matrix& first_order);

  /// (1) alone, whatever the number of bodies.
  [[nodiscard]] bool find_one_by_one(const RestModel& model);

  /// λ of every column: of a pair that with the positive imaginary part comes first.
  [[nodiscard]] const std::vector<Complex>& values() const { return values_; }
  /// V: v of a real mode, v and v' of a pair v ± iv'.
  [[nodiscard]] const Matrix& columns() const { return columns_; }
  /// Λ of L V = V Λ: of a pair two rows.
  [[nodiscard]] Matrix blocks() const;

private:
  using Vector = Eigen::Matrix<Complex, N, 1>;

  [[nodiscard]] bool find_at_once(const Matrix& first_order);
  [[nodiscard]] bool find_two(const RestModel& model, int column);
  [[nodiscard]] std::optional<Complex> settle(const RestModel& model, Complex value);
  void pass(const RestModel& model, Complex& value);
  void solve();
  void keep_pair(int column, const Complex& value);
  void keep_one(int column, double value);
  [[nodiscard]] bool are_apart() const;

  [[nodiscard]] int size() const { return N == Eigen::Dynamic ? n_ : N; }

  int n_ = 0;
  Eigen::GeneralizedSelfAdjointEigenSolver<Square> undamped_;
  Eigen::EigenSolver<Matrix> at_once_;
  Eigen::Matrix<Complex, N, N> Q_;
  Vector x_, y_, right_; ///< of (1)
  std::vector<Complex> values_;
  Matrix columns_;
};

extern template class Modes<1>;
extern template class Modes<2>;
extern template class Modes<3>;
extern template class Modes<4>;
extern template class Modes<>;

} // namespace wingspread
