#include "montecarlo/engine/accuracy/automatic_tolerance.hpp"

#include "montecarlo/engine/accuracy/chosen_runs.hpp"
#include "montecarlo/foundation/formats/output_name.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

namespace wingspread {
namespace {

constexpr std::size_t most_repeated = 12;
constexpr double of_dependent_draws =
    0.1; ///< sampling error, as a share of that of independent ones
constexpr double atol_over_rtol = 0.01;

void set_tolerance(Campaign& campaign, double rtol) {
  campaign.integration.rtol = rtol;
  if (!campaign.tolerance->has_atol) campaign.integration.atol = atol_over_rtol * rtol;
}

/// 1/f(q_p), (4).
double inverse_density(std::span<const double> sorted, double p) {
  const long count = std::ssize(sorted), k = quantile_rank(count, p);
  const long m = std::lround(std::ceil(std::sqrt(static_cast<double>(count)) / 2));
  const long first = std::max(1L, k - m), last = std::min(count, k + m);
  const double width =
      sorted[static_cast<std::size_t>(last - 1)] - sorted[static_cast<std::size_t>(first - 1)];
  return width * static_cast<double>(count) / static_cast<double>(last - first);
}

Results rows_of(const Campaign& campaign, long runs, const Crew& crew) {
  const RunPlan plan(campaign);
  Results results(plan.names());
  const auto keep = [&](const Batch& batch) {
    for (const ResultRow& row : batch.rows) results.append(row);
  };
  const std::atomic<bool> never = false;
  (void)ThreadEvaluator(crew, never).make(plan, {0, runs}, {keep, false});
  return results;
}

/// The pilot of one campaign.
class Pilot {
public:
  Pilot(const Campaign& campaign, const Crew& crew)
      : campaign_(campaign), crew_(crew), runs_(pilot_runs(campaign.sampling.runs)) {
    set_tolerance(campaign_, tolerance_ladder[0]);
    const Results results = rows_of(campaign_, runs_, crew);
    for (const std::size_t row : chosen_rows(campaign_, results, most_repeated))
      rows_.push_back(results.row(row));
    for (const Column& column : results.outputs) add_sampling_error(column);
  }

  /// The loosest tolerance that will do, or the tightest.
  [[nodiscard]] std::pair<double, bool> choose() {
    if (rows_.empty()) return {tolerance_ladder[0], true};
    for (const double rtol : tolerance_ladder)
      if (will_do(rtol)) return {rtol, true};
    return {std::end(tolerance_ladder)[-1], false};
  }

  [[nodiscard]] TolerancePilot record() const {
    TolerancePilot pilot{campaign_.sampling.seed, runs_, {}, campaign_.sampling.runs, true};
    for (const ResultRow& row : rows_) pilot.repeated.push_back(row.run);
    return pilot;
  }

private:
  void add_sampling_error(const Column& column) {
    const std::vector<double> sorted = sorted_present(column.values);
    const double happens = static_cast<double>(sorted.size()) / static_cast<double>(runs_);
    const bool counts = parse_output_name(column.name).quantity != "overtravel";
    sampling_.push_back(counts
                            ? sampling_error(sorted, campaign_.statistics.quantiles,
                                             happens * static_cast<double>(campaign_.sampling.runs))
                            : SamplingError{undefined, undefined});
  }

  [[nodiscard]] bool will_do(double rtol) {
    set_tolerance(campaign_, rtol);
    std::vector<long> runs;
    for (const ResultRow& row : rows_) runs.push_back(row.run);
    const std::vector<ResultRow> rows =
        rtol == tolerance_ladder[0] ? rows_
                                    : make_again(campaign_, campaign_.integration, runs, crew_);
    const Accuracy found = compare_with_reference(campaign_, rows, crew_);
    const double draws = has_replicates(campaign_.sampling) ? of_dependent_draws : 1;
    bool within = found.runs > 0;
    for (std::size_t i = 0; within && i < sampling_.size(); ++i)
      within = is_within(found.outputs[i], sampling_[i], draws * campaign_.tolerance->share);
    return within;
  }

  Campaign campaign_;
  Crew crew_;
  long runs_;
  std::vector<ResultRow> rows_;         ///< those that are made again, at the loosest tolerance
  std::vector<SamplingError> sampling_; ///< of each output
};

} // namespace

SamplingError sampling_error(std::span<const double> sorted, std::span<const double> quantiles,
                             double runs) {
  SamplingError error{undefined, undefined};
  const Moments m = moments(sorted);
  if (!(m.std > 0)) return error;
  const double of_mean = m.std / std::sqrt(runs);                         // (1)
  const double of_std = m.std * std::sqrt((m.kurtosis + 2) / (4 * runs)); // (2)
  error.moments = of_std > 0 ? std::fmin(of_mean, of_std) : of_mean;
  for (const double p : quantiles) {
    const double of_quantile = std::sqrt(p * (1 - p) / runs) * inverse_density(sorted, p); // (3)
    if (of_quantile > 0) error.quantiles = std::fmin(error.quantiles, of_quantile);
  }
  return error;
}

bool is_within(const OutputAccuracy& error, const SamplingError& sampling, double share) {
  return !(error.rms > share * sampling.moments) && !(error.largest > share * sampling.quantiles);
}

long pilot_runs(long runs) { return std::min(runs, std::clamp(runs / 8, 32L, 256L)); }

void settle_tolerance(Campaign& campaign, const Crew& crew) {
  if (!campaign.tolerance || campaign.tolerance->pilot) return;
  double rtol = 0;
  bool all_reached = true;
  std::optional<TolerancePilot> record; // of the case that decides
  for (const Campaign& each : campaigns_of(campaign)) {
    Pilot pilot(each, crew);
    const auto [its, reached] = pilot.choose();
    all_reached = all_reached && reached;
    if (record && its >= rtol) continue;
    rtol = its;
    record = pilot.record();
  }
  record->reached = all_reached;
  set_tolerance(campaign, rtol);
  campaign.tolerance->pilot = std::move(record);
  campaign.resolved["integration"] = write_integration(campaign.integration, campaign.tolerance);
}

} // namespace wingspread
