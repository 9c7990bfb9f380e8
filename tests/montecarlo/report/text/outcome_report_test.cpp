#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/report/text/outcome_report.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace wingspread;
using namespace wingspread::test;

namespace {

Outcome simulate(const Scene& scene, double t_end) {
  Integration integration;
  integration.t_end = t_end;
  Goal goal;
  goal.to_t_end = true;
  return Deployment().run(scene, integration, goal);
}

/// As a run may end that nothing fails but the friction.
Outcome stalled(Outcome outcome) {
  outcome.status = Status::stalled;
  outcome.reason = "friction holds root";
  outcome.phases = {{"dopri5", 0, outcome.t_end, outcome.work.steps}};
  return outcome;
}

/// Phases of one second each, by two methods in turn.
Outcome with_phases(Outcome outcome, int count) {
  outcome.phases.clear();
  for (int i = 0; i < count; ++i)
    outcome.phases.push_back({i % 2 == 0 ? "dopri5" : "rosenbrock_w", i + 0.0, i + 1.0, 10 + i});
  outcome.t_end = count;
  return outcome;
}

std::vector<std::string> keys(const Json& json) {
  std::vector<std::string> list;
  for (const auto& [key, value] : json.items()) list.push_back(key);
  return list;
}

} // namespace

TEST_CASE("the seed scene's outcome as JSON") {
  const Scene scene = read_scene_file(three_panel_file());
  const Outcome outcome = simulate(scene, 10);
  const Json json = parse_json(json_text(outcome_json(scene, outcome)));
  CHECK(keys(json) == std::vector<std::string>{"status", "reason", "method", "phases", "t_end",
                                               "latches", "peak_moment", "peak_force",
                                               "peaks_final", "overtravel", "final_angle",
                                               "warnings", "final", "energy", "work"});
  CHECK(json["status"] == "deployed");
  CHECK(json["reason"].is_null());
  CHECK(json["t_end"] == 10);
  REQUIRE(json["latches"].size() == 3);
  const Json& first = json["latches"][0];
  CHECK(keys(first) == std::vector<std::string>{"hinge", "time", "rate", "rates"});
  CHECK(first["hinge"] == "root");
  // An independent model, DOP853 at rtol 1e-11; printed to these digits
  CHECK(first["time"].get<double>() == Approx(4.819271).epsilon(0).margin(5e-7));
  CHECK(first["rate"].get<double>() == Approx(-1.267827).epsilon(0).margin(6e-7));
  CHECK(first["rates"]["root"] == first["rate"]);
  CHECK(keys(first["rates"]) == std::vector<std::string>{"root", "mid", "tip"});
  CHECK(json["latches"][2]["time"].get<double>() == Approx(6.794189).epsilon(0).margin(5e-7));
  CHECK(json["peak_moment"]["tip"]["value"].get<double>() ==
        Approx(115.9431).epsilon(0).margin(1e-4));
  CHECK(json["peak_moment"]["tip"]["time"] == json["latches"][2]["time"]);
  CHECK(json["peak_force"]["mid"]["value"].get<double>() > 0);
  CHECK(json["final"]["angles"]["root"] == outcome.final.angles[0]);
  CHECK(json["final"]["rates"]["tip"] == outcome.final.rates[2]);
  CHECK(keys(json["final"]["base"]) ==
        std::vector<std::string>{"position", "angle", "velocity", "rate"});
  CHECK(json["final"]["base"]["position"] == Json::array({0.0, 0.0}));
  CHECK(json["energy"]["initial"] == outcome.energy.initial);
  CHECK(json["energy"]["drift_before_first_latch"].get<double>() < 1e-7);
  CHECK(json["work"]["steps"] == outcome.work.steps);
  Scene driven = scene; // its way is not integrated
  driven.base.motion = BaseMotion::prescribed, driven.base.acceleration = {0.01, 0};
  const Json base = outcome_json(driven, simulate(driven, 10))["final"]["base"];
  CHECK((base["position"].is_null() && base["velocity"].is_null()));
  CHECK(base["rate"] == 0);
}

