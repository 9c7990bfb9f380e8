#include "montecarlo/foundation/platform/interrupt.hpp"
#include "montecarlo/foundation/platform/thread_pool.hpp"
#include "montecarlo/interfaces/library/wingspread.hpp"
#include "montecarlo/results/results_folder/merge.hpp"
#include "tests/montecarlo/analyses/fit/fit_support.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <cmath>
#include <numeric>

using namespace wingspread;
using namespace wingspread::test;

namespace {

api::Input as_input(const Json& json) { return api::from_text(json.dump()); }

bool same_bits(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

} // namespace

TEST_CASE("the library's tables have the bits of the runs, for any number of threads",
          "[parallel]") {
  const Json json = full_campaign(60);
  const Campaign campaign = campaign_of(json);
  const Results expected = rows_of(RunPlan(campaign), {0, 60});
  for (const int threads : {1, 2}) {
    const api::Table table = api::run(as_input(json), {.threads = threads});
    REQUIRE(table.size() == 60);
    CHECK(table.is_complete());
    CHECK(std::ranges::equal(table.runs(), expected.runs));
    for (const auto* columns : {&expected.draws, &expected.outputs})
      for (const Column& column : *columns)
        CHECK(std::ranges::equal(table.numbers(column.name), column.values, same_bits));
    for (std::size_t i = 0; i < table.size(); ++i) {
      const auto text = [&](const char* column) {
        return table.words(column).texts[table.words(column).codes[i]];
      };
      CHECK(text("status") == to_string(expected.status[i]));
      CHECK(text("latch_order") == expected.latch_order[i]);
      CHECK(text("peaks_final") == to_string(expected.peaks_final[i]));
      CHECK(table.reason(i) == expected.reason[i]);
    }
  }
}

TEST_CASE("a table says which columns it has, and keeps them as long as a copy lives") {
  std::span<const double> times;
  std::optional<api::Table> copy;
  {
    const api::Table table = api::run(as_input(quick_campaign(20)), {.runs = 3, .seed = 11});
    CHECK(table.size() == 3);
    CHECK(table.columns().front() == "run");
    CHECK(table.draws() ==
          std::vector<std::string>{"root_spring", "mass.panel_1", "mass.panel_2", "mass.panel_3"});
    CHECK(table.outputs().back() == "deployment_time");
    CHECK(parse_json(table.campaign())["sampling"]["seed"] == 11);
    CHECK_THAT(message_of([&] { return table.numbers("root.latch_tim"); }),
               Catch::StartsWith("found \"root.latch_tim\"") &&
                   Catch::Contains("\"root.latch_time\"?"));
    CHECK_THAT(message_of([&] { return table.words("peaks_final"); }),
               Catch::StartsWith("found \"peaks_final\""));
    times = table.numbers("deployment_time");
    copy = table;
  }
  CHECK(std::ranges::all_of(times, [](double time) { return time > 1 && time < 60; }));
}

TEST_CASE("a results folder is read as the table that its campaign gives") {
  const Folder folder;
  Json json = full_campaign(30);
  (void)run_into(folder.path() / "all", campaign_of(json));
  (void)run_into(folder.path() / "part", campaign_of(json), {.stop_after = 1});
  const api::Table made = api::run(as_input(json)), all = api::read(folder.path() / "all");
  CHECK(all.is_complete());
  CHECK(all.campaign() == made.campaign());
  for (const std::string& output : made.outputs())
    CHECK(std::ranges::equal(all.numbers(output), made.numbers(output), same_bits));
  const api::Table part = api::read(folder.path() / "part");
  CHECK_FALSE(part.is_complete());
  CHECK(part.size() < 30);
  CHECK_THAT(message_of([&] { return api::read(folder.path() / "none"); }),
             Catch::StartsWith((folder.path() / "none").string() + ": found no such folder"));
}

TEST_CASE("a preview that is read says what it is") {
  const Folder folder;
  const std::filesystem::path part = folder.path() / "part", preview = folder.path() / "preview";
  (void)run_into(part, campaign_of(quick_campaign(10)), {.shard = Shard{1, 2}});
  CHECK(api::read(part).notices().empty());
  (void)merge_folders({part}, preview, MergeKind::preview);
  CHECK(api::read(preview).notices() ==
        std::vector{preview.string() + " is a preview of 5 of 10 runs; the results may change"});
}

TEST_CASE("a campaign of the library stops by its rule, and when it is told to") {
  Json json = quick_campaign(4000);
  json["outputs"] = {"latch_time"};
  json["until"] = Json{parse_stopping_goal("deployed 0.1").value()};
  CHECK(api::run(as_input(json)).size() == 1000);
  const std::atomic<bool> now = true;
  const api::Table stopped = api::run(as_input(json), {.stop = &now});
  CHECK(stopped.size() == 0);
  CHECK_FALSE(stopped.is_complete());
}

TEST_CASE("of a campaign with cases the library runs the one that is named") {
  Json json = quick_campaign(8);
  json["cases"] = parse_json(R"([ { "name": "hot", "scale": { "hinges.*.spring.scale": 1.2 } },
                                  { "name": "cold", "scale": { "hinges.*.spring.scale": 0.8 } } ])");
  const auto mean = [&](const char* name) {
    const api::Table table = api::run(as_input(json), {.of_case = name});
    const auto times = table.numbers("deployment_time");
    return std::accumulate(times.begin(), times.end(), 0.0) / 8;
  };
  CHECK(mean("hot") < mean("cold"));
  CHECK(message_of([&] { return api::run(as_input(json)); }).find("cold") != std::string::npos);
}

