#include "montecarlo/report/data/envelopes_json.hpp"
#include "montecarlo/report/data/page_numbers.hpp"
#include "tests/montecarlo/analyses/fit/fit_support.hpp"
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

TEST_CASE("envelopes end with the runs, and no run that times out rests before", "[page]") {
  const auto whole = made(quick_campaign(30));
  std::vector<double> times = sorted_present(whole->results.outputs.back().values);
  Json json = quick_campaign(30);
  const double t_end = 1.001 * times[20];
  json["integration"]["t_end"] = t_end;
  const auto source = made(json);
  REQUIRE(std::ranges::count(source->results.status, Status::timed_out) > 3);
  REQUIRE(std::ranges::count(source->results.status, Status::deployed) > 3);
  const Json found = envelopes_json(*source, PageDetail(), 1);
  CHECK(found["t"].back().get<double>() == Approx(t_end).epsilon(1e-5));
  CHECK(std::abs(found["rates"][2][0].back().get<double>()) > 0.1); // the tip still opens
}

TEST_CASE("the envelope of a single run is its motion in closed form, from the first instant on",
          "[page]") {
  Json json = panel_campaign();
  json["sampling"]["runs"] = 1;
  const auto source = made(json);
  PageDetail detail;
  detail.envelope_times = 400;
  const Json found = envelopes_json(*source, detail, 1);
  const double spring = source->results.draws[0].values[0],
               friction = source->results.draws[1].values[0];
  const double latch = panel_latch_time(spring, friction);
  const double acceleration = (panel_torque * spring - 0.3 * friction) / panel_inertia;
  int compared = 0;
  for (std::size_t k = 0; k < found["t"].size(); ++k) {
    const double t = found["t"][k].get<double>();
    if (t > 0.98 * latch) break; // the end of the interval between two samples
    CAPTURE(t);
    for (const std::size_t level : {0, 3, 6}) {
      CHECK(found["angles"][0][level][k].get<double>() ==
            Approx(panel_angle(t, spring, friction)).margin(1e-3));
      CHECK(found["rates"][0][level][k].get<double>() == Approx(-acceleration * t).margin(2e-3));
    }
    ++compared;
  }
  CHECK(compared > 300);
}

TEST_CASE("without rows a run is known to its end, and then keeps its angles without a rate",
          "[page]") {
  Json json = panel_campaign();
  json["sampling"]["runs"] = 1; // it ends at its latch
  const auto source = made(json);
  source->streaming = std::make_unique<StreamingStatistics>(
      source->stored.campaign, RunPlan(source->stored.campaign).names(), source->results);
  PageDetail detail;
  detail.envelope_times = 109; // every hundredth of the latch time
  const Json found = envelopes_json(*source, detail, 1);
  const double spring = source->results.draws[0].values[0],
               friction = source->results.draws[1].values[0];
  const double latch = panel_latch_time(spring, friction);
  const double acceleration = (panel_torque * spring - 0.3 * friction) / panel_inertia;
  REQUIRE(found["t"].back().get<double>() == Approx(1.08 * latch).epsilon(1e-5));
  const Json &angles = found["angles"][0], &rates = found["rates"][0];
  for (const std::size_t level : {0, 3, 6})
    for (std::size_t k = 90; k < 109; ++k) {
      const double t = found["t"][k].get<double>();
      if (k == 100) continue; // the latch itself, with rounding
      CAPTURE(t);
      CHECK(angles[level][k].get<double>() ==
            Approx(k < 100 ? panel_angle(t, spring, friction) : 0).margin(1e-3));
      CHECK(rates[level][k].get<double>() == Approx(k < 100 ? -acceleration * t : 0).margin(2e-3));
    }
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
  for (const std::size_t most : {2, 4, 200}) { // runs are counted, not the times that are shown
    detail.latch_times = most;
    CHECK(envelopes_json(*source, detail, 1)["latched"] == Json{10, 10, 10});
  }
  source->stored.foreign = true;
  CHECK(envelopes_json(*source, detail, 1).is_null());
}

