#include "montecarlo/analyses/sensitivity/needed_change.hpp"

#include "distributions/continuous_law.hpp"
#include "montecarlo/analyses/sensitivity/draw_slopes.hpp"
#include "montecarlo/analyses/sensitivity/failure_curve.hpp"
#include "montecarlo/analyses/sensitivity/lever_response.hpp"
#include "montecarlo/foundation/statistics/bonferroni.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"

#include <boost/math/special_functions/beta.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace wingspread {
namespace {

/// Heuristic: a change is known if at least so many runs were drawn beyond each changed mean. With fewer, half of the
/// changed runs would have values that hardly a run has tried, and may not deploy.
constexpr std::ptrdiff_t fewest_beyond = 10;

bool has_draws(const Results& results, std::size_t row) {
  return std::ranges::all_of(results.draws,
                             [row](const Column& draw) { return std::isfinite(draw.values[row]); });
}

/// The deployed runs with a value, in the direction in which a larger one is worse.
OutputValues limited_values(const Requirement& requirement, const Results& results) {
  OutputValues values;
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
OutputValues undeployed_values(const Results& results) {
  OutputValues values;
  for (std::size_t row = 0; row < results.size(); ++row)
    if (has_draws(results, row)) {
      values.rows.push_back(row);
      values.y.push_back(results.status[row] == Status::deployed ? 0 : 1);
    }
  return values;
}

/// The changes of one group of draws.
class ChangeFinder {
public:
  ChangeFinder(NeededFor what, const Verdict& verdict, const Results& results,
               const OutputValues& values, const DrawSlopes& slopes, double confidence, long tests)
      : what_(what), verdict_(verdict), results_(results), values_(values), slopes_(slopes),
        confidence_(confidence), sure_(at_each_of(confidence, tests)) {
    for (const Column& draw : results.draws) {
      Sum sum;
      for (const std::size_t row : values_.rows) sum.add(draw.values[row]);
      means_.push_back(sum.value() / static_cast<double>(values_.rows.size()));
    }
  }

  [[nodiscard]] std::optional<NeededChange> of(const MovedDraws& moved) const {
    double effect = 0; // d̄
    std::vector<double> weights;
    for (const std::size_t column : moved.columns) {
      weights.push_back(moved.scaled ? means_[column] : 1);
      effect += weights.back() * slopes_.of(column);
    }
    const Bounds seen = slope_bounds(effect, slopes_.without(moved.columns, weights), sure_);
    if (!seen.lower || !(*seen.lower * *seen.upper > 0)) return std::nullopt;
    const double end = drawn_end(moved, effect < 0 ? 1 : -1);
    Ends t;
    if (what_ == NeededFor::limit) {
      t = limit_ends(moved, end);
    } else {
      const Bounds slope =
          slope_bounds(effect, slopes_.without(moved.columns, weights), confidence_);
      t = index_ends(index_of(moved, effect), slope, end);
      if (!is_seen(moved, t)) return std::nullopt;
    }
    return t.edge ? std::optional(completed(moved, t, end)) : std::nullopt;
  }

  /// How many of the runs in values_ may break the requirement.
  [[nodiscard]] long may() const {
    const long others = verdict_.runs - std::ssize(values_.y),
               allowed = verdict_.allowed.value_or(share_of(verdict_.runs));
    return others <= allowed ? allowed - others : share_of(std::ssize(values_.y));
  }

private:
  /// t at which m runs break, and the two bounds; nothing where the change leads beyond `end` or is unknown.
  struct Ends {
    std::optional<double> edge, near, far;
  };

  [[nodiscard]] long share_of(long runs) const {
    return runs > 0 ? runs - quantile_rank(runs, verdict_.requirement.probability) : 0;
  }
  /// (4): most of these runs that may break so that a new campaign passes with this probability; −1 if none may.
  [[nodiscard]] long seen_at(double probability) const {
    const auto m = static_cast<double>(may());
    long low = -1, high = std::max<long>(4 * may() + 100, 0); // passes at low, not at high
    while (high - low > 1) {
      const long k = std::midpoint(low, high);
      const bool passes = boost::math::ibeta(static_cast<double>(k) + 1, m + 1, 0.5) >= probability;
      (passes ? low : high) = k;
    }
    return low;
  }
  [[nodiscard]] long seen_far() const { return seen_at((1 + confidence_) / 2); }
  [[nodiscard]] long seen_near() const { return seen_at((1 - confidence_) / 2); }

  /// Bounds by the jackknife. An output that is exactly linear has the same slope without each group, and no width.
  [[nodiscard]] static Bounds slope_bounds(double effect, const std::vector<double>& without,
                                           double confidence) {
    const auto [least, most] = std::ranges::minmax(without);
    if (most - least <= 1e-12 * std::abs(effect)) return {effect, effect};
    return jackknife_bounds(effect, without, confidence);
  }
  [[nodiscard]] static double change_of(const MovedDraws& moved, double x, double mean) {
    return moved.scaled ? x / mean - 1 : x - mean;
  }

  /// The largest |t| in a direction at which `fewest_beyond` runs were drawn beyond each changed mean.
  [[nodiscard]] double drawn_end(const MovedDraws& moved, double way) const {
    double end = std::numeric_limits<double>::infinity();
    for (const std::size_t column : moved.columns) {
      std::vector<double> t;
      for (const std::size_t row : values_.rows)
        t.push_back(way * change_of(moved, results_.draws[column].values[row], means_[column]));
      const auto kth = t.begin() + std::min(fewest_beyond, std::ssize(t)) - 1;
      std::ranges::nth_element(t, kth, std::ranges::greater{});
      end = std::min(end, std::max(0.0, *kth));
    }
    return way * end;
  }

  /// The runs as LeverResponse takes them.
  [[nodiscard]] LeverRuns runs_of(const MovedDraws& moved) const {
    LeverRuns runs;
    const std::size_t n = values_.rows.size();
    runs.y = values_.y, runs.fitted = static_cast<std::size_t>(slopes_.runs());
    runs.d.assign(n, 0), runs.u.assign(n, 0), runs.r.assign(n, 0);
    double effect = 0;
    std::vector<double> weights;
    for (std::size_t k = 0; k < results_.draws.size(); ++k) {
      const double slope = slopes_.of(k);
      const bool moves = std::ranges::find(moved.columns, k) != moved.columns.end();
      if (slope == 0) continue;
      for (std::size_t i = 0; i < n; ++i) {
        const double x = results_.draws[k].values[values_.rows[i]];
        (moves ? runs.u : runs.r)[i] += slope * (x - means_[k]);
        if (moves) runs.d[i] += slope * (moved.scaled ? x : 1);
      }
    }
    for (const std::size_t column : moved.columns) {
      weights.push_back(moved.scaled ? means_[column] : 1);
      effect += weights.back() * slopes_.of(column);
    }
    for (const double without : slopes_.without(moved.columns, weights))
      runs.group_slope.push_back(without / effect);
    const double mean = moments(runs.y).mean;
    for (std::size_t i = 0; i < n; ++i) {
      runs.residual.push_back(runs.y[i] - mean - runs.u[i] - runs.r[i]);
      runs.group.push_back(slopes_.group(i));
    }
    return runs;
  }

  [[nodiscard]] Ends limit_ends(const MovedDraws& moved, double end) const {
    const LeverResponse response(runs_of(moved));
    const double limit = limit_of(verdict_.requirement);
    const auto at = [&](long most) { return response.change(limit, most, end); };
    Ends t{at(may()), at(seen_near()), {}};
    if (!t.edge || *t.edge == 0 || !t.near) return {};
    const auto [edge, bounds] = response.fall(*t.edge, limit, confidence_);
    if (!bounds.upper || !(*bounds.upper > 0)) return {};
    *t.near *= edge / *bounds.upper;
    if (const long few = seen_far(); few >= 0) t.far = at(few);
    if (!t.far) return t;
    const auto [mean, of_far] = response.fall(*t.far, limit, confidence_);
    const double factor = of_far.lower && *of_far.lower > 0 ? mean / *of_far.lower : undefined;
    if (factor * std::abs(*t.far) <= std::abs(end))
      *t.far *= factor;
    else
      t.far.reset();
    return t;
  }

  /// The standardised normal index, of which the moved draws make a part.
  struct Index {
    double effect = 0; ///< d̄
    double own = 0;    ///< var(u)/φ²
    double shared = 0; ///< cov(u, r)/φ²
    bool scaled = false;
    [[nodiscard]] double variance(double t) const {
      return scaled ? std::max(0.0, 1 + t * (2 + t) * own + 2 * t * shared) : 1;
    }
  };
  [[nodiscard]] Index index_of(const MovedDraws& moved, double effect) const {
    const LeverRuns runs = runs_of(moved);
    Sum own, shared;
    for (std::size_t i = 0; i < runs.u.size(); ++i)
      own.add(runs.u[i] * runs.u[i]), shared.add(runs.u[i] * runs.r[i]);
    const double all = static_cast<double>(runs.u.size()) * density() * density();
    return {effect, own.value() / all, shared.value() / all, moved.scaled};
  }

  /// (2) for the numbers of runs of (4).
  [[nodiscard]] Ends index_ends(const Index& index, const Bounds& slope, double end) const {
    if (!slope.lower || !(*slope.lower * *slope.upper > 0)) return {};
    const auto [weak, strong] = std::minmax(
        *slope.lower, *slope.upper, [](double a, double b) { return std::abs(a) < std::abs(b); });
    Ends t{
        change_at(index, index.effect, may(), end), change_at(index, strong, seen_near(), end), {}};
    if (!t.near) t.near = 0;
    if (const long few = seen_far(); few >= 0) t.far = change_at(index, weak, few, end);
    return t;
  }
  [[nodiscard]] double broken_share() const {
    return static_cast<double>(std::ranges::count(values_.y, 1.0)) /
           static_cast<double>(values_.y.size());
  }
  [[nodiscard]] static double normal_at(double share) {
    return inverse(Normal{}, {share, 1 - share});
  }
  /// φ(Φ⁻¹(q)).
  [[nodiscard]] double density() const {
    const double z = normal_at(broken_share());
    return std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi);
  }
  /// (2) with this slope; nothing beyond `end`. If no run may break the requirement, r is half a run's share, because
  /// Φ⁻¹(0) is infinite.
  [[nodiscard]] std::optional<double> change_at(const Index& index, double slope, long most,
                                                double end) const {
    const double q = broken_share(), r = std::max(0.5, static_cast<double>(most)) /
                                         static_cast<double>(values_.y.size());
    if (!(q > r && q < 1) || !std::isfinite(end)) return std::nullopt;
    const double now = normal_at(q), then = normal_at(r);
    const auto fails = [&](double t) {
      return now + t * slope / density() > then * std::sqrt(index.variance(t));
    };
    if (fails(end)) return std::nullopt;
    double low = 0, high = end;
    while (std::abs(high - low) > 1e-13 * std::abs(end)) {
      const double middle = std::midpoint(low, high);
      if (middle == low || middle == high) break;
      (fails(middle) ? low : high) = middle;
    }
    return high;
  }
  /// Whether the runs themselves show the decrease that (2) predicts: (3) at the edge is nearer to r than to q.
  /// Withdraws the far change if more than r remain there.
  [[nodiscard]] bool is_seen(const MovedDraws& moved, Ends& t) const {
    if (!t.edge) return true;
    const LeverRuns runs = runs_of(moved);
    const FailureCurve curve(runs.u, values_.y);
    const auto remaining = [&](double change) {
      Sum sum;
      for (std::size_t i = 0; i < runs.u.size(); ++i)
        sum.add(curve.at(runs.u[i] + change * runs.d[i]));
      return sum.value();
    };
    const double most = std::max(0.5, static_cast<double>(may()));
    if (t.far && remaining(*t.far) > most) t.far.reset();
    return remaining(*t.edge) <= std::midpoint(most, remaining(0));
  }
  [[nodiscard]] bool breaks(std::size_t i) const {
    return what_ == NeededFor::deployment ? values_.y[i] > 0
                                          : values_.y[i] > limit_of(verdict_.requirement);
  }

  /// Counts the runs drawn beyond the changed mean, and those of them that did not deploy; for several draws those of
  /// the draw that has the larger share of them.
  void count_beyond(const MovedDraws& moved, double t, NeededChange& found) const {
    found.beyond_runs = -1;
    for (const std::size_t column : moved.columns) {
      long runs = 0, undeployed = 0;
      for (std::size_t row = 0; row < results_.size(); ++row) {
        if (!has_draws(results_, row)) continue;
        const double at = change_of(moved, results_.draws[column].values[row], means_[column]);
        if (t > 0 ? at < t : at > t) continue;
        ++runs;
        undeployed += results_.status[row] == Status::deployed ? 0 : 1;
      }
      if (found.beyond_runs < 0 || undeployed * found.beyond_runs > found.beyond_undeployed * runs)
        found.beyond_runs = runs, found.beyond_undeployed = undeployed;
    }
  }

  [[nodiscard]] NeededChange completed(const MovedDraws& moved, const Ends& t, double end) const {
    NeededChange found;
    const double base = moved.scaled ? 1 : 0, tried = t.far.value_or(*t.edge);
    count_beyond(moved, tried, found);
    found.known = t.far && found.beyond_undeployed <= share_of(found.beyond_runs);
    found.edge = base + *t.edge;
    found.change = found.known ? base + *t.far : found.edge;
    std::optional<double> near = base + *t.near, far;
    if (found.known) far = found.change;
    found.bounds = end > 0 ? Bounds{near, far} : Bounds{far, near};
    found.least = -std::numeric_limits<double>::infinity();
    found.most = -found.least;
    double broken = 0, others = 0;
    const auto columns = static_cast<double>(moved.columns.size());
    for (const std::size_t column : moved.columns) {
      const double mean = means_[column];
      double low = std::numeric_limits<double>::infinity(), high = -low;
      Sum of_broken, of_others;
      long count = 0;
      for (std::size_t i = 0; i < values_.rows.size(); ++i) {
        const double x = results_.draws[column].values[values_.rows[i]];
        low = std::min(low, x), high = std::max(high, x);
        (breaks(i) ? of_broken : of_others).add(moved.scaled ? x / mean : x);
        count += breaks(i) ? 1 : 0;
      }
      const double at_low = base + change_of(moved, low, mean),
                   at_high = base + change_of(moved, high, mean);
      found.least = std::max(found.least, std::min(at_low, at_high));
      found.most = std::min(found.most, std::max(at_low, at_high));
      broken += of_broken.value() / static_cast<double>(count) / columns;
      others += of_others.value() / static_cast<double>(std::ssize(values_.rows) - count) / columns;
      found.now += mean / columns;
    }
    found.of_broken = broken, found.of_others = others;
    return found;
  }

  NeededFor what_;
  const Verdict& verdict_;
  const Results& results_;
  const OutputValues& values_;
  const DrawSlopes& slopes_;
  double confidence_, sure_;
  std::vector<double> means_; ///< of all draws, over the rows of values_
};

} // namespace

std::optional<NeededChanges> needed_changes(NeededFor what, const Verdict& verdict,
                                            const Results& results, const Replication& replication,
                                            std::span<const MovedDraws> moved, double confidence) {
  const OutputValues values = what == NeededFor::limit
                                  ? limited_values(verdict.requirement, results)
                                  : undeployed_values(results);
  if (values.rows.empty()) return std::nullopt;
  const DrawSlopes slopes(values, results, replication);
  if (!slopes.known()) return std::nullopt;
  const ChangeFinder finder(what, verdict, results, values, slopes, confidence, std::ssize(moved));
  NeededChanges found{what, slopes.runs(), slopes.explained(), {}};
  for (const MovedDraws& each : moved) found.changes.push_back(finder.of(each));
  results.release();
  return found;
}

} // namespace wingspread
