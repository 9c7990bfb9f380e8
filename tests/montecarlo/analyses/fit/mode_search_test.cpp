#include "montecarlo/analyses/fit/mode_search.hpp"
#include "tests/montecarlo/analyses/fit/fit_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("derivatives of a latch time have the closed form's value to 1e-5") {
  const Campaign campaign = campaign_of(panel_campaign());
  const FitSpec spec = read_fit(parse_json(R"({ "tests": [ { "name": "timer",
      "values": [ { "output": "root.latch_time", "value": 2, "std": 0.01 } ,
                  { "parameter": "hinges.root.friction.scale", "value": 1, "std": 0.1 } ] } ],
    "fit": { "parameters": ["spring", "friction"] } })"),
                                "", ".", campaign);
  const ParameterSpace space(campaign, spec);
  TestRuns runs(spec.tests, spec.parameters, space, {.threads = 2}, never);
  FitPoint at(2);
  at << 0.5, -1;
  const Eigen::MatrixXd slopes = jacobian_of(runs, at);
  const double s = 1 + 0.05 * 0.5, f = 1 - 0.3, torque = 2 * s - 0.3 * f;
  const double t = panel_latch_time(s, f);
  CHECK(slopes(0, 0) == Approx(-0.5 * t / torque * 2 * 0.05)
                            .epsilon(1e-5)); // a run's error of 1e-12 s over a step of 1e-5
  CHECK(slopes(0, 1) == Approx(0.5 * t / torque * 0.3 * 0.3).epsilon(1e-5));
  CHECK(slopes(1, 0) == Approx(0).margin(1e-9));
  CHECK(slopes(1, 1) == Approx(0.3).epsilon(1e-9));
  CHECK(runs.runs() == 4);
}

TEST_CASE("starts: the prior's median, then points of a design") {
  const auto points = first_points(3, 9, 1);
  REQUIRE(points.size() == 9);
  CHECK(points[0] == FitPoint::Zero(3));
  CHECK(points == first_points(3, 9, 1));
  for (Eigen::Index i = 0; i < 3; ++i) {
    int above = 0;
    for (std::size_t k = 1; k < 9; ++k) above += points[k][i] > 0;
    CHECK(above == 4); // Sobol' points: half of them on either side
  }
}
