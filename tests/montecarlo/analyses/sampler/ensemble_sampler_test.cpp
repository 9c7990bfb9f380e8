#include "montecarlo/analyses/sampler/ensemble_sampler.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

using namespace wingspread;

namespace {

/// A normal law with correlation ½ between all coordinates, standard deviation k in coordinate k, mean k.
struct CorrelatedNormal {
  explicit CorrelatedNormal(Eigen::Index d) : mean(d), covariance(d, d) {
    for (Eigen::Index i = 0; i < d; ++i) {
      mean[i] = static_cast<double>(i);
      for (Eigen::Index j = 0; j < d; ++j)
        covariance(i, j) = (i == j ? 1.0 : 0.5) * static_cast<double>((i + 1) * (j + 1));
    }
    inverse = covariance.inverse();
  }
  [[nodiscard]] std::vector<double> operator()(std::span<const Eigen::VectorXd> points) const {
    std::vector<double> logs;
    for (const Eigen::VectorXd& x : points)
      logs.push_back(-0.5 * (x - mean).dot(inverse * (x - mean)));
    return logs;
  }
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance, inverse;
};

std::vector<double> coordinate(const Ensemble& ensemble, Eigen::Index i) {
  std::vector<double> values;
  for (const auto& chain : ensemble.chains)
    for (const Eigen::VectorXd& point : chain) values.push_back(point[i]);
  return values;
}

const auto nothing = [](const EnsembleState&) {};

} // namespace

TEST_CASE("a normal target: its moments, with and without independent moves") {
  for (const Eigen::Index d : {3, 8}) {
    const CorrelatedNormal target(d);
    const StudentMixture proposal({{0, target.mean, target.covariance}});
    long evaluations[2] = {};
    for (const double independent : {0.0, 0.5}) {
      if (d > 3 && independent == 0) continue; // takes too long for every day
      EnsembleOptions options{.walkers = 48, .ess = 1000};
      options.independent = independent;
      const Ensemble ensemble = run_ensemble(target, proposal, options, nothing);
      REQUIRE(ensemble.finished);
      CHECK(ensemble.state.r_hat <= 1.01);
      evaluations[independent > 0] = static_cast<long>(
          static_cast<double>(ensemble.state.evaluations) / ensemble.state.ess * 1000);
      for (Eigen::Index i = 0; i < d; ++i) {
        const Moments found = moments(coordinate(ensemble, i));
        const double std = std::sqrt(target.covariance(i, i));
        CHECK(std::abs(found.mean - target.mean[i]) < 4.5 * std / std::sqrt(1000.0));
        CHECK(found.std == Approx(std).epsilon(4.5 / std::sqrt(2000.0)));
      }
    }
    INFO(evaluations[0] << " and " << evaluations[1] << " evaluations for 1000 effective samples");
    if (d == 3) CHECK(evaluations[0] > 3 * evaluations[1]);
  }
}

TEST_CASE("two modes keep their weights, and a wrong proposal does no harm") {
  // ⅔ N(−4, 1) + ⅓ N(4, ½²); the proposal has the weights wrong and the widths too small.
  const auto target = [](std::span<const Eigen::VectorXd> points) {
    std::vector<double> logs;
    for (const Eigen::VectorXd& x : points)
      logs.push_back(std::log(2 * std::exp(-0.5 * std::pow(x[0] + 4, 2)) +
                              2 * std::exp(-2 * std::pow(x[0] - 4, 2))));
    return logs;
  };
  const auto at = [](double x) { return Eigen::VectorXd(Eigen::VectorXd::Constant(1, x)); };
  const StudentMixture proposal({{0, at(-4), Eigen::MatrixXd::Constant(1, 1, 0.5)},
                                 {1, at(4), Eigen::MatrixXd::Constant(1, 1, 0.2)}});
  const Ensemble ensemble = run_ensemble(target, proposal, {.walkers = 48, .ess = 4000}, nothing);
  REQUIRE(ensemble.finished);
  double left = 0;
  const std::vector<double> x = coordinate(ensemble, 0);
  for (const double each : x) left += each < 0;
  CHECK(left / static_cast<double>(x.size()) ==
        Approx(2.0 / 3).margin(4.5 * 0.47 / std::sqrt(4000.0)));
}

