#include "montecarlo/analyses/fit/test_runs.hpp"

#include "montecarlo/engine/runs/sampled_motion.hpp"
#include "montecarlo/foundation/platform/interrupt.hpp"
#include "montecarlo/foundation/platform/thread_pool.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"

#include <algorithm>
#include <optional>

namespace wingspread {
namespace {

constexpr double derivative_rtol = 1e-10, derivative_atol = 1e-12;
constexpr double offsets_covered =
    8; // standard deviations of the clock offset beyond the last time

Campaign campaign_for(const FitTest& test, const std::vector<std::size_t>& fitted,
                      RunAccuracy accuracy) {
  Campaign campaign = fixed_but(test.campaign, fitted);
  if (accuracy == RunAccuracy::derivative) {
    campaign.integration.rtol = std::min(campaign.integration.rtol, derivative_rtol);
    campaign.integration.atol = std::min(campaign.integration.atol, derivative_atol);
  }
  return campaign;
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

/// One test at one accuracy.
struct TestRuns::Prepared {
  Prepared(const FitTest& given, std::size_t index, std::size_t place, Campaign its,
           UnitPoints points)
      : test(&given), number(index), first(place), campaign(std::move(its)),
        plan(campaign, std::move(points)) {}
  const FitTest* test;
  std::size_t number, first; ///< of the test, and of its first number
  Campaign campaign;
  RunPlan plan;
};

TestRuns::TestRuns(std::span<const FitTest> tests, const std::vector<std::size_t>& fitted,
                   const ParameterSpace& space, ThreadPool pool, const std::atomic<bool>& stop,
                   bool are_candidates)
    : space_(space), pool_(pool), stop_(stop), are_candidates_(are_candidates) {
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
  for (const auto& prepared : prepared_[static_cast<std::size_t>(accuracy)])
    make_values(*prepared, predictions);
  make_traces(accuracy, predictions);
  return predictions;
}

void TestRuns::make_values(const Prepared& prepared, std::vector<Prediction>& predictions) {
  const std::vector<FitValue>& values = prepared.test->values;
  if (values.empty()) return;
  const std::size_t first =
      prepared.first + prepared.test->columns.size() * prepared.test->times.size();
  const std::vector<std::string>& names = prepared.plan.names().outputs;
  const auto put = [&](const ResultRow& row) {
    Prediction& prediction = predictions[static_cast<std::size_t>(row.run)];
    Scene scene = prepared.campaign.scene;
    apply(prepared.campaign, row.draws, prepared.campaign.scene, scene);
    for (std::size_t v = 0; v < values.size(); ++v) {
      const auto column =
          static_cast<std::size_t>(std::ranges::find(names, values[v].name) - names.begin());
      prediction[first + v] =
          values[v].parameter ? values[v].parameter->in(std::as_const(scene)) : row.outputs[column];
    }
  };
  const RunRange all{0, std::ssize(predictions)};
  const bool needs_runs =
      std::ranges::any_of(values, [](const FitValue& v) { return !v.parameter; });
  if (!needs_runs) {
    for (long k = 0; k < all.last; ++k) {
      ResultRow row;
      row.run = k;
      row.draws.resize(prepared.campaign.dispersions.size());
      prepared.plan.draw(k, row.draws);
      put(row);
    }
    return;
  }
  const auto take = [&](const Batch& batch) {
    for (const ResultRow& row : batch.rows) put(row);
  };
  if (ThreadEvaluator(pool_, stop_).make(prepared.plan, all, {take}) < all.size()) throw Stopped{};
  runs_ += all.size();
}

void TestRuns::make_traces(RunAccuracy accuracy, std::vector<Prediction>& predictions) {
  std::vector<const Prepared*> traced;
  for (const auto& prepared : prepared_[static_cast<std::size_t>(accuracy)])
    if (!prepared->test->columns.empty()) traced.push_back(prepared.get());
  const std::size_t count = traced.size() * predictions.size();
  if (count == 0) return;
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    Deployment deployment;
    std::optional<SampledMotion> motion;
    const Prepared* of = nullptr;
    Scene scene;
    std::vector<double> draws;
    for (std::size_t task = next++; task < count && !stop_; task = next++) {
      const Prepared& prepared = *traced[task / predictions.size()];
      const std::size_t point = task % predictions.size();
      const FitTest& test = *prepared.test;
      if (of != &prepared) {
        std::vector<std::size_t> columns;
        for (const FitColumn& column : test.columns) columns.push_back(column.index);
        motion.emplace(prepared.campaign.scene, std::move(columns));
        scene = prepared.campaign.scene;
        of = &prepared;
      }
      draws.resize(prepared.campaign.dispersions.size());
      prepared.plan.draw(static_cast<long>(point), draws);
      apply(prepared.campaign, draws, prepared.campaign.scene, scene);
      const double last = test.times.back() + offsets_covered * test.time_offset_std;
      if (!motion->run(deployment, scene, prepared.campaign.integration, last,
                       grid_interval(test.times)))
        continue;
      const double offset =
          are_candidates_ ? 0 : space_.time_offset(prepared.number, points_[point]);
      double* number = &predictions[point][prepared.first];
      for (std::size_t c = 0; c < test.columns.size(); ++c) {
        const double shift =
            are_candidates_ ? 0 : space_.column_offset(prepared.number, c, points_[point]);
        for (const double t : test.times) *number++ = motion->at(c, t + offset) + shift;
      }
    }
  };
  run_on_threads(thread_count(pool_.threads), work, [&] { next = count; });
  if (stop_) throw Stopped{};
  runs_ += static_cast<long>(count);
}

} // namespace wingspread
