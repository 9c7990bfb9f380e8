/// The modes of the linear model of a latched wing, M ü + C u̇ + K u = 0.
///
/// For few bodies the modes are found one by one, each from a mode without damping; a shape that
/// creeps has two. With Q(λ) = λ² M + λ C + K, x the mode and λ its eigenvalue so far,
///
///     Q(λ) y = Q'(λ) x,   λ ← λ − yᵀQ'(λ)x / yᵀQ'(λ)y,   x ← y                                  (1)
///
/// which is Newton's method for a root of yᵀQ(λ)y. For symmetric matrices the error of that root is
/// the square of y's error: two or three passes reach round-off [Lancaster, Lambda-matrices and
/// vibrating systems, 1966]. For more bodies, and where two modes converge to the same eigenvalue, a
/// library's QR algorithm finds all modes at once. The bounds measure the residual of the modes
/// (e in modal_bounds.hpp): a mode that is wrong cannot make a proof wrong.
#pragma once

#include "core/proofs/rest_model.hpp"

#include <Eigen/Eigenvalues>

#include <complex>
#include <optional>
#include <vector>

namespace wingspread {

/// The columns of one mode among 2n: one of a real mode, two (real and imaginary part) of a conjugate pair.
struct ModeColumns {
  int column; ///< the first
  bool is_pair;
};

/// The largest |(e w)_j| of mode `of` where mode `by` alone has |w| = 1, and its conjugate with it.
/// @param e in real coordinates: w of a real mode, 2 Re w and −2 Im w of a pair
[[nodiscard]] double size_of_residual(const Eigen::MatrixXd& e, const ModeColumns& of,
                                      const ModeColumns& by);

class Modes {
public:
  using Matrix = Eigen::MatrixXd;
  using Complex = std::complex<double>;

  /// @param inverse M⁻¹
  /// @return whether they could be found
  [[nodiscard]] bool find(const RestModel& model, const Matrix& inverse);

  /// By (1) alone, for any number of bodies. @return whether all converged, to different eigenvalues
  [[nodiscard]] bool find_one_by_one(const RestModel& model);

  /// λ of every column; of a pair first the one with the positive imaginary part.
  [[nodiscard]] const std::vector<Complex>& values() const { return values_; }
  /// W: w of a real mode, w and w' of a pair w ± iw'.
  [[nodiscard]] const Matrix& columns() const { return columns_; }
  /// Λ of L W = W Λ, real: a pair has a block of 2 × 2.
  [[nodiscard]] Matrix blocks() const;

private:
  [[nodiscard]] bool find_at_once(const RestModel& model, const Matrix& inverse);
  [[nodiscard]] bool find_two(const RestModel& model, int column);
  [[nodiscard]] std::optional<Complex> converge_from(const RestModel& model, Complex value);
  void improve(const RestModel& model, Complex& value);
  template <class Size> void improve_by(Size n, const RestModel& model, Complex& value);
  void keep_pair(int column, const Complex& value);
  void keep_one(int column, double value);
  [[nodiscard]] bool are_apart() const;

  Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> undamped_;
  Eigen::MatrixXcd Q_, slope_;     ///< Q(λ), Q'(λ): symmetric
  Eigen::VectorXcd x_, y_, right_; ///< of (1)
  std::vector<Complex> values_;
  Matrix columns_;
};

} // namespace wingspread
