// What a fit says of parameters whose priors are correlated does not depend on their names.
#include "montecarlo/analyses/fit/fit_report.hpp"
#include "tests/montecarlo/analyses/fit/fit_support.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include <map>

using namespace wingspread;
using namespace wingspread::test;

namespace {

constexpr double rank_correlation = 0.95;

/// Spring and friction, correlated; the friction's scale is measured. @param friction its name
Campaign correlated(const std::string& friction) {
  Json json = panel_campaign(0.05, 0.1);
  json["dispersions"][1]["name"] = friction;
  json["correlations"] = {{{"between", {"spring", friction}}, {"spearman", rank_correlation}}};
  return campaign_of(json);
}

Json measured(const std::string& friction) {
  Json tests = parse_json(R"({ "tests": [ { "name": "torque", "values": [
      { "parameter": "hinges.root.friction.scale", "value": 1, "std": 0.01 } ] } ],
    "fit": { "parameters": ["spring"], "samples": 2000, "starts": 2 },
    "candidates": [ { "name": "again", "values": [ { "parameter": "hinges.root.friction.scale", "std": 0.01 } ] },
                    { "name": "spring", "values": [ { "parameter": "hinges.root.spring.scale", "std": 0.005 } ] } ] })");
  tests["fit"]["parameters"].push_back(friction);
  return tests;
}

} // namespace

TEST_CASE("shares left, directions and gains of correlated priors are those of the parameters, "
          "whatever their names",
          "[fit]") {
  // the normal scores have the correlation r; the measurement has a tenth of the friction's sd
  const double r = 2 * std::sin(M_PI / 6 * rank_correlation);
  const Eigen::Matrix2d prior{{1, r}, {r, 1}};
  Eigen::Matrix2d information = prior.inverse();
  information(1, 1) += 100;
  const Eigen::Matrix2d after = information.inverse();
  for (const std::string friction : {"friction", "zfriction"}) { // before and after "spring"
    const Campaign campaign = correlated(friction);
    const FitSpec spec = read_fit(measured(friction), "", ".", campaign);
    const FitResult result = fitted(campaign, spec);
    CAPTURE(friction);
    REQUIRE(result.parameters.size() == 2);
    for (const std::size_t k : {0, 1}) {
      const FittedParameter& each = result.parameters[k];
      const auto i = static_cast<Eigen::Index>(k);
      CHECK(each.name == (k == 0 ? "spring" : friction));
      CHECK(each.std_ratio() == Approx(std::sqrt(after(i, i))).epsilon(0.06));
      CHECK(each.score_std == Approx(std::sqrt(after(i, i))).epsilon(0.06));
    }
    const std::string text = fit_text(result, spec);
    CHECK(text.find("the prior decides") == std::string::npos); // 30 and 10 % are left
    CHECK(text.find("the tests do not see spring:") == std::string::npos);
    // least seen is the spring's part that friction does not explain
    REQUIRE(result.directions.size() == 2);
    const Eigen::VectorXd& weights = result.directions[0].weights;
    CHECK(result.directions[0].std_ratio == Approx(1).margin(0.05));
    CHECK(weights[1] / weights[0] == Approx(-r).epsilon(0.05));
    CHECK(result.directions[1].std_ratio == Approx(1 / std::sqrt(101.0)).epsilon(0.06));
    // candidates: by the same formula
    REQUIRE(result.candidates.size() == 2);
    for (const std::size_t c : {0, 1}) {
      Eigen::Matrix2d with = information;
      with(c == 0 ? 1 : 0, c == 0 ? 1 : 0) += 100;
      const Eigen::Matrix2d then = with.inverse();
      for (const std::size_t k : {0, 1}) {
        const auto i = static_cast<Eigen::Index>(k);
        CHECK(result.candidates[c].shrink[k] ==
              Approx(std::sqrt(then(i, i) / after(i, i))).epsilon(1e-3));
      }
      CHECK(result.candidates[c].information ==
            Approx(std::log(after.determinant() / then.determinant()) / 2).epsilon(1e-3));
    }
  }
}

// The measured scale lies four of the prior's sd off; what the copula makes of it moves the spring by r as many.
TEST_CASE("how far a parameter is from its prior counts in its own standard deviations", "[fit]") {
  const double r = 2 * std::sin(M_PI / 6 * rank_correlation);
  for (const std::string friction : {"friction", "zfriction"}) {
    const Campaign campaign = correlated(friction);
    Json tests = measured(friction);
    tests["tests"][0]["values"][0]["value"] = 1.45;
    const FitResult result = fitted(campaign, read_fit(tests, "", ".", campaign));
    const double z = 4.5 * 100 / 101;
    CAPTURE(friction);
    CHECK(result.parameters.at(1).prior_sigmas == Approx(z).epsilon(1e-3));
    CHECK(result.parameters.at(0).prior_sigmas == Approx(r * z).epsilon(1e-3));
  }
}

// Of held dispersions the widening concerns the parameter itself: both mirrored campaigns state the same.
TEST_CASE("what is held widens correlated parameters alike, whatever their names", "[fit]") {
  std::map<std::string, std::array<double, 2>> widened;
  for (const std::string friction : {"friction", "zfriction"}) {
    Json json = correlated(friction).resolved;
    json["dispersions"].push_back(
        parse_json(R"({ "name": "mass", "apply": "set", "to": ["bodies.panel.mass"],
      "distribution": { "type": "normal", "mean": 10, "std": 0.2 } })"));
    const Campaign campaign = campaign_of(json);
    Json tests = measured(friction);
    tests["tests"][0]["values"].push_back(
        {{"output", "root.latch_time"}, {"value", panel_latch_time(1, 1)}, {"std", 0.005}});
    tests.erase("candidates");
    const FitResult result = fitted(campaign, read_fit(tests, "", ".", campaign));
    widened[friction] = {result.parameters.at(0).widening, result.parameters.at(1).widening};
    CHECK(result.parameters[0].widening > 1.1);
  }
  for (const std::size_t k : {0, 1})
    CHECK(widened["friction"][k] == Approx(widened["zfriction"][k]).epsilon(0.05));
}
