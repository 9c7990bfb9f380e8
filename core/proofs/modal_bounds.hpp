/// Bounds on every later moment and force of each hinge of a latched wing, mode by mode.
///
/// | symbol | meaning                                                         | unit       | source             |
/// |--------|-----------------------------------------------------------------|------------|--------------------|
/// | u, u̇   | ways of the hinges off rest, and their rates; z = (u, u̇)        | rad, rad/s | rest_model.hpp     |
/// | M_0, K, C | mass, stiffness and damping of the hinges at rest            |            | rest_model.hpp (2) |
/// | S      | rates of the bodies for rates of the hinges                     | –          | rest_model.hpp     |
/// | n, f   | what M_0, K and C leave out: moments on bodies, at hinges       | N·m        | rest_model.hpp (3) |
/// | r, H, I | rigid rotation of the whole; angular momentum, inertia         | rad/s, …   | rest_model.hpp (4) |
/// | L      | ż = L z is the linear model                                     |            |                    |
/// | λ, Λ, W | eigenvalues of L, and its eigenvectors (W_u, W_v)              | 1/s        | modes.hpp          |
/// | P, p_j | W⁻¹, and its rows: w = P z are the coordinates of the modes     |            |                    |
/// | e      | P L W − Λ: what rounding leaves                                 | 1/s        |                    |
/// | α_j    | −Re λ_j > 0                                                     | 1/s        |                    |
/// | B_j    | no |w_j| is larger from now on                                  |            | (5)                |
/// | a_k    | no angular acceleration of body k is larger                     | rad/s²     | (6)                |
/// | E, κ   | energy that is never exceeded; least stiffnesses of the hinges  | J, N·m/rad | remaining_energy.hpp |
/// | Y_ik   | first moment of what is outward of hinge i, by body k's turning | kg·m       | rest_model.hpp     |
///
/// By (2) of rest_model.hpp
///
///     ẇ_j = λ_j w_j + e_j w + p_j M_0⁻¹ (Sᵀn + f)
///
/// so that from now on, while no |w_j| leaves B_j and no |ω̇_k| leaves a_k,
///
///     |w_j| ≤ max(|w_j(0)|, Σ |e_jk| B_k/α_j + q_j d_j) + b_j d_j                                 (5)
///     d_j = (Σ |p_j M_0⁻¹Sᵀ|_k n_k + Σ |p_j M_0⁻¹|_k f_k)/α_j
///     |ω̇_k| ≤ Σ |S W_v Λ|_kj B_j + Σ |S M_0⁻¹Sᵀ + 1 1ᵀ/I|_kl n_l + Σ |S M_0⁻¹|_kl f_l            (6)
///
/// In (5) a start decays as e^(−αt) while what drives the mode builds up as 1 − e^(−αt): the sum stays below the larger of
/// both. A real mode has q = 1 and b = 0. A mode of a pair turns at ω = Im λ, and n and f are real: only the share
/// |cos(ωt + φ)| of them drives it further, on average 2/π. The excess over this average adds, by Bonnet's mean value
/// theorem, no more with the decay than without it over the best part of one period:
///
///     q = 2/π,  b = 2 (√(1 − q²) − q acos q) α/ω,      or q = 1, b = 0 where that is less           (5a)
///
/// (3) bounds n and f over this box, with |u| ≤ |W_u| B, |u̇| ≤ |W_v| B and |ω| ≤ |S W_v| B + |r|; (4)
/// bounds r. If the right sides lie inside the box, the trajectory stays inside it. For w and r this
/// follows from continuity: they would have to reach the edge first. Accelerations jump where
/// friction does, but obey (6) at each instant, and a box that holds its own right side shows that
/// the matrix in front of a is contracting. Fast modes soon vanish from |w(0)|, and the bounds with
/// them.
///
/// An energy E that is never exceeded caps the modes too. With μ ≥ the spectral radius of
/// M(rest)⁻¹(M − M(rest)),
///
///     |w_j| ≤ √(2E/(1 − μ)) √(P_j diag(κ, M_0)⁻¹ P_jᴴ)                                          (7)
///
/// For one of a pair of modes P_j is complex, and no real state makes |w_j| as large as (7). The second root is then
/// that of the larger eigenvalue of the 2×2 matrix of the same products of Re P_j and Im P_j.
///
/// E also bounds every linear function l z of the state, with l in place of P_j in (7), and the part of l z that the
/// slowest modes make. Slow modes need this: (5) takes friction for a moment of either sign, which could drive them far.
/// With m_j = |l w_j|, and l_s z the part of the slowest s modes,
///
///     |l z| ≤ min over s of ( Σ m_j B_j over the others + √(2E/(1 − μ)) √(l_s diag(κ, M_0)⁻¹ l_sᵀ) )    (10)
///
/// E bounds ways and rates without any box, and with them the changes of M. Where μ < 1 for the largest ways, (7) gives
/// a box that the motion never leaves, whatever the right sides of (5) are. Every image of such a box is another one
/// (modal_energy.cpp). A free base that turns keeps H: the energy of the rigid turning, at least H²/2I for the largest
/// I, never moves a hinge, and E' is the rest of E.
///
/// The hinges then see, beside their moments at rest, moments and reactions of at most
///
///     |M_i| ≤ Σ |K W_u + C W_v|_ij B_j + f_i + |M_i at rest|
///     |Y_i| ≤ |Σ_j |F_ij| B_j| + Σ_l |Σ_k Y_ik (S M_0⁻¹Sᵀ + 1 1ᵀ/I)_kl| n_l + Σ_l |Σ_k Y_ik (S M_0⁻¹)_kl| f_l
///             + Σ_k |Y_ik| (|turn_k| a_k + ω_k²) + |a| m                                        (8)
///
/// F_ij by the accelerations of mode j at rest, component by component; |a| m is the base's push. Each sum over modes
/// is a linear function of the state, for which (10) may say less.
///
/// On a base that turns by ψ = s t the push on the wing at rest is g = g_c cos ψ + g_s sin ψ in n. g
/// swings every mode as
///
///     w'_j = X e^(iψ)/(2(is − λ_j)) + Y e^(−iψ)/(2(−is − λ_j))       X, Y = p_j M_0⁻¹Sᵀ(g_c ∓ i g_s)      (9)
///
/// In (5), |w_j(0) − w'_j(0)| then replaces |w_j(0)|, the largest |w'_j| is added, and n keeps only what
/// bending adds to the push.
///
/// On a base that turns at a rate Ω with a constant angular acceleration ε, and no linear one, E = T + Σ ½ κ u² as seen
/// from the base may grow. With the inertia about the base's origin, I = 1ᵀM 1,
///
///     dE/dt ≤ ½ Ω² dI/dt − ε 1ᵀM S u̇
///
/// Let y* be the rest of remaining_energy.hpp and E_0 = E(t) − ½ Ω(t)² (I(t) − I(y*)). While E ≤ A, let δI, u and δM bound
/// I − I(rest), the ways off rest and M − M(rest); |I − I(y*)| is then at most 2 δI. As ∫ |Ω ε| dt ≤ max Ω², by parts
///
///     E ≤ E_0 + 3 max Ω² δI + 2 |ε| Σ |1ᵀM(rest) S|_i u_i + |ε| (t_end − t) max |1ᵀδM S u̇|       (11)
///
/// up to t_end. (The code takes |1ᵀM(rest)| |S| for |1ᵀM(rest) S|.) Where the right side is below A, the motion never
/// reaches A. It starts below A: δI is concave in A, so that A' − E_0 > 3 max Ω² δI(A') for every A' > A too, whereas
/// E(t) − E_0 ≤ max Ω² δI(E(t)). The right side is then a bound of E, and may take the place of A.
///
/// Eigenvectors and sums are a library's: their last bits may differ between processors. A run may
/// then end some steps earlier or later, but no peak depends on when a run ends.
#pragma once

