#include "montecarlo/report/data/envelopes_json.hpp"
#include "montecarlo/report/data/page_numbers.hpp"
#include "tests/montecarlo/report/data/page_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("envelopes are quantiles of runs made again, on any number of threads", "[page]") {
  const auto source = made(quick_campaign(30));
  PageDetail detail;
  detail.envelope_times = 25;
  const Json json = envelopes_json(*source, detail, 1);
  CHECK(json == envelopes_json(*source, detail, 2));
  CHECK(json["runs"] == 30);
  REQUIRE(json["t"].size() == 25);
  const double last_latch =
      moments(std::vector<double>(source->results.outputs.back().values.begin(),
                                  source->results.outputs.back().values.end()))
          .max;
  CHECK(json["t"].back().get<double>() == Approx(1.08 * last_latch).epsilon(1e-5));
  for (const char* key : {"angles", "rates"})
    for (const Json& hinge : json[key]) {
      REQUIRE(hinge.size() == 7);
      for (std::size_t t = 0; t < 25; ++t)
        for (std::size_t level = 1; level < 7; ++level)
          CHECK(hinge[level][t].get<double>() >= hinge[level - 1][t].get<double>());
    }
  const Hinge& root = source->stored.campaign.scene.hinges[0];
  for (std::size_t level = 0; level < 7; ++level) {
    CHECK(json["angles"][0][level][0] == rounded(root.stowed, 5)); // all begin alike
    CHECK(std::abs(json["angles"][0][level][24].get<double>() - root.latched) < 0.02);
    CHECK(json["rates"][0][level][24] != 0.0); // the ring goes on
  }
  std::vector<double> times(source->results.outputs[0].values.begin(),
                            source->results.outputs[0].values.end());
  std::ranges::sort(times); // root.latch_time
  CHECK(json["latch_times"][0] == page_numbers(times, 6));
}

TEST_CASE("envelopes have at most so many runs, spread evenly, and a foreign set has none",
          "[page]") {
  const auto source = made(quick_campaign(30));
  PageDetail detail;
  detail.envelope_runs = 10;
  const Json json = envelopes_json(*source, detail, 1);
  CHECK(json["runs"] == 10);
  std::vector<double> times;
  for (std::size_t run = 0; run < 30; run += 3)
    times.push_back(source->results.outputs[0].values[run]);
  std::ranges::sort(times);
  CHECK(json["latch_times"][0] == page_numbers(times, 6));
  detail.latch_times = 4; // of 10, with both ends
  CHECK(envelopes_json(*source, detail, 1)["latch_times"][0] ==
        page_numbers(std::vector{times[0], times[3], times[6], times[9]}, 6));
  source->stored.foreign = true;
  CHECK(envelopes_json(*source, detail, 1).is_null());
}
