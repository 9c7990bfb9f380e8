#include "montecarlo/analyses/fit/likelihood.hpp"

#include "montecarlo/foundation/statistics/statistics.hpp"

#include <boost/math/special_functions/gamma.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace wingspread {
namespace {

/// Residual of a missing number, in standard deviations. Heuristic: so large that the search leaves such points.
constexpr double missing_residual = 1e3;

double tempering(const Channel& channel) {
  return channel.effective / static_cast<double>(channel.count);
}

/// b̂ of (1).
double offset_of(const Channel& channel, std::span<const double> residuals) {
  if (!(channel.offset_std > 0) || !channel.std) return 0;
  const double weight = tempering(channel) / (*channel.std * *channel.std);
  Sum sum;
  for (const double r : residuals) sum.add(r);
  return weight * sum.value() /
         (1 / (channel.offset_std * channel.offset_std) +
          weight * static_cast<double>(residuals.size()));
}

std::vector<double> raw_residuals(const FitData& data, const Channel& channel,
                                  const Prediction& prediction) {
  std::vector<double> residuals;
  for (std::size_t i = channel.first; i < channel.first + channel.count; ++i)
    residuals.push_back(data.measured[i] - prediction[i]);
  return residuals;
}

} // namespace

double p_value_of(const FitData& data, std::span<const Channel> channels,
                  std::span<const Prediction> predictions) {
  if (std::ranges::any_of(channels, [](const Channel& channel) { return !channel.std; }))
    return undefined;
  Sum sum;
  for (const Prediction& prediction : predictions) {
    double chi = 0, effective = 0;
    for (const Channel& channel : channels) {
      chi += channel.effective / static_cast<double>(channel.count) *
             fit_of(data, channel, prediction).chi_squared;
      effective += channel.effective;
    }
    sum.add(std::isfinite(chi) ? boost::math::gamma_q(effective / 2, chi / 2) : 0);
  }
  return sum.value() / static_cast<double>(predictions.size());
}

std::vector<double> residuals_of(const FitData& data, const Channel& channel,
                                 const Prediction& prediction) {
  std::vector<double> residuals = raw_residuals(data, channel, prediction);
  const double offset = offset_of(channel, residuals);
  for (double& r : residuals) r -= offset;
  return residuals;
}

std::vector<std::size_t> outliers_of(std::span<const double> residuals, std::optional<double> std) {
  constexpr double far = 6, normal = 1.4826;
  // of fewer than five residuals the median says nothing; heuristic
  constexpr std::size_t least = 5, one_of = 20;
  if (residuals.size() < least) return {};
  std::vector<double> sizes;
  for (const double r : residuals) sizes.push_back(std::abs(r));
  std::vector<double> sorted = sizes;
  std::ranges::sort(sorted);
  const double limit = far * std::max(std.value_or(0), normal * quantile(sorted, 0.5));
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < sizes.size(); ++i)
    if (sizes[i] > limit) found.push_back(i);
  if (found.size() > std::max<std::size_t>(1, sizes.size() / one_of)) return {};
  std::ranges::stable_sort(found, std::ranges::greater{}, [&](std::size_t i) { return sizes[i]; });
  return found;
}

ChannelFit fit_of(const FitData& data, const Channel& channel, const Prediction& prediction) {
  ChannelFit fit;
  std::vector<double> residuals = raw_residuals(data, channel, prediction);
  fit.offset = offset_of(channel, residuals);
  Sum squares;
  for (const double r : residuals) squares.add((r - fit.offset) * (r - fit.offset));
  fit.sum_of_squares = squares.value();
  const double kappa = tempering(channel), n = static_cast<double>(channel.count);
  if (!std::isfinite(fit.sum_of_squares)) {
    fit.log_likelihood = -std::numeric_limits<double>::infinity();
    fit.chi_squared = undefined;
  } else if (channel.std) {
    fit.chi_squared = fit.sum_of_squares / (*channel.std * *channel.std);
    fit.log_likelihood = -0.5 * kappa * fit.chi_squared;
    if (channel.offset_std > 0)
      fit.log_likelihood -= 0.5 * std::pow(fit.offset / channel.offset_std, 2);
  } else {
    fit.chi_squared = undefined;
    fit.log_likelihood = -0.5 * kappa * n * std::log(fit.sum_of_squares);
  }
  return fit;
}

double log_posterior(const FitData& data, const FitPoint& at, const Prediction& prediction) {
  double sum = -0.5 * at.squaredNorm();
  for (const Channel& channel : data.channels)
    sum += fit_of(data, channel, prediction).log_likelihood;
  return sum;
}

std::size_t least_squares_size(const FitData& data, std::size_t parameters) {
  std::size_t offsets = 0;
  for (const Channel& channel : data.channels) offsets += channel.std && channel.offset_std > 0;
  return data.measured.size() + offsets + parameters;
}

Eigen::VectorXd least_squares(const FitData& data, std::span<const double> squares,
                              const FitPoint& at, const Prediction& prediction) {
  Eigen::VectorXd v(
      static_cast<Eigen::Index>(least_squares_size(data, static_cast<std::size_t>(at.size()))));
  Eigen::Index place = 0;
  for (std::size_t c = 0; c < data.channels.size(); ++c) {
    const Channel& channel = data.channels[c];
    const double n = static_cast<double>(channel.count);
    const double weight =
        std::sqrt(tempering(channel)) / channel.std.value_or(std::sqrt(squares[c] / n));
    const std::vector<double> residuals = raw_residuals(data, channel, prediction);
    const double offset = offset_of(channel, residuals);
    for (const double r : residuals) {
      const double scaled = weight * (r - offset);
      v[place++] = std::isfinite(scaled) ? scaled : missing_residual;
    }
    if (channel.std && channel.offset_std > 0)
      v[place++] = std::isfinite(offset) ? offset / channel.offset_std : missing_residual;
  }
  v.tail(at.size()) = at;
  return v;
}

double autocorrelation_time(std::span<const double> values) {
  const std::size_t n = values.size();
  if (n < 4 || !varies(values)) return 1;
  const double mean = moments(values).mean;
  const auto covariance = [&](std::size_t lag) {
    double sum = 0;
    for (std::size_t i = 0; i + lag < n; ++i) sum += (values[i] - mean) * (values[i + lag] - mean);
    return sum;
  };
  const double variance = covariance(0);
  const double noise = 2 * std::sqrt(2 / static_cast<double>(n)); // two standard errors
  double pairs = 0, last = std::numeric_limits<double>::infinity();
  for (std::size_t lag = 0; lag + 1 < n / 2; lag += 2) {
    const double pair = (covariance(lag) + covariance(lag + 1)) / variance;
    if (!(pair > (lag == 0 ? 1 + noise : noise))) break; // ρ_0 = 1
    pairs += last = std::min(last, pair);
  }
  return std::max(1.0, 2 * pairs - 1);
}

void temper(std::span<const FitTest> tests, const Prediction& prediction, FitData& data) {
  for (Channel& channel : data.channels) {
    if (channel.count < 2 || !tests[channel.test].correlated) continue;
    const std::vector<double> residuals = residuals_of(data, channel, prediction);
    channel.effective = static_cast<double>(channel.count) / autocorrelation_time(residuals);
  }
}

} // namespace wingspread
