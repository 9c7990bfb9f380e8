#include "montecarlo/analyses/sensitivity/saltelli.hpp"
#include "montecarlo/analyses/sensitivity/sobol_report.hpp"
#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"
#include "tests/montecarlo/campaign_support.hpp"
#include "tests/montecarlo/csv_support.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("Sobol' indices as JSON, CSV and a table; what does not vary is named", "[parallel]") {
  Json json = quick_campaign(1);
  json["dispersions"].push_back({{"name", "none"},
                                 {"distribution", {{"type", "constant"}, {"value", 1}}},
                                 {"apply", "scale"},
                                 {"to", {"hinges.tip.latch.damping"}}});
  const Campaign campaign = campaign_of(json);
  const RunPlan plan = saltelli_plan(campaign, 12);
  const long runs = saltelli_runs(12, campaign.dispersions.size());
  const SobolSensitivity all = sobol_sensitivity(rows_of(plan, {0, runs}), plan.coordinates().names,
                                                 12, "random", {.resamples = 50});
  CHECK(all.unvaried == std::vector<std::string>{"none"});
  CHECK(all.idle().empty());
  REQUIRE(warnings(all).size() == 2); // and too few samples for bounds
  CHECK_THAT(warnings(all)[0], Catch::Contains("\"none\" do not vary"));
  const Json read = parse_json(json_text(sensitivity_json(all, {})));
  CHECK(read["samples"] == 12);
  CHECK(read["runs"] == runs);
  CHECK(read["partial"] == false);
  CHECK(read["do_not_vary"] == Json::array({"none"}));
  CHECK(read["moves_nothing"].empty());
  CHECK(read["warnings"] == Json(warnings(all)));
  const Json& effects = read["outputs"]["root.latch_time"]["dispersions"];
  for (const char* index : {"first", "total"})
    CHECK(effects["none"][index] ==
          Json{{"value", nullptr}, {"lower", nullptr}, {"upper", nullptr}});
  CHECK(effects["none"]["inert"] == false);
  CHECK(effects["root_spring"]["total"]["value"] > 0);
  CHECK(sensitivity_csv(all).find(",none,12,0,,,,,,\n") != std::string::npos);
  CHECK(sensitivity_csv(all).starts_with(
      "output,dispersion,rows,incomplete,first,first_lower,first_upper,"
      "total,total_lower,total_upper\nroot.latch_time,root_spring,12,0,"));
  CHECK(sensitivity_table(all, "title").find("sum of the first-order") != std::string::npos);
}

TEST_CASE("an output without indices, and bounds that there are not, are told of") {
  Json json = quick_campaign(1);
  json["integration"]["t_end"] = 6.75; // some do not come to it
  json["sampling"]["design"] = "sobol";
  const Campaign campaign = campaign_of(json);
  const RunPlan plan = saltelli_plan(campaign, 16);
  const long runs = saltelli_runs(16, campaign.dispersions.size());
  const SobolSensitivity all = sobol_sensitivity(rows_of(plan, {0, runs}), plan.coordinates().names,
                                                 16, "sobol", {.replicates = 1});
  const Json output = sensitivity_json(all, {})["outputs"]["deployment_time"];
  const long incomplete = output["incomplete"];
  CHECK((output["rows"] == 16 && 0 < incomplete && incomplete <= 16));
  CHECK(output["dispersions"]["root_spring"]["total"]["value"].is_null());
  CHECK(sensitivity_json(all, {})["definitions"]["bounds"] == one_replicate);
  CHECK_THAT(sensitivity_table(all, "title"),
             Catch::Contains("deployment_time, s · 16 rows · " + std::to_string(incomplete) +
                             " with a missing value: no indices"));
  const auto said = warnings(all);
  REQUIRE(said.size() >= 2);
  CHECK(said[0] == one_replicate);
  CHECK_THAT(said[1], Catch::Contains("\"deployment_time\"") && Catch::Contains("no indices"));
}

