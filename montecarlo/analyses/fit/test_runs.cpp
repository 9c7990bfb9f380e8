#include "montecarlo/analyses/fit/test_runs.hpp"

#include "montecarlo/engine/runs/sampled_motion.hpp"
#include "montecarlo/foundation/platform/interrupt.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "montecarlo/model/campaign/campaign_settings.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace wingspread {
namespace {

constexpr double derivative_rtol = 1e-10, derivative_atol = 1e-12;
constexpr double offsets_covered =
    8; // standard deviations of the clock offset beyond the last time

Campaign campaign_for(const FitTest& test, const std::vector<std::size_t>& fitted,
                      RunAccuracy accuracy) {
  Campaign campaign = without_correlations(fixed_but(test.campaign, fitted));
  if (accuracy == RunAccuracy::derivative) {
    campaign.integration.rtol = std::min(campaign.integration.rtol, derivative_rtol);
    campaign.integration.atol = std::min(campaign.integration.atol, derivative_atol);
    campaign.resolved["integration"] = write_integration(campaign.integration); // for other ranks
  }
  return campaign;
}

/// The last time at which a run's motion may be needed, s.
double last_needed(const FitTest& test) {
  return test.times.back() + offsets_covered * test.time_offset_std;
}

SampledColumns samples_for(const FitTest& test) {
  SampledColumns samples;
  if (test.columns.empty()) return samples;
  for (const FitColumn& column : test.columns) samples.columns.push_back(column.index);
  samples.interval = test.interval > 0 ? test.interval : grid_interval(test.times);
  samples.t_end = // beyond a sample
      (std::ceil(last_needed(test) / samples.interval) + 0.5) * samples.interval;
  return samples;
}

/// The step, s, of which all times are multiples, not longer than `longest`. Nothing if the times are not multiples of
/// their least distance.
std::optional<double> common_step(const std::vector<double>& times, double longest) {
  double least = times.back();
  for (std::size_t i = 1; i < times.size(); ++i) least = std::min(least, times[i] - times[i - 1]);
  constexpr double rounding = 1e-6;
  const auto is_multiple = [&](double t) {
    return std::abs(t / least - std::round(t / least)) < rounding;
  };
  if (!(least > 0) || !std::ranges::all_of(times, is_multiple)) return std::nullopt;
  return least / std::ceil(least / longest);
}

/// The noise of a column whose std is not known, from its second differences: their lower quartile, as shocks have large
/// ones. Normal noise σ has second differences of σ√6, and a quarter of them within 0.319 of that.
double noise_of(const std::vector<double>& measured) {
  constexpr double least_of_range = 1e-5, quarter = 0.319;
  std::vector<double> bends;
  for (std::size_t i = 1; i + 1 < measured.size(); ++i)
    bends.push_back(std::abs(measured[i - 1] - 2 * measured[i] + measured[i + 1]));
  const auto [low, high] = std::ranges::minmax(measured);
  if (bends.empty()) return high - low;
  std::ranges::sort(bends);
  return std::max(quantile(bends, 0.25) / (quarter * std::sqrt(6.0)),
                  least_of_range * (high - low));
}

/// The χ² of a test that the differences of two predictions add: the median over the points that have both.
/// @param first of the test's numbers
double added_chi_squared(const FitTest& test, std::size_t first,
                         const std::vector<Prediction>& coarse,
                         const std::vector<Prediction>& fine) {
  std::vector<double> sums;
  for (std::size_t k = 0; k < coarse.size(); ++k) {
    double sum = 0;
    std::size_t at = first;
    for (const FitColumn& column : test.columns) {
      const double noise = column.std ? *column.std : noise_of(column.measured);
      for (std::size_t i = 0; i < test.times.size(); ++i, ++at)
        sum += std::pow((coarse[k][at] - fine[k][at]) / noise, 2);
    }
    if (std::isfinite(sum)) sums.push_back(sum);
  }
  std::ranges::sort(sums);
  return sums.empty() ? 0 : quantile(sums, 0.5);
}

} // namespace

