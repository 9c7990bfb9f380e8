#include "montecarlo/analyses/fit/fit_study.hpp"

#include "distributions/prepared_distribution.hpp"
#include "distributions/random_stream.hpp"
#include "montecarlo/analyses/fit/proposal.hpp"
#include "montecarlo/engine/mpi/evaluator_of.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "montecarlo/results/results_folder/stamp.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace wingspread {
namespace {

constexpr std::size_t least_walkers = 32; // each half fills two threads of eight lanes
constexpr double independent_moves = 0.8; // heuristic: the others reach what the proposal misses
// Heuristic: the limit of the evaluations, unless the user gives one. With 100, 16 of 43 fits of four parameters, each
// with offsets of a clock and of two sensors, ended unfinished.
constexpr long runs_of_a_sample = 400;
constexpr std::size_t predicted_rows = 400; // for bands and p-values: 10 rows in each 2.5 % tail
// Heuristic: starts of a second search, if the first ends far from a trace. A moment that jumps at latching has many local
// modes. Fewer starts miss the true one more often; more cost runs where the trace is of another wing.
constexpr int most_starts_of_search = 32;
constexpr int temperings = 2;   // rounds of tempering and a new search; each moves the mode little
constexpr int least_tried = 16; // points of the prior; if no run there has a number, it is refused

std::size_t walkers_for(std::size_t dimensions) {
  const std::size_t walkers = std::max(least_walkers, 4 * dimensions);
  return walkers + walkers % 2;
}

/// A prior with one limit is cut off there if its 1 % quantile is nearer to the limit than this share of the median's
/// distance: 0.02 for a uniform law, 0.019 for a normal law cut at its mean. Heuristic: laws that fade out have far more.
constexpr double most_of_cut = 0.05;

/// The campaign whose laws the parameter has.
const Campaign& laws_of(const FitParameter& parameter, const Campaign& campaign,
                        const FitSpec& spec) {
  return parameter.kind == FitParameter::Kind::dispersion && parameter.test
             ? spec.tests[*parameter.test].campaign
             : campaign;
}

/// The limit at which the posterior lies (at_limit); none if a prior with one limit fades out there (most_of_cut).
/// @param campaign see laws_of
std::optional<double> limit_at(std::span<const double> sorted, const FitParameter& parameter,
                               const Campaign& campaign) {
  if (parameter.kind != FitParameter::Kind::dispersion) return std::nullopt;
  const PreparedDistribution law(campaign.dispersions[parameter.dispersion].distribution);
  const double lower = law.quantile(0), upper = law.quantile_complement(0);
  const bool two = std::isfinite(upper - lower);
  const auto lies_at = [&](double limit, double next, double inner) {
    const double near = two ? at_limit * (upper - lower) : std::abs(next - limit);
    const bool is_cut = two || near < most_of_cut * std::abs(law.quantile(0.5) - limit);
    return std::isfinite(limit) && is_cut && std::abs(inner - limit) < near;
  };
  if (lies_at(lower, law.quantile(at_limit), quantile(sorted, share_at_limit))) return lower;
  const double inner = quantile(sorted, 1 - share_at_limit);
  return lies_at(upper, law.quantile_complement(at_limit), inner) ? std::optional(upper)
                                                                  : std::nullopt;
}

/// Indices of the dispersions that vary and are not fitted: a test holds them at their medians.
std::vector<std::size_t> held_dispersions(const Campaign& campaign, const FitSpec& spec) {
  std::vector<std::size_t> held;
  for (std::size_t i = 0; i < campaign.dispersions.size(); ++i)
    if (varies(campaign.dispersions[i].distribution) &&
        std::ranges::find(spec.parameters, i) == spec.parameters.end())
      held.push_back(i);
  return held;
}

/// The spec with the held dispersions fitted too, with normal laws in the tests' campaigns.
/// @param campaign with_normal_laws of the campaign
FitSpec with_held(FitSpec spec, const Campaign& campaign, const std::vector<std::size_t>& held) {
  for (FitTest& test : spec.tests) test.campaign = with_normal_laws(std::move(test.campaign), held);
  for (const std::size_t i : held)
    if (std::holds_alternative<Normal>(campaign.dispersions[i].distribution.law))
      spec.parameters.push_back(i);
  std::ranges::sort(spec.parameters);
  return spec;
}

/// All kept points, step by step.
std::vector<FitPoint> points_of(const Ensemble& ensemble) {
  std::vector<FitPoint> points;
  for (std::size_t n = 0; n < ensemble.chains.front().size(); ++n)
    for (const auto& chain : ensemble.chains) points.push_back(chain[n]);
  return points;
}

/// At most `count` of the points, evenly chosen.
std::vector<FitPoint> chosen(const std::vector<FitPoint>& points, std::size_t count) {
  if (count >= points.size()) return points;
  std::vector<FitPoint> some;
  for (std::size_t k = 0; k < count; ++k) some.push_back(points[k * points.size() / count]);
  return some;
}

Eigen::MatrixXd covariance_of(const std::vector<FitPoint>& points) {
  FitPoint mean = FitPoint::Zero(points.front().size());
  for (const FitPoint& point : points) mean += point;
  mean /= static_cast<double>(points.size());
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(mean.size(), mean.size());
  for (const FitPoint& point : points) sum += (point - mean) * (point - mean).transpose();
  return sum / static_cast<double>(points.size() - 1);
}

std::string name_of(const FitTest& test, const Channel& channel) {
  return channel.column ? test.columns[*channel.column].name : test.values[channel.value].name;
}

class Study {
public:
  Study(const Campaign& campaign, const FitSpec& spec, const FitOptions& options,
        const std::atomic<bool>& stop)
      : campaign_(campaign), spec_(spec), options_(options),
        evaluator_(evaluator_of(options.pool, stop)), space_(campaign, spec),
        data_(data_of(spec.tests)), runs_(spec.tests, spec.parameters, space_, *evaluator_),
        values_(campaign, spec, space_), coupling_(space_.coupling()) {}

