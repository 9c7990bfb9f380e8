#include "core/scene/curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wingspread {
namespace {

bool same_sign(double a, double b) { return (a > 0 && b > 0) || (a < 0 && b < 0); }

/// The three-point slope at an end, from its own piece and the next, limited to the data's direction.
double end_slope(double h0, double h1, double d0, double d1) {
  const double slope = ((2 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
  if (!same_sign(slope, d0)) return 0;
  if (!same_sign(d0, d1) && std::abs(slope) > 3 * std::abs(d0)) return 3 * d0;
  return slope;
}

/// PCHIP's slopes at knots h apart with the chords' slopes d.
std::vector<double> monotone_slopes(const std::vector<double>& h, const std::vector<double>& d) {
  const std::size_t pieces = d.size();
  if (pieces == 1) return {d[0], d[0]};
  std::vector<double> slopes(pieces + 1);
  slopes.front() = end_slope(h[0], h[1], d[0], d[1]);
  slopes.back() = end_slope(h[pieces - 1], h[pieces - 2], d[pieces - 1], d[pieces - 2]);
  for (std::size_t k = 1; k < pieces; ++k) {
    if (!same_sign(d[k - 1], d[k])) continue; // an extreme of the table: level there
    if (d[k - 1] == d[k]) {
      slopes[k] = d[k]; // a line stays that line, to the last bit
      continue;
    }
    const double before = 2 * h[k] + h[k - 1], after = h[k] + 2 * h[k - 1];
    slopes[k] = (before + after) / (before / d[k - 1] + after / d[k]);
  }
  return slopes;
}

/// Slope of a piece at u beyond its knot. std::fma, because Curve::slope_at promises one rounding on every processor.
double slope_of(const Curve::Piece& piece, double u) {
  return std::fma(u, std::fma(u, 3 * piece.c[3], 2 * piece.c[2]), piece.c[1]);
}

/// Least and largest slope of a cubic over 0 … h.
void widen_by_slopes(const Curve::Piece& piece, double h, double& least, double& largest) {
  const auto slope = [&](double u) {
    return piece.c[1] + u * (2 * piece.c[2] + 3 * u * piece.c[3]);
  };
  const auto include_slope_at = [&](double u) {
    least = std::min(least, slope(u));
    largest = std::max(largest, slope(u));
  };
  include_slope_at(0), include_slope_at(h);
  const double vertex = -piece.c[2] / (3 * piece.c[3]);
  if (piece.c[3] != 0 && vertex > 0 && vertex < h) include_slope_at(vertex);
}

/// Largest excess of a cubic over 0 … h, inside any part of it, over the range of that part's ends: half its total
/// reversal.
double overshoot_of(const Curve::Piece& piece, double h) {
  const auto& c = piece.c;
  const auto value = [&](double u) { return c[0] + u * (c[1] + u * (c[2] + u * c[3])); };
  // the roots of c1 + 2 c2 u + 3 c3 u², without loss of digits: its possible extremes
  const double root = std::sqrt(std::max(c[2] * c[2] - 3 * c[1] * c[3], 0.0));
  const double q = -(c[2] + std::copysign(root, c[2]));
  const double one = c[3] != 0 ? q / (3 * c[3]) : 0, other = q != 0 ? c[1] / q : 0;
  const double first = std::clamp(std::min(one, other), 0.0, h);
  const double second = std::clamp(std::max(one, other), 0.0, h);
  const double way = std::abs(value(first) - value(0)) + std::abs(value(second) - value(first)) +
                     std::abs(value(h) - value(second));
  return std::max((way - std::abs(value(h) - value(0))) / 2, 0.0);
}

} // namespace

Curve::Curve(std::vector<double> x, std::vector<double> y, Interpolation interpolation,
             Beyond beyond) {
  if (x.front() > x.back()) std::reverse(x.begin(), x.end()), std::reverse(y.begin(), y.end());
  const std::size_t pieces = x.size() - 1;
  std::vector<double> h(pieces), d(pieces);
  for (std::size_t k = 0; k < pieces; ++k) h[k] = x[k + 1] - x[k], d[k] = (y[k + 1] - y[k]) / h[k];
  std::vector<double> slopes;
  if (interpolation == Interpolation::monotone) slopes = monotone_slopes(h, d);
  pieces_.resize(pieces + 2);
  for (std::size_t k = 0; k < pieces; ++k) {
    Piece& piece = pieces_[k + 1];
    piece.from = x[k];
    piece.c = {y[k], d[k], 0, 0};
    if (slopes.empty()) continue;
    const double a = slopes[k], b = slopes[k + 1];
    piece.c = {y[k], a, ((d[k] - a) + (2 * d[k] - a - b)) / h[k],
               ((a - d[k]) + (b - d[k])) / (h[k] * h[k])};
  }
  pieces_.back().from = x.back();
  pieces_.back().c = {y.back(), slopes.empty() ? d.back() : slopes.back(), 0, 0};
  knots_ = std::move(x);
  add_ends(beyond);
  integrate();
  find_slopes();
  find_turns();
  make_columns();
}

Curve Curve::sum(double a, const Curve& f, double b, const Curve& g) {
  Curve total = f;
  for (std::size_t k = 0; k < f.pieces_.size(); ++k)
    for (int power = 0; power < 4; ++power)
      total.pieces_[k].c[power] = a * f.pieces_[k].c[power] + b * g.pieces_[k].c[power];
  total.integrate();
  total.find_slopes();
  total.find_turns();
  total.make_columns();
  return total;
}

/// The pieces before the first knot, in powers about that, and after the last.
void Curve::add_ends(Beyond beyond) {
  pieces_.front() = {-std::numeric_limits<double>::infinity(), pieces_[1].c, 0};
  for (Piece* end : {&pieces_.front(), &pieces_.back()}) {
    end->c[2] = end->c[3] = 0;
    if (beyond == Beyond::constant) end->c[1] = 0;
  }
}

void Curve::integrate() {
  double sum = 0;
  for (std::size_t k = 1; k < pieces_.size(); ++k) {
    Piece& piece = pieces_[k];
    piece.integral = sum;
    if (k + 1 == pieces_.size()) break;
    const double u = knots_[k] - knots_[k - 1];
    const auto& c = piece.c;
    sum += u * (c[0] + u * (c[1] / 2 + u * (c[2] / 3 + u * (c[3] / 4))));
  }
}

void Curve::find_slopes() {
  steepest_fall_ = std::min(pieces_.front().c[1], pieces_.back().c[1]);
  steepest_rise_ = std::max(pieces_.front().c[1], pieces_.back().c[1]);
  sharpest_bend_ = overshoot_ = 0;
  for (std::size_t k = 1; k + 1 < pieces_.size(); ++k) {
    const double h = knots_[k] - knots_[k - 1];
    const auto& c = pieces_[k].c;
    widen_by_slopes(pieces_[k], h, steepest_fall_, steepest_rise_);
    overshoot_ = std::max(overshoot_, overshoot_of(pieces_[k], h));
    sharpest_bend_ =
        std::max({sharpest_bend_, 2 * std::abs(c[2]), std::abs(2 * c[2] + 6 * h * c[3])});
  }
}

void Curve::find_turns() {
  turns_.clear();
  const auto slope = [&](std::size_t piece, double x) {
    return slope_of(pieces_[piece], x - knots_[piece > 0 ? piece - 1 : 0]);
  };
  for (std::size_t k = 0; k < knots_.size(); ++k) {
    const double before = slope(k, knots_[k]), after = slope(k + 1, knots_[k]);
    turns_.push_back({knots_[k], std::min(before, after), std::max(before, after)});
    const auto& c = pieces_[k + 1].c;
    if (k + 1 == knots_.size() || c[3] == 0) continue;
    const double x = knots_[k] - c[2] / (3 * c[3]);
    const double there = slope(k + 1, x);
    if (knots_[k] < x && x < knots_[k + 1]) turns_.push_back({x, there, there});
  }
}

void Curve::make_columns() {
  columns_.reset();
  if (pieces_.size() > 8) return;
  columns_ = Columns{};
  for (std::size_t k = 0; k < pieces_.size(); ++k) {
    columns_->from[k] = knots_[k > 0 ? k - 1 : 0];
    for (std::size_t power = 0; power < 4; ++power) columns_->c[power][k] = pieces_[k].c[power];
    columns_->integral[k] = pieces_[k].integral;
  }
}

std::size_t Curve::piece_at(double x) const {
  return static_cast<std::size_t>(std::upper_bound(knots_.begin(), knots_.end(), x) -
                                  knots_.begin());
}

double Curve::value_at(double x) const {
  const std::size_t k = piece_at(x);
  const auto& c = pieces_[k].c;
  const double u = x - knots_[k > 0 ? k - 1 : 0];
  return std::fma(u, std::fma(u, std::fma(u, c[3], c[2]), c[1]), c[0]);
}

double Curve::slope_at(double x) const {
  const std::size_t k = piece_at(x);
  return slope_of(pieces_[k], x - knots_[k > 0 ? k - 1 : 0]);
}

} // namespace wingspread
