#include "core/proofs/modes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

namespace wingspread {
namespace {

using Complex = Modes::Complex;

/// One by one costs 1.4 µs against QR's 2.8 for 3 bodies, 15.6 against 16.9 for 8, 248 against 131
/// for 20 (measured once; no driver repeats it): beyond 8 bodies QR is as fast or faster.
constexpr int few_bodies = 8;

double size_of(const Complex& z) { return std::abs(z.real()) + std::abs(z.imag()); }

/// a·b of finite numbers: std::complex would check the product, too.
Complex times(const Complex& a, const Complex& b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

Complex over(const Complex& a, const Complex& b) {
  const double size = b.real() * b.real() + b.imag() * b.imag();
  return {(a.real() * b.real() + a.imag() * b.imag()) / size,
          (a.imag() * b.real() - a.real() * b.imag()) / size};
}

/// y ← Q⁻¹ y, by elimination with pivots. Near an eigenvalue Q is nearly singular: that makes y long,
/// and its direction no less accurate. @param Q row by row; overwritten
template <class Size> void solve(Size n, Complex* Q, Complex* y) {
  for (int k = 0; k < n; ++k) {
    Complex* of = Q + k * n;
    int pivot = k;
    double largest = size_of(of[k]);
    for (int i = k + 1; i < n; ++i)
      if (const double size = size_of(Q[i * n + k]); size > largest) pivot = i, largest = size;
    for (int c = k; pivot != k && c < n; ++c) std::swap(of[c], Q[pivot * n + c]);
    std::swap(y[k], y[pivot]);
    if (largest == 0) of[k] = std::numeric_limits<double>::epsilon();
    of[k] = over(1.0, of[k]); // from here on its inverse
    for (int i = k + 1; i < n; ++i) {
      Complex* row = Q + i * n;
      const Complex share = times(row[k], of[k]);
      for (int c = k + 1; c < n; ++c) row[c] -= times(share, of[c]);
      y[i] -= times(share, y[k]);
    }
  }
  for (int k = n - 1; k >= 0; --k) {
    for (int c = k + 1; c < n; ++c) y[k] -= times(Q[k * n + c], y[c]);
    y[k] = times(y[k], Q[k * n + k]);
  }
}

} // namespace

bool Modes::find(const RestModel& model, const Matrix& inverse) {
  return (model.size() <= few_bodies && find_one_by_one(model)) || find_at_once(model, inverse);
}

bool Modes::find_at_once(const RestModel& model, const Matrix& inverse) {
  const int n = model.size();
  Matrix L = Matrix::Zero(2L * n, 2L * n); // ż = L z, z = (u, u̇)
  L.topRightCorner(n, n).setIdentity();
  L.bottomLeftCorner(n, n) = -inverse.lazyProduct(model.stiffness);
  L.bottomRightCorner(n, n) = -inverse.lazyProduct(model.damping);
  if (!L.allFinite()) return false;
  const Eigen::EigenSolver<Matrix> at_once(L);
  if (at_once.info() != Eigen::Success) return false;
  const auto& values = at_once.eigenvalues();
  values_.assign(values.begin(), values.end());
  columns_ = at_once.pseudoEigenvectors();
  return true;
}

bool Modes::find_one_by_one(const RestModel& model) {
  const int n = model.size();
  undamped_.compute(model.stiffness, model.mass);
  if (undamped_.info() != Eigen::Success) return false;
  values_.resize(2UL * n), columns_.resize(2L * n, 2L * n);
  Q_.resize(n, n), slope_.resize(n, n), y_.resize(n), right_.resize(n);
  for (int j = 0; j < n; ++j)
    if (!find_two(model, 2 * j)) return false;
  return are_apart();
}

/// Finds the two modes that a shape without damping becomes, a pair that swings or two that creep,
/// and keeps them in two columns.
bool Modes::find_two(const RestModel& model, int column) {
  const Eigen::VectorXd shape = undamped_.eigenvectors().col(column / 2);
  const double mass = shape.dot(model.mass.lazyProduct(shape));
  const double rate = -0.5 * shape.dot(model.damping.lazyProduct(shape)) / mass;
  const double square = shape.dot(model.stiffness.lazyProduct(shape)) / mass - rate * rate;
  if (square > 0) { // the motion in this shape alone swings
    x_ = shape.cast<Complex>();
    const std::optional<Complex> value = converge_from(model, Complex(rate, std::sqrt(square)));
    if (value) keep_pair(column, *value);
    return value.has_value();
  }
  for (const int side : {0, 1}) {
    x_ = shape.cast<Complex>();
    const double apart = std::sqrt(-square);
    const std::optional<Complex> value = converge_from(model, rate + (side == 0 ? apart : -apart));
    if (!value) return false;
    keep_one(column + side, value->real());
  }
  return true;
}

/// @return the eigenvalue to which λ and x converge; none if they do not, or if λ swings and the
/// eigenvalue does not
std::optional<Complex> Modes::converge_from(const RestModel& model, Complex value) {
  constexpr int passes = 8;        // heuristic: two or three are usual; more are left to QR
  constexpr double settled = 1e-9; // the error after a pass is the square of its step, or less
  const bool swings = value.imag() > 0;
  for (int k = 0; k < passes; ++k) {
    const Complex before = value;
    improve(model, value);
    if (size_of(value - before) <= settled * size_of(value))
      return !swings || value.imag() > settled * size_of(value) ? std::optional(value)
                                                                : std::nullopt;
  }
  return std::nullopt;
}

void Modes::improve(const RestModel& model, Complex& value) {
  // Three hinges take 45 % fewer instructions where the compiler knows their number (callgrind).
  using std::integral_constant;
  switch (model.size()) {
  case 1:
    return improve_by(integral_constant<int, 1>(), model, value);
  case 2:
    return improve_by(integral_constant<int, 2>(), model, value);
  case 3:
    return improve_by(integral_constant<int, 3>(), model, value);
  case 4:
    return improve_by(integral_constant<int, 4>(), model, value);
  default:
    return improve_by(model.size(), model, value);
  }
}

template <class Size> void Modes::improve_by(Size n, const RestModel& model, Complex& value) {
  const double *mass = model.mass.data(), *damping = model.damping.data(),
               *stiffness = model.stiffness.data();
  Complex *Q = Q_.data(), *slope = slope_.data(), *x = x_.data(), *y = y_.data(),
          *right = right_.data();
  const Complex square = times(value, value), twice = 2.0 * value;
  for (int i = 0; i < n * n; ++i) {
    Q[i] = square * mass[i] + value * damping[i] + stiffness[i];
    slope[i] = twice * mass[i] + damping[i];
  }
  for (int i = 0; i < n; ++i) {
    Complex sum(0);
    for (int k = 0; k < n; ++k) sum += times(slope[i * n + k], x[k]);
    y[i] = right[i] = sum;
  }
  solve(n, Q, y);
  Complex above(0), below(0);
  double largest = 0;
  for (int i = 0; i < n; ++i) {
    above += times(y[i], right[i]);
    Complex sum(0);
    for (int k = 0; k < n; ++k) sum += times(slope[i * n + k], y[k]);
    below += times(y[i], sum);
    largest = std::max(largest, size_of(y[i]));
  }
  value -= over(above, below);
  const double scale = 1 / largest;
  for (int i = 0; i < n; ++i) x[i] = scale * y[i];
}

void Modes::keep_pair(int column, const Complex& value) {
  const int n = static_cast<int>(x_.size());
  for (int i = 0; i < n; ++i) {
    const Complex rate = times(value, x_(i));
    columns_(i, column) = x_(i).real(), columns_(i, column + 1) = x_(i).imag();
    columns_(n + i, column) = rate.real(), columns_(n + i, column + 1) = rate.imag();
  }
  values_[column] = value, values_[column + 1] = std::conj(value);
}

void Modes::keep_one(int column, double value) {
  const int n = static_cast<int>(x_.size());
  for (int i = 0; i < n; ++i) {
    columns_(i, column) = x_(i).real();
    columns_(n + i, column) = value * x_(i).real();
  }
  values_[column] = value;
}

/// Whether all eigenvalues differ, from each other and from 0: then none has been found twice, and
/// all have been found. A hinge that nothing holds has the eigenvalue 0.
bool Modes::are_apart() const {
  // heuristics: closer ones are left to QR, which costs time alone
  constexpr double apart = 1e-4, from_zero = 1e-12;
  double largest = 0;
  for (const Complex& value : values_) largest = std::max(largest, size_of(value));
  for (std::size_t j = 0; j < values_.size(); ++j) {
    if (!(size_of(values_[j]) > from_zero * largest)) return false;
    for (std::size_t k = 0; k < j; ++k)
      if (!(size_of(values_[j] - values_[k]) > apart * size_of(values_[j]))) return false;
  }
  return true;
}

Eigen::MatrixXd Modes::blocks() const {
  const auto states = static_cast<Eigen::Index>(values_.size());
  Matrix blocks = Matrix::Zero(states, states);
  for (Eigen::Index j = 0; j < states; ++j) {
    const Complex& value = values_[j];
    blocks(j, j) = value.real();
    if (value.imag() > 0) blocks(j, j + 1) = value.imag(), blocks(j + 1, j) = -value.imag();
  }
  return blocks;
}

} // namespace wingspread
