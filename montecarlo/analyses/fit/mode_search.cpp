#include "montecarlo/analyses/fit/mode_search.hpp"

#include "distributions/continuous_law.hpp"
#include "distributions/design.hpp"

#include <Eigen/Cholesky>
#include <fmt/format.h>
#include <unsupported/Eigen/NonLinearOptimization>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

namespace wingspread {
namespace {

// Heuristic: limits of one start, and of the repetitions for unknown noise. A start that needs more ends off its mode.
constexpr int most_evaluations = 200, most_weightings = 10;
// Heuristic: two starts that end closer than this, in standard deviations, found one mode. If larger, modes are lost.
constexpr double same_mode = 0.1;
constexpr double improbable = 30; // nats below the highest mode: e^−30 = 1e-13 of its density

double step_of(double u) {
  return std::cbrt(std::numeric_limits<double>::epsilon()) * (1 + std::abs(u));
}

/// Predictions one step above and below in each coordinate: +0, −0, +1, −1, …
std::vector<Prediction> predictions_around(TestRuns& runs, const FitPoint& at) {
  std::vector<FitPoint> points;
  for (Eigen::Index i = 0; i < at.size(); ++i)
    for (const double sign : {1.0, -1.0}) {
      points.push_back(at);
      points.back()[i] += sign * step_of(at[i]);
    }
  return runs.predict(points, RunAccuracy::derivative);
}

/// The functions that Eigen's LevenbergMarquardt asks for.
struct LeastSquares {
  const FitData& data;
  TestRuns& runs;
  std::vector<double> squares;

  [[nodiscard]] int inputs() const { return static_cast<int>(inputs_); }
  [[nodiscard]] int values() const {
    return static_cast<int>(least_squares_size(data, static_cast<std::size_t>(inputs_)));
  }
  int operator()(const Eigen::VectorXd& at, Eigen::VectorXd& v) const {
    v = least_squares(data, squares, at, runs.predict({&at, 1}, RunAccuracy::derivative).front());
    return 0;
  }
  int df(const Eigen::VectorXd& at, Eigen::MatrixXd& matrix) const {
    matrix = least_squares_jacobian(data, squares, runs, at);
    return 0;
  }
  Eigen::Index inputs_;
};

Prediction predict_one(TestRuns& runs, const FitPoint& at) {
  return runs.predict({&at, 1}, RunAccuracy::derivative).front();
}

/// The mode that one start leads to. Unknown noise is estimated anew until the mode stays.
FitMode end_of(const FitData& data, TestRuns& runs, FitPoint at) {
  const bool is_known = std::ranges::all_of(
      data.channels, [](const Channel& channel) { return channel.std.has_value(); });
  Prediction prediction = predict_one(runs, at);
  for (int k = 0; k < (is_known ? 1 : most_weightings); ++k) {
    LeastSquares problem{data, runs, squares_of(data, prediction), at.size()};
    Eigen::LevenbergMarquardt<LeastSquares> search(problem);
    search.parameters.maxfev = most_evaluations;
    search.parameters.xtol = search.parameters.ftol = 1e-10;
    const FitPoint before = at;
    (void)search.minimize(at);
    prediction = predict_one(runs, at);
    if ((at - before).norm() < 1e-7 * (1 + at.norm())) break;
  }
  return {at, log_posterior(data, at, prediction), laplace_covariance(data, runs, at, prediction),
          std::move(prediction)};
}

} // namespace

std::vector<double> squares_of(const FitData& data, const Prediction& prediction) {
  std::vector<double> squares;
  for (const Channel& channel : data.channels) {
    const double sum = fit_of(data, channel, prediction).sum_of_squares;
    squares.push_back(std::isfinite(sum) ? std::max(sum, std::numeric_limits<double>::min()) : 1);
  }
  return squares;
}

Eigen::MatrixXd least_squares_jacobian(const FitData& data, std::span<const double> squares,
                                       TestRuns& runs, const FitPoint& at) {
  const std::vector<Prediction> around = predictions_around(runs, at);
  Eigen::MatrixXd matrix(
      static_cast<Eigen::Index>(least_squares_size(data, static_cast<std::size_t>(at.size()))),
      at.size());
  for (Eigen::Index i = 0; i < at.size(); ++i) {
    const double h = step_of(at[i]);
    FitPoint above = at, below = at;
    above[i] += h, below[i] -= h;
    const auto k = static_cast<std::size_t>(2 * i);
    matrix.col(i) = (least_squares(data, squares, above, around[k]) -
                     least_squares(data, squares, below, around[k + 1])) /
                    (above[i] - below[i]);
  }
  return matrix;
}

Eigen::MatrixXd jacobian_of(TestRuns& runs, const FitPoint& at) {
  const std::vector<Prediction> around = predictions_around(runs, at);
  Eigen::MatrixXd matrix(static_cast<Eigen::Index>(runs.numbers()), at.size());
  for (Eigen::Index i = 0; i < at.size(); ++i)
    for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
      const auto k = static_cast<std::size_t>(2 * i), n = static_cast<std::size_t>(row);
      const double slope = (around[k][n] - around[k + 1][n]) / (2 * step_of(at[i]));
      matrix(row, i) = std::isfinite(slope) ? slope : 0;
    }
  return matrix;
}