TEST_CASE("one point without a value, one cut peak and one open latch are told, and none is not") {
  for (const bool one : {false, true}) {
    SobolSensitivity all{64, 256, 256, "random", {.resamples = 50}, {"a"}, {}};
    SobolIndices indices{64, one ? 1 : 0, 12.5, 0.75, {}};
    indices.effects = {{{0.5, {}}, {0.5, {}}, false}};
    all.outputs.push_back({"root.peak_moment", indices, one ? 1 : 0});
    all.open_latches = one ? 1 : 0;
    CAPTURE(one);
    const std::vector<std::string> said = warnings(all);
    REQUIRE(said.size() == (one ? 3 : 0));
    const std::string table = sensitivity_table(all, "t");
    CHECK((table.find(" · 1 with a missing value") != std::string::npos) == one);
    CHECK((table.find(" · 1 cut by t_end") != std::string::npos) == one);
    if (!one) continue;
    CHECK_THAT(said[0],
               Catch::StartsWith("in 1 of 256 runs t_end cut the peaks of \"root.peak_moment\""));
    CHECK(said[1] == warn_of_open_latches(1, 256, ""));
    CHECK_THAT(said[2], Catch::StartsWith("no indices of \"root.peak_moment\""));
  }
}

TEST_CASE("the short table has shares of the variance") {
  SobolSensitivity all;
  all.dispersions = {"a", "b", "c"};
  const auto effect = [](double total) { return SobolEffect{{0, {}}, {total, {}}, false}; };
  SobolIndices indices;
  indices.effects = {effect(0.1), effect(0.004), effect(0.7)};
  all.outputs.push_back({"root.latch_time", indices});
  CHECK(moved_by_table(all, "t") == "t\n\nOUTPUT                          moved by (share of the "
                                    "variance, interactions included)\n"
                                    "  root.latch_time               c 70 %\n");
}

TEST_CASE("the short table of shares counts the others that are visible") {
  SobolSensitivity all;
  all.dispersions = {"a", "b", "c", "d"};
  const auto effect = [](double total, double lower) {
    return SobolEffect{{0, {}}, {total, {lower, 2 * total}}, false};
  };
  SobolIndices indices;
  indices.effects = {effect(0.1, 0.05), effect(0.004, 0.003), effect(0.7, 0.6),
                     effect(0.03, 0.001)};
  all.outputs.push_back({"root.latch_time", indices});
  CHECK_THAT(moved_by_table(all, "t"),
             Catch::Contains("c 70 %, and 1 other with visible effect, at most 10 %\n"));
}

TEST_CASE("indices are what their definitions say, from the rows of a design") {
  const Campaign campaign = campaign_of(quick_campaign(1));
  const std::size_t d = campaign.dispersions.size();
  const long rows = 20;
  const RunPlan plan = saltelli_plan(campaign, rows);
  const Results results = rows_of(plan, {0, saltelli_runs(rows, d)});
  const Json json = sensitivity_json(
      sobol_sensitivity(results, plan.coordinates().names, rows, "random", {.resamples = 20}), {});
  const Json& definitions = json["definitions"];
  CHECK_THAT(definitions["first"],
             Catch::Contains("(f_B - m)(f_ABi - f_A)") && Catch::Contains("2N values f_A and f_B"));
  CHECK_THAT(definitions["total"], Catch::Contains("(f_A - f_ABi)^2"));
  CHECK_THAT(definitions["variance"], Catch::Contains("2N"));
  for (const Column& output : results.outputs) {
    const auto at = [&](long row, std::size_t place) {
      return output.values[static_cast<std::size_t>(row) * (d + 2) + place];
    };
    double mean = 0, variance = 0;
    for (long row = 0; row < rows; ++row) mean += (at(row, 0) + at(row, 1)) / (2 * rows);
    for (long row = 0; row < rows; ++row)
      for (const std::size_t place : {0u, 1u})
        variance += std::pow(at(row, place) - mean, 2) / (2 * rows);
    const Json& found = json["outputs"][output.name];
    CAPTURE(output.name);
    CHECK(found["variance"].get<double>() == Approx(variance).epsilon(1e-9));
    if (variance < 1e-12) continue;
    for (std::size_t i = 0; i < d; ++i) {
      double first = 0, total = 0;
      for (long row = 0; row < rows; ++row) {
        const double change = at(row, 2 + i) - at(row, 0);
        first += (at(row, 1) - mean) * change / rows / variance;
        total += change * change / rows / (2 * variance);
      }
      const Json& effect = found["dispersions"][results.draws[i].name];
      CHECK(effect["first"]["value"].get<double>() == Approx(first).epsilon(1e-8).margin(1e-10));
      CHECK(effect["total"]["value"].get<double>() == Approx(total).epsilon(1e-8).margin(1e-10));
    }
  }
}

