#include "montecarlo/engine/runs/runner.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/campaign/wanted_correlations.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <regex>

using namespace wingspread;

namespace {

/// The small campaign with this list of correlations: of "spring", "mass.inner" and "mass.outer".
Json with_correlations(const std::string& text) {
  Json campaign = test::small_campaign();
  campaign["correlations"] = parse_json(text);
  return campaign;
}

Campaign read_correlated(const std::string& text) {
  return read_campaign(with_correlations(text).dump(), "");
}

std::string correlation_problems(const std::string& text) {
  return test::message_of([&] { return read_correlated(text); });
}

Json pair(const char* first, const char* second, double spearman) {
  return {{"between", {first, second}}, {"spearman", spearman}};
}

std::string list(const std::vector<Json>& correlations) {
  Json json = Json::array();
  for (const Json& correlation : correlations) json.push_back(correlation);
  return json.dump();
}

/// Three coefficients of the three dispersions.
std::string triple(double a, double b, double c) {
  return list({pair("spring", "mass.inner", a), pair("spring", "mass.outer", b),
               pair("mass.inner", "mass.outer", c)});
}

} // namespace

TEST_CASE("Correlations are read by the names of the dispersions", "[correlations]") {
  const Campaign campaign = read_correlated(list({pair("mass.outer", "spring", 0.6)}));
  REQUIRE(campaign.wanted_correlations.size() == 1);
  const auto [first, second, spearman, covariance] = campaign.wanted_correlations[0];
  CHECK((first == 0 && second == 2 && spearman == 0.6 && !covariance));
  CHECK(campaign.resolved["correlations"].dump() ==
        R"([{"between":["spring","mass.outer"],"spearman":0.6}])");
  CHECK(read_campaign(campaign.resolved.dump(), "").resolved == campaign.resolved);
  CHECK_FALSE(read_correlated("[]").resolved.contains("correlations"));
  CHECK(campaign_hash(read_correlated("[]").resolved) ==
        campaign_hash(read_campaign(test::small_campaign().dump(), "").resolved));
}

TEST_CASE("Each fault of the correlations is told", "[correlations]") {
  const Json sound = pair("spring", "mass.inner", 0.5);
  const std::string pair_expected = ", expected an array of two dispersions' names";
  const std::vector<std::pair<std::string, std::string>> cases{
      {"{}", "/correlations: found an object, expected an array of correlations"},
      {"[3]", "/correlations/0: found 3, expected a correlation: an object"},
      {R"([{"spearman": 0.5}])", "/correlations/0/between: found nothing" + pair_expected},
      {R"([{"between": "spring", "spearman": 0.5}])",
       "/correlations/0/between: found string \"spring\"" + pair_expected},
      {R"([{"between": ["spring"], "spearman": 0.5}])",
       "/correlations/0/between: found an array of 1" + pair_expected},
      {R"([{"between": ["spring", 2], "spearman": 0.5}])",
       "/correlations/0/between/1: found 2, expected a string, the name of a dispersion"},
      {list({pair("spring", "mass", 0.5)}),
       "/correlations/0/between/1: found string \"mass\", expected the name of a dispersion (did "
       "you mean \"mass.inner\"?)"},
      {list({pair("spring", "spring", 0.5)}),
       "/correlations/0/between: found string \"spring\" twice, expected two dispersions"},
      {list({sound, pair("mass.inner", "spring", 0.5)}),
       "/correlations/1/between: found a pair that is named before, expected each pair once"},
      {R"([{"between": ["spring", "mass.inner"]}])",
       "/correlations/0/spearman: found nothing, expected a number, > -1 and < 1"},
      {list({pair("spring", "mass.inner", 1)}),
       "/correlations/0/spearman: found 1.0, expected a number, > -1 and < 1"},
      {list({pair("spring", "mass.inner", -1.5)}),
       "/correlations/0/spearman: found -1.5, expected a number, > -1 and < 1"},
      {R"([{"between": ["spring", "mass.inner"], "spearman": 0.5, "pearson": 0.5}])",
       "/correlations/0/pearson: found the unknown key \"pearson\", expected \"between\", "
       "\"covariance\" or \"spearman\" (did you mean \"spearman\"?)"}};
  for (const auto& [text, message] : cases)
    CHECK(test::facts_of(correlation_problems(text)) == test::facts_of(message));
}