Eigen::MatrixXd laplace_covariance(const FitData& data, TestRuns& runs, const FitPoint& at,
                                   const Prediction& prediction) {
  const Eigen::MatrixXd v = least_squares_jacobian(data, squares_of(data, prediction), runs, at);
  const Eigen::MatrixXd curvature = v.transpose() * v;
  return curvature.llt().solve(Eigen::MatrixXd::Identity(at.size(), at.size()));
}

bool is_far_from_a_trace(const FitData& data, const FitMode& mode) {
  return std::ranges::any_of(data.channels, [&](const Channel& channel) {
    const double most = settled_sigmas * settled_sigmas * static_cast<double>(channel.count);
    return channel.column && fit_of(data, channel, mode.prediction).chi_squared > most;
  });
}

std::vector<FitMode> find_modes(const FitData& data, TestRuns& runs,
                                std::span<const FitPoint> starts) {
  std::vector<FitMode> ends, modes;
  for (const FitPoint& start : starts) ends.push_back(end_of(data, runs, start));
  std::ranges::stable_sort(ends, std::greater(), &FitMode::log_posterior);
  for (FitMode& end : ends) {
    const bool is_known = std::ranges::any_of(
        modes, [&](const FitMode& mode) { return distance_of(mode, end) < same_mode; });
    const bool counts =
        modes.empty() || end.log_posterior > modes.front().log_posterior - improbable;
    if (!is_known && counts) modes.push_back(std::move(end));
  }
  return modes;
}

std::vector<FitPoint> first_points(std::size_t dimensions, int count, std::uint64_t seed) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < dimensions; ++i)
    names.push_back("\x7F"
                    "start " +
                    std::to_string(i));
  const bool fits = dimensions <= most_sobol_dimensions;
  const PreparedDesign design({fits ? DesignKind::sobol : DesignKind::random, seed}, names);
  const auto n = static_cast<Eigen::Index>(dimensions);
  std::vector<FitPoint> points{FitPoint::Zero(n)};
  for (int k = 1; k < count; ++k) {
    FitPoint& point = points.emplace_back(n);
    for (Eigen::Index i = 0; i < n; ++i)
      point[i] =
          inverse(Normal{}, tails_of_uniform(design.uniform(static_cast<std::uint64_t>(k - 1),
                                                            static_cast<std::size_t>(i))));
  }
  return points;
}