FitData data_of(std::span<const FitTest> tests) {
  FitData data;
  const auto add = [&](Channel channel) {
    channel.first = data.measured.size();
    channel.effective = static_cast<double>(channel.count);
    data.channels.push_back(channel);
  };
  for (std::size_t t = 0; t < tests.size(); ++t) {
    for (std::size_t c = 0; c < tests[t].columns.size(); ++c) {
      const FitColumn& column = tests[t].columns[c];
      add({.test = t,
           .column = c,
           .count = column.measured.size(),
           .std = column.std,
           .offset_std = column.offset_std});
      data.measured.insert(data.measured.end(), column.measured.begin(), column.measured.end());
    }
    for (std::size_t v = 0; v < tests[t].values.size(); ++v) {
      add({.test = t, .value = v, .count = 1, .std = tests[t].values[v].std});
      data.measured.push_back(tests[t].values[v].measured);
    }
  }
  return data;
}

namespace {

/// Halves the interval of a test's samples, or makes its times the samples, until interpolation adds no more to χ².
class IntervalSearch {
public:
  explicit IntervalSearch(FitTest& test) : test_(test), is_open_(!test.columns.empty()) {
    if (is_open_) test_.interval = grid_interval(test_.times);
  }

  [[nodiscard]] bool is_open() const { return is_open_; }

  /// The next interval, s; the present one once the search is over.
  [[nodiscard]] double next() {
    if (!is_open_) return test_.interval;
    const auto shared =
        test_.time_offset_std > 0 ? std::nullopt : common_step(test_.times, test_.interval);
    is_exact_ = shared && fits(*shared);
    return is_exact_ ? *shared : test_.interval / 2;
  }

  /// @param added to χ² by the present interval instead of `next`
  void compare(double added, double next) {
    if (!is_open_) return;
    test_.interpolation = added;
    is_open_ = added > most_interpolated;
    if (!is_open_) return;
    test_.interval = next;
    if (is_exact_) test_.interpolation = 0;
    is_open_ = !is_exact_ && fits(next / 2);
  }

private:
  [[nodiscard]] bool fits(double interval) const {
    constexpr double most_numbers = 80'000; // of a run: 640 kB
    return 2 * static_cast<double>(test_.columns.size()) * last_needed(test_) <=
           most_numbers * interval;
  }

  FitTest& test_;
  bool is_open_, is_exact_ = false;
};

} // namespace

long choose_intervals(std::vector<FitTest>& tests, const std::vector<std::size_t>& fitted,
                      const ParameterSpace& space, Evaluator& evaluator,
                      std::span<const FitPoint> points, bool are_candidates) {
  std::vector<IntervalSearch> searches;
  for (FitTest& test : tests) searches.emplace_back(test);
  std::vector<FitTest> traces = tests;
  for (FitTest& test : traces) test.values.clear();
  long runs = 0;
  const auto predict = [&] {
    TestRuns all(traces, fitted, space, evaluator, are_candidates);
    std::vector<Prediction> predictions = all.predict(points, RunAccuracy::campaign);
    runs += all.runs();
    return predictions;
  };
  if (std::ranges::none_of(searches, &IntervalSearch::is_open)) return 0;
  for (std::vector<Prediction> coarse = predict(), fine;
       std::ranges::any_of(searches, &IntervalSearch::is_open); coarse = std::move(fine)) {
    for (std::size_t t = 0; t < tests.size(); ++t) traces[t].interval = searches[t].next();
    fine = predict();
    for (std::size_t t = 0, first = 0; t < tests.size(); ++t) {
      searches[t].compare(added_chi_squared(traces[t], first, coarse, fine), traces[t].interval);
      first += traces[t].columns.size() * traces[t].times.size();
    }
  }
  return runs;
}

/// One test at one accuracy.
struct TestRuns::Prepared {
  Prepared(const FitTest& given, std::size_t index, std::size_t place, Campaign its,
           const UnitPoints& points)
      : test(&given), number(index), first(place), campaign(std::move(its)),
        values(campaign, points), samples(samples_for(given)), trace(campaign, points, samples),
        motion(campaign.scene, samples) {}
  const FitTest* test;
  std::size_t number, first; ///< of the test, and of its first number
  Campaign campaign;
  RunPlan values; ///< for the test's values
  SampledColumns samples;
  RunPlan trace; ///< for its trace, if it has one
  SampledMotion motion;
};