TEST_CASE("a sequence has the events of every hinge, and only a wing with holds has one",
          "[page]") {
  CHECK(envelopes_json(*made(quick_campaign(3)), {}, 1)["sequence"].is_null());
  Json campaign = quick_campaign(20);
  campaign["scene"]["hinges"][2]["release"] =
      parse_json(R"({"after": "root", "event": "latched", "delay": 0.25})");
  const auto source = made(campaign);
  const Json sequence = envelopes_json(*source, {}, 2)["sequence"];
  REQUIRE(sequence.size() == 3);
  CHECK(sequence[0]["release"].is_null());
  CHECK(sequence[2]["release"]["event"] == "latched");
  CHECK(sequence[2]["release"]["after"] == 0);
  CHECK(sequence[2]["release"]["fails"] == 0);
  for (std::size_t h = 0; h < 3; ++h) {
    const std::string name = source->stored.campaign.scene.hinges[h].name + ".latch_time";
    std::vector<double> times; // of the rows
    for (const Column& column : source->results.outputs)
      if (column.name == name)
        std::ranges::copy_if(column.values, std::back_inserter(times),
                             [](double time) { return !std::isnan(time); });
    REQUIRE_FALSE(times.empty());
    std::ranges::sort(times);
    CHECK(sequence[h]["latched"]["runs"] == times.size());
    CHECK(sequence[h]["latched"]["times"].front() == page_number(times.front(), 6));
    CHECK(sequence[h]["latched"]["times"][3] == page_number(times[(times.size() - 1) / 2], 6));
    CHECK(sequence[h]["latched"]["times"].back() == page_number(times.back(), 6));
    CHECK(sequence[h]["let_go"]["count"] == 0);
    CHECK(sequence[h]["released"]["count"] == (h == 2 ? sequence[0]["latched"]["count"] : Json(0)));
  }
  const double first = sequence[0]["latched"]["times"].front().get<double>();
  CHECK(sequence[2]["released"]["times"].front().get<double>() == Approx(first + 0.25));
  campaign["scene"]["hinges"][2]["release"]["fails"] = 1;
  CHECK(envelopes_json(*made(campaign), {}, 2)["sequence"][2]["release"]["fails"] == 1);
}

// A latch that lets go once a run or more often, in some runs.
TEST_CASE("runs in which an event happens, and how often it does, are those of the runs made again",
          "[page]") {
  Json json = quick_campaign(24);
  json["scene"]["hinges"][0]["latch"]["holding_moment"] = 60;
  json["scene"]["hinges"][2]["latch"]["capture_rate"] = 0.9;
  for (Json& hinge : json["scene"]["hinges"])
    hinge["stop"] = parse_json(R"([ { "side": "stowed", "stiffness": 500, "dissipation": 0.2 },
                                    { "side": "latched", "stiffness": 500, "dissipation": 0.2 } ])");
  const auto source = made(json);
  PageDetail detail;
  const Json sequence = envelopes_json(*source, detail, 2)["sequence"];
  const RunPlan plan(source->stored.campaign);
  const std::size_t hinges = source->stored.campaign.scene.hinges.size();
  struct Count {
    std::size_t runs = 0, events = 0;
  };
  std::map<std::string, std::vector<Count>> expected;
  const double end = 1.08 * std::ranges::max(sorted_present(source->results.outputs.back().values));
  Goal goal;
  goal.to_t_end = true;
  for (long run = 0; run < 24; ++run) {
    const bool deployed = source->results.status[static_cast<std::size_t>(run)] == Status::deployed;
    Runner runner(plan);
    const Outcome outcome =
        deployed ? runner.watch(run, goal, std::min(end, plan.integration().t_end), {})
                 : runner.replay(run, {}).outcome;
    const auto add = [&](const char* kind, const auto& events) {
      auto& counts = expected[kind];
      counts.resize(hinges);
      for (std::size_t h = 0; h < hinges; ++h) {
        const auto own = static_cast<std::size_t>(std::ranges::count_if(
            events, [&](const auto& event) { return event.hinge == static_cast<int>(h); }));
        counts[h].runs += own > 0 ? 1 : 0;
        counts[h].events += own;
      }
    };
    add("latched", outcome.latches), add("missed", outcome.missed), add("let_go", outcome.let_go);
  }
  bool some = false; // more than once in a run
  for (const auto& [kind, counts] : expected)
    for (std::size_t h = 0; h < hinges; ++h) {
      CAPTURE(kind, h);
      CHECK(sequence[h][kind]["runs"] == counts[h].runs);
      CHECK(sequence[h][kind]["count"] == counts[h].events);
      some = some || counts[h].events > counts[h].runs;
    }
  CHECK(some);
}

TEST_CASE("without rows the envelopes of a shard are of its own runs", "[page]") {
  const Json json = quick_campaign(12);
  const auto whole = made(json);
  for (const Shard& shard : {Shard{1, 3}, Shard{3, 3}}) {
    const auto source = made(json);
    source->stored.stamp.shard = shard;
    const auto [first, last] = source->stored.runs();
    source->summary.runs = last - first;
    source->streaming = std::make_unique<StreamingStatistics>(
        source->stored.campaign, RunPlan(source->stored.campaign).names(), source->results);
    std::vector<double> times;
    for (long run = first; run < last; ++run)
      times.push_back(whole->results.outputs[0].values[static_cast<std::size_t>(run)]);
    std::ranges::sort(times);
    CAPTURE(first);
    CHECK(envelopes_json(*source, PageDetail(), 1)["latch_times"][0] == page_numbers(times, 6));
  }
}