TEST_CASE("fewer samples than bounds take are told, with the number that they take") {
  for (const long rows : {3L, 15L, 16L}) {
    SobolSensitivity all{rows, 3 * rows, 3 * rows, "random", {.resamples = 50}, {"a"}, {}};
    const std::vector<std::string> said = warnings(all);
    REQUIRE(said.size() == (rows < 16 ? 1 : 0));
    if (rows < 16) CHECK_THAT(said[0], Catch::Contains("too few") && Catch::Contains("16"));
  }
}

TEST_CASE("shares of which the bounds say nothing are warned of by their output's name") {
  SobolSensitivity all;
  all.rows = 256, all.dispersions = {"a"};
  const auto add = [&](const char* name, double lower, double upper) {
    all.outputs.push_back({name, {10, 0, 1, 1, {{{0, {}}, {0.9, {lower, upper}}, false}}}});
  };
  add("root.latch_time", 0.2, 1.15);
  CHECK(warnings(all).empty());
  add("mid.latch_time", 0.106, 5.48);
  add("tip.latch_time", -0.1, 0.91);
  REQUIRE(warnings(all).size() == 1);
  CHECK_THAT(warnings(all)[0], Catch::Contains("\"mid.latch_time\", \"tip.latch_time\"") &&
                                   Catch::Contains("more --samples"));
}

TEST_CASE("the short table has outputs without indices as not known, and warns of constant draws") {
  SobolSensitivity all;
  all.dispersions = {"a"};
  SobolIndices known{10, 0, 1, 1, {{{0, {}}, {0.9, {}}, false}}}, some = known;
  some.incomplete = 1, some.effects[0].total.value = std::nan("");
  all.outputs.push_back({"root.latch_time", known});
  all.outputs.push_back({"deployment_time", some});
  const std::string table = moved_by_table(all, "t");
  CHECK_THAT(table, Catch::Contains("root.latch_time               a 90 %") &&
                        Catch::Contains("not known") && Catch::Contains(": deployment_time\n") &&
                        !Catch::Contains("no visible effect"));
  all.unvaried = {"a"};
  CHECK_THAT(warnings(all).at(0), Catch::Contains("\"a\" do not vary"));
  CHECK(sensitivity_json(all, {})["do_not_vary"] == Json{"a"});
}

TEST_CASE("indices of peaks that t_end cut are told to be those of the cut values") {
  const Campaign campaign = campaign_of(ringing_panel(1, 2.3, 0));
  const RunPlan plan = saltelli_plan(campaign, 8);
  const SobolSensitivity all = sobol_sensitivity(rows_of(plan, {0, 24}), plan.coordinates().names,
                                                 8, "random", {.resamples = 20});
  CHECK_THAT(warnings(all).at(0), Catch::StartsWith("in 24 of 24 runs t_end cut the peaks of "
                                                    "\"root.peak_moment\", \"root.peak_force\": "));
  CHECK(sensitivity_json(all, {})["outputs"]["root.peak_moment"]["cut"] == 24);
  CHECK_THAT(sensitivity_table(all, "t"), Catch::Contains(" · 24 cut by t_end\n"));
}

