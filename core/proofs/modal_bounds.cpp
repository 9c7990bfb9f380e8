#include "core/proofs/modal_bounds.hpp"

#include <algorithm>
#include <cmath>

namespace wingspread {

bool ModalBounds::prepare(const RestModel& model) {
  model_ = &model, n_ = model.size();
  inverse_ = model.mass.llt().solve(Matrix::Identity(n_, n_));
  const Eigen::Index states = 2L * n_;
  Matrix L = Matrix::Zero(states, states);
  L.topRightCorner(n_, n_).setIdentity();
  L.bottomLeftCorner(n_, n_) = -inverse_ * model.stiffness;
  L.bottomRightCorner(n_, n_) = -inverse_ * model.damping;
  if (!L.allFinite()) return false;
  solver_.compute(L);
  if (solver_.info() != Eigen::Success) return false;
  const Eigen::VectorXcd lambda = solver_.eigenvalues();
  if (!(lambda.real().maxCoeff() < 0)) return false;
  const Complex W = solver_.eigenvectors(), P = W.partialPivLu().inverse();
  if (!P.allFinite()) return false;
  Complex residual = P * L.cast<std::complex<double>>() * W;
  residual.diagonal() -= lambda;
  keep(lambda, W, P, residual);
  return true;
}

void ModalBounds::prepare_cap(const double* least, const double* rest) {
  capped_ = least != nullptr;
  if (!capped_) return;
  by_energy_.resize(modes_), offset_.resize(modes_);
  Vector apart(n_);
  for (int i = 0; i < n_; ++i) apart(i) = rest[i] - model_->angles(i);
  offset_ = (P_.leftCols(n_) * apart.cast<std::complex<double>>()).cwiseAbs();
  const Complex slow = P_.rightCols(n_) * inverse_.cast<std::complex<double>>();
  for (int j = 0; j < modes_; ++j) {
    double square = std::abs(P_.row(j).tail(n_).dot(slow.row(j)));
    for (int i = 0; i < n_; ++i) square += std::norm(P_(j, i)) / least[i];
    by_energy_(j) = std::sqrt(square);
  }
}

/// One mode of each conjugate pair, which counts twice.
void ModalBounds::keep(const Eigen::VectorXcd& lambda, const Complex& W, const Complex& P,
                       const Complex& residual) {
  std::vector<int> kept;
  for (int j = 0; j < 2 * n_; ++j)
    if (lambda(j).imag() >= 0) kept.push_back(j);
  modes_ = static_cast<int>(kept.size());
  const Matrix& S = model_->turns;
  const int bodies = n_ + 1;
  for (Matrix* m : {&way_, &rate_of_, &moment_of_, &force_x_, &force_y_}) m->resize(n_, modes_);
  for (Matrix* m : {&turn_, &swing_}) m->resize(bodies, modes_);
  P_.resize(modes_, 2L * n_), decay_.resize(modes_), rounding_.setZero(modes_, modes_);
  const Complex turns = S.cast<std::complex<double>>() * W.bottomRows(n_);
  const Complex moments = model_->stiffness.cast<std::complex<double>>() * W.topRows(n_) +
                          model_->damping.cast<std::complex<double>>() * W.bottomRows(n_);
  for (int m = 0; m < modes_; ++m) {
    const int j = kept[m];
    const double count = lambda(j).imag() > 0 ? 2 : 1;
    decay_(m) = -lambda(j).real(), P_.row(m) = P.row(j);
    way_.col(m) = count * W.col(j).head(n_).cwiseAbs();
    rate_of_.col(m) = count * W.col(j).tail(n_).cwiseAbs();
    turn_.col(m) = count * turns.col(j).cwiseAbs();
    const Eigen::VectorXcd swing = lambda(j) * turns.col(j);
    swing_.col(m) = count * swing.cwiseAbs();
    moment_of_.col(m) = count * moments.col(j).cwiseAbs();
    force_x_.col(m) = count * (model_->lever_y.cast<std::complex<double>>() * swing).cwiseAbs();
    force_y_.col(m) = count * (model_->lever_x.cast<std::complex<double>>() * swing).cwiseAbs();
    for (int k = 0; k < modes_; ++k) {
      const int l = kept[k];
      double& r = rounding_(m, k);
      r = std::abs(residual(j, l));
      if (lambda(l).imag() > 0) // its conjugate's column
        r += std::abs(residual(j, l + 1));
    }
  }
  const Complex drive = P_.rightCols(n_) * inverse_.cast<std::complex<double>>();
  const Vector time = decay_.cwiseInverse();
  by_hinges_ = time.asDiagonal() * drive.cwiseAbs();
  by_turns_ = time.asDiagonal() * (drive * S.transpose().cast<std::complex<double>>()).cwiseAbs();
  rounding_ = time.asDiagonal() * rounding_;
  swing_by_hinges_ = (S * inverse_).cwiseAbs();
  swing_by_turns_ = ((S * inverse_ * S.transpose()).array() + model_->rigid).abs().matrix();
  lever_ = (model_->lever_x.array().square() + model_->lever_y.array().square()).sqrt().matrix();
  for (Vector* v : {&u_, &v_, &f_, &moment_, &force_, &rate_}) v->setZero(n_);
  for (Vector* v : {&turned_, &spin_, &n_bound_, &a_, &next_a_, &added_}) v->setZero(bodies);
}

void ModalBounds::find_rates(const double* angles, const double* rates) {
  z_.resize(2L * n_);
  z_.head(n_) = Eigen::Map<const Vector>(angles, n_) - model_->angles;
  z_.tail(n_) = Eigen::Map<const Vector>(rates, n_);
  start_ = (P_ * z_.cast<std::complex<double>>()).cwiseAbs();
  rate_.noalias() = rate_of_ * start_;
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
  a_.noalias() = swing_ * B_;
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
  u_.noalias() = way_ * B_, v_.noalias() = rate_of_ * B_;
  spin_.noalias() = turn_ * B_;
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
  next_B_ = start_;
  next_B_.noalias() += rounding_ * B_;
  next_B_.noalias() += by_turns_ * n_bound_;
  next_B_.noalias() += by_hinges_ * f_;
  added_.noalias() = swing_by_turns_ * n_bound_;
  added_.noalias() += swing_by_hinges_ * f_;
  next_a_ = added_;
  next_a_.noalias() += swing_ * B_;
}

/// (7).
void ModalBounds::cap_modes(double energy) {
  double mu = 0; // by Collatz, a being positive
  const Vector shaken = swing_by_turns_ * n_bound_;
  for (int k = 0; k <= n_; ++k)
    if (shaken(k) > 0) mu = std::max(mu, shaken(k) / a_(k));
  if (!(mu < 1)) return;
  const double size = std::sqrt(2 * std::max(energy, 0.0) / (1 - mu));
  next_B_ = next_B_.cwiseMin(size * by_energy_ + offset_);
}

/// What the hinges will see where the modes alone act.
void ModalBounds::bound_linear(const Vector& modes) {
  moment_.noalias() = moment_of_ * modes;
  force_ = ((force_x_ * modes).array().square() + (force_y_ * modes).array().square()).sqrt();
}

void ModalBounds::bound_all() {
  constexpr double rounded_up = 1 + 1e-6;
  bound_linear(next_B_);
  moment_ = rounded_up * (moment_ + f_ + model_->moment.cwiseAbs());
  force_ +=
      lever_ * (added_.array() + turned_.array() * a_.array() + spin_.array().square()).matrix();
  force_ = rounded_up * (force_ + model_->weight);
}

bool ModalBounds::below(const double* moments, const double* forces) const {
  using Map = Eigen::Map<const Vector>;
  return (!moments || (moment_.array() <= Map(moments, n_).array()).all()) &&
         (!forces || (force_.array() <= Map(forces, n_).array()).all());
}

} // namespace wingspread