  FitResult run(BatchLog* log, const std::function<void(const EnsembleState&)>& report_progress) {
    search_modes();
    sample(log, report_progress);
    summarize_parameters();
    summarize_held();
    summarize_channels();
    judge_candidates();
    result_.space = space_.list();
    result_.common = space_.common();
    result_.runs += runs_.runs();
    result_.lost_laws = lost_laws(campaign_, result_.posterior.columns);
    return std::move(result_);
  }

private:
  void search_modes() {
    const auto from = [&](int starts) {
      return find_modes(data_, runs_, first_points(space_.size(), starts, campaign_.sampling.seed));
    };
    modes_ = from(spec_.starts);
    if (is_far_from_a_trace(data_, modes_.front()))
      modes_ = from(std::max(spec_.starts, most_starts_of_search));
    for (int k = 0; k < temperings; ++k) {
      temper(spec_.tests, modes_.front().prediction, data_);
      std::vector<FitPoint> starts;
      for (const FitMode& mode : modes_) starts.push_back(mode.at);
      modes_ = find_modes(data_, runs_, starts);
    }
    for (std::size_t k = 1; k < modes_.size(); ++k)
      result_.other_modes.push_back({distance_of(modes_.front(), modes_[k]),
                                     modes_.front().log_posterior - modes_[k].log_posterior,
                                     values_.of(modes_[k].at)});
  }