TEST_CASE("Sobol' indices stand under their names, in JSON, CSV and the table") {
  SobolSensitivity all{64, 250, 256, "random", {.resamples = 50}, {"a", "b"}, {}};
  SobolIndices indices{64, 0, 12.5, 0.75, {}};
  indices.effects = {{{0.125, {0.0625, 0.25}}, {0.375, {0.3125, 0.5}}, false},
                     {{-0.03125, {-0.25, 0.015625}}, {0.0078125, {0, 0.09375}}, true}};
  all.outputs.push_back({"root.latch_time", indices, 3});
  const Json json = sensitivity_json(all, {});
  CHECK((json["samples"] == 64 && json["runs"] == 250 && json["partial"] == true));
  const Json& output = json["outputs"]["root.latch_time"];
  CHECK((output["rows"] == 64 && output["incomplete"] == 0 && output["cut"] == 3));
  CHECK((output["mean"] == 12.5 && output["variance"] == 0.75));
  CHECK(output["dispersions"]["a"] ==
        Json{{"first", {{"value", 0.125}, {"lower", 0.0625}, {"upper", 0.25}}},
             {"total", {{"value", 0.375}, {"lower", 0.3125}, {"upper", 0.5}}},
             {"inert", false}});
  CHECK(output["dispersions"]["b"]["inert"] == true);
  const auto rows = rows_by_name(sensitivity_csv(all));
  REQUIRE(rows.size() == 2);
  CHECK(rows[1] == CsvRow{{"output", "root.latch_time"},
                          {"dispersion", "b"},
                          {"rows", "64"},
                          {"incomplete", "0"},
                          {"first", "-0.03125"},
                          {"first_lower", "-0.25"},
                          {"first_upper", "0.015625"},
                          {"total", "0.0078125"},
                          {"total_lower", "0"},
                          {"total_upper", "0.09375"}});
  const std::string table = sensitivity_table(all, "t");
  const auto numbers_of = [&](const std::string& begin) {
    const std::string line = table.substr(table.find("\n  " + begin + ' ') + 3 + begin.size());
    std::vector<double> numbers;
    std::istringstream words(line.substr(0, line.find('\n')));
    for (std::string word; words >> word;)
      if (char* end = nullptr; (void)std::strtod(word.c_str(), &end), end != word.c_str())
        numbers.push_back(std::strtod(word.c_str(), nullptr));
    return numbers;
  };
  const auto of_a = numbers_of("a");
  REQUIRE(of_a.size() >= 2);
  CHECK(of_a.front() == Approx(0.375).margin(6e-4)); // the total first
  CHECK(std::ranges::any_of(of_a, [](double x) { return std::abs(x - 0.125) < 6e-4; }));
  CHECK(numbers_of("sum of the first-order") == std::vector<double>{0.094});
  // each number under its heading
  const auto end_of = [&](const std::string& begin, const std::string& word) {
    const auto from = table.find("\n  " + begin + ' ') + 1;
    return count_characters(table.substr(from, table.find(word, from) + word.size() - from));
  };
  CHECK(end_of("a", "0.375") == end_of("dispersion", "total"));
  CHECK(end_of("a", "0.125") == end_of("dispersion", "first"));
  CHECK(end_of("sum of the first-order", "0.094") == end_of("dispersion", "first"));
}

TEST_CASE("the report of Sobol' indices says what its bounds are") {
  const auto definition = [](const SobolBounds& bounds) {
    SobolSensitivity all;
    all.bounds = bounds;
    return sensitivity_json(all, {})["definitions"]["bounds"].get<std::string>();
  };
  CHECK_THAT(definition({.replicates = 0, .resamples = 250}),
             Catch::Contains("bootstrap") && Catch::Contains(" 250 "));
  CHECK(definition({.replicates = 1, .resamples = 250}) == one_replicate);
  CHECK_THAT(definition({.replicates = 2, .resamples = 250}),
             Catch::Contains("jackknife") && Catch::Contains(" 2 independent replicates"));
  CHECK_THAT(definition({.replicates = 8, .resamples = 250}),
             Catch::Contains("jackknife") && Catch::Contains(" 8 independent replicates"));
}

TEST_CASE("a share that no true index has is said to be noise of its estimate") {
  SobolSensitivity all;
  all.rows = 100, all.runs = all.total = 400, all.dispersions = {"a", "b"};
  SobolIndices indices;
  indices.rows = 100;
  indices.effects = {{{0.4, {0.2, 0.6}}, {0.9, {0.7, 1.1}}, false},
                     {{0.02, {-0.1, 0.1}}, {0.1, {0.05, 0.2}}, false}};
  const auto noisy = [&] {
    all.outputs = {{"root.latch_time", indices}};
    const auto says = [](const std::string& text) {
      return text.find("noise of its estimate") != std::string::npos;
    };
    return std::pair(says(moved_by_table(all, "")), says(sensitivity_table(all, "")));
  };
  CHECK(noisy() == std::pair(false, false));
  indices.effects[1].first.value = -0.02; // printed by the full table alone
  CHECK(noisy() == std::pair(false, true));
  indices.effects[1].first.value = 0.02;
  indices.effects[0].total.value = 1.13;
  CHECK(noisy() == std::pair(true, true));
}