TEST_CASE("Names are not looked up in dispersions that have problems of their own",
          "[correlations]") {
  Json campaign = with_correlations(list({pair("spring", "no", 0.5)}));
  campaign["dispersions"][0]["apply"] = "times";
  const std::string own =
      "/dispersions/0/apply: found string \"times\", expected \"set\", \"scale\" or \"add\"";
  CHECK(test::message_of([&] { return read_campaign(campaign.dump(), ""); }) == own);
  campaign["correlations"] =
      parse_json(R"([{"between": ["spring", "mass.inner"], "covariance": 0.001}])");
  CHECK(test::message_of([&] { return read_campaign(campaign.dump(), ""); }) == own);
}

// The nearest matrix by numpy 1.24 (20,000 projections), its smallest eigenvalue 3e-4, as
// Spearman's coefficients.
TEST_CASE("Impossible correlations are refused, and the nearest possible ones named",
          "[correlations]") {
  CHECK(
      correlation_problems(triple(0.9, 0.9, -0.9)) ==
      "/correlations: found coefficients that cannot hold together (the smallest eigenvalue of "
      "their matrix is -0.82), expected a positive definite matrix; the nearest has \"spring\" and "
      "\"mass.inner\" 0.4824, \"spring\" and \"mass.outer\" 0.4824, \"mass.inner\" and "
      "\"mass.outer\" -0.4824");
  CHECK(correlation_problems(triple(0.9, 0.9, 0.9)).empty());
  CHECK_THAT(correlation_problems(
                 list({pair("spring", "mass.inner", 0.99), pair("spring", "mass.outer", 0.99)})),
             Catch::Contains("\"mass.inner\" and \"mass.outer\" 0.")); // one that was not named
}

// 1 − 2 · 0.25 = ½ is the cosine of the sum of two angles whose cosine is √¾: a matrix on the edge.
TEST_CASE("Correlations on the very edge are refused, in whatever order they are taken",
          "[correlations]") {
  const double r = std::sqrt(0.75), half = 6 / std::acos(-1.) * std::asin(0.25),
               high = 6 / std::acos(-1.) * std::asin(r / 2);
  for (const auto& given :
       {std::array{half, high, high}, std::array{high, half, high}, std::array{high, high, half}})
    CHECK_THAT(correlation_problems(triple(given[0], given[1], given[2])),
               Catch::StartsWith("/correlations: found coefficients that cannot hold together"));
}

TEST_CASE("The coefficients that a refusal names are accepted", "[correlations]") {
  const std::regex number(R"( (-?[0-9]\.[0-9]{4}))");
  for (const auto& given : {std::array{0.9, 0.9, -0.9}, std::array{0.99, -0.99, 0.99},
                            std::array{-0.6, -0.6, -0.6}, std::array{0.5, 0.5, -0.52}}) {
    const std::string message = correlation_problems(triple(given[0], given[1], given[2]));
    std::vector<double> named;
    for (std::sregex_iterator at(message.begin(), message.end(), number), end; at != end; ++at)
      named.push_back(std::stod((*at)[1]));
    CAPTURE(message);
    REQUIRE(named.size() == 3);
    CHECK(correlation_problems(triple(named[0], named[1], named[2])).empty());
    for (std::size_t i = 0; i < 3; ++i) CHECK(std::abs(named[i] - given[i]) < 0.7);
  }
}

