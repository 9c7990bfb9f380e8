#include "montecarlo/analyses/sensitivity/needed_change.hpp"

#include "distributions/continuous_law.hpp"
#include "montecarlo/foundation/statistics/bonferroni.hpp"
#include "montecarlo/foundation/statistics/jackknife.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace wingspread {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Heuristic: fewest runs beyond the number of draws. With fewer, the adjusted R² and the jackknife's bounds are mostly
/// chance.
constexpr long fewest_spare_runs = 10;
/// Largest number of runs of the fit; of a random design the first ones are used. With so many, a standardised slope
/// has a standard error of 1/√10,000 = 1 %, and the time is bounded.
constexpr std::size_t most_fitted = 10'000;
/// A draw is a linear combination of others if less than this share of its variance is its own: rounding leaves 1e-15.
constexpr double least_own = 1e-9;

/// The runs of an estimate, and the output's value in each.
struct Values {
  std::vector<std::size_t> rows; ///< of the results
  std::vector<double> y;
};

bool has_draws(const Results& results, std::size_t row) {
  return std::ranges::all_of(results.draws,
                             [row](const Column& draw) { return std::isfinite(draw.values[row]); });
}

/// The deployed runs with a value, in the direction in which a larger one is worse.
Values limited_values(const Requirement& requirement, const Results& results) {
  Values values;
  const auto column = std::ranges::find(results.outputs, requirement.output, &Column::name);
  if (column == results.outputs.end()) return values;
  for (std::size_t row = 0; row < results.size(); ++row) {
    const double y = requirement.absolute ? std::abs(column->values[row]) : column->values[row];
    if (results.status[row] != Status::deployed || !std::isfinite(y) ||
        results.is_cut(row, peak_kind(column->name)) || !has_draws(results, row))
      continue;
    values.rows.push_back(row);
    values.y.push_back(sign_of(requirement) * y);
  }
  return values;
}

/// All runs: 1 where the wing did not deploy.
Values undeployed_values(const Results& results) {
  Values values;
  for (std::size_t row = 0; row < results.size(); ++row)
    if (has_draws(results, row)) {
      values.rows.push_back(row);
      values.y.push_back(results.status[row] == Status::deployed ? 0 : 1);
    }
  return values;
}

/// Least squares of the values on all draws that vary, and again without each group of runs.
class Slopes {
public:
  Slopes(const Values& values, const Results& results, const Replication& replication)
      : results_(results), values_(values), replication_(replication),
        fitted_(replication.replicates > 0 ? values.y.size()
                                           : std::min(values.y.size(), most_fitted)) {
    standardise();
    groups_ = replication.replicates > 0 ? replication.replicates : jackknife_groups;
    if (!enough()) return;
    const Index size = std::ssize(columns_) + 2;
    std::vector<MatrixXd> of_group(static_cast<std::size_t>(groups_), MatrixXd::Zero(size, size));
    for (std::size_t i = 0; i < fitted_; ++i) {
      const VectorXd z = row(i);
      of_group[static_cast<std::size_t>(group(i))].selfadjointView<Eigen::Lower>().rankUpdate(z);
    }
    MatrixXd sums = MatrixXd::Zero(size, size);
    for (const MatrixXd& each : of_group) sums += each;
    all_ = solved(sums);
    if (all_.size() == 0) return;
    explained_ = adjusted(sums);
    for (const MatrixXd& each : of_group) without_.push_back(solved(sums - each));
  }

  [[nodiscard]] bool known() const { return all_.size() > 0; }
  [[nodiscard]] double explained() const { return explained_; }
  [[nodiscard]] long runs() const { return static_cast<long>(fitted_); }
  /// b of a column of the draws; 0 of a constant one.
  [[nodiscard]] double of(std::size_t column) const { return slope(all_, column); }
  /// For each group, Σ weight · b over the columns with the group left out; NaN if that has no slopes.
  [[nodiscard]] std::vector<double> without(std::span<const std::size_t> columns,
                                            std::span<const double> weights) const {
    std::vector<double> sums;
    for (const VectorXd& each : without_) {
      double sum = each.size() > 0 ? 0 : undefined;
      for (std::size_t k = 0; k < columns.size(); ++k) sum += weights[k] * slope(each, columns[k]);
      sums.push_back(sum);
    }
    return sums;
  }

private:
  struct Scale {
    std::size_t column;
    double mean, std;
  };

