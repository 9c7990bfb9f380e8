#include "montecarlo/analyses/sensitivity/lever_response.hpp"

#include "distributions/decompositions.hpp"
#include "montecarlo/foundation/statistics/jackknife.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace wingspread {
namespace {

constexpr int sums_size = 7; // 1, the five terms of (1), the residual
using Sums = Eigen::Matrix<double, sums_size, sums_size>;

/// The coefficients of (1) from sums of products, of draws divided by `scale`. Terms that others give, as r without
/// other draws, share the smallest coefficients.
std::array<double, 5> solved(const Sums& sums, double scale) {
  const double n = sums(0, 0);
  std::array<double, 5> curve{};
  if (!(n > sums_size + 10)) return curve; // heuristic: fewer runs do not show a curve
  const Eigen::Matrix<double, 6, 1> mean = sums.block<6, 1>(1, 0) / n;
  const Eigen::Matrix<double, 6, 6> c = sums.block<6, 6>(1, 1) / n - mean * mean.transpose();
  const Eigen::MatrixXd terms = c.topLeftCorner<5, 5>();
  const Eigen::VectorXd wanted = c.block<5, 1>(0, 5);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(terms);
  Eigen::VectorXd found = Eigen::VectorXd::Zero(5);
  // Solved twice, the second time for what is left: terms of very different sizes cost digits.
  for (int pass = 0; pass < 2; ++pass) {
    const Eigen::VectorXd left = wanted - terms * found;
    for (int k = 0; k < 5; ++k) {
      const double value = modes.eigenvalues()[k];
      if (value <= 1e-9 * modes.eigenvalues()[4]) continue;
      const auto mode = modes.eigenvectors().col(k);
      found += mode.dot(left) / value * mode;
    }
  }
  for (int k = 0; k < 5; ++k)
    curve[static_cast<std::size_t>(k)] = k < 2 ? found[k] : found[k] / scale;
  return curve;
}

} // namespace

LeverResponse::LeverResponse(LeverRuns runs) : runs_(std::move(runs)) {
  const std::span fitted = std::span(runs_.y).first(runs_.fitted);
  const double scale = moments(fitted).std;
  std::vector<Sums> of_group(runs_.group_slope.size(), Sums::Zero());
  if (!(scale > 0)) {
    without_.resize(of_group.size());
    return;
  }
  for (std::size_t i = 0; i < runs_.fitted; ++i) {
    const double u = runs_.u[i] / scale, r = runs_.r[i] / scale;
    Eigen::Matrix<double, sums_size, 1> z;
    z << 1, u, r, u * u, u * r, r * r, runs_.residual[i] / scale;
    of_group[static_cast<std::size_t>(runs_.group[i])] += z * z.transpose();
  }
  Sums all = Sums::Zero();
  for (const Sums& each : of_group) all += each;
  curve_ = solved(all, scale);
  for (const Sums& each : of_group) without_.push_back(solved(all - each, scale));
}

double LeverResponse::moved(std::size_t run, double t, double slope, const Curve& curve) const {
  const double q = t * runs_.d[run];
  return q * (slope + curve[0] + 2 * curve[2] * runs_.u[run] + curve[3] * runs_.r[run]) +
         curve[2] * q * q;
}

long LeverResponse::count_beyond(double limit, double t) const {
  long count = 0;
  for (std::size_t i = 0; i < runs_.y.size(); ++i)
    count += runs_.y[i] + moved(i, t, 1, curve_) > limit ? 1 : 0;
  return count;
}

std::optional<double> LeverResponse::change(double limit, long most, double end) const {
  if (count_beyond(limit, 0) <= most) return 0;
  if (!std::isfinite(end) || count_beyond(limit, end) > most) return std::nullopt;
  double low = 0, high = end;
  while (std::abs(high - low) > 1e-13 * std::abs(end)) {
    const double middle = low + (high - low) / 2;
    if (middle == low || middle == high) break;
    (count_beyond(limit, middle) > most ? low : high) = middle;
  }
  return high;
}

double LeverResponse::mean_fall(double t, double limit, double slope, const Curve& curve) const {
  Sum sum;
  long count = 0;
  for (std::size_t i = 0; i < runs_.y.size(); ++i)
    if (runs_.y[i] > limit) sum.add(-moved(i, t, slope, curve)), ++count;
  return sum.value() / static_cast<double>(count);
}

LeverResponse::Fall LeverResponse::fall(double t, double limit, double confidence) const {
  Fall fall{mean_fall(t, limit, 1, curve_), {}};
  std::vector<double> without;
  for (std::size_t g = 0; g < without_.size(); ++g)
    without.push_back(mean_fall(t, limit, runs_.group_slope[g], without_[g]));
  const auto [least, most] = std::ranges::minmax(without);
  fall.bounds = most - least <= 1e-9 * std::abs(fall.mean)
                    ? Bounds{fall.mean, fall.mean} // exactly quadratic
                    : jackknife_bounds(fall.mean, without, confidence);
  return fall;
}

} // namespace wingspread