  void sample(BatchLog* log, const std::function<void(const EnsembleState&)>& report_progress) {
    const LogDensity density = [&](std::span<const FitPoint> points) {
      const auto make = [&] {
        const std::vector<Prediction> predictions = runs_.predict(points, RunAccuracy::campaign);
        std::vector<double> logs;
        for (std::size_t k = 0; k < points.size(); ++k)
          logs.push_back(log_posterior(data_, points[k], predictions[k]));
        return logs;
      };
      return log ? log->next(points.size(), make) : make();
    };
    const long most =
        options_.most_runs > 0 ? options_.most_runs : runs_of_a_sample * spec_.samples;
    const EnsembleOptions how{.walkers = walkers_for(space_.size()),
                              .seed = campaign_.sampling.seed,
                              .ess = static_cast<double>(spec_.samples),
                              .most_evaluations = most,
                              .independent = independent_moves};
    const StudentMixture proposal = proposal_about(modes_, data_, runs_, campaign_.sampling.seed);
    const Ensemble ensemble = run_ensemble(density, proposal, how, report_progress);
    result_.finished = ensemble.finished;
    result_.sampler = ensemble.state;
    points_ = points_of(ensemble);
  }

  void summarize_parameters() {
    const std::vector<double> mode = values_.of(modes_.front().at);
    std::vector<std::vector<double>> columns(space_.size());
    for (const FitPoint& point : points_) {
      const std::vector<double> values = values_.of(point);
      for (std::size_t k = 0; k < values.size(); ++k) columns[k].push_back(values[k]);
    }
    const Eigen::MatrixXd covariance = coupling_ * covariance_of(points_) * coupling_.transpose();
    const FitPoint scores = coupling_ * modes_.front().at;
    const auto d = static_cast<Eigen::Index>(space_.size());
    result_.correlation = Eigen::MatrixXd::Identity(d, d);
    for (Eigen::Index i = 0; i < d; ++i)
      for (Eigen::Index j = 0; j < i; ++j)
        result_.correlation(i, j) = result_.correlation(j, i) =
            pearson(columns[static_cast<std::size_t>(i)], columns[static_cast<std::size_t>(j)]);
    for (std::size_t k = 0; k < space_.size(); ++k) {
      const FitParameter& parameter = space_.list()[k];
      const Campaign& laws = laws_of(parameter, campaign_, spec_);
      const ParameterPrior prior = prior_of(parameter, laws, fit_confidence);
      const Moments after = moments(columns[k]);
      std::ranges::sort(columns[k]);
      const double tail = (1 - fit_confidence) / 2;
      const auto place = static_cast<Eigen::Index>(k);
      result_.parameters.push_back({.name = parameter.name,
                                    .unit = std::string(prior.unit),
                                    .prior_mean = prior.mean,
                                    .prior_std = prior.std,
                                    .mode = mode[k],
                                    .mean = after.mean,
                                    .std = after.std,
                                    .lower = quantile(columns[k], tail),
                                    .upper = quantile(columns[k], 1 - tail),
                                    .score_std = std::sqrt(covariance(place, place)),
                                    .prior_sigmas = std::abs(scores[place]),
                                    .limit = limit_at(columns[k], parameter, laws),
                                    .prior_lower = prior.lower,
                                    .prior_upper = prior.upper});
    }
    const auto common = static_cast<Eigen::Index>(space_.common());
    result_.score_covariance = covariance.topLeftCorner(common, common);
    result_.prior_covariance = (coupling_ * coupling_.transpose()).topLeftCorner(common, common);
    if (common > 0)
      result_.directions = directions_of(result_.score_covariance, result_.prior_covariance);
    result_.posterior = posterior_rows(campaign_, space_, values_,
                                       chosen(points_, static_cast<std::size_t>(spec_.samples)));
  }

