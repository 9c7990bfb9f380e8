#include "distributions/copula.hpp"
#include "montecarlo/analyses/fit/fit_campaign.hpp"
#include "montecarlo/analyses/fit/fit_report.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "tests/montecarlo/analyses/fit/fit_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

namespace {

constexpr double shared_std = 0.05, own_std = 0.3, noise = 0.1;

/// The panel whose friction each unit has of its own, correlated with the spring that all share. Their names decide which
/// of them a campaign draws first.
Json correlated_campaign(const char* shared, const char* own, double spearman) {
  Json json = panel_campaign(shared_std, own_std);
  json["dispersions"][0]["name"] = shared;
  json["dispersions"][1]["name"] = own;
  json["correlations"] = {{{"between", {own, shared}}, {"spearman", spearman}}};
  return json;
}

/// Tests that each measure the friction of their unit.
Json friction_tests(const char* shared, const char* own, const std::vector<double>& measured) {
  Json tests{{"tests", Json::array()},
             {"fit", {{"parameters", {shared, own}}, {"samples", 2000}, {"starts", 2}}}};
  for (std::size_t t = 0; t < measured.size(); ++t)
    tests["tests"].push_back(
        {{"name", "unit " + std::to_string(t)},
         {"own", {own}},
         {"values",
          {{{"parameter", "hinges.root.friction.scale"}, {"value", measured[t]}, {"std", noise}},
           {{"output", "root.latch_time"}, {"value", 2}, {"std", 1e3}}}}});
  return tests;
}

} // namespace

// Everything is normal and linear, so Bayes' rule has a closed form.
TEST_CASE("units teach what is common through a correlation, whatever the names are",
          "[fit][correlations]") {
  const double spearman = GENERATE(0.8, -0.6);
  const auto [shared, own] =
      GENERATE(table<const char*, const char*>({{"a_common", "z_own"}, {"z_common", "a_own"}}));
  CAPTURE(spearman, shared);
  const Folder folder;
  const Campaign campaign = campaign_of(correlated_campaign(shared, own, spearman));
  const std::vector<double> measured{1.5, 1.4, 1.6};
  const FitResult result = fitted(
      campaign, read_fit(friction_tests(shared, own, measured), "", folder.path(), campaign));
  REQUIRE(result.finished);
  REQUIRE(result.posterior.names == std::vector<std::string>{shared, own});

  const double r = normal_correlation(spearman), slope = r * own_std / shared_std;
  const auto n = static_cast<Eigen::Index>(measured.size());
  Eigen::MatrixXd of_data = Eigen::MatrixXd::Constant(n, n, r * r * own_std * own_std);
  of_data.diagonal().setConstant(own_std * own_std + noise * noise);
  const Eigen::VectorXd beside = Eigen::VectorXd::Constant(n, r * own_std * shared_std);
  const Eigen::VectorXd gain = of_data.ldlt().solve(beside);
  const Eigen::VectorXd off = Eigen::Map<const Eigen::VectorXd>(measured.data(), n).array() - 1.0;
  const double mean = 1 + gain.dot(off), variance = shared_std * shared_std - gain.dot(beside);
  const FittedParameter& common = result.parameters.at(0);
  const double error = std::sqrt(variance / 2000);
  CHECK(std::abs(common.mean - mean) < 4 * error);
  CHECK(common.std == Approx(std::sqrt(variance)).epsilon(0.08));

  // a new unit
  std::vector<double> commons, owns;
  for (const std::vector<double>& row : result.posterior.rows)
    commons.push_back(row.at(0)), owns.push_back(row.at(1));
  const double new_variance = own_std * own_std * (1 - r * r) + slope * slope * variance;
  const Moments drawn = moments(owns);
  CHECK(std::abs(drawn.mean - (1 + slope * (mean - 1))) < 4 * std::sqrt(new_variance / 2000));
  CHECK(drawn.std == Approx(std::sqrt(new_variance)).epsilon(0.08));
  CHECK(pearson(commons, owns) ==
        Approx(slope * std::sqrt(variance / new_variance)).margin(4 / std::sqrt(2000.0)));

  // the written campaign draws the pair
  folder.write(posterior_file, posterior_csv(result));
  const Campaign after =
      read_campaign(predicting_campaign(campaign, result.posterior.columns).dump(), folder.path());
  CHECK(after.dispersions.size() == 2);
  CHECK(after.dispersions[0].rows == after.dispersions[1].rows);
  CHECK(after.wanted_correlations.empty());
}

TEST_CASE("a unit's own parameter without a correlation stays a dispersion",
          "[fit][correlations]") {
  const Folder folder;
  Json json = correlated_campaign("common", "own", 0.8);
  json.erase("correlations");
  const Campaign campaign = campaign_of(json);
  const FitResult result = fitted(
      campaign, read_fit(friction_tests("common", "own", {1.5, 1.4}), "", folder.path(), campaign));
  CHECK(result.posterior.names == std::vector<std::string>{"common"});
}

TEST_CASE("what all tests share has one value in all of them", "[fit][correlations]") {
  const auto [shared, own] =
      GENERATE(table<const char*, const char*>({{"a_common", "z_own"}, {"z_common", "a_own"}}));
  const Folder folder;
  const Campaign campaign = campaign_of(correlated_campaign(shared, own, 0.7));
  const FitSpec spec =
      read_fit(friction_tests(shared, own, {1.5, 1.4}), "", folder.path(), campaign);
  const ParameterSpace space(campaign, spec);
  CHECK(space.dependent() == std::vector<std::size_t>{1});
  FitPoint at(3);
  at << 0.4, -1.2, 1.7;
  std::vector<Tails> u(2);
  for (const std::size_t t : {0u, 1u}) {
    space.place(t, at, u);
    CHECK(u[0].below == Approx(unit_point(0.4).below));
    const double r = normal_correlation(0.7),
                 z = r * 0.4 + std::sqrt(1 - r * r) * at[1 + static_cast<Eigen::Index>(t)];
    CHECK(u[1].below == Approx(unit_point(z).below));
  }
}
