#include "core/scene/base_table.hpp"

#include <utility>

namespace wingspread {
namespace {

using Powers = std::array<double, 4>;
using Wide = long double; // sums over a thousand pieces keep all digits of a double

Wide integral_of(const Powers& c, Wide u) {
  return u * (c[0] + u * (c[1] / Wide(2) + u * (c[2] / Wide(3) + u * (c[3] / Wide(4)))));
}
Wide double_integral_of(const Powers& c, Wide u) {
  return u * u *
         (c[0] / Wide(2) + u * (c[1] / Wide(6) + u * (c[2] / Wide(12) + u * (c[3] / Wide(20)))));
}

/// A curve's integral and the integral of that at the start of each piece, both 0 at t = 0.
struct Integrals {
  std::vector<Wide> first, second;

  explicit Integrals(const Curve& curve) : first(curve.pieces().size()), second(first.size()) {
    for (std::size_t k = 2; k < first.size(); ++k) {
      const Powers& c = curve.pieces()[k - 1].c;
      const Wide h = Wide(curve.knots()[k - 1]) - curve.knots()[k - 2];
      first[k] = first[k - 1] + integral_of(c, h);
      second[k] = second[k - 1] + first[k - 1] * h + double_integral_of(c, h);
    }
    begin_at_zero(curve);
  }

  /// Index of the piece that holds t = 0.
  static std::size_t at_zero(const Curve& curve) {
    std::size_t k = 0;
    while (k < curve.knots().size() && curve.knots()[k] <= 0) ++k;
    return k;
  }

private:
  void begin_at_zero(const Curve& curve) {
    const std::size_t k = at_zero(curve);
    const Powers& c = curve.pieces()[k].c;
    const Wide u = -Wide(curve.knots()[k > 0 ? k - 1 : 0]);
    const Wide rate = first[k] + integral_of(c, u),
               angle = second[k] + first[k] * u + double_integral_of(c, u);
    for (std::size_t j = 0; j < first.size(); ++j) {
      const Wide from = curve.knots()[j > 0 ? j - 1 : 0];
      first[j] -= rate;
      second[j] -= angle + rate * from;
    }
  }
};

std::vector<double> component(const std::vector<Eigen::Vector2d>& vectors, int axis) {
  std::vector<double> result;
  for (const Eigen::Vector2d& v : vectors) result.push_back(v[axis]);
  return result;
}

} // namespace

BaseTable::BaseTable(Columns columns, Interpolation interpolation)
    : columns_(std::move(columns)), interpolation_(interpolation) {
  const std::vector<double>& time = columns_.time;
  pieces_.resize(time.size() + 1);
  for (std::size_t k = 0; k < pieces_.size(); ++k) pieces_[k].from = time[k > 0 ? k - 1 : 0];
  if (gives_acceleration())
    set_acceleration(Curve(time, component(columns_.acceleration, 0), interpolation),
                     Curve(time, component(columns_.acceleration, 1), interpolation));
  if (gives_rate())
    set_turning_by_rate(Curve(time, columns_.rate, interpolation));
  else if (gives_turning())
    set_turning(Curve(time, columns_.angular_acceleration, interpolation));
}

void BaseTable::set_acceleration(const Curve& x, const Curve& y) {
  const Integrals of_x(x), of_y(y);
  for (std::size_t k = 0; k < pieces_.size(); ++k) {
    pieces_[k].x = x.pieces()[k].c, pieces_[k].y = y.pieces()[k].c;
    pieces_[k].velocity = {static_cast<double>(of_x.first[k]), static_cast<double>(of_y.first[k])};
  }
}

void BaseTable::set_turning(const Curve& curve) {
  const Integrals of(curve);
  for (std::size_t k = 0; k < pieces_.size(); ++k) {
    pieces_[k].turning = curve.pieces()[k].c;
    pieces_[k].rate = static_cast<double>(of.first[k]);
    pieces_[k].angle = static_cast<double>(of.second[k]);
  }
}

void BaseTable::set_turning_by_rate(const Curve& curve) {
  const Integrals of(curve);
  for (std::size_t k = 0; k < pieces_.size(); ++k) {
    const Powers& c = curve.pieces()[k].c;
    pieces_[k].turning = {c[1], 2 * c[2], 3 * c[3], 0};
    pieces_[k].rate = c[0];
    pieces_[k].angle = static_cast<double>(of.first[k]);
  }
}

} // namespace wingspread
