#include "montecarlo/foundation/statistics/rank_correlation.hpp"

#include "distributions/copula.hpp"
#include "montecarlo/foundation/platform/thread_pool.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "montecarlo/foundation/statistics/two_sided.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace wingspread {
namespace {

using Matrix = Eigen::MatrixXd;

Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

/// The inverse of a correlation matrix from its Cholesky factor L: L⁻ᵀ L⁻¹. Nothing if the matrix is singular.
/// In long double, for which Eigen has no vector code: the same bytes whatever the processor's vector registers.
std::optional<Matrix> inverse_of(const Matrix& correlations) {
  const auto factor = cholesky(correlations);
  if (!factor) return std::nullopt;
  using Wide = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  const Wide identity = Wide::Identity(correlations.rows(), correlations.cols());
  const Wide root =
      factor->cast<long double>().triangularView<Eigen::Lower>().solve(identity); // L⁻¹
  return Matrix((root.transpose() * root).cast<double>());
}

/// Ranks from their mean, divided by their number.
std::vector<double> centred(std::span<const double> ranks) {
  const auto n = static_cast<double>(ranks.size());
  std::vector<double> shares;
  for (const double rank : ranks) shares.push_back((rank - (n + 1) / 2) / n);
  return shares;
}

double mean_product(std::span<const double> a, std::span<const double> b) {
  Sum sum;
  for (std::size_t i = 0; i < a.size(); ++i) sum.add(a[i] * b[i]);
  return sum.value() / static_cast<double>(a.size());
}

/// G of each row: the mean of the values of rows with larger ranks, and half of those with the same rank.
std::vector<double> upper_means(std::span<const double> ranks, std::span<const double> values) {
  const auto place = [&](std::size_t i) { return static_cast<std::size_t>(2 * ranks[i]); };
  std::vector<double> above(2 * ranks.size() + 1, 0.0);
  for (std::size_t i = 0; i < ranks.size(); ++i) above[place(i)] += values[i];
  double sum = 0; // of larger ranks
  for (std::size_t k = above.size(); k-- > 0;) {
    const double own = above[k];
    above[k] = sum + own / 2;
    sum += own;
  }
  std::vector<double> means;
  for (std::size_t i = 0; i < ranks.size(); ++i)
    means.push_back(above[place(i)] / static_cast<double>(ranks.size()));
  return means;
}

} // namespace

Bounds rank_correlation_bounds(double coefficient, long n, double confidence, double error) {
  if (n <= 3) return {};
  // z is infinite where the ranks agree; the nearest coefficient, of two neighbours exchanged, bounds the other side
  const double rows = static_cast<double>(n), nearest = 1 - 12 / (rows * (rows * rows - 1));
  const double r = std::clamp(coefficient, -nearest, nearest);
  const double by_normal = std::sqrt((1 + r * r / 2) / (rows - 3)), by_rows = error / (1 - r * r);
  const double reach = two_sided_normal(confidence) * std::max(by_normal, by_rows);
  const double z = std::atanh(r);
  return {coefficient < -nearest ? coefficient : std::tanh(z - reach),
          coefficient > nearest ? coefficient : std::tanh(z + reach)};
}

double rank_correlation_error(std::span<const double> a, std::span<const double> b) {
  const std::vector<double> u = centred(a), v = centred(b);
  const double uu = mean_product(u, u), vv = mean_product(v, v), uv = mean_product(u, v);
  if (!(uu > 0 && vv > 0)) return 0;
  const std::vector<double> of_uv = upper_means(a, v), of_vu = upper_means(b, u),
                            of_uu = upper_means(a, u), of_vv = upper_means(b, v);
  const double scale = std::sqrt(uu * vv), rho = uv / scale;
  Sum square;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double both = u[i] * v[i] + of_uv[i] + of_vu[i] - 3 * uv,
                 first = u[i] * u[i] + 2 * of_uu[i] - 3 * uu,
                 second = v[i] * v[i] + 2 * of_vv[i] - 3 * vv,
                 influence = both / scale - rho / 2 * (first / uu + second / vv);
    square.add(influence * influence);
  }
  return std::sqrt(square.value()) / static_cast<double>(u.size());
}