TEST_CASE("the library refuses a case that the campaign does not have, with cases and without") {
  for (const bool has_cases : {false, true}) {
    Json json = quick_campaign(2);
    if (has_cases) json["cases"] = parse_json(R"([ { "name": "cold" } ])");
    CAPTURE(has_cases);
    const std::vector<std::string> said{
        message_of([&] { return api::run(as_input(json), {.of_case = "hot"}).size(); }),
        message_of([&] { return api::simulate(as_input(json), {.of_case = "hot"}).status; }),
        message_of([&] {
          return api::Model(as_input(json), {"hinges.root.spring.scale"}, {}, {.of_case = "hot"})
              .parameters();
        })};
    for (const std::string& each : said) CHECK_THAT(each, Catch::Contains("hot"));
  }
}

TEST_CASE("a case of the library changes the wing that the settings have changed") {
  Json json = quick_campaign(8);
  json["cases"] = parse_json(R"([ { "name": "hot", "scale": { "hinges.*.spring.scale": 1.25 } },
    { "name": "fixed", "set": { "hinges.root.spring.scale": 0.9 } },
    { "name": "more", "add": { "hinges.root.spring.scale": 0.125 } } ])");
  const char* const path = "hinges.root.spring.scale";
  for (const auto& [name, expected] :
       {std::pair{"hot", 0.625}, std::pair{"fixed", 0.9}, std::pair{"more", 0.625}}) {
    const api::Settings settings{.set = {std::string(path) + "=0.5"}, .of_case = name};
    CAPTURE(name);
    CHECK(api::Model(as_input(json), {path}, {}, settings).nominal().at(0) == expected);
    Json changed = json;
    for (Json& hinge : changed["scene"]["hinges"])
      if (hinge["name"] == "root") hinge["spring"]["scale"] = 0.5;
    CHECK(api::simulate(as_input(json), settings).json ==
          api::simulate(as_input(changed), {.of_case = name}).json);
  }
}

TEST_CASE("a run that fails has no peaks: a larger one might have followed") {
  for (const double step : {0.2, 0.5, 1.0}) {
    const api::Outcome outcome = api::simulate(
        api::from_file(three_panel_file()), {.method = "runge_kutta4", .step = step, .t_end = 20});
    CAPTURE(step);
    REQUIRE(outcome.status == "failed");
    CHECK_FALSE(outcome.reason.empty());
    CHECK((outcome.peak_moment.empty() && outcome.peak_force.empty()));
  }
}

TEST_CASE("a deployment of the library is that of simulate, with its trajectory") {
  const Scene scene = read_scene_file(three_panel_file());
  Goal goal;
  goal.to_t_end = true;
  Integration integration;
  integration.t_end = 8;
  const Outcome expected = Deployment().run(scene, integration, goal);
  const api::Outcome outcome = api::simulate(api::from_file(three_panel_file()), {.t_end = 8}, 0.5);
  CHECK(outcome.status == to_string(expected.status));
  REQUIRE(outcome.latches.size() == expected.latches.size());
  for (std::size_t k = 0; k < outcome.latches.size(); ++k) {
    const LatchEvent& latch = expected.latches[k];
    CHECK(outcome.latches[k].hinge == scene.hinges[latch.hinge].name);
    CHECK(outcome.latches[k].time == latch.time);
    CHECK(outcome.latches[k].rate == latch.rates[latch.hinge]);
    CHECK(outcome.latches[k].rates == latch.rates);
  }
  REQUIRE(outcome.peak_moment.size() == expected.peak_moment.size());
  REQUIRE(outcome.peak_force.size() == expected.peak_force.size());
  for (std::size_t h = 0; h < outcome.peak_moment.size(); ++h) {
    CHECK(outcome.hinges[h] == scene.hinges[h].name);
    CHECK(outcome.peak_moment[h].value == expected.peak_moment[h].value);
    CHECK(outcome.peak_moment[h].time == expected.peak_moment[h].time);
    CHECK(outcome.peak_force[h].value == expected.peak_force[h].value);
    CHECK(outcome.peak_force[h].time == expected.peak_force[h].time);
  }
  CHECK(outcome.t_end == expected.t_end);
  CHECK(outcome.angles == expected.final.angles);
  CHECK(outcome.rates == expected.final.rates);
  CHECK(parse_json(outcome.json)["work"]["steps"] == expected.work.steps);
  REQUIRE(outcome.trajectory.size() == 13);
  CHECK(outcome.trajectory[1].name == "root.angle");
  CHECK(outcome.trajectory[0].values.size() == 17);
  CHECK(outcome.trajectory[0].values[3] == 1.5);
  CHECK(outcome.trajectory[1].values[0] == scene.hinges[0].stowed);
}

