/// Bounds on the modes of a latched wing from the energy that is left: (7), (10) and (11) of modal_bounds.hpp.
#include "core/proofs/modal_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace wingspread {

/// The second root of (7). For a pair of modes, Re P_j and −Im P_j are half of two rows of P.
double ModalBounds::largest_by_energy(const Mode& mode, const double* least) const {
  const int n = size();
  const auto product_of = [&](int j, int k) { // of rows of P
    double sum = rows_.row(j).tail(n).dot(drive_.row(k));
    for (int i = 0; i < n; ++i) sum += rows_(j, i) * rows_(k, i) / least[i];
    return sum;
  };
  const int j = mode.column, k = j + 1;
  const double own = product_of(j, j);
  if (!mode.is_pair) return std::sqrt(own);
  const double other = product_of(k, k);
  const double apart = own - other, both = 2 * product_of(j, k);
  return std::sqrt((own + other + std::sqrt(apart * apart + both * both)) / 8);
}

/// The linear functions of (8), by rows as load_of_, by the columns of W.
auto ModalBounds::make_loads() const -> Matrix {
  const int n = size();
  const RestModel& m = *model_;
  const auto ways = columns_.topRows(n), rates = columns_.bottomRows(n);
  const Matrix moments = product(m.stiffness, ways) + product(m.damping, rates);
  const Matrix shaken = product(product(m.turns, inverse_).eval(), moments);
  Matrix loads(3L * n + 2, 2L * n);
  loads << moments, product(m.lever_y, shaken), product(m.lever_x, shaken),
      product(m.turns.topRows(1), ways), product(m.turns.topRows(1), rates);
  return loads;
}

/// Computes the matrices that only `bound_in_reach` needs.
void ModalBounds::keep_reach() {
  const int n = size();
  turns_ = {0, BodyVector::Zero(n + 1), BodyVector::Zero(n + 1)};
  for (int i = 0; i < n; ++i) {
    const int p = model_->parents[i];
    turns_.softness(i + 1) = turns_.softness(p) + soft_(i) * soft_(i);
    turns_.apart(i + 1) = turns_.apart(p) + std::abs(apart_(i));
  }
  const Matrix slow = rows_.leftCols(n);
  const Matrix scaled = slow * soft_.asDiagonal();
  const Matrix gram =
      product(scaled, scaled.transpose()) + product(drive_, rows_.rightCols(n).transpose());
  keep_loads(gram, product(slow, apart_));
}

/// (10) for s = 1, 2, … @param gram P diag(κ, M_0)⁻¹ Pᵀ @param apart P_u times the difference of the two rests
void ModalBounds::keep_loads(const Matrix& gram, const Eigen::VectorXd& apart) {
  slowest_.resize(modes());
  std::iota(slowest_.begin(), slowest_.end(), 0);
  std::ranges::stable_sort(slowest_, {}, [this](int m) { return -modes_[m].value.real(); });
  const Matrix loads = make_loads();
  energy_loads_.resize(loads.rows(), modes()), offset_loads_.resize(loads.rows(), modes());
  for (int row = 0; row < loads.rows(); ++row) {
    ModeVector taken =
        ModeVector::Zero(gram.rows()); // what the modes so far contribute to each product
    double square = 0, shift = 0, parts = 0;
    for (int s = 0; s < modes(); ++s) {
      const Mode& mode = modes_[slowest_[s]];
      for (int j = mode.column; j <= mode.column + (mode.is_pair ? 1 : 0); ++j) {
        const double load = loads(row, j);
        square += load * (2 * taken(j) + load * gram(j, j));
        parts += std::abs(load) * std::sqrt(std::abs(gram(j, j)));
        shift += load * apart(j);
        for (int k = 0; k < gram.rows(); ++k) taken(k) += load * gram(k, j);
      }
      constexpr double rounding = 1e-13; // far more than some hundred operations lose
      energy_loads_(row, s) = std::sqrt(std::max(square, 0.0) + rounding * parts * parts);
      offset_loads_(row, s) = std::abs(shift);
    }
  }
}

/// (10) for one of the loads. @param reach null: only the sum over all modes
double ModalBounds::largest(int row, const Image& image, const Reach* reach) const {
  double others = 0;
  for (int m = 0; m < modes(); ++m) others += load_of_(row, m) * image.box.modes(m);
  double least = others;
  for (int s = 0; reach && s < modes(); ++s) {
    const int m = slowest_[s];
    others = std::max(0.0, others - load_of_(row, m) * image.box.modes(m));
    least = std::min(least, others + reach->size * energy_loads_(row, s) + offset_loads_(row, s));
  }
  return least;
}

/// By Collatz, for a matrix A without negative elements and any x > 0, max_k (A x)_k/x_k ≥ the spectral radius.
/// @return none if the least maximum found is 0.9 or more: heuristic, bounds would be useless
auto ModalBounds::contraction(const Reach& reach) const -> std::optional<Contraction> {
  constexpr int passes = 6; // heuristic: fewer, and μ is too large; more cost time
  constexpr double most = 0.9, least_share = 0.01;
  const BodyVector none = BodyVector::Zero(size() + 1);
  const auto turned = [&](const BodyVector& x) {
    return model_->bound_turns(reach.way, x, none, &reach.turns).moments;
  };
  const BodyVector pushes = turned(none);
  Contraction best{most, {}};
  BodyVector x = BodyVector::Ones(size() + 1);
  for (int pass = 0; pass < passes; ++pass) {
    BodyVector moments = turned(x) - pushes;
    if (model_->rigid == 0) moments(0) = 0; // the base is not moved by it
    const BodyVector next = product(swing_by_turns_, moments);
    const double mu = (next.array() / x.array()).maxCoeff();
    if (mu < best.mu) best = {mu, x};
    if (!(mu > 1e-3)) break;
    x = next / next.maxCoeff();
    x.array() += least_share;
  }
  if (!(best.mu < most)) return std::nullopt;
  return best;
}

