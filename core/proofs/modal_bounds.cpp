#include "core/proofs/modal_bounds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <type_traits>
#include <utility>

namespace wingspread {

namespace {

constexpr double wider = 1.02; ///< heuristic: ratio of a box to its image; see find_bounds()

/// Row i of A·v.
double sum_of_row(const Eigen::MatrixXd& A, int i, const ModalBounds::ModeVector& v) {
  double sum = 0;
  for (int k = 0; k < v.size(); ++k) sum += A(i, k) * v(k);
  return sum;
}

/// A⁻¹ by Gauss and Jordan's elimination with pivots; not finite where A is singular. Like `product`
/// without a library's blocks.
Eigen::MatrixXd inverse_of(Eigen::MatrixXd A) {
  const auto n = static_cast<int>(A.rows());
  ModalBounds::ModeVector column(n);
  std::array<int, 2 * most_modelled_bodies> pivots;
  for (int k = 0; k < n; ++k) {
    int& pivot = pivots[k] = k;
    for (int i = k + 1; i < n; ++i)
      if (std::abs(A(i, k)) > std::abs(A(pivot, k))) pivot = i;
    for (int c = 0; pivot != k && c < n; ++c) std::swap(A(k, c), A(pivot, c));
    const double inverse = 1 / A(k, k);
    for (int i = 0; i < n; ++i) column(i) = A(i, k), A(i, k) = 0;
    A(k, k) = 1, column(k) = 0;
    for (int c = 0; c < n; ++c) {
      double* of = &A(0, c);
      const double share = of[k] * inverse;
      for (int i = 0; i < n; ++i) of[i] -= column(i) * share;
      of[k] = share;
    }
  }
  for (int k = n - 1; k >= 0; --k)
    for (int i = 0; pivots[k] != k && i < n; ++i) std::swap(A(i, k), A(i, pivots[k]));
  return A;
}

/// The lengths of vectors of these components.
Eigen::MatrixXd lengths(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y) {
  return (x.array().square() + y.array().square()).sqrt();
}

double size_of(double real, double imaginary) {
  return std::sqrt(real * real + imaginary * imaginary);
}

/// p_j x of a mode, from the products of the rows of P.
template <class Mode, class Products>
std::complex<double> row_of(const Mode& mode, const Products& rows) {
  const int j = mode.column;
  return mode.is_pair ? 0.5 * std::complex(rows(j), -rows(j + 1)) : std::complex(rows(j));
}

} // namespace

double size_of_residual(const Eigen::MatrixXd& e, const ModeColumns& of, const ModeColumns& by) {
  const int a = of.column, c = by.column;
  if (of.is_pair && by.is_pair)
    return 0.5 * (size_of(e(a, c) + e(a + 1, c + 1), e(a, c + 1) - e(a + 1, c)) +
                  size_of(e(a, c) - e(a + 1, c + 1), e(a, c + 1) + e(a + 1, c)));
  if (of.is_pair) return 0.5 * size_of(e(a, c), e(a + 1, c));
  return by.is_pair ? 2 * size_of(e(a, c), e(a, c + 1)) : std::abs(e(a, c));
}

// ---- the matrices

/// |p_j x| of every mode, from the products of the rows of P.
template <class Products> auto ModalBounds::sizes_of_rows(const Products& products) const {
  using Kept = std::conditional_t<Products::ColsAtCompileTime == 1, ModeVector, Matrix>;
  const auto& all = products.eval();
  Kept sizes(modes(), all.cols());
  for (int k = 0; k < all.cols(); ++k)
    for (int m = 0; m < modes(); ++m) {
      const int j = modes_[m].column;
      sizes(m, k) =
          modes_[m].is_pair ? 0.5 * size_of(all(j, k), all(j + 1, k)) : std::abs(all(j, k));
    }
  return sizes;
}

/// |x w_j| of every mode, pairs counted twice, from the products of the columns of W.
template <class Products>
Eigen::MatrixXd ModalBounds::sizes_of_columns(const Products& products) const {
  Matrix sizes(products.rows(), modes());
  for (int m = 0; m < modes(); ++m)
    for (int k = 0; k < products.rows(); ++k) {
      const int j = modes_[m].column;
      sizes(k, m) = modes_[m].is_pair ? 2 * size_of(products(k, j), products(k, j + 1))
                                      : std::abs(products(k, j));
    }
  return sizes;
}

std::optional<ModalBounds> ModalBounds::make(const RestModel& model, const double* least,
                                             const double* rest) {
  ModalBounds made(model);
  if (!made.find_modes()) return std::nullopt;
  made.keep_rows();
  made.keep_cap(least, rest);
  return made;
}

/// Finds the modes and what they move. @return whether all of them decay
bool ModalBounds::find_modes() {
  const int n = size();
  inverse_ = inverse_of(model_->mass);
  if (!inverse_.allFinite() || !model_->damping.allFinite()) return false;
  Modes found;
  if (!found.find(*model_, inverse_)) return false;
  for (int j = 0; j < 2 * n; ++j) {
    const std::complex<double>& value = found.values()[j];
    if (!(value.real() < 0)) return false;
    if (value.imag() >= 0) modes_.push_back({{j, value.imag() > 0}, value});
  }
  const Matrix& W = found.columns();
  rows_ = inverse_of(W);
  if (!rows_.allFinite()) return false;
  drive_ = product(rows_.rightCols(n), inverse_);
  const Matrix moments =
      product(model_->stiffness, W.topRows(n)) + product(model_->damping, W.bottomRows(n));
  // L W = (W_v, −M_0⁻¹(K W_u + C W_v))
  keep_rounding(product(rows_.leftCols(n), W.bottomRows(n)) - product(drive_, moments) -
                found.blocks());
  keep_columns(W, moments);
  columns_ = W;
  return true;
}

void ModalBounds::keep_rounding(const Matrix& residual) {
  rounding_.resize(modes(), modes());
  for (int m = 0; m < modes(); ++m)
    for (int k = 0; k < modes(); ++k)
      rounding_(m, k) =
          -1 / modes_[m].value.real() * size_of_residual(residual, modes_[m], modes_[k]);
}

/// Keeps the effects of unit modes: turns, levers, loads. @param vectors W @param moments K W_u + C W_v
void ModalBounds::keep_columns(const Matrix& vectors, const Matrix& moments) {
  const int n = size();
  ModeVector quick(modes()); // |λ|
  for (int m = 0; m < modes(); ++m)
    quick(m) = size_of(modes_[m].value.real(), modes_[m].value.imag());
  const auto ways = vectors.topRows(n), rates = vectors.bottomRows(n);
  way_ = sizes_of_columns(ways), rate_of_ = sizes_of_columns(rates);
  const Matrix turns = product(model_->turns, rates);
  turn_ = sizes_of_columns(turns);
  const Matrix base_way = sizes_of_columns(product(model_->turns.topRows(1), ways).eval());
  swing_ = turn_ * quick.asDiagonal();
  const Matrix &x = model_->lever_x, &y = model_->lever_y;
  lever_ = lengths(x, y);
  load_of_.resize(3L * n + 2, modes());
  load_of_ << sizes_of_columns(moments),
      sizes_of_columns(product(y, turns).eval()) * quick.asDiagonal(),
      sizes_of_columns(product(x, turns).eval()) * quick.asDiagonal(), base_way, turn_.topRows(1);
}

/// Keeps the effects of loads on the modes.
void ModalBounds::keep_rows() {
  ModeVector time(modes()); // 1/α
  for (int m = 0; m < modes(); ++m) time(m) = -1 / modes_[m].value.real();
  keep_drive();
  const Matrix& S = model_->turns;
  by_hinges_ = time.asDiagonal() * sizes_of_rows(drive_);
  const Matrix by_turns = product(drive_, S.transpose());
  by_turns_ = time.asDiagonal() * sizes_of_rows(by_turns);
  keep_push(by_turns);
  const Matrix answer = product(S, inverse_);
  swing_by_hinges_ = answer.cwiseAbs();
  const Matrix by_moments = product(answer, S.transpose()).array() + model_->rigid;
  swing_by_turns_ = by_moments.cwiseAbs();
  const Matrix &x = model_->lever_x, &y = model_->lever_y;
  force_by_turns_ = lengths(product(x, by_moments), product(y, by_moments));
  force_by_hinges_ = lengths(product(x, answer), product(y, answer));
}

/// (5a).
void ModalBounds::keep_drive() {
  constexpr double average = 2 / std::numbers::pi; // of |cos|
  static const double excess =
      2 * (std::sqrt(1 - average * average) - average * std::acos(average));
  lasting_.setOnes(modes()), at_first_.setZero(modes());
  for (int m = 0; m < modes(); ++m) {
    const double damped = -modes_[m].value.real() / modes_[m].value.imag(); // infinite where real
    if (!(average + excess * damped < 1)) continue;
    lasting_(m) = average, at_first_(m) = excess * damped;
  }
}

/// (9). @param by_turns p_j M_0⁻¹Sᵀ of the rows
void ModalBounds::keep_push(const Matrix& by_turns) {
  swung_.setZero(modes());
  if (model_->turn_rate == 0) return;
  const Eigen::VectorXd cosine = product(by_turns, model_->push_cosine),
                        sine = product(by_turns, model_->push_sine);
  const std::complex<double> i(0, 1), turning = i * model_->turn_rate;
  for (int m = 0; m < modes(); ++m) {
    Mode& mode = modes_[m];
    const std::complex<double> c = row_of(mode, cosine), s = row_of(mode, sine);
    mode.with_base = 0.5 * (c - i * s) / (turning - mode.value);
    mode.against_base = 0.5 * (c + i * s) / (-turning - mode.value);
    swung_(m) = std::abs(mode.with_base) + std::abs(mode.against_base);
  }
}

/// The root of (7).
void ModalBounds::keep_cap(const double* least, const double* rest) {
  is_capped_ = least != nullptr;
  if (!is_capped_) return;
  const int n = size();
  soft_ = Eigen::Map<const Eigen::VectorXd>(least, n).cwiseInverse().cwiseSqrt();
  apart_ = Eigen::Map<const Eigen::VectorXd>(rest, n) - model_->angles;
  offset_ = sizes_of_rows(product(rows_.leftCols(n), apart_));
  by_energy_.resize(modes());
  for (int m = 0; m < modes(); ++m) by_energy_(m) = largest_by_energy(modes_[m], least);
}

// ---- the bounds from a state on

auto ModalBounds::start(const double* angles, const double* rates, double t) const -> ModeVector {
  const int n = size();
  ModeVector z(2 * n);
  for (int i = 0; i < n; ++i) z(i) = angles[i] - model_->angles(i), z(n + i) = rates[i];
  const ModeVector rows = product(rows_, z);
  if (model_->turn_rate == 0) return sizes_of_rows(rows);
  const auto round = std::polar(1.0, model_->turn_rate * (t - model_->since));
  ModeVector start(modes());
  for (int m = 0; m < modes(); ++m)
    start(m) = std::abs(row_of(modes_[m], rows) - modes_[m].with_base * round -
                        modes_[m].against_base * std::conj(round));
  return start;
}

HingeVector ModalBounds::rates(const ModeVector& start) const {
  return product(rate_of_, start + swung_);
}

double ModalBounds::turn_of_base(const double* angles) const {
  double turn = 0;
  for (int i = 0; i < size(); ++i) turn += model_->turns(0, i) * (angles[i] - model_->angles(i));
  return turn;
}

double ModalBounds::linear_moment(int i, const ModeVector& modes) const {
  return sum_of_row(load_of_, i, modes);
}

double ModalBounds::linear_force(int i, const ModeVector& modes) const {
  return size_of(sum_of_row(load_of_, size() + i, modes),
                 sum_of_row(load_of_, 2 * size() + i, modes));
}

std::optional<HingeBounds> ModalBounds::bound(const ModeVector& start,
                                              const std::optional<double>& energy,
                                              double spin) const {
  return find_bounds(start, energy, spin, nullptr);
}

std::optional<HingeBounds> ModalBounds::bound_in_reach(const ModeVector& start, double energy,
                                                       double spin) {
  if (!is_capped_) return std::nullopt;
  if (slowest_.empty()) keep_reach();
  const std::optional<Reach> reached = reach(energy, start, spin);
  if (!reached) return std::nullopt;
  return find_bounds(start, energy, spin, &*reached);
}

/// Widens a box until it holds its image. Heuristic: too wide a margin gives poor bounds, too small a margin takes more
/// passes. Where no box is found in these passes, the energy's box is used, or a later attempt.
/// @param inside bounds by the energy alone; null: not known
std::optional<HingeBounds> ModalBounds::find_bounds(const ModeVector& start,
                                                    const std::optional<double>& energy,
                                                    double spin, const Reach* inside) const {
  constexpr int passes =
      12; // heuristic: fewer find no bounds where they contract slowly, more cost time in vain
  Box box{wider * (start + swung_), {}, model_->spin + wider * model_->rigid * spin};
  box.accelerations = product(swing_, box.modes);
  for (int pass = 0; pass <= passes; ++pass) {
    const bool is_last = pass == passes;
    if (is_last && !inside) return std::nullopt;
    if (is_last) box = inside->box;
    Image image = map(box, start, spin, inside);
    if (inside)
      image.box.shrink_to(inside->box);
    else if (is_capped_ && energy)
      cap_modes(*energy, box, image);
    if (!image.box.is_finite()) return std::nullopt;
    if (is_last || box.holds(image.box)) {
      if (!(image.way.array() < model_->room.array()).all()) return std::nullopt;
      return bounds_inside(box, image, inside);
    }
    box.widen_to(image.box);
  }
  return std::nullopt;
}

bool ModalBounds::Box::holds(const Box& other) const {
  // on a base that is not free the first body does not take part: 0 in 0
  return (other.modes.array() <= modes.array()).all() &&
         (other.accelerations.array() <= accelerations.array()).all() && other.rigid <= rigid;
}

void ModalBounds::Box::widen_to(const Box& other) {
  rigid = std::max(rigid, wider * other.rigid);
  modes = modes.cwiseMax(wider * other.modes).eval();
  accelerations = accelerations.cwiseMax(wider * other.accelerations).eval();
}

void ModalBounds::Box::shrink_to(const Box& other) {
  rigid = std::min(rigid, other.rigid);
  modes = modes.cwiseMin(other.modes).eval();
  accelerations = accelerations.cwiseMin(other.accelerations).eval();
}

/// The right sides of (4), (5) and (6) over a box. @param reach null: not known
auto ModalBounds::map(const Box& box, const ModeVector& start, double spin,
                      const Reach* reach) const -> Image {
  const RestModel& m = *model_;
  Image image;
  image.way = product(way_, box.modes);
  HingeVector rates = product(rate_of_, box.modes);
  image.spin = product(turn_, box.modes);
  image.spin.array() += box.rigid;
  if (reach) {
    image.way = image.way.cwiseMin(reach->way).eval();
    rates = rates.cwiseMin(reach->rate).eval();
    image.spin = image.spin.cwiseMin(reach->spin).eval();
  }
  image.remainder = m.bound_remainders(image.way, rates);
  const RestModel::Turned off =
      m.bound_turns(image.way, box.accelerations, image.spin, reach ? &reach->turns : nullptr);
  image.turned = off.ways, image.moments = off.moments;
  image.drift = m.rigid * off.momentum;
  image.box.rigid = m.spin + m.rigid * spin + image.drift;
  image.moments += m.dragged;
  if (m.rigid == 0) image.moments(0) = 0; // the base is not moved by it
  const ModeVector driven =
      product(by_turns_, image.moments) + product(by_hinges_, image.remainder);
  image.box.modes = start.cwiseMax(product(rounding_, box.modes) + lasting_.cwiseProduct(driven)) +
                    at_first_.cwiseProduct(driven) + swung_;
  if (m.turn_rate != 0) image.moments += m.pushed;
  image.box.accelerations = product(swing_by_turns_, image.moments) +
                            product(swing_by_hinges_, image.remainder) + product(swing_, box.modes);
  image.box.accelerations.array() += m.quickening;
  return image;
}

/// (7).
void ModalBounds::cap_modes(double energy, const Box& box, Image& image) const {
  double mu = 0; // by Collatz, a being positive
  const BodyVector shaken = product(swing_by_turns_, image.moments);
  for (int k = 0; k <= size(); ++k)
    if (shaken(k) > 0) mu = std::max(mu, shaken(k) / box.accelerations(k));
  if (!(mu < 1)) return;
  const double size = std::sqrt(2 * std::max(energy, 0.0) / (1 - mu));
  image.box.modes = image.box.modes.cwiseMin(size * by_energy_ + offset_).eval();
}

/// (8), rounded up. @param image of the box, inside it
HingeBounds ModalBounds::bounds_inside(const Box& box, const Image& image,
                                       const Reach* reach) const {
  constexpr double rounded_up = 1 + 1e-6; // far more than some hundred operations lose
  const int n = size();
  const BodyVector turned = image.turned.array() * box.accelerations.array() +
                            image.spin.array().square() + model_->quickening;
  HingeBounds bounds;
  bounds.moment.resize(n), bounds.force.resize(n);
  for (int i = 0; i < n; ++i) {
    bounds.moment(i) = largest(i, image, reach);
    bounds.force(i) = size_of(largest(n + i, image, reach), largest(2 * n + i, image, reach));
  }
  bounds.moment = rounded_up * (bounds.moment + image.remainder + model_->moment.cwiseAbs());
  bounds.force = rounded_up * (bounds.force + product(force_by_turns_, image.moments) +
                               product(force_by_hinges_, image.remainder) +
                               product(lever_, turned) + model_->weight);
  bounds.way = image.way;
  bounds.base = {rounded_up * largest(3 * n, image, reach),
                 rounded_up * largest(3 * n + 1, image, reach), rounded_up * image.drift};
  return bounds;
}

} // namespace wingspread
