/// Bounds on what every hinge of a latched wing can still see, mode by mode.
///
/// With z = (u, u̇), Λ the eigenvalues and W the eigenvectors of the linear model of rest_model.hpp,
/// P = W⁻¹ and w = P z, (2) there is
///
///     ẇ_j = λ_j w_j + e_j w + p_j M_0⁻¹ (Sᵀn + f)      P = (… p), e what rounding leaves of P L W − Λ
///
/// so that with α_j = −Re λ_j > 0, from now on, while no |w_j| leaves B_j and no |ω̇_k| leaves a_k
///
///     |w_j| ≤ |w_j(0)| + (Σ |e_jk| B_k + Σ |p_j M_0⁻¹Sᵀ|_k n_k + Σ |p_j M_0⁻¹|_k f_k)/α_j         (5)
///     |ω̇_k| ≤ Σ |S W_v Λ|_kj B_j + Σ |S M_0⁻¹Sᵀ + 1 1ᵀ/I|_kl n_l + Σ |S M_0⁻¹|_kl f_l            (6)
///
/// n and f being bounded over that box by (3), with |u| ≤ |W_u| B, |u̇| ≤ |W_v| B and
/// |ω| ≤ |S W_v| B + |r|, r by (4). Where the right sides lie inside the box they never leave it: what
/// changes continuously would have to reach its edge first, and the accelerations, which jump where
/// friction does, obey (6) at each instant: there a box that holds its own right side says that the
/// matrix in front of a is contracting. Fast modes are soon gone from |w(0)|, so that the bounds come down to what truly remains. An energy E (prospects.hpp)
/// that is never exceeded caps the modes too: with κ the least stiffness of the hinges and
/// μ ≥ the spectral radius of M(rest)⁻¹(M − M(rest)),
///
///     |w_j| ≤ √(2E/(1 − μ)) √(P_j diag(κ, M_0)⁻¹ P_jᴴ)                                          (7)
///
/// On a base that turns by ψ = s t the push on the wing at rest, g = g_c cos ψ + g_s sin ψ in n, swings every mode as
///
///     w'_j = X e^(iψ)/(2(is − λ_j)) + Y e^(−iψ)/(2(−is − λ_j))       X, Y = p_j M_0⁻¹Sᵀ(g_c ∓ i g_s)      (9)
///
/// so that in (5) |w_j(0) − w'_j(0)| and the largest |w'_j| take the place of |w_j(0)|, and n has of the push only
/// what bending adds to it.
///
/// Then |M_i| ≤ Σ |K W_u + C W_v|_ij B_j + f_i + |M_i at rest|, and of the reactions, Y_ik the levers,
///
///     |Y_i| ≤ |Σ_j |F_ij| B_j| + Σ_k |Y_ik| (what (6) adds to the modes + |turn_k| a_k + ω_k²) + |a| m (8)
///
/// F_ij by the accelerations of mode j at rest, component by component.
///
/// The proof uses a library's eigenvectors and sums, whose last bits may differ between processors:
/// a run may then end a look earlier or later, but no peak depends on when a run ends.
#pragma once

#include "core/proofs/modes.hpp"
#include "core/proofs/rest_model.hpp"

#include <Eigen/Dense>

#include <complex>
#include <optional>
#include <vector>