TEST_CASE("a target with a wall keeps its walkers inside, and a mixture is normalized") {
  const auto exponential = [](std::span<const Eigen::VectorXd> points) {
    std::vector<double> logs;
    for (const Eigen::VectorXd& x : points)
      logs.push_back(x[0] > 0 ? -x[0] : -std::numeric_limits<double>::infinity());
    return logs;
  };
  const StudentMixture proposal(
      {{0, Eigen::VectorXd::Constant(1, 1), Eigen::MatrixXd::Constant(1, 1, 1)}});
  const Ensemble ensemble =
      run_ensemble(exponential, proposal, {.walkers = 48, .ess = 4000}, nothing);
  REQUIRE(ensemble.finished);
  const Moments found = moments(coordinate(ensemble, 0));
  CHECK(found.min > 0);
  CHECK(found.mean == Approx(1).margin(4.5 / std::sqrt(4000.0)));
  CHECK(found.std == Approx(1).margin(4.5 * std::sqrt(2.0 / 4000)));
  // The density of a mixture of the same part twice is that of the part.
  const StudentMixture twice(
      {{0, Eigen::VectorXd::Constant(1, 1), Eigen::MatrixXd::Constant(1, 1, 1)},
       {0, Eigen::VectorXd::Constant(1, 1), Eigen::MatrixXd::Constant(1, 1, 1)}});
  const Eigen::VectorXd x = Eigen::VectorXd::Constant(1, 0.3);
  CHECK(twice.log_density(x) == Approx(proposal.log_density(x)));
}

TEST_CASE("draws of a mixture have its density, up to a constant, part by part") {
  constexpr int draws = 20000;
  RandomStream random(1, 0, stream_name("mixture"));
  const auto uniform = [&] { return open_uniform(random()); };
  /// The integral of f from a to b.
  const auto integral = [](double a, double b, const auto& f) {
    constexpr int cells = 5000;
    double sum = 0;
    for (int c = 0; c < cells; ++c) sum += f(a + (c + 0.5) * (b - a) / cells) * (b - a) / cells;
    return sum;
  };
  const auto check_share = [](long count, double share) {
    CHECK(static_cast<double>(count) / draws ==
          Approx(share).margin(4.5 * std::sqrt(share * (1 - share) / draws)));
  };
  // One coordinate: parts of their own weights and widths, by intervals.
  const auto at = [](double x) { return Eigen::VectorXd(Eigen::VectorXd::Constant(1, x)); };
  const auto wide = [](double std) {
    return Eigen::MatrixXd(Eigen::MatrixXd::Constant(1, 1, std * std));
  };
  const StudentMixture line({{std::log(0.2), at(-5), wide(0.5)},
                             {std::log(0.5), at(0), wide(1)},
                             {std::log(0.3), at(7), wide(0.1)}});
  const std::vector<double> edges{-60, -5.5, -5,  -4, -1.5, -0.5, 0, 0.5,
                                  1,   3,    6.8, 7,  7.05, 7.3,  60};
  std::vector<double> x;
  for (int k = 0; k < draws; ++k) x.push_back(line.draw(uniform)[0]);
  std::vector<double> shares;
  for (std::size_t i = 1; i < edges.size(); ++i)
    shares.push_back(integral(edges[i - 1], edges[i],
                              [&](double y) { return std::exp(line.log_density(at(y))); }));
  const double whole = std::accumulate(shares.begin(), shares.end(), 0.0);
  for (std::size_t i = 1; i < edges.size(); ++i) {
    CAPTURE(edges[i]);
    check_share(
        std::ranges::count_if(x, [&](double y) { return edges[i - 1] < y && y <= edges[i]; }),
        shares[i - 1] / whole);
  }
  // Four coordinates, by balls: the area of a sphere is 2π² r³.
  const Eigen::VectorXd origin = Eigen::VectorXd::Zero(4);
  const StudentMixture ball({{0, origin, Eigen::MatrixXd::Identity(4, 4)}});
  std::vector<double> radii;
  for (int k = 0; k < draws; ++k) radii.push_back(ball.draw(uniform).norm());
  const auto within = [&](double radius) {
    return integral(0, radius, [&](double r) {
      return r * r * r * std::exp(ball.log_density(Eigen::Vector4d{0, 0, r, 0}));
    });
  };
  for (const double radius : {0.8, 1.5, 2.0, 3.0, 5.0}) {
    CAPTURE(radius);
    check_share(std::ranges::count_if(radii, [&](double r) { return r < radius; }),
                within(radius) / within(60));
  }
}

TEST_CASE("too few evaluations: not finished") {
  const CorrelatedNormal target(3);
  const StudentMixture proposal({{0, target.mean, target.covariance}});
  const Ensemble ensemble = run_ensemble(
      target, proposal, {.walkers = 48, .ess = 1e6, .most_evaluations = 20000}, nothing);
  CHECK_FALSE(ensemble.finished);
  CHECK(ensemble.state.evaluations <= 20000);
}