TEST_CASE("overtravel stands by hinge, and in the table, and is warned of without a stop") {
  Scene scene = read_scene_file(three_panel_file());
  Outcome outcome = simulate(scene, 1);
  outcome.peaks_final = true;
  outcome.overtravel = {0, 0.5, 0.25};
  scene.hinges[2].stop = Stop{100, 0, 0};
  const std::string text =
      "mid turns up to 28.6 deg backwards, beyond its stowed angle (overtravel); it has no stop";
  CHECK(outcome_json(scene, outcome)["warnings"] == Json::array({text}));
  CHECK_THAT(outcome_text(scene, outcome),
             Catch::Contains("\nWARNING\n  " + wrapped(text, 2) + "\n\nEnergy"));
  scene.hinges[1].stop = Stop{};
  CHECK(outcome_json(scene, outcome)["warnings"] == Json::array());
  CHECK(outcome_text(scene, outcome).find("WARNING") == std::string::npos);
  CHECK(outcome_json(scene, outcome)["overtravel"].dump() ==
        R"({"root":0.0,"mid":0.5,"tip":0.25})");
  CHECK_THAT(outcome_text(scene, outcome), Catch::Contains("rate, rad/s  beyond stowed, deg\n") &&
                                               Catch::Contains("28.65\n  tip"));
}

TEST_CASE("what did not happen, or is not known, is null") {
  Scene scene = read_scene_file(three_panel_file());
  SECTION("timed out: no latch yet, peaks so far") {
    const Json json = outcome_json(scene, simulate(scene, 1));
    CHECK(json["status"] == "timed_out");
    CHECK(json["latches"] == Json::array());
    CHECK(json["peak_moment"]["root"]["value"] == 2.0);
    CHECK(json["peaks_final"] == false);
    const std::string warning =
        "t_end cut the peaks: it is not proven that none would be exceeded after it";
    CHECK(json["warnings"] == Json::array({warning}));
    CHECK_THAT(outcome_text(scene, simulate(scene, 1)),
               Catch::Contains("\nWARNING\n  " + warning + "\n"));
  }
  SECTION("stalled: with its reason, and peaks up to the end") {
    const Json json = outcome_json(scene, stalled(simulate(scene, 1)));
    CHECK(json["status"] == "stalled");
    CHECK(json["reason"] == "friction holds root");
    CHECK(json["peak_moment"]["root"]["value"] == 2.0);
  }
  SECTION("invalid") {
    scene.bodies[0].mass = -1;
    const Json json = outcome_json(scene, simulate(scene, 1));
    CHECK(json["status"] == "invalid");
    CHECK(json["reason"].get<std::string>().starts_with("bodies.panel_1.mass is -1"));
    CHECK(json["latches"] == Json::array());
    for (const char* key : {"method", "phases", "t_end", "peak_moment", "peak_force", "peaks_final",
                            "overtravel", "final", "energy"})
      CHECK(json[key].is_null());
  }
  SECTION("failed") {
    Outcome outcome = simulate(scene, 1);
    outcome.status = Status::failed;
    outcome.overtravel = {0, 0, 1};
    outcome.final.rates[1] = std::numeric_limits<double>::infinity();
    const Json json = outcome_json(scene, outcome);
    CHECK(json["peak_moment"].is_null());
    CHECK(json["overtravel"].is_null());
    CHECK(json["peaks_final"].is_null());
    CHECK(json["warnings"].dump().find("t_end") == std::string::npos);
    CHECK(json["final"]["rates"]["mid"].is_null());
    const auto row = [&] {
      const std::string text = outcome_text(scene, outcome);
      const std::size_t at = text.find("  tip ", text.find("\nEND"));
      return text.substr(at, text.find('\n', at) - at);
    };
    CHECK_THAT(row(), Catch::EndsWith(" –")); // as null in JSON
    outcome.status = Status::stalled;
    CHECK_THAT(row(), Catch::EndsWith(" 57.3"));
  }
}