  void summarize_held() {
    const std::vector<std::size_t> held = held_dispersions(campaign_, spec_);
    for (const std::size_t i : held) {
      const PreparedDistribution law(campaign_.dispersions[i].distribution);
      const LawMoments prior = moments_of(campaign_.dispersions[i].distribution);
      result_.held.push_back(
          {campaign_.dispersions[i].name, law.quantile(0.5), prior.mean, prior.standard_deviation});
      for (const FitTest& test : spec_.tests) {
        const PreparedDistribution own(test.campaign.dispersions[i].distribution);
        if (own.quantile(0.5) != result_.held.back().median)
          result_.held.back().in_tests.emplace_back(test.name, own.quantile(0.5));
      }
    }
    const Campaign linear = with_normal_laws(campaign_, held);
    const FitSpec all = with_held(spec_, linear, held);
    if (all.parameters.size() == spec_.parameters.size()) return;
    const ParameterSpace space(linear, all);
    TestRuns runs(all.tests, all.parameters, space, *evaluator_);
    FitPoint at = FitPoint::Zero(static_cast<Eigen::Index>(space.size()));
    std::vector<std::size_t> fitted; // indices in `space` of the parameters of space_
    for (std::size_t k = 0; k < space_.size(); ++k) {
      const auto same = std::ranges::find(space.list(), space_.list()[k].name, &FitParameter::name);
      fitted.push_back(static_cast<std::size_t>(same - space.list().begin()));
      at[static_cast<Eigen::Index>(fitted.back())] =
          modes_.front().at[static_cast<Eigen::Index>(k)];
    }
    std::vector<std::size_t> not_fitted; // dispersions, in the order of `space`
    for (std::size_t k = 0; k < space.size(); ++k)
      if (std::ranges::find(fitted, k) == fitted.end())
        not_fitted.push_back(space.list()[k].dispersion);
    const std::vector<double> widening =
        widening_by_held(data_, modes_.front().prediction, runs, at, fitted, covariance_of(points_),
                         correlations_in_rows(campaign_, not_fitted), coupling_);
    for (std::size_t k = 0; k < widening.size(); ++k) result_.parameters[k].widen(widening[k]);
    result_.runs += runs.runs();
  }

  void summarize_channels() {
    const std::vector<FitPoint> some = chosen(points_, predicted_rows);
    const std::vector<Prediction> predictions = runs_.predict(some, RunAccuracy::campaign);
    for (const Channel& channel : data_.channels) {
      const Prediction& mode = modes_.front().prediction;
      const ChannelFit fit = fit_of(data_, channel, mode);
      FittedChannel& fitted = result_.channels.emplace_back();
      fitted.channel = channel;
      fitted.name = name_of(spec_.tests[channel.test], channel);
      fitted.rms = std::sqrt(fit.sum_of_squares / static_cast<double>(channel.count));
      fitted.chi_squared = fit.chi_squared;
      fitted.offset = fit.offset;
      fitted.measured = data_.measured[channel.first];
      fitted.fitted = mode[channel.first];
      fitted.sigmas = (fitted.measured - fitted.fitted) / channel.std.value_or(undefined);
      fitted.p_value = p_value_of(data_, {&channel, 1}, predictions);
      if (!channel.column) continue;
      add_bands(channel, predictions, fitted);
      add_outliers(channel, fitted);
    }
    std::vector<Channel> values = data_.channels;
    std::erase_if(values, [](const Channel& channel) { return channel.column.has_value(); });
    result_.values.count = values.size();
    for (const FittedChannel& each : result_.channels)
      if (!each.channel.column) result_.values.chi_squared += each.chi_squared;
    if (!values.empty()) result_.values.p_value = p_value_of(data_, values, predictions);
  }

  void add_outliers(const Channel& channel, FittedChannel& fitted) const {
    const std::vector<double> residuals = residuals_of(data_, channel, modes_.front().prediction);
    Sum rest;
    for (const double r : residuals) rest.add(r * r);
    const std::vector<std::size_t> far = outliers_of(residuals, channel.std);
    for (const std::size_t i : far) {
      rest.add(-residuals[i] * residuals[i]);
      fitted.outliers.push_back({spec_.tests[channel.test].times[i],
                                 data_.measured[channel.first + i],
                                 std::abs(residuals[i]) / channel.std.value_or(fitted.rms)});
    }
    fitted.rest_rms =
        std::sqrt(std::max(0.0, rest.value()) / static_cast<double>(residuals.size() - far.size()));
  }

