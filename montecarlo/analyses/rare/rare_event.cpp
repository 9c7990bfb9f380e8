#include "montecarlo/analyses/rare/rare_event.hpp"

#include "montecarlo/foundation/formats/spec_error.hpp"
#include "montecarlo/foundation/platform/interrupt.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace wingspread {
namespace {

double distance(const NormalPoint& z) {
  Sum square;
  for (const double coordinate : z) square.add(coordinate * coordinate);
  return std::sqrt(square.value());
}

/// Runs of the campaign at points of the normal space.
class NormalRuns {
public:
  NormalRuns(const Campaign& campaign, const LimitState& limit_state, Evaluator& evaluator)
      : evaluator_(evaluator),
        plan_(
            campaign,
            [this](long k, std::span<Tails> u) {
              std::ranges::transform(points_[static_cast<std::size_t>(k)], u.begin(), unit_point);
            },
            limit_state.measure()) {}
  NormalRuns(const NormalRuns&) = delete;
  NormalRuns& operator=(const NormalRuns&) = delete;
  ~NormalRuns() = default;

  struct Judged {
    double g;
    Status status;
  };

  /// g and status of the runs at the points, in their order. @throws Stopped
  /// @param told called with the number of finished runs
  [[nodiscard]] std::vector<Judged> judge(std::span<const NormalPoint> points,
                                          const std::function<void(long)>& told) {
    points_ = points;
    const RunRange all{0, std::ssize(points)};
    std::vector<Judged> judged;
    const auto keep = [&](const Batch& batch) {
      for (const ResultRow& row : batch.rows) judged.push_back({row.outputs.front(), row.status});
      told(std::ssize(judged));
    };
    if (evaluator_.make(plan_, all, {keep}) < all.size()) throw Stopped{};
    return judged;
  }

  [[nodiscard]] LikeliestRun run_at(const NormalPoint& z) {
    points_ = {&z, 1};
    LikeliestRun likeliest{
        distance(z), {}, std::vector<double>(plan_.names().draws.size()), {}, {}};
    for (const std::size_t coordinate : plan_.coordinates().of)
      likeliest.z.push_back(z[coordinate]);
    plan_.draw(0, likeliest.draws);
    ResultRow row = Runner(plan_).run(0);
    likeliest.status = row.status;
    likeliest.reason = std::move(row.reason);
    return likeliest;
  }

private:
  Evaluator& evaluator_;
  std::span<const NormalPoint> points_; ///< the points of the plan's runs
  RunPlan plan_;
};

std::optional<LikeliestRun> likeliest_of(const std::vector<SubsetEstimate>& estimates,
                                         NormalRuns& runs) {
  const NormalPoint* nearest = nullptr;
  for (const SubsetEstimate& estimate : estimates)
    for (const NormalPoint& point : estimate.inside)
      if (!nearest || distance(point) < distance(*nearest)) nearest = &point;
  return nearest ? std::optional(runs.run_at(*nearest)) : std::nullopt;
}

} // namespace

RareResult estimate_rare_event(const Campaign& campaign, const RareOptions& options,
                               Evaluator& evaluator,
                               const std::function<void(const StudyProgress&)>& progress) {
  if (campaign.dispersions.empty())
    throw SpecError({{"", "/dispersions", "none", "at least one: there is nothing to vary"}});
  const LimitState limit_state(campaign, options.event);
  NormalRuns runs(campaign, limit_state, evaluator);
  RareResult result;
  long made = 0, most = 0;
  const auto told = [&](long now) { progress({0, 0, made + now, std::max(most, made + now)}); };
  const LimitStateFunction g = [&](std::span<const NormalPoint> points) {
    std::vector<double> values;
    for (const auto& [value, status] : runs.judge(points, told)) {
      values.push_back(value);
      ++result.statuses[static_cast<std::size_t>(status)];
    }
    made += std::ssize(points);
    return values;
  };
  for (long k = 0; k < options.repeats; ++k) {
    const SubsetOptions subset{options.samples, options.smallest, campaign.sampling.seed,
                               static_cast<std::uint64_t>(k)};
    most = made + (options.repeats - k) *
                      most_evaluations(subset); // an upper bound: a repeat may end early
    result.estimates.push_back(
        subset_simulation(g, coordinates_of(campaign.dispersions).names.size(), subset));
  }
  result.estimate = combined(result.estimates, options.confidence);
  result.likeliest = likeliest_of(result.estimates, runs);
  for (SubsetEstimate& estimate : result.estimates) estimate.inside.clear();
  return result;
}

} // namespace wingspread
