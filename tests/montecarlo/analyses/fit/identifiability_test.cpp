#include "montecarlo/analyses/fit/identifiability.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace wingspread;

TEST_CASE("directions of a covariance, and their sentences") {
  // Along (1, 1)/√2 the prior's variance is left, along (1, −1)/√2 a hundredth of a hundredth.
  const double unseen = 1, seen = 1e-4;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(3, 3);
  covariance(0, 0) = covariance(1, 1) = (unseen + seen) / 2;
  covariance(0, 1) = covariance(1, 0) = (unseen - seen) / 2;
  covariance(2, 2) = 0.25;
  const Eigen::MatrixXd prior = Eigen::MatrixXd::Identity(3, 3);
  const std::vector<std::string> names{"spring", "friction", "damper"};
  const auto directions = directions_of(covariance, prior);
  REQUIRE(directions.size() == 3);
  CHECK(directions[0].std_ratio == Approx(1));
  CHECK(directions[1].std_ratio == Approx(0.5));
  CHECK(directions[2].std_ratio == Approx(0.01));
  CHECK(directions[0].weights[0] == Approx(std::sqrt(0.5)));
  CHECK(describe(directions[0], names, covariance, prior) ==
        "the tests tell spring and friction only by their difference: sd of the sum 1.00 of the "
        "prior's, of the difference 0.01");
  CHECK(describe({Eigen::Vector3d(0, 0, 1), 0.97}, names, covariance, prior) ==
        "the tests do not see damper: its sd stays 0.97 of the prior's");
  CHECK(describe({Eigen::Vector3d(0.6, -0.6, 0.53), 0.97}, names, covariance, prior) ==
        "the tests do not see 0.60 spring − 0.60 friction + 0.53 damper: its sd stays 0.97 of the "
        "prior's");
}

TEST_CASE("of two parameters that no test sees, neither sum nor difference is told") {
  const Eigen::MatrixXd covariance{{0.98, 0.01}, {0.01, 0.98}};
  const Eigen::MatrixXd prior = Eigen::MatrixXd::Identity(2, 2);
  const auto directions = directions_of(covariance, prior);
  for (const FitDirection& each : directions) {
    const std::string text = describe(each, {"spring", "friction"}, covariance, prior);
    CAPTURE(text);
    CHECK(text.starts_with("the tests do not see "));
    CHECK(text.find("0.71 spring") != std::string::npos);
    CHECK(text.find("0.71 friction") != std::string::npos);
  }
}