#include "core/proofs/modes.hpp"
#include "core/proofs/rest_model.hpp"

#include <Eigen/Core>

#include <complex>
#include <optional>
#include <vector>

namespace wingspread {

/// A free base turns as the hinges do, by (S u)_0, and with the whole, by ∫ r.
struct BaseBounds {
  double way;   ///< |(S u)_0|, rad
  double rate;  ///< |(S u̇)_0|, rad/s
  double drift; ///< |r − H/I|, rad/s
};

/// Upper bounds for each hinge, 0 … n − 1.
struct HingeBounds {
  HingeVector moment; ///< N·m
  HingeVector force;  ///< N
  HingeVector way;    ///< off rest, rad
  BaseBounds base;
};

/// The matrices of (5) to (10), made once for a latched wing, and the bounds that follow from a state.
///
/// Vectors have room for the largest model in place: a proof attempt allocates nothing.
class ModalBounds {
public:
  /// One number for each mode that is kept: one mode of each conjugate pair.
  using ModeVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2 * most_modelled_bodies, 1>;

  /// Finds the modes. Cost O(n³). The model must outlive the bounds.
  /// @param least, rest of each hinge κ, N·m/rad, and the angle φ, such that the energy is at least
  ///        T + ½ Σ κ (φ − rest)²; least may be null: `bound` then ignores energies
  /// @return none where a mode does not decay
  [[nodiscard]] static std::optional<ModalBounds> make(const RestModel& model, const double* least,
                                                       const double* rest);

