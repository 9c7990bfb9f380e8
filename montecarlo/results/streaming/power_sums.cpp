#include "montecarlo/results/streaming/power_sums.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

namespace wingspread {
namespace {

/// The sums of a correlation over n runs.
struct Sums {
  double n, x, y, xx, yy, xy;
};

/// A column's variance as a share of its mean square: where it is less, it may be nothing but rounding errors.
/// Heuristic: 64 roundings; a smaller number correlates such errors, a larger one takes a column that varies little for
/// a constant.
constexpr double nothing = 64 * std::numeric_limits<double>::epsilon();

double pearson_of(const Sums& s) {
  const double of_x = s.xx - s.x * s.x / s.n, of_y = s.yy - s.y * s.y / s.n;
  if (s.n < 2 || !(of_x > nothing * s.xx) || !(of_y > nothing * s.yy)) return undefined;
  return std::clamp((s.xy - s.x * s.y / s.n) / std::sqrt(of_x * of_y), -1.0, 1.0);
}

} // namespace

Scale scale_of(std::span<const double> values) {
  std::vector<double> finite;
  for (const double value : values)
    if (std::isfinite(value)) finite.push_back(value);
  if (finite.empty()) return {};
  std::ranges::sort(finite);
  const double spread = moments(finite).std;
  Scale scale;
  scale.shift = quantile(finite, 0.5); // one of the values, so that z of a constant column is 0
  const bool usable = spread > 0 && std::isfinite(spread);
  scale.per_unit = std::ldexp(1.0, -std::clamp(usable ? std::ilogb(spread) : 0, -1000, 1000));
  return scale;
}

void PowerSums::add(const PowerSums& other) {
  count += other.count;
  for (std::size_t i = 0; i < powers.size(); ++i) powers[i].add(other.powers[i]);
}

Moments PowerSums::moments(const Scale& scale, double min, double max) const {
  Moments result{count, undefined, undefined, min, max, undefined, undefined};
  if (count == 0) return result;
  const auto n = static_cast<double>(count);
  const auto mean_of = [&](std::size_t power) { return powers[power - 1].value() / n; };
  const double a = mean_of(1), b = mean_of(2), c = mean_of(3), d = mean_of(4);
  result.mean = std::clamp(scale.shift + a / scale.per_unit, min, max);
  const double m2 = min == max ? 0 : std::max(0.0, b - a * a);
  if (min < max && !(m2 > nothing * b)) return result; // the scale does not fit these values
  if (count > 1) result.std = std::sqrt(n / (n - 1) * m2) / scale.per_unit;
  if (m2 == 0) return result;
  const double m3 = c - 3 * a * b + 2 * a * a * a;
  const double m4 = d - 4 * a * c + 6 * a * a * b - 3 * a * a * a * a;
  set_shape(m2, m3, m4, result);
  return result;
}

void PowerSums::write(StateWriter& to) const {
  to.put(static_cast<std::int64_t>(count));
  for (const ExactSum& sum : powers) sum.write(to);
}

void PowerSums::read(StateReader& from) {
  count = static_cast<long>(from.get<std::int64_t>());
  for (ExactSum& sum : powers) sum.read(from);
}

CoMoments::CoMoments(std::size_t xs, std::size_t ys) : x_(xs), y_(ys), pairs_(xs * ys) {}

void CoMoments::add(std::span<const double> x, std::span<const double> y) {
  assert(x.size() == x_.size() && y.size() == y_.size());
  const auto add_to = [](auto& sums, double z) {
    ++sums.count;
    sums.sum.add(z);
    sums.squares.add(z * z);
  };
  const auto is_missing = [](double z) { return std::isnan(z); };
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!is_missing(x[i])) add_to(x_[i], x[i]);
  for (std::size_t j = 0; j < y.size(); ++j)
    if (!is_missing(y[j])) add_to(y_[j], y[j]);
  Pair* pair = pairs_.data();
  for (const double of_x : x)
    for (const double of_y : y) {
      Pair& own = *pair++;
      if (!is_missing(of_x) && !is_missing(of_y))
        own.products.add(of_x * of_y);
      else if (!is_missing(of_x))
        add_to(own.x, of_x);
      else if (!is_missing(of_y))
        add_to(own.y, of_y);
    }
}

void CoMoments::add(const CoMoments& other) {
  const auto add_to = [](auto& mine, const auto& theirs) {
    mine.count += theirs.count;
    mine.sum.add(theirs.sum);
    mine.squares.add(theirs.squares);
  };
  for (std::size_t i = 0; i < x_.size(); ++i) add_to(x_[i], other.x_[i]);
  for (std::size_t j = 0; j < y_.size(); ++j) add_to(y_[j], other.y_[j]);
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    pairs_[k].products.add(other.pairs_[k].products);
    add_to(pairs_[k].x, other.pairs_[k].x);
    add_to(pairs_[k].y, other.pairs_[k].y);
  }
}

Correlation CoMoments::of(std::size_t x, std::size_t y) const {
  const Pair& pair = pairs_[x * y_.size() + y];
  const auto less = [](ExactSum all, const ExactSum& left) {
    all.subtract(left);
    return all.value();
  };
  const long n = x_[x].count - pair.x.count;
  const Sums sums{static_cast<double>(n),
                  less(x_[x].sum, pair.x.sum),
                  less(y_[y].sum, pair.y.sum),
                  less(x_[x].squares, pair.x.squares),
                  less(y_[y].squares, pair.y.squares),
                  pair.products.value()};
  return {n, pearson_of(sums), undefined};
}

void CoMoments::write(StateWriter& to) const {
  const auto put = [&](const auto& sums) {
    to.put(static_cast<std::int64_t>(sums.count));
    sums.sum.write(to);
    sums.squares.write(to);
  };
  for (const Column& each : x_) put(each);
  for (const Column& each : y_) put(each);
  for (const Pair& pair : pairs_) {
    pair.products.write(to);
    put(pair.x);
    put(pair.y);
  }
}

void CoMoments::read(StateReader& from) {
  const auto get = [&](auto& sums) {
    sums.count = static_cast<long>(from.get<std::int64_t>());
    sums.sum.read(from);
    sums.squares.read(from);
  };
  for (Column& each : x_) get(each);
  for (Column& each : y_) get(each);
  for (Pair& pair : pairs_) {
    pair.products.read(from);
    get(pair.x);
    get(pair.y);
  }
}

} // namespace wingspread