  void add_bands(const Channel& channel, const std::vector<Prediction>& predictions,
                 FittedChannel& fitted) const {
    const double tail = (1 - fit_confidence) / 2;
    for (std::size_t i = channel.first; i < channel.first + channel.count; ++i) {
      std::vector<double> values;
      for (const Prediction& prediction : predictions)
        if (std::isfinite(prediction[i])) values.push_back(prediction[i]);
      std::ranges::sort(values);
      fitted.mode.push_back(modes_.front().prediction[i]);
      fitted.lower.push_back(values.empty() ? undefined : quantile(values, tail));
      fitted.upper.push_back(values.empty() ? undefined : quantile(values, 1 - tail));
    }
  }

  void judge_candidates() {
    if (spec_.candidates.empty()) return;
    TestRuns runs(spec_.candidates, spec_.parameters, space_, *evaluator_, true);
    result_.candidates = candidate_gains(spec_.candidates, runs, modes_.front(), coupling_);
  }

  const Campaign& campaign_;
  const FitSpec& spec_;
  const FitOptions& options_;
  const std::unique_ptr<Evaluator> evaluator_;
  ParameterSpace space_;
  FitData data_;
  TestRuns runs_;
  PhysicalValues values_;
  const Eigen::MatrixXd coupling_;
  std::vector<FitMode> modes_;
  std::vector<FitPoint> points_;
  FitResult result_;
};

/// Chooses the intervals of the runs' samples. @return the number of runs made
long set_intervals(const Campaign& campaign, const FitOptions& options,
                   const std::atomic<bool>& stop, FitSpec& spec) {
  const auto evaluator = evaluator_of(options.pool, stop);
  const ParameterSpace space(campaign, spec);
  const auto points = first_points(space.size(), least_tried, campaign.sampling.seed);
  return choose_intervals(spec.tests, spec.parameters, space, *evaluator, points) +
         choose_intervals(spec.candidates, spec.parameters, space, *evaluator, points, true);
}

} // namespace

long smallest_run_limit() { return least_evaluations(walkers_for(1)); }

FitResult fit_campaign(const Campaign& campaign, const FitSpec& spec, const FitOptions& options,
                       const std::atomic<bool>& stop, BatchLog* log,
                       const std::function<void(const EnsembleState&)>& report_progress) {
  FitSpec sampled = spec;
  const long runs = set_intervals(campaign, options, stop, sampled);
  FitResult result = Study(campaign, sampled, options, stop).run(log, report_progress);
  result.runs += runs;
  for (const FitTest& test : sampled.tests)
    if (test.interpolation > most_interpolated)
      result.interpolated.push_back({test.name, test.interval, test.interpolation});
  return result;
}

void refuse_unpredictable(const Campaign& campaign, const FitSpec& spec, const FitOptions& options,
                          const std::string& file, const std::atomic<bool>& stop) {
  const auto evaluator = evaluator_of(options.pool, stop);
  const ParameterSpace space(campaign, spec);
  if (const long least = least_evaluations(walkers_for(space.size()));
      options.most_runs > 0 && options.most_runs < least)
    throw SpecError(
        {{"", "--runs", std::to_string(options.most_runs),
          fmt::format("at least {}, which the first diagnosis of the chains takes", least)}});
  refuse_lost_order(campaign, space, file);
  TestRuns runs(spec.tests, spec.parameters, space, *evaluator);
  std::vector<Problem> problems = unpredictable(
      spec.tests, runs,
      first_points(space.size(), std::max(spec.starts, least_tried), campaign.sampling.seed));
  for (Problem& problem : problems) problem.file = file;
  if (!problems.empty()) throw SpecError(std::move(problems));
}

Json about_fit(const Campaign& campaign, const FitSpec& spec) {
  std::string bytes;
  for (const double number : data_of(spec.tests).measured) bytes += fmt::format("{:a} ", number);
  for (const FitTest& test : spec.tests)
    for (const double time : test.times) bytes += fmt::format("{:a} ", time);
  return {{stamp_key, stamp_json(stamp_of(campaign, {}))},
          {"tests_hash", campaign_hash(spec.resolved)},
          {"measured_hash", fmt::format("{:016x}", stream_name(bytes).hash)}};
}

} // namespace wingspread