  /// |w(0)|; on a base that turns |w(0) − w'(0)| of (9).
  /// @param angles, rates of the hinges
  /// @param t s, counts on a base that turns
  [[nodiscard]] ModeVector start(const double* angles, const double* rates, double t) const;

  /// The largest rates of the hinges from that start on in the linear model, rad/s.
  [[nodiscard]] HingeVector rates(const ModeVector& start) const;
  /// (S u)_0: the turn of a free base due to the hinges' ways off rest, rad. @param angles of the hinges, rad
  [[nodiscard]] double turn_of_base(const double* angles) const;
  /// Moment, N·m, and force, N, of hinge i while |w| stays below these: parts of what `bound` returns.
  [[nodiscard]] double linear_moment(int i, const ModeVector& modes) const;
  [[nodiscard]] double linear_force(int i, const ModeVector& modes) const;

  /// Bounds from that start on by (5) and (6). Cost O(n²) a pass.
  /// @param energy that is never exceeded, J, where there is one: it caps modes by (7) once there is a box
  /// @param spin |H| of a free base about the common centre of mass, kg·m²/s, else 0
  /// @return none where no box was found, or a hinge may leave RestModel::room
  [[nodiscard]] std::optional<HingeBounds>
  bound(const ModeVector& start, const std::optional<double>& energy, double spin) const;

  /// Bounds inside the box that the energy alone gives, with (10): closer, and several times as costly.
  /// The first call computes the matrices that (10) needs. @param energy E, J @param spin as of `bound`
  /// @return none without `least` in `make`, without such a box, or if a hinge may leave RestModel::room
  [[nodiscard]] std::optional<HingeBounds> bound_in_reach(const ModeVector& start, double energy,
                                                          double spin);

  /// Bounds the energy up to the run's end on a base with a constant angular acceleration and no linear one, by (11).
  /// Costs as much as `bound_in_reach`. @pre every hinge stays where its κ holds
  /// @param energy E_0, J @param time t_end − t, s
  /// @return J; none without `least` in `make`, or where no A was found
  [[nodiscard]] std::optional<double> most_energy(double energy, double time);

private:
  /// A·B by plain sums: for the few bodies of a wing a blocked product costs more to set up.
  template <class A, class B> [[nodiscard]] static auto product(const A& a, const B& b) {
    return a.lazyProduct(b);
  }

  using Matrix = Eigen::MatrixXd;

  /// A real one, or one of a conjugate pair.
  struct Mode : ModeColumns {
    std::complex<double> value; ///< λ
    std::complex<double> with_base{},
        against_base{}; ///< of (9): what turns with the base, and against
  };

  /// |w_j| ≤ modes, |ω̇_k| ≤ accelerations, |r| ≤ rigid.
  struct Box {
    ModeVector modes;
    BodyVector accelerations;
    double rigid;

    [[nodiscard]] bool is_finite() const { return modes.allFinite() && accelerations.allFinite(); }
    [[nodiscard]] bool holds(const Box& other) const;
    void widen_to(const Box& other);
    void shrink_to(const Box& other);
  };
  /// Bounds that hold for a motion inside a box.
  struct Image {
    Box box;                    ///< the right sides of (4), (5) and (6)
    HingeVector way, remainder; ///< |u|, f
    BodyVector turned, spin;    ///< by how much bodies have turned since rest, rad; |ω|
    BodyVector moments;         ///< n
    double drift;               ///< |r − H/I| by (4)
  };

