#include "montecarlo/engine/runs/sampled_motion.hpp"
#include "tests/montecarlo/analyses/fit/fit_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("a motion between its samples has the closed form's angle and rate") {
  const Scene scene = campaign_of(panel_campaign()).scene;
  SampledMotion motion(scene, {1, 2}); // root.angle, root.rate
  Deployment deployment;
  Integration how;
  how.rtol = 1e-10, how.atol = 1e-12;
  REQUIRE(motion.run(deployment, scene, how, 2, 0.02));
  for (double t = 0.001; t < 1.9; t += 0.0137) {
    CHECK(motion.at(0, t) == Approx(panel_angle(t, 1, 1)).margin(1e-8));
    // while the rate is below its regularization, 1e-6 rad/s, friction is less: some 1e-7 rad/s in all
    CHECK(motion.at(1, t) == Approx(-(2 - 0.3) / panel_inertia * t).margin(3e-7));
  }
  CHECK(motion.at(0, -1) == motion.at(0, 0)); // before the release
}

TEST_CASE("the grid is as coarse as the recording allows") {
  const auto every = [](double step, int count) {
    std::vector<double> times;
    for (int k = 0; k < count; ++k) times.push_back(step * k);
    return times;
  };
  CHECK(grid_interval(every(0.001, 8001)) == 0.01);
  CHECK(grid_interval(every(0.015, 1001)) == Approx(0.015));
  CHECK(grid_interval(every(0.1, 601)) == 0.02);
  CHECK(grid_interval(every(0.01, 51)) == Approx(0.005)); // a short one: 100 intervals
}
