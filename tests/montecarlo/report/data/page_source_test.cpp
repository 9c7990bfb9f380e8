#include "montecarlo/report/data/envelopes_json.hpp"
#include "montecarlo/report/data/motions_json.hpp"
#include "montecarlo/report/data/page_source.hpp"
#include "montecarlo/report/data/set_json.hpp"
#include "montecarlo/results/streaming/streaming_folder.hpp"
#include "tests/montecarlo/report/data/page_support.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <random>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("a folder read for the page tells what its runs tell in memory", "[page]") {
  const Folder place;
  const std::filesystem::path path = place.path() / "r";
  Json json = full_campaign(100);
  json["statistics"] = {{"confidence", 0.9}};
  json["requirements"] = parse_json(
      R"([ { "output": "mid.peak_moment", "max": 100, "probability": 0.2, "confidence": 0.5 } ])");
  const Campaign campaign = campaign_of(json);
  (void)run_into(path, campaign);
  const auto in_memory = source_of(campaign, rows_of(RunPlan(campaign), {0, 100}));
  in_memory->stored.folder = in_memory->made_from = path;
  const auto read = read_page_source(read_stored_campaign(path), "set", nullptr, 1);
  CHECK(read->confidence == 0.9);
  CHECK(read->replayable());
  CHECK(set_json(*read, {}, 1) == set_json(*in_memory, {}, 1));

  Campaign before = campaign;
  before.scene.name = "before its case";
  const auto of_case = read_page_source(read_stored_campaign(path), "cold", &before, 1);
  CHECK(of_case->label == "cold");
  CHECK(of_case->before_case.scene.name == "before its case");
  CHECK(read->before_case.scene.name == campaign.scene.name);
}

TEST_CASE("the page makes runs again where there are runs, and the program made them", "[page]") {
  const Campaign campaign = campaign_of(quick_campaign(20));
  for (const long runs : {0L, 20L})
    for (const bool foreign : {false, true}) {
      CAPTURE(runs, foreign);
      const auto source = source_of(campaign, rows_of(RunPlan(campaign), {0, runs}));
      source->stored.foreign = foreign;
      const bool made_again = runs > 0 && !foreign;
      CHECK(source->replayable() == made_again);
      CHECK(motions_json(*source, {}, 1).empty() == !made_again);
      CHECK(envelopes_json(*source, {}, 1).is_null() == !made_again);
    }
}

TEST_CASE("the page's bounds hold together over all interim analyses, with rows and without",
          "[page]") {
  const Folder place;
  Json json = quick_campaign(5000);
  json["until"] = Json{parse_stopping_goal("root.latch_time@0.5 1e-9").value()}; // never met
  const Campaign campaign = campaign_of(json);
  (void)run_into(place.path() / "rows", campaign);
  const auto rows =
      read_page_source(read_stored_campaign(place.path() / "rows"), "rows", nullptr, 1);
  CHECK(rows->summary.interim.count() > 1);
  CHECK(rows->confidence == rows->summary.interim.confidence_of_bound(0.95));
  CHECK(rows->confidence > 0.95);

  json.erase("until");
  const Campaign whole = campaign_of(json);
  const RunPlan plan(whole);
  const std::filesystem::path path = place.path() / "streaming";
  ThreadEvaluator evaluator({.threads = 1}, never);
  StreamingFolder folder(path, plan, std::nullopt, false);
  REQUIRE(folder.begin(evaluator));
  (void)evaluator.make(plan, folder.remaining(), {[&](const Batch& batch) { folder.add(batch); }});
  folder.finish();
  const auto streaming = read_page_source(read_stored_campaign(path), "streaming", nullptr, 1);
  CHECK(streaming->confidence == 0.95);
  CHECK((rows->has_rows() && !streaming->has_rows()));
  CHECK_THAT(set_json(*streaming, {}, 1)["made_by"].get<std::string>(),
             Catch::EndsWith(" --no-rows --out again"));
  CHECK_THAT(set_json(*rows, {}, 1)["made_by"].get<std::string>(), !Catch::Contains("--no-rows"));
  CHECK(streaming->made_from == path);
  CHECK(streaming->summary.runs == 5000);
  CHECK(set_json(*streaming, {}, 1)["orders"][0]["count"] ==
        set_json(*rows, {}, 1)["orders"][0]["count"]);
}

TEST_CASE("the worst run of a requirement is the same with rows and without, of x and of |x|",
          "[page]") {
  std::mt19937_64 random(3);
  for (int k = 0; k < 10; ++k) {
    std::vector<Json> requirements{{{"min", -100}}, {{"max", 100}}, {{"max", 100}, {"abs", true}}};
    std::shuffle(requirements.begin(), requirements.end(), random);
    Json json = quick_campaign(25);
    for (const Json& each : requirements) {
      Json requirement{{"output", "mid.latch_rate"}, {"probability", 0.5}, {"confidence", 0.5}};
      requirement.update(each);
      json["requirements"].push_back(requirement);
    }
    const Campaign campaign = campaign_of(json);
    const ResultNames names = RunPlan(campaign).names();
    const auto filled = [&](std::uint64_t seed) {
      std::mt19937_64 values(seed);
      Results results(names);
      for (long run = 0; run < 25; ++run) {
        ResultRow row{run, Status::deployed, std::vector<double>(names.draws.size(), 1.0),
                      {},  "root",           ""};
        if (names.peaks_final) row.peaks_final = PeaksFinal::yes;
        for (std::size_t i = 0; i < names.outputs.size(); ++i)
          row.outputs.push_back(2 * uniform(values) - 1);
        results.append(row);
      }
      return results;
    };
    const std::uint64_t seed = random();
    const auto rows = source_of(campaign, filled(seed)),
               rowless = source_of(campaign, filled(seed));
    rowless->streaming = std::make_unique<StreamingStatistics>(campaign, names, rowless->results);
    for (std::size_t row = 0; row < 25; ++row)
      (void)rowless->streaming->add(rowless->results.row(row), {});
    rowless->results = Results(names); // none is broken, so none is kept
    for (const Verdict& verdict : rows->summary.requirements) {
      const auto expected = broken_runs_of(*rows, verdict, 5).worst,
                 found = broken_runs_of(*rowless, verdict, 5).worst;
      REQUIRE((expected && found));
      CHECK(found->run == expected->run);
      CHECK(found->value == expected->value);
    }
  }
}
