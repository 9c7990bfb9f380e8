#include "distributions/random_stream.hpp"
#include "montecarlo/analyses/fit/likelihood.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <optional>

using namespace wingspread;

namespace {

FitData data_with(const Channel& channel) {
  FitData data{{1, 2, 4, 3}, {channel}};
  data.channels[0].count = 4;
  if (data.channels[0].effective == 0) data.channels[0].effective = 4;
  return data;
}

const Prediction first{1.1, 1.7, 3.9, 3.3}, second{0.6, 2.4, 4.3, 2.9};

double difference(const FitData& data) {
  return fit_of(data, data.channels[0], first).log_likelihood -
         fit_of(data, data.channels[0], second).log_likelihood;
}

double normal() {
  static RandomStream random(4, 0, stream_name("noise"));
  return inverse(Normal{}, tails_of_uniform(open_uniform(random())));
}

} // namespace

TEST_CASE("independent noise, and an offset that is integrated out") {
  for (const double s : {0.0, 0.7}) {
    const FitData data = data_with({.std = 0.4, .offset_std = s});
    const Eigen::Matrix4d covariance =
        Eigen::Matrix4d::Identity() * 0.16 + Eigen::Matrix4d::Constant(s * s);
    const auto log_density = [&](const Prediction& prediction) {
      Eigen::Vector4d r;
      for (int i = 0; i < 4; ++i)
        r[i] = data.measured[static_cast<std::size_t>(i)] - prediction[static_cast<std::size_t>(i)];
      return -0.5 * r.dot(covariance.inverse() * r);
    };
    CHECK(difference(data) == Approx(log_density(first) - log_density(second)).epsilon(1e-12));
    const FitPoint u = FitPoint::Constant(2, 0.3);
    const std::vector<double> squares{1};
    for (const Prediction& prediction : {first, second})
      CHECK(-0.5 * least_squares(data, squares, u, prediction).squaredNorm() ==
            Approx(log_posterior(data, u, prediction)).epsilon(1e-12));
  }
}

TEST_CASE("unknown noise is integrated out with the prior 1/σ") {
  const FitData data = data_with({});
  const auto log_integral = [&](const Prediction& prediction) { // ∫ σ^{−n−1} exp(−S/2σ²) dσ
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < 4; ++i) squares += std::pow(data.measured[i] - prediction[i], 2);
    for (int k = 1; k < 400000; ++k) {
      const double log_sigma = -8 + 16e-5 * 0.25 * k; // d log σ = dσ/σ
      sum += std::exp(-4 * log_sigma - squares / 2 * std::exp(-2 * log_sigma));
    }
    return std::log(sum);
  };
  CHECK(difference(data) == Approx(log_integral(first) - log_integral(second)).epsilon(1e-6));
}

TEST_CASE("correlated samples count as their effective number, of known noise and of unknown") {
  for (const std::optional<double> std : {std::optional(0.4), std::optional<double>()}) {
    const double whole = difference(data_with({.std = std, .effective = 4}));
    CHECK(difference(data_with({.std = std, .effective = 1})) == Approx(whole / 4).epsilon(1e-12));
  }
}

TEST_CASE("a missing number rules a point out, and repels the search") {
  const FitData data = data_with({.std = 0.4});
  Prediction missing = first;
  missing[2] = std::numeric_limits<double>::quiet_NaN();
  CHECK(fit_of(data, data.channels[0], missing).log_likelihood ==
        -std::numeric_limits<double>::infinity());
  const std::vector<double> squares{1};
  CHECK(least_squares(data, squares, FitPoint::Zero(1), missing)[2] == 1e3);
}

TEST_CASE("numbers far from the rest are found, and not where the model is wrong") {
  std::vector<double> residuals(40);
  for (std::size_t i = 0; i < residuals.size(); ++i)
    residuals[i] = 0.1 * std::sin(static_cast<double>(17 * i + 1)); // median size 0.07
  CHECK(outliers_of(residuals, 0.1).empty());
  CHECK(outliers_of(residuals, std::nullopt).empty());
  residuals[7] = -3, residuals[30] = 5;
  CHECK(outliers_of(residuals, 0.1) == std::vector<std::size_t>{30, 7});
  CHECK(outliers_of(residuals, std::nullopt) == std::vector<std::size_t>{30, 7});
  CHECK(outliers_of(residuals, 1.0).empty()); // within 6 σ
  residuals[11] = 4;
  CHECK(outliers_of(residuals, 0.1).empty());                              // 3 of 40: too many
  CHECK(outliers_of(std::vector<double>{0.1, -0.1, 0.1, 9}, 0.1).empty()); // too few to tell
}

TEST_CASE("the autocorrelation of residuals tempers the likelihood") {
  std::vector<double> white, red;
  double x = normal();
  for (int k = 0; k < 20000; ++k) {
    white.push_back(normal());
    red.push_back(x);
    x = 0.8 * x + 0.6 * normal();
  }
  CHECK(autocorrelation_time(white) == Approx(1).margin(0.05));
  CHECK(autocorrelation_time(red) == Approx(9).epsilon(0.15)); // (1 + 0.8)/(1 − 0.8)
  CHECK(autocorrelation_time(std::vector<double>(10, 3)) == 1);
  int counted_less = 0; // short traces of independent residuals
  for (std::size_t k = 0; k < 100; ++k)
    counted_less += autocorrelation_time(std::span(white).subspan(100 * k, 100)) > 1.01;
  CHECK(counted_less <= 8); // beyond two standard errors: 2.3 % of them
  std::vector<FitTest> tests(1);
  FitData data{red, {{.count = red.size(), .std = 1, .effective = 20000}}};
  const Prediction zeros(red.size(), 0);
  const double before = fit_of(data, data.channels[0], zeros).log_likelihood;
  temper(tests, zeros, data);
  CHECK(data.channels[0].effective == Approx(20000 / autocorrelation_time(red)));
  CHECK(fit_of(data, data.channels[0], zeros).log_likelihood ==
        Approx(before / autocorrelation_time(red)));
  tests[0].correlated = false;
  data.channels[0].effective = 20000;
  temper(tests, zeros, data);
  CHECK(data.channels[0].effective == 20000);
}