TEST_CASE("Correlations couple the draws, and leave those of the first as they were",
          "[correlations]") {
  const Campaign coupled = read_correlated(list({pair("spring", "mass.outer", 0.9)}));
  const Campaign loose = read_correlated("[]");
  const RunPlan coupled_plan(coupled), loose_plan(loose);
  std::vector<double> with(3), without(3);
  int same_side = 0;
  for (long k = 0; k < 1000; ++k) {
    coupled_plan.draw(k, with);
    loose_plan.draw(k, without);
    CHECK((with[1] == without[1] && with[2] == without[2])); // mass.inner; mass.outer before spring
    same_side += (with[0] > 1) == (with[2] > 8) ? 1 : 0;
  }
  // Of normal variables of correlation r the medians agree in ½ + asin(r)/π.
  const double share = 0.5 + std::asin(2 * std::sin(std::acos(-1.) * 0.9 / 6)) / std::acos(-1.);
  CHECK(same_side / 1000.0 == Approx(share).margin(5 * std::sqrt(share * (1 - share) / 1000)));
}

TEST_CASE("A covariance of two normal laws gives their coefficient", "[correlations]") {
  Json document = with_correlations("[]");
  for (const std::size_t k : {0U, 1U})
    document["dispersions"][k]["distribution"] = {
        {"type", "normal"}, {"mean", 1}, {"std", k == 0 ? 0.02 : 0.05}};
  const auto read = [&](const char* rest) {
    document["correlations"] =
        parse_json(fmt::format(R"([{{"between": ["spring", "mass.outer"], {}}}])", rest));
    return read_campaign(document.dump(), "");
  };
  const Campaign campaign = read(R"("covariance": -0.0009)"); // r = −0.9
  CHECK(campaign.wanted_correlations[0].spearman ==
        Approx(6 / std::numbers::pi * std::asin(-0.45)).epsilon(1e-12));
  CHECK(campaign.resolved["correlations"].dump() ==
        R"([{"between":["spring","mass.outer"],"covariance":-0.0009}])");
  CHECK(read_campaign(campaign.resolved.dump(), "").resolved == campaign.resolved);
  CHECK(read(R"("covariance": -0.0009, "spearman": -0.89)").wanted_correlations[0].spearman ==
        campaign.wanted_correlations[0].spearman);
  const auto problem = [&](const char* rest) {
    return test::message_of([&] { return read(rest); });
  };
  CHECK_THAT(problem(R"("covariance": -0.0009, "spearman": -0.8)"),
             Catch::Contains("/correlations/0/spearman: found -0.8, expected -0.8915"));
  CHECK_THAT(problem(R"("covariance": 0.0011)"),
             Catch::Contains("/covariance: found 0.0011, expected a magnitude below 0.001"));
  document["dispersions"][0]["distribution"] = {
      {"type", "uniform"}, {"lower", 0.9}, {"upper", 1.1}};
  CHECK_THAT(problem(R"("covariance": 0.0001)"), Catch::Contains("two normal laws"));
}

TEST_CASE("a coefficient beside a covariance is a rounded one, and not further off on either side",
          "[correlations]") {
  Json document = with_correlations("[]");
  for (const std::size_t k : {0U, 1U})
    document["dispersions"][k]["distribution"] = {{"type", "normal"}, {"mean", 1}, {"std", 0.1}};
  for (const double r : {-0.8, -0.1, 0.0, 0.3, 0.9})
    for (const double off : {-0.1, -0.011, -0.009, 0.009, 0.011, 0.05}) {
      const double spearman = 6 / std::numbers::pi * std::asin(r / 2);
      document["correlations"] = {{{"between", {"spring", "mass.outer"}},
                                   {"covariance", 0.01 * r},
                                   {"spearman", spearman + off}}};
      CAPTURE(r, off);
      const std::string told = test::message_of([&] { return read_campaign(document.dump(), ""); });
      CHECK(told.empty() == (std::abs(off) < 0.01));
      if (!told.empty()) CHECK_THAT(told, Catch::Contains("/correlations/0/spearman: found "));
    }
}