TEST_CASE("a run's phases follow one another, and name their methods") {
  const Scene scene = read_scene_file(three_panel_file());
  const Outcome outcome = simulate(scene, 10);
  double reached = 0;
  long steps = 0;
  const Json made = outcome_json(scene, outcome);
  for (const Json& phase : made["phases"]) {
    CHECK(keys(phase) == std::vector<std::string>{"method", "from", "to", "steps"});
    CHECK(phase["from"] == reached);
    reached = phase["to"];
    steps += phase["steps"].get<long>();
  }
  CHECK(reached == 10);
  CHECK(steps == outcome.work.steps);
  const Json json = outcome_json(scene, with_phases(outcome, 3));
  CHECK(json["method"] == "dopri5, rosenbrock_w");
  CHECK(json["phases"].size() == 3);
  CHECK(json["phases"][1].dump() == R"({"method":"rosenbrock_w","from":1.0,"to":2.0,"steps":11})");
}

TEST_CASE("the phases in words, the first four of them") {
  const Scene scene = read_scene_file(three_panel_file());
  const Outcome outcome = simulate(scene, 10);
  const auto first_line = [&](int phases) {
    const std::string text = outcome_text(scene, with_phases(outcome, phases));
    return text.substr(0, text.find('\n'));
  };
  const std::string four = ": dopri5 to 1 s, rosenbrock_w to 2 s, dopri5 to 3 s, "
                           "rosenbrock_w to 4 s";
  CHECK(first_line(1) == "three_panel: deployed, integrated to 1 s by dopri5");
  CHECK(first_line(2) ==
        "three_panel: deployed, integrated to 2 s: dopri5 to 1 s, rosenbrock_w to 2 s");
  CHECK(first_line(4) == "three_panel: deployed, integrated to 4 s" + four);
  CHECK(first_line(5) == "three_panel: deployed, integrated to 5 s" + four + " and 1 more phase");
  CHECK(first_line(9) == "three_panel: deployed, integrated to 9 s" + four + " and 5 more phases");
}

TEST_CASE("the outcome in words") {
  Scene scene = read_scene_file(three_panel_file());
  const std::string text = outcome_text(scene, simulate(scene, 10));
  CHECK(text.starts_with("three_panel: deployed, integrated to 10 s"));
  CHECK(text.find("root                        4.819271       -1.267827") != std::string::npos);
  CHECK(text.find("root                        250.4651") != std::string::npos);
  CHECK(outcome_text(scene, simulate(scene, 1)).find("no hinge latched") != std::string::npos);
  CHECK(outcome_text(scene, stalled(simulate(scene, 1)))
            .starts_with("three_panel: stalled (friction holds root), integrated to 1 s by "));
  scene.bodies[0].mass = -1;
  CHECK(outcome_text(scene, simulate(scene, 1)) ==
        "three_panel: invalid (bodies.panel_1.mass is -1, expected > 0)\n");
}

TEST_CASE("short and long times keep their digits and their columns") {
  const Scene scene = read_scene_file(three_panel_file());
  Outcome outcome = simulate(scene, 1);
  outcome.latches = {{0, 84078.866641, {1.07335, 0, 0}}, {1, 2.94063e-5, {0, -123456.789, 0}}};
  for (Peak& peak : outcome.peak_moment) peak = {12345678.9, 84078.866641};
  outcome.peak_force = outcome.peak_moment;
  const std::string text = outcome_text(scene, outcome);
  CHECK_THAT(text, Catch::Contains("\n  root                        84078.87        1.073350\n"));
  CHECK_THAT(text, Catch::Contains("\n  mid                     2.940630e-05       -123456.8\n"));
  CHECK_THAT(text, Catch::Contains("  1.234568e+07      84078.87  1.234568e+07      84078.87\n"));
}

TEST_CASE("a run at its limit of steps says what the limit counts") {
  const Scene scene = read_scene_file(three_panel_file());
  Integration few;
  few.t_end = 10, few.max_steps = 50;
  const Outcome outcome = Deployment().run(scene, few, Goal{});
  REQUIRE(outcome.status == Status::failed);
  CHECK_THAT(outcome_text(scene, outcome), Catch::Contains("max_steps counts every trial step"));
  CHECK_THAT(outcome_text(scene, simulate(scene, 10)), !Catch::Contains("max_steps"));
}