TEST_CASE("a bent proposal makes short chains where a posterior bends by more than its thickness") {
  // x₀ ~ N(0, 1), x₁ ~ N(3 (x₀² − 1), 0.1²).
  const auto target = [](std::span<const Eigen::VectorXd> points) {
    std::vector<double> logs;
    for (const Eigen::VectorXd& x : points)
      logs.push_back(-0.5 * x[0] * x[0] - 50 * std::pow(x[1] - 3 * (x[0] * x[0] - 1), 2));
    return logs;
  };
  std::vector<Eigen::VectorXd> z, xi; // ξ₁ = (x₁ − 3 (x₀² − 1))/0.1
  for (const double a : {-1.0, 0.0, 1.0})
    for (const double b : {-1.0, 0.0, 1.0}) {
      z.push_back(Eigen::Vector2d{a, b});
      xi.push_back(Eigen::Vector2d{a, b - 30 * (a * a - 1)});
    }
  const Eigen::MatrixXd covariance = Eigen::Vector2d{1, 0.01}.asDiagonal();
  const Eigen::VectorXd center = Eigen::Vector2d::Zero();
  const StudentMixture bent({{0, center, covariance, PolynomialMap(z, xi, 2)}});
  const EnsembleOptions options{
      .walkers = 32, .ess = 4000, .most_evaluations = 100000, .independent = 0.8};
  const Ensemble ensemble = run_ensemble(target, bent, options, nothing);
  REQUIRE(ensemble.finished);
  CHECK(ensemble.state.evaluations < 12000);
  const Moments across = moments(coordinate(ensemble, 1));
  CHECK(across.mean == Approx(0).margin(4.5 * std::sqrt(18.0 / 4000)));
  CHECK(across.std == Approx(std::sqrt(18.01)).epsilon(0.15)); // kurtosis 15
  const StudentMixture straight({{0, center, covariance}});
  CHECK_FALSE(run_ensemble(target, straight, options, nothing).finished);
}

TEST_CASE("where the proposal is far too narrow, the default mixture moves on by its stretches") {
  const auto target = [](std::span<const Eigen::VectorXd> points) { // N(0, I)
    std::vector<double> logs;
    for (const Eigen::VectorXd& x : points) logs.push_back(-0.5 * x.squaredNorm());
    return logs;
  };
  const StudentMixture narrow(
      {{0, Eigen::Vector3d::Zero(), 1e-3 * Eigen::MatrixXd::Identity(3, 3)}});
  EnsembleOptions options{.walkers = 48, .ess = 1000, .most_evaluations = 300'000};
  const Ensemble mixed = run_ensemble(target, narrow, options, nothing);
  REQUIRE(mixed.finished);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Moments found = moments(coordinate(mixed, i));
    CHECK(std::abs(found.mean) < 4.5 / std::sqrt(1000.0));
    CHECK(found.std == Approx(1).epsilon(4.5 / std::sqrt(2000.0)));
  }
  options.independent = 1;
  CHECK_FALSE(run_ensemble(target, narrow, options, nothing).finished);
}

TEST_CASE("draws of a bent proposal have its density where the bend stretches too") {
  // ξ = z + z²/5 + z³/12: its slope grows from 0.84 to 1.9 within three standard deviations.
  std::vector<Eigen::VectorXd> z, xi;
  for (int k = -6; k <= 6; ++k) {
    const double at = k / 2.0;
    z.push_back(Eigen::VectorXd::Constant(1, at));
    xi.push_back(Eigen::VectorXd::Constant(1, at + at * at / 5 + at * at * at / 12));
  }
  const double center = 2, std = 0.5;
  const StudentMixture bent(
      {{0, Eigen::VectorXd::Constant(1, center), Eigen::MatrixXd::Constant(1, 1, std * std),
        PolynomialMap(z, xi, 3)}});
  constexpr int draws = 5000;
  RandomStream random(2, 0, stream_name("bent"));
  std::vector<double> x;
  for (int k = 0; k < draws; ++k)
    if (const Eigen::VectorXd y = bent.draw([&] { return open_uniform(random()); }); y.allFinite())
      x.push_back(y[0]);
  REQUIRE(std::ssize(x) > draws - 20);
  // The shares of intervals of half a standard deviation, by the rule of rectangles.
  std::vector<double> shares;
  constexpr int cells = 20;
  for (int k = -16; k < 16; ++k) {
    double sum = 0;
    for (int c = 0; c < cells; ++c) {
      const double y = center + std * (k + (c + 0.5) / cells) / 2;
      sum += std::exp(bent.log_density(Eigen::VectorXd::Constant(1, y)));
    }
    shares.push_back(sum);
  }
  const double whole = std::accumulate(shares.begin(), shares.end(), 0.0);
  for (int k = -16; k < 16; ++k) {
    const double share = shares[static_cast<std::size_t>(k + 16)] / whole;
    const auto count = std::ranges::count_if(
        x, [&](double y) { return center + std * k / 2 < y && y <= center + std * (k + 1) / 2; });
    CAPTURE(k);
    CHECK(static_cast<double>(count) / draws ==
          Approx(share).margin(4.5 * std::sqrt(share * (1 - share) / draws) + 1e-3));
  }
}
