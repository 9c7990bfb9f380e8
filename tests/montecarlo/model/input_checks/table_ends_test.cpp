// Draws beyond the ends of the tables that they act through.
#include "distributions/prepared_distribution.hpp"
#include "montecarlo/model/input_checks/dispersion_checks.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// The share of the draws that a warning finds beyond a table, %; 0 without one.
double share_told(double mean, double std, double from, double to) {
  Json json = quick_campaign(2);
  json["dispersions"] =
      parse_json(R"([{ "name": "temperature", "distribution": { "type": "normal" },
    "through": [{ "apply": "scale", "to": ["hinges.*.spring.scale"], "table": { "value": [1, 1.05, 1.1] } }] }])");
  Json& draw = json["dispersions"][0];
  draw["distribution"]["mean"] = mean, draw["distribution"]["std"] = std;
  draw["through"][0]["table"]["at"] = {from, (from + to) / 2, to};
  InputWarnings warnings({});
  check_dispersions(campaign_of(json), warnings);
  for (const InputWarning& each : warnings.list()) {
    double share = 0;
    if (!each.pointer.ends_with("/table/at")) continue;
    CHECK(std::sscanf(each.found.c_str(), "%lf %% of the draws", &share) == 1);
    return share;
  }
  return 0;
}

double below(double z) { return std::erfc(-z / std::numbers::sqrt2) / 2; }

} // namespace

TEST_CASE("draws beyond either end of a table are warned of, by their share at both ends together",
          "[warnings]") {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> reach(0.5, 3);
  int told = 0, quiet = 0;
  for (int k = 0; k < 60; ++k) {
    const double down = k % 3 == 0 ? 5 : reach(random), up = k % 3 == 1 ? 5 : reach(random);
    const double beyond = 100 * (below(-down) + below(-up));
    CAPTURE(down, up, beyond);
    const double share = share_told(20, 10, 20 - 10 * down, 20 + 10 * up);
    ++(share > 0 ? told : quiet);
    if (beyond > 5)
      CHECK(share == Approx(beyond).epsilon(0.006)); // printed with three digits
    else
      CHECK(share == 0);
    CHECK(share == share_told(-20, 10, -20 - 10 * up, -20 + 10 * down)); // the mirror image
  }
  CHECK((told > 10 && quiet > 10));
}

TEST_CASE("a case's law is warned of by its worst table", "[warnings]") {
  Json json = quick_campaign(2);
  json["dispersions"] = parse_json(R"([{ "name": "temperature",
    "distribution": { "type": "uniform", "lower": 0, "upper": 10 },
    "through": [
      { "apply": "scale", "to": ["hinges.root.spring.scale"], "table": { "at": [-90, 60], "value": [1, 1] } },
      { "apply": "scale", "to": ["hinges.*.friction.scale"], "table": { "at": [-90, 22], "value": [1, 1] } } ] }])");
  json["cases"] = parse_json(R"([{ "name": "hot", "distributions": {
    "temperature": { "type": "uniform", "lower": 45, "upper": 80 } } }])");
  InputWarnings warnings({});
  check_dispersions(campaign_of(json), warnings);
  const auto& list = warnings.list();
  REQUIRE(list.size() == 1);
  CHECK(list[0].pointer == "/cases/0/distributions/temperature");
  CHECK_THAT(list[0].found, Catch::Contains("100 % of the draws") && Catch::Contains("to 22") &&
                                Catch::Contains("2 of its tables"));
}
