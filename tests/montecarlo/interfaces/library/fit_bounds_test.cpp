#include "montecarlo/interfaces/library/wingspread.hpp"
#include "tests/montecarlo/analyses/fit/fit_support.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("the library's bounds of a fitted parameter hold 95 % of its posterior") {
  Json json = panel_campaign();
  const Json tests = parse_json(R"({ "tests": [ { "name": "ground",
      "values": [ { "output": "root.latch_time", "value": 2.2, "std": 0.02 } ] } ],
    "fit": { "parameters": ["spring"], "samples": 400, "starts": 1 } })");
  for (const double confidence : {0.5, 0.8, 0.95}) {
    json["statistics"]["confidence"] = confidence;
    const api::Fit made =
        api::fit(api::from_text(json.dump()), api::from_text(tests.dump()), {.threads = 1});
    const Json spring = parse_json(made.json)["parameters"]["spring"];
    const std::vector<double>& values = made.posterior.at(0).values;
    const auto inside = std::ranges::count_if(values, [&](double value) {
      return spring["lower"].get<double>() <= value && value <= spring["upper"].get<double>();
    });
    CHECK(static_cast<double>(inside) / static_cast<double>(values.size()) ==
          Approx(0.95).margin(0.03));
  }
}