/// Takes the energy of the whole's turning from `energy`. @param reach knows ways already @param spin |H|
/// @return |H|/I of the least I, on a base that is driven the rate of its turning; none where inertia may vanish
std::optional<double> ModalBounds::leave_turning(double& energy, const Reach& reach,
                                                 double spin) const {
  if (model_->rigid == 0 || spin == 0) return model_->spin;
  const BodyVector none = BodyVector::Zero(size() + 1), ones = BodyVector::Ones(size() + 1);
  const double change = model_->bound_turns(reach.way, none, ones, &reach.turns).momentum;
  const double inertia = 1 / model_->rigid;
  if (!(change < inertia)) return std::nullopt;
  constexpr double rounded_down = 1 - 1e-9;
  energy = std::max(0.0, energy - rounded_down * spin * spin / (2 * (inertia + change)));
  return spin / (inertia - change);
}

/// The ways by the energy alone. The rest is left empty.
auto ModalBounds::reach_of(double energy) const -> Reach {
  Reach reach;
  reach.turns = turns_, reach.turns.size = std::sqrt(2 * energy);
  reach.way = reach.turns.size * soft_ + apart_.cwiseAbs();
  return reach;
}

/// What (11) adds to E_0 while E ≤ most. @return none where rates have no bound
std::optional<double> ModalBounds::energy_gained(double most, double time) const {
  const RestModel& m = *model_;
  const Reach reach = reach_of(most);
  const std::optional<Contraction> found = contraction(reach);
  if (!found) return std::nullopt;
  const double root = reach.turns.size / std::sqrt(1 - found->mu);
  const auto momentum = [&](const BodyVector& rates) {
    return m.bound_turns(reach.way, BodyVector::Zero(size() + 1), rates, &reach.turns).momentum;
  };
  const double inertia = momentum(BodyVector::Ones(size() + 1));
  const double apart = momentum(root * swing_by_turns_.diagonal().cwiseSqrt());
  const double along =
      product(m.dragged.transpose(), product(m.turns.cwiseAbs(), reach.way)).value();
  return 3 * m.spin * m.spin * inertia + 2 * along + m.quickening * time * apart;
}

std::optional<double> ModalBounds::most_energy(double energy, double time) {
  if (!is_capped_) return std::nullopt;
  if (slowest_.empty()) keep_reach();
  constexpr int tries = 4; // heuristic: an A that is not found by then is far above the energy
  const double start = std::max(energy, 0.0);
  double most = 2 * start;
  for (int k = 0; k < tries; ++k) {
    const std::optional<double> gained = energy_gained(most, time);
    if (!gained) return std::nullopt;
    if (start + *gained < most) {
      const std::optional<double> closer = energy_gained(start + *gained, time);
      return start + std::min(*gained, closer.value_or(*gained));
    }
    most = start + 2 * *gained;
  }
  return std::nullopt;
}

/// The box of (7) and what follows from it. With smaller ways μ is smaller, and then the box is.
auto ModalBounds::reach(double energy, const ModeVector& start, double spin) const
    -> std::optional<Reach> {
  constexpr int rounds = 2, images = 3; // heuristic: further ones gain little
  const double whole = std::max(energy, 0.0);
  Reach reach = reach_of(whole);
  for (int round = 0; round < rounds; ++round) {
    double left = whole;
    const std::optional<double> whirl = leave_turning(left, reach, spin);
    if (!whirl) break;
    reach.turns.size = std::sqrt(2 * left);
    reach.way = reach.way.cwiseMin(reach.turns.size * soft_ + apart_.cwiseAbs()).eval();
    const std::optional<Contraction> found = contraction(reach);
    if (!found) break;
    reach.size = reach.turns.size / std::sqrt(1 - found->mu);
    reach.rate = reach.size * inverse_.diagonal().cwiseSqrt();
    reach.spin = reach.size * swing_by_turns_.diagonal().cwiseSqrt();
    reach.spin.array() += *whirl;
    Box box{reach.size * by_energy_ + offset_, BodyVector::Zero(size() + 1),
            reach.size * std::sqrt(model_->rigid) + *whirl};
    const Image still = map(box, start, spin, &reach);
    const double most = (still.box.accelerations.array() / found->x.array()).maxCoeff();
    box.accelerations = most / (1 - found->mu) * found->x;
    if (round > 0) box.shrink_to(reach.box);
    for (int k = 0; k < images; ++k) {
      const Image image = map(box, start, spin, &reach);
      if (!image.box.is_finite()) return std::nullopt;
      box.shrink_to(image.box);
      reach.way = image.way;
    }
    reach.box = box;
  }
  if (reach.box.modes.size() == 0) return std::nullopt;
  return reach;
}

} // namespace wingspread