  /// Bounds on all later motion by the energy alone.
  struct Reach {
    Box box;
    HingeVector way, rate; ///< |u|, |u̇|
    BodyVector spin;       ///< |ω|
    double size;           ///< √(2E'/(1 − μ))
    RestModel::EnergyOfTurns turns;
  };
  /// A bound μ, and a vector of accelerations by which it was found: (M(rest)⁻¹ |M − M(rest)| x)_k ≤ μ x_k.
  struct Contraction {
    double mu;
    BodyVector x;
  };

  explicit ModalBounds(const RestModel& model) : model_(&model) {}
  [[nodiscard]] int size() const { return model_->size(); }
  [[nodiscard]] int modes() const { return static_cast<int>(modes_.size()); }

  [[nodiscard]] bool find_modes();
  void keep_rounding(const Matrix& residual);
  void keep_columns(const Matrix& vectors, const Matrix& moments);
  void keep_rows();
  void keep_drive();
  void keep_push(const Matrix& by_turns);
  void keep_cap(const double* least, const double* rest);
  [[nodiscard]] double largest_by_energy(const Mode& mode, const double* least) const;
  void keep_reach();
  [[nodiscard]] Matrix make_loads() const;
  void keep_loads(const Matrix& gram, const Eigen::VectorXd& apart);

  [[nodiscard]] std::optional<HingeBounds> find_bounds(const ModeVector& start,
                                                       const std::optional<double>& energy,
                                                       double spin, const Reach* reach) const;

  [[nodiscard]] Image map(const Box& box, const ModeVector& start, double spin,
                          const Reach* reach) const;
  void cap_modes(double energy, const Box& box, Image& image) const;
  [[nodiscard]] Reach reach_of(double energy) const;
  [[nodiscard]] std::optional<double> energy_gained(double most, double time) const;
  [[nodiscard]] std::optional<Contraction> contraction(const Reach& reach) const;
  [[nodiscard]] std::optional<double> leave_turning(double& energy, const Reach& reach,
                                                    double spin) const;
  [[nodiscard]] std::optional<Reach> reach(double energy, const ModeVector& start,
                                           double spin) const;
  [[nodiscard]] double largest(int row, const Image& image, const Reach* reach) const;
  [[nodiscard]] HingeBounds bounds_inside(const Box& box, const Image& image,
                                          const Reach* reach) const;

  template <class Products> [[nodiscard]] auto sizes_of_rows(const Products& products) const;
  template <class Products> [[nodiscard]] Matrix sizes_of_columns(const Products& products) const;

  const RestModel* model_;
  std::vector<Mode> modes_; ///< those kept
  Matrix inverse_;          ///< M_0⁻¹
  Matrix drive_;            ///< P_v M_0⁻¹, the columns of P for rates times M_0⁻¹
  Matrix rows_; ///< P of a real W, with columns v of a real mode, v and v' of a pair v ± iv'
  Matrix way_, rate_of_;                    ///< |W_u|, |W_v|, pairs counted twice
  Matrix turn_, swing_;                     ///< |S W_v|, |S W_v Λ|, likewise
  Matrix rounding_, by_turns_, by_hinges_;  ///< of (5), divided by α
  ModeVector lasting_, at_first_;           ///< q and b of (5a)
  Matrix swing_by_turns_, swing_by_hinges_; ///< of (6)
  Matrix lever_;                            ///< |Y_ik|
  Matrix force_by_turns_, force_by_hinges_; ///< of (8)
  /// m_j of the linear functions of (8), by rows: moments, x and y of forces, way and rate of the base.
  Matrix load_of_;
  ModeVector swung_; ///< the largest |w'| of (9)

  bool is_capped_ = false;        ///< κ is known; then
  ModeVector by_energy_, offset_; ///< of (7): the second root, and what the two rests differ by
  HingeVector soft_, apart_;      ///< 1/√κ; from the model's rest to the energy's, rad
  Matrix columns_;                ///< W

  // made at the first call of bound_in_reach
  std::vector<int> slowest_; ///< the modes, the slowest first; empty: not made yet
  Matrix energy_loads_,
      offset_loads_; ///< of (10), by rows as load_of_, by columns s − 1: the root, and what the two rests differ by
  RestModel::EnergyOfTurns turns_; ///< of no energy
};

} // namespace wingspread
