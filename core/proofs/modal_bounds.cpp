#include "core/proofs/modal_bounds.hpp"

#include <algorithm>
#include <cmath>

namespace wingspread {

namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

/// A·B, by sums written out: of the few bodies of a wing a library's blocks take longer to begin.
template <class A, class B> auto product(const A& a, const B& b) { return a.lazyProduct(b); }

double size_of(double real, double imaginary) {
  return std::sqrt(real * real + imaginary * imaginary);
}

} // namespace

bool ModalBounds::prepare(const RestModel& model) {
  model_ = &model, n_ = model.size();
  inverse_ = model.mass.llt().solve(Matrix::Identity(n_, n_));
  const Eigen::Index states = 2L * n_;
  Matrix L = Matrix::Zero(states, states);
  L.topRightCorner(n_, n_).setIdentity();
  L.bottomLeftCorner(n_, n_) = -product(inverse_, model.stiffness);
  L.bottomRightCorner(n_, n_) = -product(inverse_, model.damping);
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

void ModalBounds::prepare_cap(const double* least, const double* rest) {
  capped_ = least != nullptr;
  if (!capped_) return;
  Vector apart(n_), squares(2L * n_);
  for (int i = 0; i < n_; ++i) apart(i) = rest[i] - model_->angles(i);
  offset_ = sizes_of_rows(product(rows_.leftCols(n_), apart));
  const Matrix slow = product(rows_.rightCols(n_), inverse_);
  for (int j = 0; j < 2 * n_; ++j) {
    squares(j) = std::abs(rows_.row(j).tail(n_).dot(slow.row(j)));
    for (int i = 0; i < n_; ++i) squares(j) += rows_(j, i) * rows_(j, i) / least[i];
  }
  by_energy_ = sizes_of_rows(squares.cwiseSqrt());
}

/// |p_j x| of every mode, from the products of its rows.
Eigen::MatrixXd ModalBounds::sizes_of_rows(const Products& products) const {
  Matrix sizes(modes_.size(), products.cols());
  for (std::size_t m = 0; m < modes_.size(); ++m)
    for (int k = 0; k < products.cols(); ++k) {
      const int j = modes_[m].column;
      sizes(m, k) = modes_[m].is_pair ? 0.5 * size_of(products(j, k), products(j + 1, k))
                                      : std::abs(products(j, k));
    }
  return sizes;
}

/// |x w_j| of every mode, pairs counted twice, from the products of its columns.
Eigen::MatrixXd ModalBounds::sizes_of_columns(const Products& products) const {
  Matrix sizes(products.rows(), modes_.size());
  for (std::size_t m = 0; m < modes_.size(); ++m)
    for (int k = 0; k < products.rows(); ++k) {
      const int j = modes_[m].column;
      sizes(k, m) = modes_[m].is_pair ? 2 * size_of(products(k, j), products(k, j + 1))
                                      : std::abs(products(k, j));
    }
  return sizes;
}

/// |e_jk| of two modes, that of the conjugate of the second added where it is one of a pair.
double ModalBounds::size_of_residual(const Matrix& E, const Mode& of, const Mode& by) {
  const int a = of.column, c = by.column;
  if (of.is_pair && by.is_pair)
    return 0.5 * (size_of(E(a, c) + E(a + 1, c + 1), E(a, c + 1) - E(a + 1, c)) +
                  size_of(E(a, c) - E(a + 1, c + 1), E(a, c + 1) + E(a + 1, c)));
  if (of.is_pair) return 0.5 * size_of(E(a, c), E(a + 1, c));
  return by.is_pair ? 2 * size_of(E(a, c), E(a, c + 1)) : std::abs(E(a, c));
}

void ModalBounds::keep(const Matrix& V, const Matrix& residual) {
  const std::vector<std::complex<double>>& lambda = found_.values();
  modes_.clear();
  for (int j = 0; j < 2 * n_; ++j)
    if (lambda[j].imag() >= 0) modes_.push_back({j, lambda[j].imag() > 0});
  const auto count = static_cast<Eigen::Index>(modes_.size());
  Vector time(count), quick(count);
  rounding_.resize(count, count);
  for (int m = 0; m < count; ++m) {
    const std::complex<double> own = lambda[modes_[m].column];
    time(m) = -1 / own.real(), quick(m) = size_of(own.real(), own.imag());
    for (int k = 0; k < count; ++k)
      rounding_(m, k) = time(m) * size_of_residual(residual, modes_[m], modes_[k]);
  }
  keep_columns(V, quick);
  keep_rows(time);
  const int bodies = n_ + 1;
  for (Vector* v : {&u_, &v_, &f_, &moment_, &force_, &rate_}) v->setZero(n_);
  for (Vector* v : {&turned_, &spin_, &n_bound_, &a_, &next_a_, &added_}) v->setZero(bodies);
}

/// What the modes move. @param quick |λ|
void ModalBounds::keep_columns(const Matrix& V, const Vector& quick) {
  const auto ways = V.topRows(n_), rates = V.bottomRows(n_);
  way_ = sizes_of_columns(ways), rate_of_ = sizes_of_columns(rates);
  const Matrix turns = product(model_->turns, rates);
  turn_ = sizes_of_columns(turns);
  swing_ = turn_ * quick.asDiagonal();
  moment_of_ = sizes_of_columns(product(model_->stiffness, ways) + product(model_->damping, rates));
  force_x_ = sizes_of_columns(product(model_->lever_y, turns)) * quick.asDiagonal();
  force_y_ = sizes_of_columns(product(model_->lever_x, turns)) * quick.asDiagonal();
  lever_ = (model_->lever_x.array().square() + model_->lever_y.array().square()).sqrt().matrix();
}

/// What moves the modes. @param time 1/α
void ModalBounds::keep_rows(const Vector& time) {
  const Matrix& S = model_->turns;
  const Matrix drive = product(rows_.rightCols(n_), inverse_);
  by_hinges_ = time.asDiagonal() * sizes_of_rows(drive);
  by_turns_ = time.asDiagonal() * sizes_of_rows(product(drive, S.transpose()));
  const Matrix answer = product(S, inverse_);
  swing_by_hinges_ = answer.cwiseAbs();
  swing_by_turns_ = (product(answer, S.transpose()).array() + model_->rigid).abs().matrix();
}

void ModalBounds::find_rates(const double* angles, const double* rates) {
  z_.resize(2L * n_);
  z_.head(n_) = Eigen::Map<const Vector>(angles, n_) - model_->angles;
  z_.tail(n_) = Eigen::Map<const Vector>(rates, n_);
  start_ = sizes_of_rows(product(rows_, z_));
  rate_ = product(rate_of_, start_);
}

bool ModalBounds::none_exceeds(const double* angles, const double* rates, const double* moments,
                               const double* forces, const std::optional<double>& energy,
                               double spin) {
  find_rates(angles, rates);
  bound_linear(start_);
  if (!below(moments, forces) || !find_box(energy, spin)) return false;
  bound_all();
  return below(moments, forces);
}

/// A box that (4), (5) and (6) do not leave.
bool ModalBounds::find_box(const std::optional<double>& energy, double spin) {
  constexpr int passes = 12;
  constexpr double wider = 1.02;
  B_ = wider * start_;
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
void ModalBounds::follow() {
  u_ = product(way_, B_), v_ = product(rate_of_, B_);
  spin_ = product(turn_, B_);
  spin_.array() += rigid_;
  const RestModel& m = *model_;
  m.bound_remainders(u_, v_, f_);
  turned_(0) = n_bound_(0) = 0;
  for (int k = 1; k <= n_; ++k) {
    turned_(k) = u_(k - 1) + turned_(m.parents[k - 1]);
    n_bound_(k) = m.pushed(k) * (m.push_turns ? 1.0 : turned_(k));
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
  next_B_ =
      start_ + product(rounding_, B_) + product(by_turns_, n_bound_) + product(by_hinges_, f_);
  added_ = product(swing_by_turns_, n_bound_) + product(swing_by_hinges_, f_);
  next_a_ = added_ + product(swing_, B_);
}

/// (7).
void ModalBounds::cap_modes(double energy) {
  double mu = 0; // by Collatz, a being positive
  const Vector shaken = product(swing_by_turns_, n_bound_);
  for (int k = 0; k <= n_; ++k)
    if (shaken(k) > 0) mu = std::max(mu, shaken(k) / a_(k));
  if (!(mu < 1)) return;
  const double size = std::sqrt(2 * std::max(energy, 0.0) / (1 - mu));
  next_B_ = next_B_.cwiseMin(size * by_energy_ + offset_);
}

/// What the hinges will see where the modes alone act.
void ModalBounds::bound_linear(const Vector& modes) {
  moment_ = product(moment_of_, modes);
  force_ = (product(force_x_, modes).array().square() + product(force_y_, modes).array().square())
               .sqrt();
}

void ModalBounds::bound_all() {
  constexpr double rounded_up = 1 + 1e-6;
  bound_linear(next_B_);
  moment_ = rounded_up * (moment_ + f_ + model_->moment.cwiseAbs());
  const Vector shaken = added_.array() + turned_.array() * a_.array() + spin_.array().square();
  force_ += product(lever_, shaken);
  force_ = rounded_up * (force_ + model_->weight);
}

bool ModalBounds::below(const double* moments, const double* forces) const {
  using Map = Eigen::Map<const Vector>;
  return (!moments || (moment_.array() <= Map(moments, n_).array()).all()) &&
         (!forces || (force_.array() <= Map(forces, n_).array()).all());
}

} // namespace wingspread
