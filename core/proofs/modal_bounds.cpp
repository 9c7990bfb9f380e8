#include "core/proofs/modal_bounds.hpp"

#include <algorithm>
#include <cmath>

namespace wingspread {

namespace {

/// A·B, by sums written out: of the few bodies of a wing a library's blocks take longer to begin.
template <class A, class B> auto product(const A& a, const B& b) { return a.lazyProduct(b); }

double size_of(double real, double imaginary) {
  return std::sqrt(real * real + imaginary * imaginary);
}

} // namespace

template <int N> bool ModalBounds<N>::prepare(const RestModel& model) {
  model_ = &model, n_ = model.size();
  const int n = size();
  inverse_ = seen_as<Square>(model.mass).llt().solve(Square::Identity(n, n));
  Matrix L = Matrix::Zero(2L * n, 2L * n);
  L.template topRightCorner<N, N>(n, n).setIdentity();
  L.template bottomLeftCorner<N, N>(n, n) = -product(inverse_, seen_as<Square>(model.stiffness));
  L.template bottomRightCorner<N, N>(n, n) = -product(inverse_, seen_as<Square>(model.damping));
  if (!L.allFinite()) return false;
  if (!found_.find(model, L)) return false;
  const auto decays = [](const std::complex<double>& value) { return value.real() < 0; };
  if (!std::ranges::all_of(found_.values(), decays)) return false;
  const Matrix& V = found_.columns();
  rows_ = V.partialPivLu().inverse();
  if (!rows_.allFinite()) return false;
  const Matrix changes = product(L, V);
  keep(V, product(rows_, changes) - found_.blocks());
  return true;
}

template <int N> void ModalBounds<N>::prepare_cap(const double* least, const double* rest) {
  capped_ = least != nullptr;
  if (!capped_) return;
  const int n = size();
  Vector apart(n);
  States squares(2L * n);
  for (int i = 0; i < n; ++i) apart(i) = rest[i] - model_->angles(i);
  offset_ = sizes_of_rows(product(rows_.template leftCols<N>(n), apart).eval());
  const auto quick = rows_.template rightCols<N>(n);
  const auto slow = product(quick, inverse_).eval();
  for (int j = 0; j < 2 * n; ++j) {
    squares(j) = std::abs(quick.row(j).dot(slow.row(j)));
    for (int i = 0; i < n; ++i) squares(j) += rows_(j, i) * rows_(j, i) / least[i];
  }
  by_energy_ = sizes_of_rows(squares.cwiseSqrt().eval());
}

/// |p_j x| of every mode, from the products of its rows.
template <int N>
template <class Products>
auto ModalBounds<N>::sizes_of_rows(const Products& products) const {
  Eigen::Matrix<double, many, Products::ColsAtCompileTime, 0, Of::states,
                Products::MaxColsAtCompileTime>
      sizes(modes(), products.cols());
  for (int m = 0; m < modes(); ++m)
    for (int k = 0; k < products.cols(); ++k) {
      const int j = modes_[m].column;
      sizes(m, k) = modes_[m].is_pair ? 0.5 * size_of(products(j, k), products(j + 1, k))
                                      : std::abs(products(j, k));
    }
  return sizes;
}

/// |x w_j| of every mode, pairs counted twice, from the products of its columns.
template <int N>
template <class Products>
auto ModalBounds<N>::sizes_of_columns(const Products& products) const {
  Kept<Products::RowsAtCompileTime, many> sizes(products.rows(), modes());
  for (int m = 0; m < modes(); ++m)
    for (int k = 0; k < products.rows(); ++k) {
      const int j = modes_[m].column;
      sizes(k, m) = modes_[m].is_pair ? 2 * size_of(products(k, j), products(k, j + 1))
                                      : std::abs(products(k, j));
    }
  return sizes;
}

/// |e_jk| of two modes, that of the conjugate of the second added where it is one of a pair.
template <int N>
double ModalBounds<N>::size_of_residual(const Matrix& E, const Mode& of, const Mode& by) {
  const int a = of.column, c = by.column;
  if (of.is_pair && by.is_pair)
    return 0.5 * (size_of(E(a, c) + E(a + 1, c + 1), E(a, c + 1) - E(a + 1, c)) +
                  size_of(E(a, c) - E(a + 1, c + 1), E(a, c + 1) + E(a + 1, c)));
  if (of.is_pair) return 0.5 * size_of(E(a, c), E(a + 1, c));
  return by.is_pair ? 2 * size_of(E(a, c), E(a, c + 1)) : std::abs(E(a, c));
}

template <int N> void ModalBounds<N>::keep(const Matrix& V, const Matrix& residual) {
  const std::vector<std::complex<double>>& lambda = found_.values();
  modes_.clear();
  for (int j = 0; j < 2 * size(); ++j)
    if (lambda[j].imag() >= 0) modes_.push_back({j, lambda[j].imag() > 0});
  const int count = modes();
  OfModes time(count), quick(count);
  rounding_.resize(count, count);
  for (int m = 0; m < count; ++m) {
    const std::complex<double> own = lambda[modes_[m].column];
    time(m) = -1 / own.real(), quick(m) = size_of(own.real(), own.imag());
    for (int k = 0; k < count; ++k)
      rounding_(m, k) = time(m) * size_of_residual(residual, modes_[m], modes_[k]);
  }
  keep_columns(V, quick);
  keep_rows(time);
  const int n = size();
  for (Eigen::VectorXd* v : {&u_, &v_, &f_}) v->setZero(n);
  for (Vector* v : {&moment_, &force_, &rate_}) v->setZero(n);
  for (Bodies* v : {&turned_, &spin_, &n_bound_, &a_, &next_a_, &added_}) v->setZero(n + 1);
}

/// What the modes move. @param quick |λ|
template <int N> void ModalBounds<N>::keep_columns(const Matrix& V, const OfModes& quick) {
  const int n = size();
  const auto ways = V.template topRows<N>(n), rates = V.template bottomRows<N>(n);
  way_ = sizes_of_columns(ways), rate_of_ = sizes_of_columns(rates);
  const auto turns = product(seen_as<Fixed<Of::bodies, N>>(model_->turns), rates).eval();
  turn_ = sizes_of_columns(turns);
  swing_ = turn_ * quick.asDiagonal();
  moment_of_ = sizes_of_columns((product(seen_as<Square>(model_->stiffness), ways) +
                                 product(seen_as<Square>(model_->damping), rates))
                                    .eval());
  using Levers = Fixed<N, Of::bodies>;
  const auto x = seen_as<Levers>(model_->lever_x), y = seen_as<Levers>(model_->lever_y);
  force_x_ = sizes_of_columns(product(y, turns).eval()) * quick.asDiagonal();
  force_y_ = sizes_of_columns(product(x, turns).eval()) * quick.asDiagonal();
  lever_ = (x.array().square() + y.array().square()).sqrt().matrix();
}

/// What moves the modes. @param time 1/α
template <int N> void ModalBounds<N>::keep_rows(const OfModes& time) {
  const auto S = seen_as<Fixed<Of::bodies, N>>(model_->turns);
  const auto drive = product(rows_.template rightCols<N>(size()), inverse_).eval();
  by_hinges_ = time.asDiagonal() * sizes_of_rows(drive);
  const Fixed<Of::states, Of::bodies> by_turns = product(drive, S.transpose());
  by_turns_ = time.asDiagonal() * sizes_of_rows(by_turns);
  keep_push(by_turns);
  const auto answer = product(S, inverse_).eval();
  swing_by_hinges_ = answer.cwiseAbs();
  swing_by_turns_ = (product(answer, S.transpose()).array() + model_->rigid).abs().matrix();
}

/// (9). @param by_turns p_j M_0⁻¹Sᵀ of the rows
template <int N> void ModalBounds<N>::keep_push(const Fixed<Of::states, Of::bodies>& by_turns) {
  using Complex = std::complex<double>;
  swung_.setZero(modes());
  with_base_.clear(), against_base_.clear();
  if (model_->turn_rate == 0) return;
  const States cosine = product(by_turns, model_->push_cosine),
               sine = product(by_turns, model_->push_sine);
  const Complex i(0, 1), turning = i * model_->turn_rate;
  for (int m = 0; m < modes(); ++m) {
    const Complex c = of_mode(modes_[m], cosine), s = of_mode(modes_[m], sine),
                  lambda = found_.values()[modes_[m].column];
    with_base_.push_back(0.5 * (c - i * s) / (turning - lambda));
    against_base_.push_back(0.5 * (c + i * s) / (-turning - lambda));
    swung_(m) = std::abs(with_base_[m]) + std::abs(against_base_[m]);
  }
}

/// p_j x of a mode, from the products of its rows.
template <int N>
std::complex<double> ModalBounds<N>::of_mode(const Mode& mode, const States& rows) {
  const int j = mode.column;
  return mode.is_pair ? 0.5 * std::complex(rows(j), -rows(j + 1)) : std::complex(rows(j));
}

/// |w − w'| in place of |w|.
template <int N> void ModalBounds<N>::take_push(const States& rows, double t) {
  const auto round = std::polar(1.0, model_->turn_rate * (t - model_->since));
  for (int m = 0; m < modes(); ++m)
    start_(m) = std::abs(of_mode(modes_[m], rows) - with_base_[m] * round -
                         against_base_[m] * std::conj(round));
}

template <int N>
void ModalBounds<N>::find_rates(const double* angles, const double* rates, double t) {
  const int n = size();
  z_.resize(2L * n);
  for (int i = 0; i < n; ++i) z_(i) = angles[i] - model_->angles(i), z_(n + i) = rates[i];
  const States rows = product(rows_, z_);
  start_ = sizes_of_rows(rows);
  if (!with_base_.empty()) take_push(rows, t);
  rate_ = product(rate_of_, start_ + swung_);
}

template <int N>
bool ModalBounds<N>::none_exceeds(const double* angles, const double* rates, const double* moments,
                                  const double* forces, double t,
                                  const std::optional<double>& energy, double spin) {
  find_rates(angles, rates, t);
  bound_linear(start_);
  if (!below(moments, forces) || !find_box(energy, spin)) return false;
  bound_all();
  return below(moments, forces);
}

/// A box that (4), (5) and (6) do not leave.
template <int N> bool ModalBounds<N>::find_box(const std::optional<double>& energy, double spin) {
  constexpr int passes = 12;
  constexpr double wider = 1.02;
  B_ = wider * (start_ + swung_);
  a_ = product(swing_, B_);
  momentum_ = spin;
  rigid_ = model_->spin + wider * model_->rigid * spin;
  for (int pass = 0; pass < passes; ++pass) {
    follow();
    if (capped_ && energy) cap_modes(*energy);
    if (!next_B_.allFinite() || !next_a_.allFinite()) return false;
    // on a base that is not free the first body does not take part: 0 in 0
    const bool inside = (next_B_.array() <= B_.array()).all() &&
                        (next_a_.array() <= a_.array()).all() && next_rigid_ <= rigid_;
    if (inside) return (u_.array() < model_->room.array()).all();
    rigid_ = std::max(rigid_, wider * next_rigid_);
    B_ = B_.cwiseMax(wider * next_B_), a_ = a_.cwiseMax(wider * next_a_);
  }
  return false;
}

/// The right sides of (4), (5) and (6) over the box.
template <int N> void ModalBounds<N>::follow() {
  u_ = product(way_, B_), v_ = product(rate_of_, B_);
  spin_ = product(turn_, B_);
  spin_.array() += rigid_;
  const RestModel& m = *model_;
  m.bound_remainders(u_, v_, f_);
  turned_(0) = n_bound_(0) = 0;
  for (int k = 1; k <= size(); ++k) {
    turned_(k) = u_(k - 1) + turned_(m.parents[k - 1]);
    n_bound_(k) = m.pushed(k) * turned_(k);
  }
  double momentum = momentum_;
  for (const RestModel::Pair& pair : m.pairs) {
    const int k = pair.first, l = pair.second;
    const double way = turned_(k) + turned_(l) - 2 * turned_(pair.meet);
    const double mass = way * std::fma(0.5 * pair.cosine, way, pair.sine);
    const double turning = std::fma(pair.cosine, way, pair.sine);
    n_bound_(k) += mass * a_(l) + turning * spin_(l) * spin_(l);
    n_bound_(l) += mass * a_(k) + turning * spin_(k) * spin_(k);
    momentum += mass * (spin_(k) + spin_(l));
  }
  next_rigid_ = m.spin + m.rigid * momentum;
  if (m.rigid == 0) n_bound_(0) = 0; // the base is not moved by it
  next_B_ = start_ + swung_ + product(rounding_, B_) + product(by_turns_, n_bound_) +
            product(by_hinges_, f_);
  if (m.turn_rate != 0) n_bound_ += m.pushed;
  added_ = product(swing_by_turns_, n_bound_) + product(swing_by_hinges_, f_);
  next_a_ = added_ + product(swing_, B_);
}

/// (7).
template <int N> void ModalBounds<N>::cap_modes(double energy) {
  double mu = 0; // by Collatz, a being positive
  const Bodies shaken = product(swing_by_turns_, n_bound_);
  for (int k = 0; k <= size(); ++k)
    if (shaken(k) > 0) mu = std::max(mu, shaken(k) / a_(k));
  if (!(mu < 1)) return;
  const double size = std::sqrt(2 * std::max(energy, 0.0) / (1 - mu));
  next_B_ = next_B_.cwiseMin(size * by_energy_ + offset_);
}

/// What the hinges will see where the modes alone act.
template <int N> void ModalBounds<N>::bound_linear(const OfModes& modes) {
  moment_ = product(moment_of_, modes);
  force_ = (product(force_x_, modes).array().square() + product(force_y_, modes).array().square())
               .sqrt();
}

template <int N> void ModalBounds<N>::bound_all() {
  constexpr double rounded_up = 1 + 1e-6;
  bound_linear(next_B_);
  moment_ = rounded_up * (moment_ + f_ + model_->moment.cwiseAbs());
  const Bodies shaken = added_.array() + turned_.array() * a_.array() + spin_.array().square();
  force_ += product(lever_, shaken);
  force_ = rounded_up * (force_ + model_->weight);
}

template <int N> bool ModalBounds<N>::below(const double* moments, const double* forces) const {
  using Map = Eigen::Map<const Vector>;
  return (!moments || (moment_.array() <= Map(moments, size()).array()).all()) &&
         (!forces || (force_.array() <= Map(forces, size()).array()).all());
}

template class ModalBounds<1>;
template class ModalBounds<2>;
template class ModalBounds<3>;
template class ModalBounds<4>;
template class ModalBounds<>;

} // namespace wingspread