namespace wingspread {

/// @tparam N of hinges, as of Modes
template <int N = Eigen::Dynamic> class ModalBounds {
public:
  using Of = SizesFor<N>;
  using Vector = Eigen::Matrix<double, N, 1>; ///< of hinges

  /// Finds the modes. Cost O(n³). @return whether all of them decay
  bool prepare(const RestModel& model);

  /// Makes ready for energies E ≥ T + ½ Σ κ_i (φ_i − rest_i)² that are never exceeded. @pre prepared
  /// @param least, rest 1 … n: κ, N·m/rad, and the angles; null: energies are not asked of
  void prepare_cap(const double* least, const double* rest);

  /// Whether no moment and no force will exceed these, from a state on. Cost O(n²) a pass.
  /// @param angles, rates of the hinges
  /// @param moments, forces of each hinge so far; null: not asked for
  /// @param t s; counts on a base that turns
  /// @param energy that is never exceeded, J, where there is one
  /// @param spin   |H| of a free base about the common centre of mass, kg·m²/s, else 0
  /// @pre prepared, and all decay
  bool none_exceeds(const double* angles, const double* rates, const double* moments,
                    const double* forces, double t, const std::optional<double>& energy,
                    double spin);

  /// Finds `rates()` alone.
  void find_rates(const double* angles, const double* rates, double t);
  /// Of the last question, where a box was found: 0 … n − 1.
  [[nodiscard]] const Vector& moment() const { return moment_; }
  [[nodiscard]] const Vector& force() const { return force_; }
  [[nodiscard]] const Eigen::VectorXd& ways() const { return u_; } ///< off rest, rad
  /// No hinge of the linear model will turn faster from that state on, rad/s.
  [[nodiscard]] const Vector& rates() const { return rate_; }

private:
  static constexpr int most(int count) { return count == Eigen::Dynamic ? Of::states : count; }
  /// The only one in which the library keeps what has a single row.
  static constexpr int order(int rows, int columns) {
    return rows == 1 && columns != 1 ? Eigen::RowMajor : Eigen::ColMajor;
  }
  /// Where a number is dynamic there are as many as modes that are kept.
  template <int rows, int columns>
  using Kept =
      Eigen::Matrix<double, rows, columns, order(rows, columns), most(rows), most(columns)>;
  template <int rows, int columns>
  using Fixed = Eigen::Matrix<double, rows, columns, order(rows, columns)>;
  static constexpr int many = Eigen::Dynamic;
  using Square = Fixed<N, N>;
  using States = Fixed<Of::states, 1>;
  using Bodies = Fixed<Of::bodies, 1>;
  using Matrix = Fixed<Of::states, Of::states>;
  using OfModes = Kept<many, 1>;
  /// A real one, or one of a conjugate pair, whose real and imaginary part have columns of their own.
  struct Mode {
    int column;
    bool is_pair;
  };

  [[nodiscard]] int size() const { return N == Eigen::Dynamic ? n_ : N; }
  [[nodiscard]] int modes() const { return static_cast<int>(modes_.size()); }
  void keep(const Matrix& V, const Matrix& residual);
  void keep_columns(const Matrix& V, const OfModes& quick);
  void keep_rows(const OfModes& time);
  void keep_push(const Fixed<Of::states, Of::bodies>& by_turns);
  [[nodiscard]] static std::complex<double> of_mode(const Mode& mode, const States& rows);
  void take_push(const States& rows, double t);
  template <class Products> [[nodiscard]] auto sizes_of_rows(const Products& products) const;
  template <class Products> [[nodiscard]] auto sizes_of_columns(const Products& products) const;
  [[nodiscard]] static double size_of_residual(const Matrix& E, const Mode& of, const Mode& by);
  bool find_box(const std::optional<double>& energy, double spin);
  void follow();
  void cap_modes(double energy);
  void bound_linear(const OfModes& modes);
  void bound_all();
  [[nodiscard]] bool below(const double* moments, const double* forces) const;

  const RestModel* model_ = nullptr;
  int n_ = 0;
  Square inverse_; ///< M_0⁻¹
  Modes<N> found_;
  std::vector<Mode> modes_; ///< those kept: one of each conjugate pair
  Matrix rows_; ///< V⁻¹, V having the columns v of a real mode, and v, v' of a pair v ± iv'
  Kept<N, many> way_, rate_of_;                  ///< |W_u|, |W_v|, pairs counted twice
  Kept<Of::bodies, many> turn_, swing_;          ///< |S W_v|, |S W_v Λ|, likewise
  Kept<many, Of::bodies> by_turns_;              ///< of (5), divided by α
  Kept<many, N> by_hinges_;                      ///< likewise
  Kept<many, many> rounding_;                    ///< likewise
  Fixed<Of::bodies, Of::bodies> swing_by_turns_; ///< of (6)
  Fixed<Of::bodies, N> swing_by_hinges_;         ///< of (6)
  Kept<N, many> moment_of_, force_x_, force_y_;
  Fixed<N, Of::bodies> lever_;
  OfModes by_energy_, offset_; ///< of (7): the root, and what the two rests differ by
  bool capped_ = false;
  /// Of (9), what goes round with the base and against it.
  std::vector<std::complex<double>> with_base_, against_base_;
  OfModes swung_; ///< the most that (9) comes to
  // of a question
  States z_;
  OfModes start_, B_, next_B_; ///< start_: |w(0) − w'(0)|
  Bodies a_, next_a_, added_;
  double rigid_ = 0, next_rigid_ = 0; ///< |r| of the box, and the right side of (4)
  double momentum_ = 0;               ///< |H|
  Bodies turned_, spin_, n_bound_;
  Eigen::VectorXd u_, v_, f_; ///< of hinges
  Vector moment_, force_, rate_;
};

extern template class ModalBounds<1>;
extern template class ModalBounds<2>;
extern template class ModalBounds<3>;
extern template class ModalBounds<4>;
extern template class ModalBounds<>;

} // namespace wingspread