TEST_CASE("a free base's largest changes are those that its motion shows") {
  const Scene scene = read_scene_file(three_panel_file().parent_path() / "two_wing_release.json");
  Integration integration;
  integration.t_end = 12;
  Goal goal;
  goal.to_t_end = true;
  double angle = 0, rate = 0;
  const Outcome outcome = Deployment().run(scene, integration, goal, [&](const Sample& sample) {
    angle = std::max(angle, std::abs(sample.base_angle - scene.base.angle));
    rate = std::max(rate, std::abs(sample.base_rate - scene.base.rate));
  });
  REQUIRE(angle > 0.01);
  const Json json = outcome_json(scene, outcome)["base_motion"];
  // Between two steps the changes are a little larger than at their ends.
  CHECK(json["peak_angle"].get<double>() >= angle);
  CHECK(json["peak_angle"].get<double>() == Approx(angle).epsilon(1e-3));
  CHECK(json["peak_rate"].get<double>() >= rate);
  CHECK(json["peak_rate"].get<double>() == Approx(rate).epsilon(1e-2));
  const std::string text = outcome_text(scene, outcome);
  const auto row = text.find("LARGEST CHANGE");
  REQUIRE(row != std::string::npos);
  CHECK_THAT(text.substr(row),
             Catch::Contains(degrees_text(json["peak_angle"].get<double>())) &&
                 Catch::Contains(fmt::format("{:.6g}\n", json["peak_rate"].get<double>())));
  Outcome failed = outcome;
  failed.status = Status::failed;
  CHECK(outcome_json(scene, failed)["base_motion"].is_null());
  CHECK(outcome_text(scene, failed).find("LARGEST CHANGE") == std::string::npos);
}

TEST_CASE("whether peaks are final is told where there are peaks, of moments or of forces") {
  const Scene scene = read_scene_file(three_panel_file());
  const Outcome both = simulate(scene, 1);
  const auto told = [&](bool moments, bool forces) {
    Outcome outcome = both;
    if (!moments) outcome.peak_moment.clear();
    if (!forces) outcome.peak_force.clear();
    return outcome_json(scene, outcome)["peaks_final"];
  };
  CHECK(told(true, true) == false);
  CHECK(told(true, false) == false);
  CHECK(told(false, true) == false);
  CHECK(told(false, false).is_null());
}

TEST_CASE("each table of loads stands where its loads are known, and none of a run that failed") {
  Scene scene = read_scene_file(three_panel_file());
  scene.hinges[1].release.emplace();
  scene.hinges[2].motor.emplace();
  scene.bodies[1].flexible.emplace();
  Outcome outcome = simulate(read_scene_file(three_panel_file()), 1);
  const std::vector<Peak> peaks{{1.5, 0.25}, {2.5, 0.5}, {3.5, 0.75}};
  const auto tables = [&](const Outcome& of) {
    std::string found;
    const std::string text = outcome_text(scene, of);
    for (const char* title : {"\nPEAK", "\nHOLD", "\nMOTOR"})
      if (text.find(title) != std::string::npos) found += title;
    return found;
  };
  outcome.peak_moment = outcome.peak_force = outcome.hold_moment = {};
  outcome.motor_energy = {};
  CHECK(tables(outcome).empty());
  Outcome all = outcome;
  for (auto* of : {&all.peak_moment, &all.peak_force, &all.hold_moment, &all.bending_moment})
    *of = peaks;
  all.motor_energy = {0, 0, 4.5};
  CHECK(tables(all) == "\nPEAK\nHOLD\nMOTOR");
  const std::string text = outcome_text(scene, all);
  for (const char* row : {"  root                        1.500000     0.2500000      1.500000     "
                          "0.2500000\n",
                          "  panel_2                     2.500000     0.5000000 bending\n",
                          "  mid                         2.500000     0.5000000\n",
                          "  tip                         4.500000\n"})
    CHECK_THAT(text, Catch::Contains(row));
  CHECK(text.find("panel_1") == std::string::npos); // rigid
  Outcome one = outcome;
  for (auto* of : {&one.peak_moment, &one.peak_force}) {
    one.peak_moment = one.peak_force = {};
    *of = peaks;
    CHECK(tables(one) == "\nPEAK");
    CHECK_THAT(outcome_text(scene, one), Catch::Contains("–"));
  }
  all.status = Status::failed;
  CHECK(tables(all).empty());
}
