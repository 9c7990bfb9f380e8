#include "tests/montecarlo/analyses/fit/fit_support.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include <utility>

using namespace wingspread;
using namespace wingspread::test;

// A channel's readings share one offset: their covariance is σ² I + s² 1 1ᵀ, inverted here as it stands. The slopes are
// differences of the closed form.
TEST_CASE("what a candidate with an offset is worth is by the covariance of its readings") {
  const Folder folder;
  folder.write("t1.csv", panel_trace(1.02, 1.1, 0, 0.005, 1));
  const Campaign campaign = campaign_of(panel_campaign());
  Json tests = parse_json(one_way);
  constexpr double std = 0.005;
  const double offsets[] = {0, 0.001, 0.02, 5};
  for (const double offset : offsets) {
    Json candidate = parse_json(R"({ "set": { "hinges.root.initial_rate": 0.8 },
      "trace": { "times": { "to": 1.6, "step": "20 ms" }, "columns": { "root.angle": { "std": 0.005 } } } })");
    candidate["name"] = "offset " + std::to_string(offset);
    candidate["trace"]["columns"]["root.angle"]["offset_std"] = offset;
    tests["candidates"].push_back(candidate);
  }
  const FitResult found = fitted(campaign, read_fit(tests, "", folder.path(), campaign));
  REQUIRE(found.candidates.size() == 4);
  constexpr Eigen::Index readings = 81;
  const double s = found.parameters[0].mode, f = found.parameters[1].mode, h = 1e-5;
  Eigen::MatrixXd slopes(readings, 2); // in u: the priors' standard deviations are 0.05 and 0.3
  for (Eigen::Index k = 0; k < readings; ++k) {
    const double t = 0.02 * static_cast<double>(k);
    slopes(k, 0) = 0.05 * (panel_angle(t, s + h, f, 0.8) - panel_angle(t, s - h, f, 0.8)) / (2 * h);
    slopes(k, 1) = 0.3 * (panel_angle(t, s, f + h, 0.8) - panel_angle(t, s, f - h, 0.8)) / (2 * h);
  }
  Eigen::MatrixXd first(readings, 2); // slopes of the test that was made
  for (Eigen::Index k = 0; k < readings; ++k) {
    const double t = 0.02 * static_cast<double>(k);
    first(k, 0) = 0.05 * (panel_angle(t, s + h, f) - panel_angle(t, s - h, f)) / (2 * h);
    first(k, 1) = 0.3 * (panel_angle(t, s, f + h) - panel_angle(t, s, f - h)) / (2 * h);
  }
  const Eigen::Matrix2d before =
      (Eigen::Matrix2d::Identity() + first.transpose() * first / (std * std)).inverse();
  for (std::size_t c = 0; c < 4; ++c) {
    CAPTURE(offsets[c]);
    const Eigen::MatrixXd noise =
        std * std * Eigen::MatrixXd::Identity(readings, readings) +
        offsets[c] * offsets[c] * Eigen::MatrixXd::Ones(readings, readings);
    const Eigen::Matrix2d after =
        (before.inverse() + slopes.transpose() * noise.inverse() * slopes).inverse();
    for (Eigen::Index i = 0; i < 2; ++i)
      CHECK(found.candidates[c].shrink[static_cast<std::size_t>(i)] ==
            Approx(std::sqrt(after(i, i) / before(i, i))).epsilon(0.01));
    if (c > 0) CHECK(found.candidates[c].information < found.candidates[c - 1].information);
  }
}