PartialCorrelations::PartialCorrelations(const std::vector<Spilled<double>>& columns, int threads)
    : columns_(columns.size()),
      rows_(columns.empty() ? 0 : static_cast<long>(columns.front().size())) {
  std::vector<Standard> standards;
  for (std::size_t j = 0; j < columns.size(); ++j)
    if (const auto standard = standard_of(columns[j])) {
      varying_.push_back(j);
      standards.push_back(*standard);
    }
  Matrix correlations = Matrix::Identity(index(varying_.size()), index(varying_.size()));
  const auto pairs = static_cast<double>(varying_.size() * varying_.size()) / 2;
  const int team = threads_worth(threads, pairs * static_cast<double>(rows_));
  for_each_task(team, varying_.size(), [&](std::size_t i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double products =
          sum_of_products(columns[varying_[i]], standards[i], columns[varying_[j]], standards[j]);
      correlations(index(i), index(j)) = correlations(index(j), index(i)) =
          pearson(standards[i], standards[j], products);
      columns[varying_[j]].release();
    }
  });
  for (const Spilled<double>& column : columns) column.release();
  correlations_ = std::move(correlations);
  inverse_ = inverse_of(correlations_);
}

PartialCorrelations PartialCorrelations::with(Matrix correlations) const {
  PartialCorrelations other = *this;
  other.inverse_ = inverse_of(correlations);
  other.correlations_ = std::move(correlations);
  return other;
}

std::vector<double> PartialCorrelations::explained() const {
  std::vector<double> explained(columns_, undefined);
  const long n = rows_, k = varying();
  if (!inverse_ || n <= k) return explained;
  for (std::size_t j = 0; j < varying_.size(); ++j)
    explained[varying_[j]] = 1 - static_cast<double>(n - 1) /
                                     (static_cast<double>(n - k) * (*inverse_)(index(j), index(j)));
  return explained;
}

std::optional<PartialCorrelations::Regression>
PartialCorrelations::regression(std::span<const double> plain) const {
  const std::size_t k = varying_.size();
  const bool usable =
      inverse_ && rows_ > static_cast<long>(k) + 1 &&
      std::ranges::none_of(varying_, [&](std::size_t j) { return std::isnan(plain[j]); });
  if (!usable) return std::nullopt;
  Regression found{std::vector<double>(k, 0.0)};
  for (std::size_t i = 0; i < k; ++i) {
    for (std::size_t j = 0; j < k; ++j)
      found.b[i] += (*inverse_)(index(i), index(j)) * plain[varying_[j]];
    found.explained += found.b[i] * plain[varying_[i]];
  }
  return found;
}

double PartialCorrelations::unexplained(std::span<const double> plain) const {
  const auto found = regression(plain);
  if (!found) return undefined;
  return std::max(0.0, 1 - found->explained) * static_cast<double>(rows_ - 1) /
         static_cast<double>(rows_ - varying() - 1);
}

std::vector<double> PartialCorrelations::given(std::span<const double> plain) const {
  std::vector<double> partial(columns_, undefined);
  const auto found = regression(plain);
  if (!found) return partial;
  const auto& [b, explained] = *found;
  const std::size_t k = varying_.size();
  // A rest below the rounding error is noise, and would make the other coefficients noise: it is raised to that error. Where
  // some columns then explain y alone, the coefficients of the others are 0/0, and undefined.
  const double rounding = 64 * static_cast<double>(k + 1) * std::numeric_limits<double>::epsilon();
  const double rest = std::max(1 - explained, rounding);
  for (std::size_t i = 0; i < k; ++i) {
    const double left = rest * (*inverse_)(index(i), index(i));
    if (rest > 1 - explained && b[i] * b[i] < left) continue;
    partial[varying_[i]] = std::clamp(b[i] / std::sqrt(b[i] * b[i] + left), -1.0, 1.0);
  }
  return partial;
}

} // namespace wingspread