TEST_CASE("an empty path is refused as one") {
  CHECK_THROWS_WITH(api::from_file(""), Catch::Contains("an empty path"));
}

TEST_CASE("a model's rows are deployments of their own, in lanes or alone", "[parallel]") {
  const api::Input input = api::from_file(three_panel_file());
  const std::vector<std::string> outputs{"deployment_time", "root.peak_moment"};
  const api::Model model(input, {"hinges.*.spring.scale", "bodies.panel_1.mass"}, outputs,
                         {.t_end = 20});
  CHECK(model.nominal() == std::vector<double>{1, 10});
  // no one number stands for springs of different torques
  CHECK(std::isnan(api::Model(input, {"hinges.*.spring.torque_stowed"}, outputs).nominal()[0]));
  CHECK(model.parameters() == 2);
  const std::vector<double> x{1, 10, 1.2, 10, 1, -1, 0.9, 11, 1, NAN};
  std::vector<double> y(10), alone(2);
  for (const int threads : {1, 2}) {
    CHECK(model.evaluate(x, y, threads));
    for (std::size_t row = 0; row < 5; ++row) {
      CHECK(model.evaluate(std::span(x).subspan(2 * row, 2), alone, 1));
      CHECK(same_bits(alone[0], y[2 * row]));
      CHECK(same_bits(alone[1], y[2 * row + 1]));
    }
    CHECK(y[2] < y[0]);      // a stronger spring is faster
    CHECK(std::isnan(y[4])); // a mass below zero
    CHECK(std::isnan(y[8]));
  }
  const auto nominal = api::simulate(input, {.t_end = 20});
  CHECK(y[0] == nominal.latches.back().time);
  const std::atomic<bool> now = true;
  CHECK_FALSE(model.evaluate(x, y, 1, &now));
  const api::Model of_end(input, {"bodies.panel_1.mass"}, {"tip.overtravel", "tip.final_angle"},
                          {.t_end = 20});
  std::vector<double> at_end(2);
  CHECK(of_end.evaluate(std::vector<double>{10}, at_end, 1));
  CHECK(at_end[0] >= 0);                                      // there is one
  CHECK(at_end[1] == Approx(nominal.angles[2]).margin(1e-9)); // latched at 0
}

TEST_CASE(
    "a fit of the library is the study's own, with all runs that it needs unless told otherwise") {
  const Folder folder;
  const Json campaign = panel_campaign(0.01);
  Json tests = parse_json(R"({ "tests": [ { "name": "timer",
      "values": [ { "output": "root.latch_time", "value": 0, "std": "10 ms" } ] } ],
    "fit": { "parameters": ["spring"], "samples": 1500, "starts": 2 } })");
  tests["tests"][0]["values"][0]["value"] = panel_latch_time(1.01, 1);
  const auto fit_with = [&](const api::FitRequest& request) {
    return api::fit(as_input(campaign), as_input(tests), request);
  };
  const Campaign read = campaign_of(campaign);
  const FitResult expected = fitted(read, read_fit(tests, "", ".", read));
  const api::Fit fit = fit_with({});
  CHECK((fit.finished && expected.finished));
  REQUIRE(fit.posterior.size() == 1);
  CHECK(fit.posterior[0].name == "spring");
  REQUIRE(fit.posterior[0].values.size() == 1500);
  for (std::size_t row = 0; row < 1500; ++row)
    CHECK(fit.posterior[0].values[row] == expected.posterior.rows[row][0]);
  CHECK(parse_json(fit.json)["parameters"].contains("spring"));
  const api::Fit kept = fit_with({.out = folder.path() / "f", .threads = 2});
  CHECK(kept.posterior[0].values == fit.posterior[0].values);
  CHECK(read_text(folder.path() / "f" / "fit.json") == kept.json);
  CHECK(fit_with({.seed = 9}).posterior[0].values != fit.posterior[0].values);
  CHECK_FALSE(fit_with({.runs = 2080}).finished);
  const std::atomic<bool> now = true;
  CHECK_THROWS_AS(fit_with({.stop = &now}), wingspread::Stopped);
  CHECK_THROWS_AS(fit_with({.stop = &now}), std::exception); // caught by who knows no more of it
  CHECK_THROWS_AS(fit_with({.runs = -5}), SpecError);
  CHECK_THROWS_AS(fit_with({.runs = 50}), SpecError); // fewer than the sampler makes
  CHECK_THROWS_AS(fit_with({.threads = -5}), SpecError);
}