TestRuns::TestRuns(std::span<const FitTest> tests, const std::vector<std::size_t>& fitted,
                   const ParameterSpace& space, Evaluator& evaluator, bool are_candidates)
    : space_(space), evaluator_(evaluator), are_candidates_(are_candidates) {
  for (const RunAccuracy accuracy : {RunAccuracy::campaign, RunAccuracy::derivative}) {
    auto& list = prepared_.emplace_back();
    numbers_ = 0;
    for (std::size_t t = 0; t < tests.size(); ++t) {
      list.push_back(std::make_unique<Prepared>(
          tests[t], t, numbers_, campaign_for(tests[t], fitted, accuracy),
          [this, t](long k, std::span<Tails> u) {
            space_.place(are_candidates_ ? std::nullopt : std::optional(t),
                         points_[static_cast<std::size_t>(k)], u);
          }));
      numbers_ += tests[t].columns.size() * tests[t].times.size() + tests[t].values.size();
    }
  }
}

TestRuns::~TestRuns() = default;

std::vector<Prediction> TestRuns::predict(std::span<const FitPoint> points, RunAccuracy accuracy) {
  points_ = points;
  std::vector<Prediction> predictions(points.size(), Prediction(numbers_, undefined));
  for (const auto& prepared : prepared_[static_cast<std::size_t>(accuracy)]) {
    if (!prepared->test->values.empty()) make_values(*prepared, predictions);
    if (!prepared->test->columns.empty()) make_trace(*prepared, predictions);
  }
  return predictions;
}

void TestRuns::make_runs(const RunPlan& plan, std::size_t count,
                         const std::function<void(const ResultRow&)>& take) {
  const RunRange all{0, static_cast<long>(count)};
  const auto take_all = [&](const Batch& batch) {
    for (const ResultRow& row : batch.rows) take(row);
  };
  if (evaluator_.make(plan, all, {take_all}) < all.size()) throw Stopped{};
  runs_ += all.size();
}

void TestRuns::make_values(const Prepared& prepared, std::vector<Prediction>& predictions) {
  const std::vector<FitValue>& values = prepared.test->values;
  const std::size_t first =
      prepared.first + prepared.test->columns.size() * prepared.test->times.size();
  const std::vector<std::string>& names = prepared.values.names().outputs;
  const auto put = [&](const ResultRow& row) {
    Prediction& prediction = predictions[static_cast<std::size_t>(row.run)];
    const Scene scene = scene_with(prepared.campaign, row.draws);
    for (std::size_t v = 0; v < values.size(); ++v) {
      const auto column =
          static_cast<std::size_t>(std::ranges::find(names, values[v].name) - names.begin());
      prediction[first + v] =
          values[v].parameter ? values[v].parameter->in(std::as_const(scene)) : row.outputs[column];
    }
  };
  const auto is_output = [](const FitValue& value) { return !value.parameter; };
  if (std::ranges::any_of(values, is_output))
    return make_runs(prepared.values, predictions.size(), put);
  for (long k = 0; k < std::ssize(predictions); ++k) {
    ResultRow row;
    row.run = k;
    row.draws.resize(prepared.campaign.dispersions.size());
    prepared.values.draw(k, row.draws);
    put(row);
  }
}

void TestRuns::make_trace(const Prepared& prepared, std::vector<Prediction>& predictions) {
  const FitTest& test = *prepared.test;
  make_runs(prepared.trace, predictions.size(), [&](const ResultRow& row) {
    if (!prepared.motion.is_whole(row.outputs)) return;
    const FitPoint& point = points_[static_cast<std::size_t>(row.run)];
    const double offset = are_candidates_ ? 0 : space_.time_offset(prepared.number, point);
    double* number = &predictions[static_cast<std::size_t>(row.run)][prepared.first];
    for (std::size_t c = 0; c < test.columns.size(); ++c) {
      const double shift = are_candidates_ ? 0 : space_.column_offset(prepared.number, c, point);
      for (const double t : test.times)
        *number++ = prepared.motion.at(row.outputs, c, t + offset) + shift;
    }
  });
}

} // namespace wingspread
