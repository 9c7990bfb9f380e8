#include "montecarlo/analyses/rare/rare_event.hpp"

#include "montecarlo/foundation/formats/spec_error.hpp"
#include "montecarlo/foundation/platform/interrupt.hpp"
#include "montecarlo/foundation/statistics/binomial_bounds.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "montecarlo/model/input_checks/requirement_checks.hpp"

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
      : evaluator_(evaluator), peak_(limit_state.peak()),
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
    bool cut, open; ///< t_end cut the peak; a latch may let go after it
  };

  /// g and status of the runs at the points, in their order. @throws Stopped
  /// @param report_progress called with the number of finished runs
  [[nodiscard]] std::vector<Judged> judge(std::span<const NormalPoint> points,
                                          const std::function<void(long)>& report_progress) {
    points_ = points;
    const RunRange all{0, std::ssize(points)};
    std::vector<Judged> judged;
    const auto keep = [&](const Batch& batch) {
      for (const ResultRow& row : batch.rows)
        judged.push_back({row.outputs.front(), row.status,
                          is_cut(peak_, row.peaks_final.value_or(PeaksFinal::unknown)),
                          row.status == Status::deployed && row.reason == latches_may_let_go});
      report_progress(std::ssize(judged));
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
  PeakKind peak_;
  std::span<const NormalPoint> points_; ///< the points of the plan's runs
  RunPlan plan_;
};

std::optional<LikeliestRun> likeliest_of(const std::vector<StratumEstimate>& strata,
                                         NormalRuns& runs) {
  std::optional<NormalPoint> nearest;
  for (const StratumEstimate& part : strata)
    for (const SubsetEstimate& estimate : part.estimates)
      for (const NormalPoint& point : estimate.inside) {
        NormalPoint z = within(part.stratum, point);
        if (!nearest || distance(z) < distance(*nearest)) nearest = std::move(z);
      }
  return nearest ? std::optional(runs.run_at(*nearest)) : std::nullopt;
}

/// N of a stratum's levels: all strata with rare values share the N of the first stratum, but each has at least 200.
long samples_of(const Strata& strata, std::size_t s, long samples) {
  if (s == 0) return samples;
  constexpr long least = 200; // 20 chains
  const long share = samples / (std::ssize(strata.list) - 1) / 10 * 10;
  return std::max(share, std::min(samples, least));
}

/// Raises the upper bound to that of the first levels as a plain sample, if that is larger.
void widen_to_plain(double confidence, RareEstimate& estimate) {
  const Interval plain = clopper_pearson(estimate.hits, estimate.draws, confidence);
  estimate.interval.upper = std::max(estimate.interval.upper, plain.upper);
}

/// Simulates strata one after the other.
class StrataSimulation {
public:
  StrataSimulation(const Campaign& campaign, const RareOptions& options, NormalRuns& runs,
                   const std::function<void(const StudyProgress&)>& progress)
      : campaign_(campaign), options_(options), runs_(runs), progress_(progress),
        strata_(strata_of(campaign, {options.samples, options.repeats, options.smallest})) {}

  RareResult run() {
    const std::size_t count = strata_.list.size();
    result_.strata.resize(count);
    // Strata with rare values go first: with their sum known, the first stratum can omit levels that add nothing to it.
    for (std::size_t s = 1; s < count; ++s) simulate(s);
    simulate(0);
    result_.left_out = strata_.left_out;
    result_.unseen = std::move(strata_.unseen);
    result_.estimate = sum_of(result_.strata, result_.left_out);
    result_.likeliest = likeliest_of(result_.strata, runs_);
    for (StratumEstimate& part : result_.strata)
      for (SubsetEstimate& estimate : part.estimates) estimate.inside.clear();
    return std::move(result_);
  }

private:
  /// Smallest level of stratum s: below it, all strata together add less than 1e-3 of the sum so far.
  [[nodiscard]] double smallest_of(std::size_t s) const {
    const double negligible = 1e-3 * found_ / static_cast<double>(strata_.list.size());
    return std::min(1.0, std::max(options_.smallest, negligible) / strata_.list[s].probability);
  }

  [[nodiscard]] SubsetOptions subset_of(std::size_t s) const {
    return {samples_of(strata_, s, options_.samples), smallest_of(s), campaign_.sampling.seed, 0,
            strata_.list[s].labels};
  }

  /// Most runs of the strata after this one.
  [[nodiscard]] long most_after(std::size_t s) const {
    if (s == 0) return 0;
    long most = options_.repeats * most_evaluations(subset_of(0));
    for (std::size_t next = s + 1; next < strata_.list.size(); ++next)
      most += options_.repeats * most_evaluations(subset_of(next));
    return most;
  }

  void simulate(std::size_t s) {
    StratumEstimate& part = result_.strata[s];
    part.stratum = strata_.list[s];
    const LimitStateFunction g = [&](std::span<const NormalPoint> points) {
      return judge(part.stratum, points);
    };
    SubsetOptions subset = subset_of(s);
    part.samples = subset.samples;
    for (long k = 0; k < options_.repeats; ++k) {
      // Stratum 0 has the streams of a simulation without strata: without rare values the result is that one's.
      subset.repetition = (static_cast<std::uint64_t>(s) << 32U) + static_cast<std::uint64_t>(k);
      most_ = made_ + (options_.repeats - k) * most_evaluations(subset) +
              most_after(s); // an upper bound: a repeat may end early
      const std::size_t own = coordinates_of(campaign_.dispersions).names.size();
      part.estimates.push_back(subset_simulation(g, coordinates_in(part.stratum, own), subset));
    }
    part.estimate = combined(part.estimates, options_.confidence);
    if (!strata_.unseen.empty()) widen_to_plain(options_.confidence, part.estimate);
    if (part.estimate.reached) found_ += part.stratum.probability * part.estimate.probability;
  }

  std::vector<double> judge(const Stratum& stratum, std::span<const NormalPoint> points) {
    std::vector<NormalPoint> moved;
    for (const NormalPoint& point : points) moved.push_back(within(stratum, point));
    std::vector<double> values;
    const auto report_progress = [&](long now) {
      progress_({0, 0, made_ + now, std::max(most_, made_ + now)});
    };
    for (const auto& [value, status, cut, open] : runs_.judge(moved, report_progress)) {
      values.push_back(value);
      ++result_.statuses[static_cast<std::size_t>(status)];
      result_.cut += cut && std::isnan(value), result_.open_latches += open;
      if (options_.event.output.empty()) continue;
      result_.undeployed += status != Status::deployed && !std::isnan(value);
      result_.absent +=
          std::isnan(value) && !cut && status != Status::invalid && status != Status::failed;
    }
    made_ += std::ssize(points);
    return values;
  }

  const Campaign& campaign_;
  const RareOptions& options_;
  NormalRuns& runs_;
  const std::function<void(const StudyProgress&)>& progress_;
  Strata strata_;
  RareResult result_;
  double found_ = 0; ///< the sum so far
  long made_ = 0, most_ = 0;
};

} // namespace

RareResult estimate_rare_event(const Campaign& campaign, const RareOptions& options,
                               Evaluator& evaluator,
                               const std::function<void(const StudyProgress&)>& progress) {
  if (!vary(campaign.dispersions))
    throw SpecError({{"", "/dispersions",
                      campaign.dispersions.empty() ? "none" : "laws with a single value only",
                      "at least one that varies"}});
  const LimitState limit_state(campaign, options.event);
  NormalRuns runs(campaign, limit_state, evaluator);
  RareResult result = StrataSimulation(campaign, options, runs, progress).run();
  result.never_final = why_never_final(campaign);
  return result;
}

} // namespace wingspread