  void standardise() {
    for (std::size_t j = 0; j < results_.draws.size(); ++j) {
      std::vector<double> x;
      for (std::size_t i = 0; i < fitted_; ++i)
        x.push_back(results_.draws[j].values[values_.rows[i]]);
      if (const Moments of = moments(x); of.std > 0) columns_.push_back({j, of.mean, of.std});
    }
    const Moments of = moments(std::span(values_.y).first(fitted_));
    y_mean_ = of.mean, y_std_ = of.std;
  }
  [[nodiscard]] bool enough() const {
    return y_std_ > 0 && !columns_.empty() &&
           static_cast<long>(fitted_) >= std::ssize(columns_) + 1 + fewest_spare_runs;
  }
  [[nodiscard]] int group(std::size_t i) const {
    return replication_.replicates > 0 ? replication_.of_row[values_.rows[i]]
                                       : static_cast<int>(values_.rows[i] % jackknife_groups);
  }
  /// 1, the standardised draws, the standardised output.
  [[nodiscard]] VectorXd row(std::size_t i) const {
    VectorXd z(std::ssize(columns_) + 2);
    z(0) = 1;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      const auto& [column, mean, std] = columns_[k];
      z(static_cast<Index>(k) + 1) = (results_.draws[column].values[values_.rows[i]] - mean) / std;
    }
    z(z.size() - 1) = (values_.y[i] - y_mean_) / y_std_;
    return z;
  }
  /// Standardised slopes from sums of products; empty if the draws depend on each other.
  [[nodiscard]] static VectorXd solved(const MatrixXd& sums) {
    const Index k = sums.rows() - 2;
    const MatrixXd full = sums.selfadjointView<Eigen::Lower>();
    const double n = full(0, 0);
    if (!(n > static_cast<double>(k) + 1)) return {};
    const VectorXd sum = full.block(1, 0, k, 1);
    const MatrixXd c = full.block(1, 1, k, k) - sum * sum.transpose() / n;
    const VectorXd to_y = full.block(1, k + 1, k, 1) - sum * (full(k + 1, 0) / n);
    const Eigen::LDLT<MatrixXd> factors(c);
    if (factors.info() != Eigen::Success || !(factors.vectorD().minCoeff() > least_own * n))
      return {};
    return factors.solve(to_y);
  }
  [[nodiscard]] double adjusted(const MatrixXd& sums) const {
    const Index k = sums.rows() - 2;
    const MatrixXd full = sums.selfadjointView<Eigen::Lower>();
    const double n = full(0, 0), shared = all_.dot(full.col(k + 1).segment(1, k)),
                 total = full(k + 1, k + 1);
    return 1 - (1 - shared / total) * (n - 1) / (n - static_cast<double>(k) - 1);
  }
  [[nodiscard]] double slope(const VectorXd& standardised, std::size_t column) const {
    const auto found = std::ranges::find(columns_, column, &Scale::column);
    if (found == columns_.end() || standardised.size() == 0) return 0;
    return standardised(found - columns_.begin()) * y_std_ / found->std;
  }

  const Results& results_;
  const Values& values_;
  const Replication& replication_;
  std::size_t fitted_;
  std::vector<Scale> columns_;
  double y_mean_ = 0, y_std_ = 0, explained_ = 0;
  int groups_ = 0;
  VectorXd all_;
  std::vector<VectorXd> without_;
};

/// Finds the change of one group of draws.
class ChangeFinder {
public:
  ChangeFinder(NeededFor what, const Verdict& verdict, const Results& results, const Values& values,
               const Slopes& slopes, double confidence, long tests)
      : what_(what), verdict_(verdict), results_(results), values_(values), slopes_(slopes),
        confidence_(confidence), sure_(at_each_of(confidence, tests)) {}

  [[nodiscard]] std::optional<NeededChange> of(const MovedDraws& moved) const {
    const std::vector<double> means = means_of(moved);
    std::vector<double> weights(means.size(), 1);
    if (moved.scaled) weights = means;
    double effect = 0; // d̄
    for (std::size_t k = 0; k < weights.size(); ++k)
      effect += weights[k] * slopes_.of(moved.columns[k]);
    const std::vector<double> without = slopes_.without(moved.columns, weights);
    const Bounds slope = slope_bounds(effect, without, confidence_),
                 seen = slope_bounds(effect, without, sure_);
    if (!seen.lower || !(*seen.lower * *seen.upper > 0)) return std::nullopt;
    const std::optional<double> t = what_ == NeededFor::limit ? up_to_limit(moved) : index(effect);
    if (!t) return std::nullopt;
    return completed(moved, means, *t, {*t * effect / *slope.upper, *t * effect / *slope.lower});
  }