namespace {

std::string pointer_of(const Channel& channel, std::string_view key) {
  return fmt::format("/tests/{}/values/{}/{}", channel.test, channel.value, key);
}

/// The problem of a measured time that no run reaches.
std::optional<Problem> beyond_t_end(const FitTest& test, const Channel& channel) {
  const FitValue& value = test.values[channel.value];
  const double t_end = test.campaign.integration.t_end;
  if (value.parameter || value.unit != "s" || value.measured <= t_end) return std::nullopt;
  return Problem{"", pointer_of(channel, "value"),
                 fmt::format("{:.6g} s, beyond t_end = {:.6g} s", value.measured, t_end),
                 "a time within the run"};
}

/// The problem of a parameter of the scene that no fitted one changes: its measured value tells nothing.
std::optional<Problem> told_in_vain(const FitTest& test, const Channel& channel,
                                    std::span<const double> predicted) {
  const FitValue& value = test.values[channel.value];
  if (!value.parameter ||
      std::ranges::adjacent_find(predicted, std::not_equal_to()) != predicted.end())
    return std::nullopt;
  return Problem{
      "", pointer_of(channel, "parameter"),
      fmt::format("\"{}\", which no fitted parameter changes: its value tells nothing", value.name),
      "a parameter that a fitted dispersion changes, as a \"scale\": a measured value over the "
      "scene's"};
}

/// The problem of an output far from all runs, which they have in another unit or sense. Heuristic: far is five times
/// what the runs spread, and an explanation leads to within one; a test within its prior is not so far.
std::optional<Problem> in_another_unit(const FitTest& test, const Channel& channel,
                                       std::span<const double> predicted) {
  constexpr double far = 5, degrees = 180 / std::numbers::pi;
  const FitValue& value = test.values[channel.value];
  const auto [low, high] = std::ranges::minmax(predicted);
  const double spread = high - low + value.std;
  const auto distance = [&](double number) { return std::max({low - number, number - high, 0.0}); };
  if (value.parameter || !(distance(value.measured) > far * spread)) return std::nullopt;
  for (const double factor : {-1.0, degrees, 1 / degrees, -degrees, -1 / degrees, 1e3, 1e-3}) {
    if (!(distance(value.measured / factor) < spread)) continue;
    return Problem{"", pointer_of(channel, "value"),
                   fmt::format("{:.6g} {}, {}, where runs of the prior have {:.4g} to {:.4g} {}",
                               value.measured, value.unit,
                               factor == -1 ? std::string("of the opposite sense")
                                            : fmt::format("{:.4g} times too large", factor),
                               low, high, value.unit),
                   factor == -1 ? "the sense of the scene"
                                : "a value with its unit, as \"-40 deg/s\""};
  }
  return std::nullopt;
}

/// The problem of a measured value, given those of the runs that have it.
std::optional<Problem> problem_of_value(const FitTest& test, const Channel& channel,
                                        std::span<const double> predicted) {
  if (auto late = beyond_t_end(test, channel)) return late;
  if (predicted.empty()) return std::nullopt;
  if (auto vain = told_in_vain(test, channel, predicted)) return vain;
  return in_another_unit(test, channel, predicted);
}

} // namespace

std::vector<Problem> unpredictable(std::span<const FitTest> tests, TestRuns& runs,
                                   std::span<const FitPoint> points) {
  const std::vector<Prediction> tried = runs.predict(points, RunAccuracy::campaign);
  const FitData data = data_of(tests);
  std::vector<Problem> problems;
  for (const Channel& channel : data.channels) {
    if (!channel.column) {
      std::vector<double> predicted;
      for (const Prediction& prediction : tried)
        if (std::isfinite(prediction[channel.first]))
          predicted.push_back(prediction[channel.first]);
      if (auto problem = problem_of_value(tests[channel.test], channel, predicted)) {
        problems.push_back(std::move(*problem));
        continue;
      }
    }
    const auto compares = [&](const Prediction& prediction) {
      return std::isfinite(fit_of(data, channel, prediction).log_likelihood);
    };
    if (std::ranges::any_of(tried, compares)) continue;
    const auto has_all = [&](const Prediction& prediction) {
      return std::ranges::all_of(std::span(prediction).subspan(channel.first, channel.count),
                                 [](double number) { return std::isfinite(number); });
    };
    const FitTest& test = tests[channel.test];
    const std::string& name =
        channel.column ? test.columns[*channel.column].name : test.values[channel.value].name;
    const std::string place =
        channel.column ? "trace/columns/" + name : fmt::format("values/{}", channel.value);
    problems.push_back(
        {"", fmt::format("/tests/{}/{}", channel.test, place),
         std::ranges::any_of(tried, has_all)
             ? "numbers too large to be compared with a run by their std"
             : fmt::format("{}, which none of {} runs of the prior has", name, points.size()),
         "numbers that runs of the campaign come near"});
  }
  return problems;
}

double distance_of(const FitMode& first, const FitMode& second) {
  const FitPoint apart = second.at - first.at;
  return std::sqrt(apart.dot(first.covariance.llt().solve(apart)));
}

} // namespace wingspread
