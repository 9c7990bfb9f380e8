#include "montecarlo/analyses/sensitivity/lever_response.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <random>

using namespace wingspread;

namespace {

/// y = u + r + 0.1 u² − 0.1 u r, with u = 2 x and r another draw; t moves x by t. The linear fit is u + r.
LeverRuns quadratic_runs() {
  LeverRuns runs;
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 500; ++i) {
    const double x = 0.3 * normal(random), r = 0.5 * normal(random), u = 2 * x;
    runs.u.push_back(u), runs.r.push_back(r), runs.d.push_back(2);
    runs.residual.push_back(0.1 * u * u - 0.1 * u * r);
    runs.y.push_back(u + r + runs.residual.back());
    runs.group.push_back(i % 16);
  }
  runs.fitted = runs.y.size();
  runs.group_slope.assign(16, 1);
  return runs;
}

} // namespace

TEST_CASE("a quadratic output is followed exactly", "[needed]") {
  const LeverRuns runs = quadratic_runs();
  const LeverResponse response(runs);
  const auto beyond = [&](double t) {
    long count = 0;
    for (std::size_t i = 0; i < runs.y.size(); ++i) {
      const double u = runs.u[i] + 2 * t, r = runs.r[i];
      count += u + r + 0.1 * u * u - 0.1 * u * r > 1.5 ? 1 : 0;
    }
    return count;
  };
  REQUIRE(beyond(0) > 20);
  for (const long most : {20L, 10L, 5L}) {
    const auto t = response.change(1.5, most, -0.6);
    REQUIRE(t);
    CHECK(beyond(*t * (1 + 1e-6)) <= most);
    CHECK(beyond(*t * (1 - 1e-6)) > most);
  }
  CHECK(response.change(1.5, beyond(0), -0.6) == 0.0);
  CHECK_FALSE(response.change(1.5, 5, -0.01));
  const auto [mean, bounds] = response.fall(-0.1, 1.5, 0.95);
  CHECK(mean > 0);
  CHECK(*bounds.lower == Approx(mean).epsilon(1e-6)); // no residual is left
}

// Counts of whole numbers: many runs lie at the limit, and these keep it.
TEST_CASE("runs at the limit itself are not beyond it", "[needed]") {
  LeverRuns runs;
  std::mt19937_64 random(2);
  for (int i = 0; i < 500; ++i) {
    const double u = static_cast<double>(random() % 3) - 1, r = static_cast<double>(random() % 4);
    runs.u.push_back(u), runs.r.push_back(r), runs.d.push_back(1), runs.residual.push_back(0);
    runs.y.push_back(u + r);
    runs.group.push_back(i % 16);
  }
  runs.fitted = runs.y.size();
  runs.group_slope.assign(16, 1);
  const LeverResponse response(runs);
  for (const double limit : {0., 1., 2., 3.}) {
    const long beyond = std::ranges::count_if(runs.y, [&](double y) { return y > limit; });
    CAPTURE(limit, beyond);
    CHECK(response.change(limit, beyond, -0.6) == 0.0);
    CHECK(response.change(limit, beyond - 1, -10) != 0.0);
  }
}