  /// How many of the runs in values_ may break the requirement.
  [[nodiscard]] long may() const {
    const long others = verdict_.runs - std::ssize(values_.y),
               allowed = verdict_.allowed.value_or(share_of(verdict_.runs));
    return others <= allowed ? allowed - others : share_of(std::ssize(values_.y));
  }

private:
  [[nodiscard]] long share_of(long runs) const {
    return static_cast<long>((1 - verdict_.requirement.probability) * static_cast<double>(runs));
  }
  [[nodiscard]] std::vector<double> means_of(const MovedDraws& moved) const {
    std::vector<double> means;
    for (const std::size_t column : moved.columns) {
      Sum sum;
      for (const std::size_t row : values_.rows) sum.add(results_.draws[column].values[row]);
      means.push_back(sum.value() / static_cast<double>(values_.rows.size()));
    }
    return means;
  }
  /// Bounds by the jackknife. An output that is exactly linear has the same slope without each group, and no width.
  [[nodiscard]] static Bounds slope_bounds(double effect, const std::vector<double>& without,
                                           double confidence) {
    const auto [least, most] = std::ranges::minmax(without);
    if (most - least <= 1e-12 * std::abs(effect)) return {effect, effect};
    return jackknife_bounds(effect, without, confidence);
  }
  /// d_i.
  [[nodiscard]] double effect_in(const MovedDraws& moved, std::size_t row) const {
    double effect = 0;
    for (const std::size_t column : moved.columns)
      effect += slopes_.of(column) * (moved.scaled ? results_.draws[column].values[row] : 1);
    return effect;
  }
  /// The order statistic of (1); nothing if the runs' outputs move in different directions.
  [[nodiscard]] std::optional<double> up_to_limit(const MovedDraws& moved) const {
    const double limit = limit_of(verdict_.requirement);
    std::vector<double> t;
    bool up = false, down = false;
    for (std::size_t i = 0; i < values_.rows.size(); ++i) {
      const double d = effect_in(moved, values_.rows[i]);
      (d > 0 ? up : down) = true;
      t.push_back((limit - values_.y[i]) / d);
    }
    if (up == down || may() >= std::ssize(t)) return std::nullopt;
    const auto kth = t.begin() + may();
    if (up)
      std::ranges::nth_element(t, kth);
    else
      std::ranges::nth_element(t, kth, std::ranges::greater{});
    return *kth;
  }
  /// (2). If no run may break the requirement, r is half a run's share, because Φ⁻¹(0) is infinite.
  [[nodiscard]] std::optional<double> index(double effect) const {
    const auto n = static_cast<double>(values_.y.size());
    const auto at = [](double share) { return inverse(Normal{}, {share, 1 - share}); };
    const double q = static_cast<double>(std::ranges::count(values_.y, 1.0)) / n,
                 r = std::max(0.5, static_cast<double>(may())) / n;
    if (!(q > r && q < 1)) return std::nullopt;
    const double density = std::exp(-at(q) * at(q) / 2) / std::sqrt(2 * std::numbers::pi);
    return -density * (at(q) - at(r)) / effect;
  }
  [[nodiscard]] bool breaks(std::size_t i) const {
    return what_ == NeededFor::deployment ? values_.y[i] > 0
                                          : values_.y[i] > limit_of(verdict_.requirement);
  }

  [[nodiscard]] NeededChange completed(const MovedDraws& moved, const std::vector<double>& means,
                                       double t, Bounds t_bounds) const {
    NeededChange found;
    const double base = moved.scaled ? 1 : 0;
    if (*t_bounds.lower > *t_bounds.upper) std::swap(t_bounds.lower, t_bounds.upper);
    found.change = base + t;
    found.bounds = {base + *t_bounds.lower, base + *t_bounds.upper};
    found.least = -std::numeric_limits<double>::infinity();
    found.most = -found.least;
    double broken = 0, others = 0;
    for (std::size_t k = 0; k < means.size(); ++k) {
      const auto value = [&](std::size_t row) {
        return results_.draws[moved.columns[k]].values[row];
      };
      const auto change = [&](double x) { return moved.scaled ? x / means[k] : x - means[k]; };
      double low = value(values_.rows.front()), high = low;
      Sum of_broken, of_others;
      long count = 0;
      for (std::size_t i = 0; i < values_.rows.size(); ++i) {
        const double x = value(values_.rows[i]);
        low = std::min(low, x), high = std::max(high, x);
        (breaks(i) ? of_broken : of_others).add(moved.scaled ? x / means[k] : x);
        count += breaks(i) ? 1 : 0;
      }
      found.least = std::max(found.least, std::min(change(low), change(high)));
      found.most = std::min(found.most, std::max(change(low), change(high)));
      broken += of_broken.value() / static_cast<double>(count);
      others += of_others.value() / static_cast<double>(std::ssize(values_.rows) - count);
      found.now += means[k] / static_cast<double>(means.size());
    }
    found.of_broken = broken / static_cast<double>(means.size());
    found.of_others = others / static_cast<double>(means.size());
    return found;
  }

  NeededFor what_;
  const Verdict& verdict_;
  const Results& results_;
  const Values& values_;
  const Slopes& slopes_;
  double confidence_, sure_;
};

} // namespace

std::optional<NeededChanges> needed_changes(NeededFor what, const Verdict& verdict,
                                            const Results& results, const Replication& replication,
                                            std::span<const MovedDraws> moved, double confidence) {
  const Values values = what == NeededFor::limit ? limited_values(verdict.requirement, results)
                                                 : undeployed_values(results);
  if (values.rows.empty()) return std::nullopt;
  const Slopes slopes(values, results, replication);
  if (!slopes.known()) return std::nullopt;
  const ChangeFinder finder(what, verdict, results, values, slopes, confidence, std::ssize(moved));
  NeededChanges found{what, slopes.runs(), slopes.explained(), {}};
  for (const MovedDraws& each : moved) found.changes.push_back(finder.of(each));
  results.release();
  return found;
}

} // namespace wingspread
