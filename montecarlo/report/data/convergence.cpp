#include "montecarlo/report/data/convergence.hpp"

#include "montecarlo/foundation/statistics/binomial_bounds.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "montecarlo/foundation/statistics/two_sided.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace wingspread {
namespace {

/// Sorts values of which the first `sorted` are in order already.
template <class Value, class Number>
void merge_behind(std::vector<Value>& values, std::size_t sorted, Number number) {
  const auto less = [&](const Value& a, const Value& b) { return number(a) < number(b); };
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(sorted);
  std::stable_sort(middle, values.end(), less);
  std::inplace_merge(values.begin(), middle, values.end(), less);
}

/// The values of a column's first runs, kept sorted while their number grows, and their statistics.
class SortedPrefix {
public:
  SortedPrefix(const Column& column, const Replication& replication, MissingRank end,
               SortedWithConvergence& result)
      : column_(column), replication_(replication), end_(end), result_(result),
        missing_of_(static_cast<std::size_t>(replication.replicates), 0) {}

  void grow_to(std::size_t rows) {
    const std::size_t before = result_.sorted.size();
    const bool replicated = replication_.replicates > 0;
    for (; rows_ < rows; ++rows_) {
      if (replicated) replicates_ = std::max(replicates_, replication_.of_row[rows_] + 1);
      if (std::isnan(column_.values[rows_])) {
        if (replicated) ++missing_of_[static_cast<std::size_t>(replication_.of_row[rows_])];
        continue;
      }
      result_.sorted.push_back(column_.values[rows_]);
      if (replicated)
        result_.replicated.push_back({column_.values[rows_], replication_.of_row[rows_]});
    }
    merge_behind(result_.sorted, before, std::identity{});
    if (replicated)
      merge_behind(result_.replicated, before,
                   [](const ReplicateValue& each) { return each.value; });
  }

  [[nodiscard]] ConvergencePoint point(double p, double confidence) const {
    const Moments all = moments(result_.sorted);
    return {static_cast<long>(rows_), all.mean, quantile(result_.sorted, ranks(), p),
            mean_bounds(all, confidence), quantile_bounds_at(p, confidence)};
  }

private:
  [[nodiscard]] Bounds mean_bounds(const Moments& all, double confidence) const {
    const bool replicated = replication_.replicates > 0;
    const double error = replicated
                             ? replicate_mean_error(result_.replicated, replicates_, all.mean)
                             : all.std / std::sqrt(static_cast<double>(all.count));
    const long degrees = (replicated ? replicates_ : all.count) - 1;
    if (degrees < 1 || !std::isfinite(error)) return {};
    const double width = two_sided_student(degrees, confidence) * error;
    return {all.mean - width, all.mean + width};
  }

  [[nodiscard]] Bounds quantile_bounds_at(double p, double confidence) const {
    return replication_.replicates > 0
               ? replicate_quantile_bounds(
                     result_.replicated, replicates_, p, confidence,
                     {std::span(missing_of_).first(static_cast<std::size_t>(replicates_)), end_})
               : quantile_bounds(result_.sorted, ranks(), p, confidence);
  }

  [[nodiscard]] PartialRanks ranks() const {
    const long present = std::ssize(result_.sorted);
    return {present, static_cast<long>(rows_) - present, end_};
  }

  const Column& column_;
  const Replication& replication_;
  MissingRank end_;
  SortedWithConvergence& result_;
  std::size_t rows_ = 0;
  int replicates_ = 0;           ///< number of replicates with rows so far
  std::vector<long> missing_of_; ///< per replicate, so far
};

} // namespace

std::vector<long> convergence_runs(long all, std::size_t most, long first) {
  std::vector<long> runs;
  const double from = std::log(static_cast<double>(std::min(first, all)));
  const double to = std::log(static_cast<double>(all));
  for (std::size_t i = 0; i + 1 < most; ++i)
    runs.push_back(std::lround(
        std::exp(std::lerp(from, to, static_cast<double>(i) / static_cast<double>(most - 1)))));
  runs.push_back(all);
  runs.erase(std::unique(runs.begin(), runs.end()), runs.end());
  return runs;
}

SortedWithConvergence sort_with_convergence(const Column& column, double p, double confidence,
                                            const Replication& replication, std::size_t most,
                                            MissingRank end) {
  SortedWithConvergence result;
  result.convergence.p = p;
  if (column.values.empty()) return result;
  SortedPrefix prefix(column, replication, end, result);
  for (const long runs : convergence_runs(std::ssize(column.values), most)) {
    prefix.grow_to(static_cast<std::size_t>(runs));
    result.convergence.points.push_back(prefix.point(p, confidence));
  }
  return result;
}

} // namespace wingspread
