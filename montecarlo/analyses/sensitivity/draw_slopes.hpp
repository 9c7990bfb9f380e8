/// Slopes of an output with all draws, and again without each group of runs.
#pragma once

#include "montecarlo/engine/runs/results.hpp"
#include "montecarlo/foundation/statistics/jackknife.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "montecarlo/results/summary/replication.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace wingspread {

/// The runs of an estimate, and the output's value in each.
struct OutputValues {
  std::vector<std::size_t> rows; ///< of the results
  std::vector<double> y;
};

/// Least squares of the values on all draws that vary, and again without each group of runs. Cost O(n k²).
/// @pre values, results and replication outlive it
class DrawSlopes {
public:
  DrawSlopes(const OutputValues& values, const Results& results, const Replication& replication)
      : results_(results), values_(values), replication_(replication),
        fitted_(replication.replicates > 0 ? values.y.size()
                                           : std::min(values.y.size(), most_fitted)) {
    standardise();
    groups_ = replication.replicates > 0 ? replication.replicates : jackknife_groups;
    if (!enough()) return;
    const Eigen::Index size = std::ssize(columns_) + 2;
    std::vector<Eigen::MatrixXd> of_group(static_cast<std::size_t>(groups_),
                                          Eigen::MatrixXd::Zero(size, size));
    for (std::size_t i = 0; i < fitted_; ++i) {
      const Eigen::VectorXd z = row(i);
      of_group[static_cast<std::size_t>(group(i))].selfadjointView<Eigen::Lower>().rankUpdate(z);
    }
    Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(size, size);
    for (const Eigen::MatrixXd& each : of_group) sums += each;
    all_ = solved(sums);
    if (all_.size() == 0) return;
    explained_ = adjusted(sums);
    for (const Eigen::MatrixXd& each : of_group) without_.push_back(solved(sums - each));
  }

  [[nodiscard]] bool known() const { return all_.size() > 0; }
  [[nodiscard]] double explained() const { return explained_; }
  [[nodiscard]] long runs() const { return static_cast<long>(fitted_); }
  /// The jackknife's group of run i of the values.
  [[nodiscard]] int group(std::size_t i) const {
    return replication_.replicates > 0 ? replication_.of_row[values_.rows[i]]
                                       : static_cast<int>(values_.rows[i] % jackknife_groups);
  }
  /// The slope b of the output with this column of draws; 0 if the column is constant.
  [[nodiscard]] double of(std::size_t column) const { return slope(all_, column); }
  /// For each group, Σ weight · b over the columns with the group left out; NaN if that has no slopes.
  [[nodiscard]] std::vector<double> without(std::span<const std::size_t> columns,
                                            std::span<const double> weights) const {
    std::vector<double> sums;
    for (const Eigen::VectorXd& each : without_) {
      double sum = each.size() > 0 ? 0 : undefined;
      for (std::size_t k = 0; k < columns.size(); ++k) sum += weights[k] * slope(each, columns[k]);
      sums.push_back(sum);
    }
    return sums;
  }

private:
  /// Heuristic: fewest runs beyond the number of draws. With fewer, the adjusted R² and the jackknife's bounds are mostly
  /// chance.
  static constexpr long fewest_spare_runs = 10;
  /// Largest number of runs of the fit; of a random design the first ones are used. With so many, a standardised slope
  /// has a standard error of 1/√10,000 = 1 %, and the time is bounded.
  static constexpr std::size_t most_fitted = 10'000;
  /// A draw is a linear combination of others if less than this share of its variance is its own: rounding leaves 1e-15.
  static constexpr double least_own = 1e-9;

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
  /// 1, the standardised draws, the standardised output.
  [[nodiscard]] Eigen::VectorXd row(std::size_t i) const {
    Eigen::VectorXd z(std::ssize(columns_) + 2);
    z(0) = 1;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      const auto& [column, mean, std] = columns_[k];
      z(static_cast<Eigen::Index>(k) + 1) =
          (results_.draws[column].values[values_.rows[i]] - mean) / std;
    }
    z(z.size() - 1) = (values_.y[i] - y_mean_) / y_std_;
    return z;
  }
  /// Standardised slopes from sums of products; empty if the draws depend on each other.
  [[nodiscard]] static Eigen::VectorXd solved(const Eigen::MatrixXd& sums) {
    const Eigen::Index k = sums.rows() - 2;
    const Eigen::MatrixXd full = sums.selfadjointView<Eigen::Lower>();
    const double n = full(0, 0);
    if (!(n > static_cast<double>(k) + 1)) return {};
    const Eigen::VectorXd sum = full.block(1, 0, k, 1);
    const Eigen::MatrixXd c = full.block(1, 1, k, k) - sum * sum.transpose() / n;
    const Eigen::VectorXd to_y = full.block(1, k + 1, k, 1) - sum * (full(k + 1, 0) / n);
    const Eigen::LDLT<Eigen::MatrixXd> factors(c);
    if (factors.info() != Eigen::Success || !(factors.vectorD().minCoeff() > least_own * n))
      return {};
    return factors.solve(to_y);
  }
  [[nodiscard]] double adjusted(const Eigen::MatrixXd& sums) const {
    const Eigen::Index k = sums.rows() - 2;
    const Eigen::MatrixXd full = sums.selfadjointView<Eigen::Lower>();
    const double n = full(0, 0), shared = all_.dot(full.col(k + 1).segment(1, k)),
                 total = full(k + 1, k + 1);
    return 1 - (1 - shared / total) * (n - 1) / (n - static_cast<double>(k) - 1);
  }
  [[nodiscard]] double slope(const Eigen::VectorXd& standardised, std::size_t column) const {
    const auto found = std::ranges::find(columns_, column, &Scale::column);
    if (found == columns_.end() || standardised.size() == 0) return 0;
    return standardised(found - columns_.begin()) * y_std_ / found->std;
  }

  const Results& results_;
  const OutputValues& values_;
  const Replication& replication_;
  std::size_t fitted_;
  std::vector<Scale> columns_;
  double y_mean_ = 0, y_std_ = 0, explained_ = 0;
  int groups_ = 0;
  Eigen::VectorXd all_;
  std::vector<Eigen::VectorXd> without_;
};

} // namespace wingspread
