/// The fit of a campaign's parameters to tests: modes, samples of the posterior, and their statistics.
#pragma once

#include "montecarlo/analyses/fit/fit_campaign.hpp"
#include "montecarlo/analyses/fit/identifiability.hpp"
#include "montecarlo/analyses/sampler/ensemble_sampler.hpp"
#include "montecarlo/results/checkpoint/batch_log.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace wingspread {

struct FitOptions {
  ThreadPool pool{};
  long most_runs = 0; ///< evaluations of the sampler; 0: 400 for each sample asked for
};

/// Of the intervals of parameters and of the bands of traces, whatever confidence the campaign's statistics have.
inline constexpr double fit_confidence = 0.95;

/// The smallest FitOptions::most_runs that a fit of up to eight parameters accepts. Beyond eight it grows in proportion
/// to their number.
[[nodiscard]] long smallest_run_limit();

/// A parameter as its dispersion applies it; an offset in SI.
struct FittedParameter {
  std::string name, unit;
  double prior_mean = 0, prior_std = 0;
  double mode = 0, mean = 0, std = 0, lower = 0, upper = 0;
  double score_std = 0;    ///< of the normal score z, which has 1 before the tests
  double prior_sigmas = 0; ///< |z| of the mode: its distance from the prior's median
  double widening = 1;     ///< factor of `std` by the spread of dispersions that are not fitted
  std::optional<double> limit{}; ///< of the prior, if the posterior lies there
  bool held_decides = false;     ///< `widening` is cut: the widened `std` would exceed the prior's
  double prior_lower = 0, prior_upper = 0; ///< quantiles of the prior, for fit_confidence

  /// The share of the prior's standard deviation that is left.
  [[nodiscard]] double std_ratio() const { return std / prior_std; }

  /// Sets the widening to the first-order factor, cut where the standard deviation would exceed the prior's: so far out
  /// the model is not linear, and the prior bounds the parameter anyway.
  void widen(double factor) {
    const double most = std::max(1.0, prior_std / std);
    held_decides = !(factor <= most);
    widening = std::fmin(factor, most);
  }
};

/// A dispersion that is not fitted: every test holds it at its median.
struct HeldDispersion {
  std::string name;
  double median = 0, prior_mean = 0, prior_std = 0;
  std::vector<std::pair<std::string, double>> in_tests{}; ///< tests whose case has another median
};

/// A number of a trace that lies far from the fit, unlike the other numbers (outliers_of).
struct Outlier {
  double time = 0, measured = 0, sigmas = 0;
};

/// Residuals of a channel at the highest mode, and over the posterior.
struct FittedChannel {
  Channel channel;
  std::string name;
  double rms = 0, chi_squared = 0; ///< NaN for unknown noise
  double offset = 0;               ///< b̂
  double p_value =
      0; ///< posterior predictive: P(χ² of new numbers ≥ that of the measured); NaN for unknown noise
  double measured = 0, fitted = 0, sigmas = 0; ///< of a value: `fitted` at the mode
  /// For a trace: predictions at the mode, and bounds of the posterior's predictions, at the test's times.
  std::vector<double> mode, lower, upper;
  std::vector<Outlier> outliers{}; ///< the furthest first
  double rest_rms = 0;             ///< rms without the outliers
};

/// All measured values together: many small contradictions of one sense show only here.
struct FittedValues {
  std::size_t count = 0;
  double chi_squared = 0; ///< at the highest mode
  double p_value = 1;     ///< as of a channel
};

/// Whether a channel contradicts the model: the p-value is below this.
inline constexpr double misfit_p_value = 0.01;
/// Heuristic: if the rms residual is below σ by this factor, σ is probably in another unit.
inline constexpr double too_close = 5;
/// A parameter this far from its prior's median contradicts the prior: the prior's probability is 6e-5.
inline constexpr double conflict_sigmas = 4;

/// A posterior lies at a limit of its prior if at least `share_at_limit` of it is in the part next to the limit that
/// has `at_limit` of the prior. Heuristic: a posterior that falls off from the limit by 1/e within a thirtieth of the
/// range has so much; one that the tests put twice its standard deviation inside the limit has not.
inline constexpr double at_limit = 0.01, share_at_limit = 0.25;

/// Runs of each campaign, before and after the tests, for the prediction.
inline constexpr long predicted_runs = 1000;

/// Quantiles 5, 50 and 95 % of an output with the priors and with the posterior, over all runs: NaN where a run without
/// the output has that rank (missing_rank).
struct PredictedOutput {
  std::string name;
  std::array<double, 3> before{}, after{};
  long cut = 0; ///< runs of both whose peak t_end cut (finality.hpp)
};

struct FitPrediction {
  std::array<double, 2> deployed{};       ///< share of the runs, before and after
  std::vector<PredictedOutput> outputs{}; ///< those that any run has; empty: nothing is predicted
  std::string_view never_final{}; ///< why no t_end proves peaks final (requirement_checks.hpp)
};

/// A mode beside the highest one.
struct OtherMode {
  double distance = 0,
         drop = 0; ///< in standard deviations of the highest; its log posterior below that
  std::vector<double> parameters;
};

/// A test whose trace the samples of a run resolve too little: see choose_intervals.
struct InterpolatedTest {
  std::string name;
  double interval = 0, chi_squared = 0;
};

struct FitResult {
  bool finished = false;
  std::vector<FitParameter> space;
  std::size_t common = 0; ///< parameters of the prediction: the first of the list
  std::vector<FittedParameter> parameters;
  std::vector<HeldDispersion> held; ///< dispersions that vary and are not fitted
  Eigen::MatrixXd correlation;      ///< of the parameters
  std::vector<OtherMode> other_modes;
  std::vector<FitDirection> directions; ///< of the common parameters
  Eigen::MatrixXd score_covariance,
      prior_covariance; ///< of the common parameters' scores, after and before
  std::vector<FittedChannel> channels;
  FittedValues values;
  EnsembleState sampler;
  long runs = 0; ///< all runs made
  std::vector<InterpolatedTest> interpolated;
  PosteriorRows posterior;
  std::vector<CandidateGain> candidates;
  FitPrediction prediction;
  bool beside_cases = false; ///< the campaign has cases, and the prediction is of none of them
  std::vector<std::string> lost_laws; ///< of cases, for written dispersions; see lost_laws()
};

/// Runs points of the prior before anything is written. @param file of the tests, for the message
/// @throws SpecError where no run has a measured number, or a number is too large to be compared; Stopped
void refuse_unpredictable(const Campaign& campaign, const FitSpec& spec, const FitOptions& options,
                          const std::string& file, const std::atomic<bool>& stop);

/// @param log recorded batches of the sampler; may be null
/// @throws Stopped
[[nodiscard]] FitResult
fit_campaign(const Campaign& campaign, const FitSpec& spec, const FitOptions& options,
             const std::atomic<bool>& stop, BatchLog* log,
             const std::function<void(const EnsembleState&)>& report_progress);

/// Identifies the study for --resume: tests, measured numbers and campaign.
[[nodiscard]] Json about_fit(const Campaign& campaign, const FitSpec& spec);

} // namespace wingspread
