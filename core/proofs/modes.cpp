#include "core/proofs/modes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace wingspread {
namespace {

using Complex = Modes<>::Complex;

constexpr int few_bodies = 8; // beyond, all at once are found as quickly

double size_of(const Complex& z) { return std::abs(z.real()) + std::abs(z.imag()); }

/// a·b of finite numbers: std::complex asks whether the product is.
Complex times(const Complex& a, const Complex& b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

Complex over(const Complex& a, const Complex& b) {
  const double size = b.real() * b.real() + b.imag() * b.imag();
  return {(a.real() * b.real() + a.imag() * b.imag()) / size,
          (a.imag() * b.real() - a.real() * b.imag()) / size};
}

} // namespace

template <int N> bool Modes<N>::find(const RestModel& model, const Matrix& first_order) {
  return (model.size() <= few_bodies && find_one_by_one(model)) || find_at_once(first_order);
}

template <int N> bool Modes<N>::find_at_once(const Matrix& first_order) {
  at_once_.compute(first_order);
  if (at_once_.info() != Eigen::Success) return false;
  const auto& values = at_once_.eigenvalues();
  values_.assign(values.begin(), values.end());
  columns_ = at_once_.pseudoEigenvectors();
  return true;
}

template <int N> bool Modes<N>::find_one_by_one(const RestModel& model) {
  n_ = model.size();
  const int n = size();
  undamped_.compute(seen_as<Square>(model.stiffness), seen_as<Square>(model.mass));
  if (undamped_.info() != Eigen::Success) return false;
  values_.resize(2UL * n), columns_.resize(2L * n, 2L * n), Q_.resize(n, n), right_.resize(n);
  for (int j = 0; j < n; ++j)
    if (!find_two(model, 2 * j)) return false;
  return are_apart();
}

/// The two modes that a shape without damping becomes, into two columns: a pair that swings, or two that creep.
template <int N> bool Modes<N>::find_two(const RestModel& model, int column) {
  const Eigen::Matrix<double, N, 1> shape = undamped_.eigenvectors().col(column / 2);
  const double mass = shape.dot(seen_as<Square>(model.mass).lazyProduct(shape));
  const double rate = -0.5 * shape.dot(seen_as<Square>(model.damping).lazyProduct(shape)) / mass;
  const double square =
      shape.dot(seen_as<Square>(model.stiffness).lazyProduct(shape)) / mass - rate * rate;
  if (square > 0) { // by the motion in this shape alone
    x_ = shape.template cast<Complex>();
    const std::optional<Complex> value = settle(model, Complex(rate, std::sqrt(square)));
    if (value) keep_pair(column, *value);
    return value.has_value();
  }
  for (const int side : {0, 1}) {
    x_ = shape.template cast<Complex>();
    const double apart = std::sqrt(-square);
    const std::optional<Complex> value = settle(model, rate + (side == 0 ? apart : -apart));
    if (!value) return false;
    keep_one(column + side, value->real());
  }
  return true;
}

/// The eigenvalue to which λ and x come; none if that is no swinging mode's where λ swings.
template <int N> std::optional<Complex> Modes<N>::settle(const RestModel& model, Complex value) {
  constexpr int passes = 8;
  constexpr double settled = 1e-9; // what is left of a pass's step is its square and less
  const bool swings = value.imag() > 0;
  for (int k = 0; k < passes; ++k) {
    const Complex before = value;
    pass(model, value);
    if (size_of(value - before) <= settled * size_of(value))
      return !swings || value.imag() > settled * size_of(value) ? std::optional(value)
                                                                : std::nullopt;
  }
  return std::nullopt;
}

template <int N> void Modes<N>::pass(const RestModel& model, Complex& value) {
  const int n = size();
  const auto mass = seen_as<Square>(model.mass), damping = seen_as<Square>(model.damping),
             stiffness = seen_as<Square>(model.stiffness);
  const Complex square = times(value, value), twice = 2.0 * value;
  const auto slope = [&](int i, int k) { return twice * mass(i, k) + damping(i, k); };
  for (int i = 0; i < n; ++i) {
    right_(i) = 0;
    for (int k = 0; k < n; ++k) {
      Q_(i, k) = square * mass(i, k) + value * damping(i, k) + stiffness(i, k);
      right_(i) += times(slope(i, k), x_(k));
    }
  }
  y_ = right_;
  solve();
  Complex above(0), below(0);
  for (int i = 0; i < n; ++i) {
    above += times(y_(i), right_(i));
    for (int k = 0; k < n; ++k) below += times(times(y_(i), slope(i, k)), y_(k));
  }
  value -= over(above, below);
  double largest = 0;
  for (int i = 0; i < n; ++i) largest = std::max(largest, size_of(y_(i)));
  x_ = y_ / largest;
}

/// y ← Q⁻¹ y, by elimination. Near an eigenvalue Q is nearly singular, which makes y long and no less right.
template <int N> void Modes<N>::solve() {
  const int n = size();
  for (int k = 0; k < n; ++k) {
    int pivot = k;
    for (int i = k + 1; i < n; ++i)
      if (size_of(Q_(i, k)) > size_of(Q_(pivot, k))) pivot = i;
    for (int c = k; pivot != k && c < n; ++c) std::swap(Q_(k, c), Q_(pivot, c));
    std::swap(y_(k), y_(pivot));
    if (size_of(Q_(k, k)) == 0) Q_(k, k) = std::numeric_limits<double>::epsilon();
    for (int i = k + 1; i < n; ++i) {
      const Complex share = over(Q_(i, k), Q_(k, k));
      for (int c = k + 1; c < n; ++c) Q_(i, c) -= times(share, Q_(k, c));
      y_(i) -= times(share, y_(k));
    }
  }
  for (int k = n - 1; k >= 0; --k) {
    for (int c = k + 1; c < n; ++c) y_(k) -= times(Q_(k, c), y_(c));
    y_(k) = over(y_(k), Q_(k, k));
  }
}

template <int N> void Modes<N>::keep_pair(int column, const Complex& value) {
  const int n = size();
  for (int i = 0; i < n; ++i) {
    const Complex rate = times(value, x_(i));
    columns_(i, column) = x_(i).real(), columns_(i, column + 1) = x_(i).imag();
    columns_(n + i, column) = rate.real(), columns_(n + i, column + 1) = rate.imag();
  }
  values_[column] = value, values_[column + 1] = std::conj(value);
}

template <int N> void Modes<N>::keep_one(int column, double value) {
  const int n = size();
  for (int i = 0; i < n; ++i) {
    columns_(i, column) = x_(i).real();
    columns_(n + i, column) = value * x_(i).real();
  }
  values_[column] = value;
}

/// Of as many eigenvalues that differ as there are, each is another mode's.
template <int N> bool Modes<N>::are_apart() const {
  constexpr double apart = 1e-4;
  for (std::size_t j = 0; j < values_.size(); ++j)
    for (std::size_t k = 0; k < j; ++k)
      if (!(size_of(values_[j] - values_[k]) > apart * size_of(values_[j]))) return false;
  return true;
}

template <int N> auto Modes<N>::blocks() const -> Matrix {
  const auto states = static_cast<Eigen::Index>(values_.size());
  Matrix blocks = Matrix::Zero(states, states);
  for (Eigen::Index j = 0; j < states; ++j) {
    const Complex& value = values_[j];
    blocks(j, j) = value.real();
    if (value.imag() > 0) blocks(j, j + 1) = value.imag(), blocks(j + 1, j) = -value.imag();
  }
  return blocks;
}

template class Modes<1>;
template class Modes<2>;
template class Modes<3>;
template class Modes<4>;
template class Modes<>;

} // namespace wingspread
