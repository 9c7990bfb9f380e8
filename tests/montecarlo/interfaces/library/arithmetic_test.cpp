// The library in a program that has another floating-point environment than the default one.
#include "montecarlo/interfaces/library/wingspread.hpp"
#include "tests/montecarlo/analyses/fit/fit_support.hpp"

#include <catch2/catch.hpp>

#include <cfenv>
#include <thread>
#include <vector>

using namespace wingspread;
using namespace wingspread::test;

namespace {

struct Computed {
  std::string outcome, fit;
  std::vector<double> draws, times, y;
};

/// The input, as text: the test's own reading of numbers follows the arithmetic too.
struct Inputs {
  std::string campaign = quick_campaign(40).dump(), panel = panel_campaign(0.01).dump();
  std::string tests = R"({ "tests": [ { "name": "timer",
      "values": [ { "output": "root.latch_time", "value": 2, "std": "10 ms" } ] } ],
    "fit": { "parameters": ["spring"], "samples": 400, "starts": 1 } })";
};

/// The results of every function of the library that computes.
Computed compute(const Inputs& inputs) {
  Computed results;
  const api::Input scene = api::from_file(three_panel_file());
  results.outcome = api::simulate(scene, {.t_end = 12}, 0.1, true).json;
  const api::Table table = api::run(api::from_text(inputs.campaign), {.runs = 40, .threads = 2});
  const auto draws = table.numbers("root_spring"), times = table.numbers("tip.latch_time");
  results.draws.assign(draws.begin(), draws.end());
  results.times.assign(times.begin(), times.end());
  const api::Model model(scene, {"hinges.*.spring.scale"}, {"deployment_time"});
  results.y.resize(3);
  (void)model.evaluate(std::vector{0.9, 1.0, 1.1}, results.y, 2);
  results.fit = api::fit(api::from_text(inputs.panel), api::from_text(inputs.tests),
                         {.runs = 2080, .threads = 2})
                    .json;
  return results;
}

} // namespace

TEST_CASE("a call computes in the default arithmetic, and its thread keeps its own") {
  const Inputs inputs;
  const Computed expected = compute(inputs);
  constexpr int traps = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW;
  std::thread([&] { // in a thread, so that the tests after this one have theirs
    std::fesetround(FE_UPWARD);
    feenableexcept(traps);
    const Computed found = compute(inputs);
    const bool kept = std::fegetround() == FE_UPWARD && fegetexcept() == traps;
    fedisableexcept(FE_ALL_EXCEPT);
    std::fesetround(FE_TONEAREST);
    CHECK(kept);
    CHECK(found.outcome == expected.outcome);
    CHECK(found.fit == expected.fit);
    CHECK(found.draws == expected.draws);
    CHECK(found.times == expected.times);
    CHECK(found.y == expected.y);
  })
      .join();
}

TEST_CASE("arrays of a wrong size are refused before any number is written") {
  const api::Model model(api::from_file(three_panel_file()),
                         {"hinges.root.spring.scale", "bodies.panel_1.mass"}, {"deployment_time"});
  std::vector<double> y(2, -1);
  CHECK_THAT(message_of([&] {
               return model.evaluate(std::vector{1.0, 10.0, 1.0}, y, 1);
             }),
             Catch::Contains("x: found 3 numbers, expected rows of 2 numbers"));
  CHECK_THAT(message_of([&] {
               return model.evaluate(std::vector{1.0, 10.0}, y, 1);
             }),
             Catch::Contains("y: found 2 numbers, expected 1 rows of 1 numbers"));
  CHECK(y == std::vector<double>{-1, -1});
}
