#include "montecarlo/model/static_margins/least_quotient.hpp"

#include <algorithm>
#include <cmath>

namespace wingspread {

Cubic Cubic::through(const std::array<double, 4>& values) {
  // Divided differences at equal distances of ¼, then Newton's form in powers of u.
  std::array<double, 4> d = values;
  for (std::size_t order = 1; order < d.size(); ++order)
    for (std::size_t k = d.size() - 1; k >= order; --k)
      d[k] = (d[k] - d[k - 1]) / (0.25 * static_cast<double>(order));
  Cubic cubic;
  for (std::size_t k = d.size(); k-- > 0;) { // c ← c (u − u_k) + d_k
    std::array<double, 4>& c = cubic.c_;
    for (std::size_t power = c.size() - 1; power > 0; --power)
      c[power] = c[power - 1] - cubic_samples[k] * c[power];
    c[0] = d[k] - cubic_samples[k] * c[0];
  }
  return cubic;
}

double Cubic::place_of_least() const {
  double best = (*this)(1) < (*this)(0) ? 1 : 0;
  const auto offer = [&](double u) {
    if (u > 0 && u < 1 && (*this)(u) < (*this)(best)) best = u;
  };
  // stationary where c_1 + 2 c_2 u + 3 c_3 u² = 0; both roots without cancellation
  const double square = c_[2] * c_[2] - 3 * c_[3] * c_[1];
  if (!(square >= 0)) return best;
  const double q = -(c_[2] + std::copysign(std::sqrt(square), c_[2]));
  offer(q / (3 * c_[3]));
  offer(c_[1] / q);
  return best;
}

Cubic Cubic::less(double factor, const Cubic& other) const {
  Cubic difference = *this;
  for (std::size_t k = 0; k < c_.size(); ++k) difference.c_[k] -= factor * other.c_[k];
  return difference;
}

std::optional<double> place_of_least_quotient(const Cubic& over, const Cubic& under,
                                              double quotient) {
  constexpr int most_rounds = 50;   // superlinear: few are needed
  constexpr double nothing = 1e-12; // of the quotient: rounding of the cubics
  std::optional<double> place;
  for (int round = 0; round < most_rounds && std::isfinite(quotient); ++round) {
    const double u = over.less(quotient, under).place_of_least();
    const double next = over(u) / under(u);
    if (!(under(u) > 0) || !(next < quotient - nothing * std::abs(quotient))) break;
    place = u, quotient = next;
  }
  return place;
}

} // namespace wingspread
