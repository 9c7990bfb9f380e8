#include "montecarlo/analyses/fit/fit_campaign.hpp"
#include "montecarlo/analyses/fit/fit_report.hpp"
#include "montecarlo/report/page/fit_set.hpp"
#include "tests/montecarlo/analyses/fit/fit_support.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <algorithm>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("a fit of the page has every trace, value and sample of its folder, with their units",
          "[page]") {
  const Folder folder;
  folder.write(fit_json_file, R"({ "finished": true, "findings": ["far"], "unseen": ["x"],
    "parameters": { "spring": { "mean": 1.5 }, "friction": { "mean": 2 } },
    "prior_decides": ["spring"], "tests": [ { "name": "ground", "values": { "root.latch_time": { "measured": 2.5 },
                                               "hinges.root.friction.coulomb": { "measured": 0.25 },
                                               "root.peak_moment": { "unit": "kN·m", "measured": 4 } },
                 "traces": { "root.angle": { "rms": 0.125,
                     "outliers": [ { "t": 703 }, { "t": 705 } ] }, "root.rate": { "rms": 0.5 } } },
               { "name": "flight", "values": {}, "traces": { "root.angle": { "rms": 4 } } } ],
    "candidates": [ { "test": "next" } ],
    "prediction": { "root.peak_moment": { "before": [1, 2, 3] } } })");
  std::string traces = "test,column,t,measured,fitted,lower,upper\n";
  for (int k = 0; k < 900; ++k)
    traces += fmt::format("ground,root.angle,{},{},2,,3\n", k,
                          k == 703   ? -99
                          : k == 705 ? 99
                                     : k % 9);
  traces += "ground,root.rate,0.5,1,2,3,4\nflight,root.angle,1,5,6,7,8\n";
  folder.write(traces_csv_file, traces);
  const Scene scene = campaign_of(panel_campaign()).scene;
  const Json whole = fit_block(folder.path(), &scene);
  CHECK((whole["finished"] == true && whole["findings"] == Json{"far"} &&
         whole["unseen"] == Json{"x"} && whole["prior_decides"] == Json{"spring"}));
  CHECK(whole["parameters"] == parse_json(R"([ { "name": "spring", "mean": 1.5 },
                                               { "name": "friction", "mean": 2 } ])"));
  CHECK(whole["values"] == parse_json(R"([
    { "test": "ground", "name": "root.latch_time", "unit": "s", "measured": 2.5 },
    { "test": "ground", "name": "hinges.root.friction.coulomb", "unit": "N·m", "measured": 0.25 },
    { "test": "ground", "name": "root.peak_moment", "unit": "kN·m", "measured": 4 } ])")); // its own
  CHECK(whole["candidates"] == parse_json(R"([ { "test": "next" } ])"));
  CHECK(whole["prediction"]["root.peak_moment"] ==
        parse_json(R"({ "before": [1, 2, 3], "unit": "N·m" })"));
  CHECK(whole["samples"].is_null());
  const Json& found = whole["traces"];
  REQUIRE(found.size() == 3);
  CHECK((found[0]["test"] == "ground" && found[0]["column"] == "root.angle"));
  CHECK((found[0]["unit"] == "rad" && found[0]["rms"] == 0.125));
  CHECK(found[0]["samples"] == 900);
  const auto times = found[0]["t"].get<std::vector<double>>();
  CHECK((times.size() <= 401 && times.size() > 300));
  CHECK(std::ranges::adjacent_find(times, std::ranges::greater_equal{}) == times.end());
  const auto is_drawn = [&](std::size_t k) {
    return std::ranges::find(times, static_cast<double>(k)) != times.end();
  };
  for (std::size_t k = 0; k < 200; ++k) {
    CHECK(is_drawn(k * 900 / 200));
    const auto size = [](std::size_t i) {
      return i == 703 ? 101 : i == 705 ? 97 : std::abs(static_cast<int>(i % 9) - 2);
    };
    std::size_t worst = k * 900 / 200;
    for (std::size_t i = worst; i < (k + 1) * 900 / 200; ++i)
      if (size(i) > size(worst)) worst = i;
    CHECK(is_drawn(worst));
  }
  CHECK((is_drawn(703) && is_drawn(705))); // both outliers of the part from 702 to 706
  CHECK((found[0]["measured"][0] == 0.0 && found[0]["fitted"][0] == 2.0));
  CHECK((found[0]["lower"][7].is_null() && found[0]["upper"][7] == 3.0));
  CHECK(found[1] == parse_json(R"({ "test": "ground", "column": "root.rate", "unit": "rad/s",
    "t": [0.5], "measured": [1.0], "fitted": [2.0], "lower": [3.0], "upper": [4.0], "rms": 0.5, "samples": 1 })"));
  CHECK((found[2]["test"] == "flight" && found[2]["t"] == Json{1.0} && found[2]["rms"] == 4));

  std::string posterior = "spring,friction\n";
  for (int k = 0; k < 450; ++k) posterior += fmt::format("{},{}\n", k, -k);
  folder.write(posterior_file, posterior);
  const Json samples = fit_block(folder.path(), nullptr)["samples"];
  CHECK(samples["names"] == Json{"spring", "friction"});
  CHECK(samples["samples"] == 450);
  REQUIRE(samples["rows"].size() == 400);
  CHECK((samples["rows"][0] == Json{0.0, 0.0} && samples["rows"][399] == Json{448.0, -448.0}));
  CHECK(fit_block(folder.path(), nullptr)["values"][1]["unit"] == ""); // without the scene
  folder.write(posterior_file, "spring,friction\n1\n");
  CHECK_THAT(message_of([&] { return fit_block(folder.path(), nullptr); }),
             Catch::Contains(posterior_file) && Catch::Contains("number of cells"));
}

TEST_CASE("a trace of 400 rows is drawn whole, and a longer one thinned", "[page]") {
  const Folder folder;
  folder.write(fit_json_file, R"({ "finished": true, "findings": [], "unseen": [], "parameters": {},
    "tests": [ { "name": "ground", "values": {},
                 "traces": { "root.angle": {}, "root.rate": {} } } ] })");
  std::string traces = "test,column,t,measured,fitted,lower,upper\n";
  for (const auto& [column, rows] : {std::pair("root.angle", 400), std::pair("root.rate", 401)})
    for (int k = 0; k < rows; ++k) traces += fmt::format("ground,{},{},1,1,,\n", column, k);
  folder.write(traces_csv_file, traces);
  const Json found = fit_block(folder.path(), nullptr)["traces"];
  REQUIRE(found.size() == 2);
  CHECK((found[0]["samples"] == 400 && found[0]["t"].size() == 400));
  CHECK((found[1]["samples"] == 401 && found[1]["t"].size() == 200)); // none is far from the fit
}