TEST_CASE("what the library is asked and cannot do is refused with every problem") {
  const api::Input input = api::from_file(three_panel_file());
  const std::string model = message_of([&] {
    return api::Model(input, {"bodies.panel_1.mass", "bodies.*.mass", "hinges.rot.spring.scale"},
                      {"root.latch_tim"});
  });
  CHECK_THAT(model, Catch::Contains("paths[1]: found bodies.panel_1.mass a second time") &&
                        Catch::Contains("\npaths[2]: found string \"hinges.rot.spring.scale\"") &&
                        Catch::Contains("\"hinges.root.spring.scale\"?") &&
                        Catch::Contains("\noutputs[0]: found \"root.latch_tim\"") &&
                        Catch::Contains("\"root.latch_time\"?"));
  CHECK_THAT(
      message_of([&] { return api::run(as_input(quick_campaign(5)), {.runs = 0, .threads = -1}); }),
      Catch::Contains("--runs: found 0") && Catch::Contains("2147483647\n--threads: found -1") &&
          Catch::Contains("1024, or 0"));
  for (const int threads : {-1, most_threads + 1})
    CHECK_THAT(
        message_of([&] { return api::run(as_input(quick_campaign(5)), {.threads = threads}); }),
        Catch::StartsWith(fmt::format("--threads: found {}", threads)));
  for (const long runs : {0L, most_runs + 1})
    CHECK_THAT(message_of([&] { return api::run(as_input(quick_campaign(5)), {.runs = runs}); }),
               Catch::StartsWith(fmt::format("--runs: found {}", runs)));
  for (const int threads : {0, most_threads}) // these alone are no fault
    CHECK_THAT(message_of([&] {
                 return api::run(as_input(quick_campaign(5)), {.runs = 0, .threads = threads});
               }),
               !Catch::Contains("--threads"));
  const std::vector<double> x{1};
  std::vector<double> y(1);
  const api::Model one(input, {"hinges.*.spring.scale"}, {"root.latch_time"});
  CHECK_THAT(message_of([&] { return one.evaluate(x, y, -3); }),
             Catch::StartsWith("--threads: found -3"));
  for (const std::size_t wrong : {0, 2, 3}) { // of one row with one output
    std::vector<double> other(wrong);
    CHECK_THAT(message_of([&] { return one.evaluate(x, other, 1); }),
               Catch::StartsWith(fmt::format("y: found {} numbers", wrong)));
  }
  const api::Model two(input, {"hinges.root.spring.scale", "hinges.tip.spring.scale"}, {});
  CHECK_THAT(message_of([&] { return two.evaluate(x, y, 1); }),
             Catch::StartsWith("x: found 1 numbers"));
  CHECK_THAT(message_of([&] { return api::simulate(input, {.t_end = 1}, 1e-9); }),
             Catch::StartsWith("--dt: found 1e-09") && Catch::Contains("1e-08"));
  const std::atomic<bool> now = true;
  CHECK_THROWS_AS(api::simulate(input, {}, {}, false, &now), Stopped);
  CHECK_THAT(message_of([&] { return api::simulate(input, {.latch = "soft"}); }),
             Catch::StartsWith("--latch: found soft") && Catch::Contains("smoothed:EPS"));
  CHECK(message_of([&] {
          return api::simulate(input, {.rtol = -1});
        }).starts_with("--rtol: found -1"));
  CHECK_THAT(message_of([&] { return api::simulate(input, {}, -1.0); }),
             Catch::StartsWith("--dt: found -1"));
  CHECK_THAT(message_of([&] { return api::Model(input, {}, {}); }),
             Catch::StartsWith("paths: found none"));
}
