#include "montecarlo/analyses/sensitivity/effect_table.hpp"
#include "montecarlo/analyses/sensitivity/rank_report.hpp"
#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"
#include "tests/montecarlo/analyses/sensitivity/rank_support.hpp"
#include "tests/montecarlo/campaign_support.hpp"
#include "tests/montecarlo/csv_support.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <cmath>
#include <sstream>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("rank correlations as JSON, CSV and a table", "[parallel]") {
  const Campaign campaign = campaign_of(quick_campaign(60));
  const RankSensitivity all = rank_sensitivity(rows_of(RunPlan(campaign), {0, 60}), 0.9);
  const Json json = parse_json(json_text(sensitivity_json(all, {{"seed", 7}})));
  CHECK(json["wingspread"]["seed"] == 7);
  CHECK(json["runs"] == 60);
  CHECK(json["confidence"] == 0.9);
  const Json& spring = json["outputs"]["root.latch_time"]["dispersions"]["root_spring"];
  CHECK(spring["prcc"]["value"].get<double>() == all.outputs[0].effects[0].partial.value);
  CHECK(spring["prcc"]["lower"] < spring["prcc"]["value"]);
  CHECK(spring["spearman"]["upper"] > spring["spearman"]["value"]);

  const std::string csv = sensitivity_csv(all);
  CHECK(csv.starts_with("output,dispersion,count,missing,spearman,spearman_lower,spearman_upper,"
                        "prcc,prcc_lower,prcc_upper\nroot.latch_time,root_spring,60,0,"));
  CHECK(std::ranges::count(csv, '\n') == 1 + std::ssize(all.outputs) * std::ssize(all.dispersions));

  const std::string table = sensitivity_table(all, "title");
  CHECK(table.starts_with("title\n\nroot.latch_time, s · 60 runs\n  dispersion"));
  const auto block = table.find("root.latch_time");
  CHECK(table.find("root_spring", block) < table.find("mass.panel_1", block)); // it matters most
}

TEST_CASE("what is undefined is null, an empty cell and a dash; every dispersion has its line") {
  RankSensitivity all;
  all.runs = 5;
  OutputRanks output{"x.latch_time", 3, 2, {}, true};
  for (int j = 0; j < 12; ++j) {
    all.dispersions.push_back(std::string("d") += std::to_string(j));
    const double value = j == 0 ? std::nan("") : j / 20.0;
    output.effects.push_back({{value, {}}, {std::nan(""), {}}});
  }
  all.outputs.push_back(output);
  all.unvaried = {"d0"};
  const Json json = sensitivity_json(all, {});
  CHECK(json["outputs"]["x.latch_time"]["dispersions"]["d0"]["prcc"]["value"].is_null());
  CHECK(sensitivity_csv(all).find("x.latch_time,d1,3,2,0.050000000000000003,,,,,\n") !=
        std::string::npos);
  const std::string table = sensitivity_table(all, "t");
  CHECK(table.find("· 2 without") != std::string::npos);
  CHECK(table.find("d11") < table.find("d10")); // entangled: by Spearman's
  for (const std::string& name : all.dispersions)
    CHECK(table.find("\n  " + name + " ") != std::string::npos);
  CHECK(table.find("–") != std::string::npos);
  const auto said = warnings(all);
  REQUIRE(said.size() == 2);
  CHECK_THAT(said[0], Catch::Contains("\"d0\"") && Catch::Contains("do not vary"));
  CHECK_THAT(said[1], Catch::Contains("no partial coefficients"));
}

TEST_CASE("what a dispersion does with others is not hidden by what it does by itself") {
  RankSensitivity all;
  all.runs = 90;
  all.dispersions = {"alone", "together", "nothing"};
  const auto effect = [](double spearman, double partial) {
    return RankEffect{{spearman, {}}, {partial, {}}};
  };
  all.outputs.push_back(
      {"x.latch_time", 90, 0, {effect(0.3, 0.4), effect(0.77, 0.05), effect(0.02, 0.03)}, false});
  all.collinear = {"together"};
  const std::string table = sensitivity_table(all, "t");
  CHECK(table.find("together") < table.find("alone"));
  CHECK(table.find("alone") < table.find("nothing"));
  CHECK(table.find("0.770", table.find("together")) < table.find("alone"));
  CHECK(sensitivity_json(all, {})["follow_from_others"] == Json::array({"together"}));
  const auto said = warnings(all);
  REQUIRE(said.size() == 1);
  CHECK_THAT(said[0], Catch::Contains("\"together\"") && Catch::Contains("partial"));
}

TEST_CASE("columns of one rows are told as such") {
  RankSensitivity all;
  all.runs = 90;
  CHECK_FALSE(sensitivity_json(all, {}).contains("rows"));
  all.rows = {{"alone", {"mass"}}, {"fitted", {"spring", "friction"}}};
  CHECK(sensitivity_json(all, {})["rows"]["fitted"] == Json::array({"spring", "friction"}));
  const auto said = warnings(all);
  REQUIRE(said.size() == 1);
  CHECK_THAT(said[0], Catch::Contains("drawn together, as rows of \"fitted\""));
}

TEST_CASE("the report says what its bounds are") {
  const auto definition = [](int replicates, long looks) {
    RankSensitivity all;
    all.replicates = replicates;
    all.interim.planned = looks;
    return sensitivity_json(all, {})["definitions"]["bounds"].get<std::string>();
  };
  CHECK_THAT(definition(0, 1),
             Catch::Contains("variance (1 + r^2/2)/(n - 3)") && Catch::Contains("16 parts"));
  CHECK_THAT(definition(0, 5), Catch::Contains("0.99 each") && Catch::Contains(" 5 "));
  RankSensitivity
      extended; // of an extension: all extensions together, at the confidence that its bounds have
  extended.interim.before = {100, 200};
  CHECK_THAT(sensitivity_json(extended, {})["definitions"]["bounds"].get<std::string>(),
             Catch::Contains("0.9916666667: of analysis 3") &&
                 Catch::Contains("extensions hold together at 0.95"));
  CHECK_THAT(definition(8, 1), Catch::Contains("8 independent replicates"));
  CHECK(definition(1, 1) == one_replicate);
  RankSensitivity one;
  one.runs = 90, one.replicates = 1;
  CHECK(warnings(one) == std::vector<std::string>{std::string(one_replicate)});
}

TEST_CASE("the short table names what moves an output, and stops") {
  RankSensitivity all;
  all.runs = 90;
  all.dispersions = {"spring", "damper", "mass", "nothing"};
  const auto effect = [](double spearman, double partial, bool seen = true) {
    return RankEffect{{spearman, {}}, {partial, {}}, seen};
  };
  all.outputs.push_back(
      {"root.latch_time",
       90,
       0,
       {effect(-0.3, -0.85), effect(0.6, 0.2), effect(0.1, 0.15), effect(0.5, 0.5, false)},
       false});
  all.outputs.push_back(
      {"root.overtravel",
       90,
       0,
       {effect(std::nan(""), std::nan("")), effect(0.1, 0.05), effect(0, 0), effect(0, 0)},
       false});
  CHECK(
      moved_by_table(all, "t") ==
      "t\n\nOUTPUT                          moved by (rank correlation, partial or Spearman's, the "
      "larger)\n"
      "  root.latch_time               spring -0.85, damper 0.60\n"
      "  no visible effect on root.overtravel. A draw that moves an output both ways has "
      "no rank\n"
      "  correlation: Sobol' indices show it (sensitivity of the campaign's file)\n");
}

TEST_CASE("a line with many dispersions goes on below its second column") {
  MovedBy moved;
  std::vector<std::string> names;
  for (std::size_t k = 0; k < 5; ++k)
    names.push_back("a_dispersion_of_a_long_name_" + std::to_string(k));
  moved.add("root.latch_time",
            {names, [](std::size_t) { return 1; }, 0.1, [](std::size_t) { return true; },
             [](double) { return std::string("1"); }});
  std::istringstream table(moved.table("moved by"));
  std::string line;
  std::getline(table, line);
  std::size_t found = 0;
  for (long lines = 0; std::getline(table, line); ++lines) {
    CAPTURE(line);
    CHECK(line.size() <= table_width);
    CHECK(line.find("a_dispersion") == name_width + 2);
    CHECK((lines == 0 || line.find_first_not_of(' ') == name_width + 2));
    for (std::size_t k = 0; k < 5; ++k) found += line.find(names[k]) != std::string::npos;
  }
  CHECK(found == 5);
}

TEST_CASE("the short table counts the visible effects that it leaves out, with the largest") {
  RankSensitivity all;
  all.runs = 900;
  const auto effect = [](double value, bool seen = true) {
    return RankEffect{{value, {value - 0.05, value + 0.05}}, {value, {}}, seen};
  };
  OutputRanks many{"many", 900, 0, {}, false}, small = many, none = many;
  for (int k = 0; k < 9; ++k) {
    all.dispersions.push_back("d" + std::to_string(k));
    many.effects.push_back(effect(k < 6 ? 0.9 - 0.05 * k : -0.15, k < 8)); // d8: not visible
    small.effects.push_back(effect(0.1 + 0.01 * k, k < 3));
    none.effects.push_back(effect(0.1, false));
  }
  small.output = "small", none.output = "none";
  all.outputs = {many, small, none};
  std::istringstream words(moved_by_table(all, "t"));
  std::string text, word;
  while (words >> word) text += word + ' ';
  CHECK_THAT(text, Catch::Contains("d4 0.70, and 3 others with visible effect, at most 0.65 ") &&
                       Catch::Contains("small 3 dispersions with visible effect, at most 0.12 ") &&
                       Catch::Contains("no visible effect on none"));
  for (OutputRanks& output : all.outputs) // of one replicate nothing is known of the others
    for (RankEffect& each : output.effects) each.spearman.bounds = {}, each.seen = true;
  CHECK(moved_by_table(all, "t").find("visible effect, at most") == std::string::npos);
}

TEST_CASE("up to three runs are told to be too few, not to have no effect or draws that vary") {
  for (std::size_t runs = 0; runs < 6; ++runs) {
    std::vector<double> rising;
    for (std::size_t k = 0; k < runs; ++k) rising.push_back(static_cast<double>(k));
    const RankSensitivity all = rank_sensitivity(results_of({rising}, rising), 0.95);
    const std::vector<std::string> said = warnings(all);
    const std::string table = moved_by_table(all, "t");
    CAPTURE(runs, said, table);
    const bool few = runs < 4;
    const auto tells = [&](const std::string& text, const char* fact) {
      return text.find(fact) != std::string::npos;
    };
    CHECK(std::ranges::any_of(said, [&](const std::string& each) {
            return tells(each, "too few") && tells(each, "takes 4");
          }) == few);
    CHECK(tells(table, "too few") == few);
    CHECK(tells(table, "x0 1.00") == !few);
    for (const std::string& each : said)
      CHECK_FALSE((tells(each, "no visible effect") || tells(each, "do not vary")));
    CHECK_FALSE(tells(table, "no visible effect"));
    CHECK((all.idle.empty() && all.unvaried.empty()));
  }
}

TEST_CASE("effects on peaks that t_end cut are told to be those on the cut values") {
  const auto ranks = [](double t_end) {
    const Campaign campaign = campaign_of(ringing_panel(40, t_end, 0));
    return rank_sensitivity(rows_of(RunPlan(campaign), {0, 40}), 0.9);
  };
  const RankSensitivity cut = ranks(2.3);
  CHECK_THAT(warnings(cut).at(0), Catch::StartsWith("in 40 of 40 runs t_end cut the peaks of "
                                                    "\"root.peak_moment\", \"root.peak_force\": "));
  CHECK(sensitivity_json(cut, {})["outputs"]["root.peak_moment"]["cut"] == 40);
  CHECK(sensitivity_json(cut, {})["outputs"]["root.latch_time"]["cut"] == 0);
  CHECK_THAT(sensitivity_table(cut, "t"),
             Catch::Contains("root.peak_moment, N·m · 40 runs · 40 cut by t_end\n"));
  const RankSensitivity whole = ranks(15); // of forces there is no proof
  CHECK_THAT(warnings(whole).at(0),
             Catch::StartsWith("in 40 of 40 runs t_end cut the peaks of \"root.peak_force\": "));
}

TEST_CASE("rank coefficients and their bounds stand under their names, in JSON and CSV") {
  RankSensitivity all;
  all.runs = 90;
  all.dispersions = {"spring"};
  const RankEffect effect{{0.25, {0.125, 0.375}}, {-0.5, {-0.75, -0.0625}}};
  all.outputs.push_back({"x.latch_time", 80, 10, {effect}, false, 7});
  const Json output = sensitivity_json(all, {})["outputs"]["x.latch_time"];
  CHECK((output["count"] == 80 && output["missing"] == 10 && output["cut"] == 7));
  CHECK(output["dispersions"]["spring"] ==
        Json{{"spearman", {{"value", 0.25}, {"lower", 0.125}, {"upper", 0.375}}},
             {"prcc", {{"value", -0.5}, {"lower", -0.75}, {"upper", -0.0625}}}});
  const auto rows = rows_by_name(sensitivity_csv(all));
  REQUIRE(rows.size() == 1);
  CHECK(rows[0] == CsvRow{{"output", "x.latch_time"},
                          {"dispersion", "spring"},
                          {"count", "80"},
                          {"missing", "10"},
                          {"spearman", "0.25"},
                          {"spearman_lower", "0.125"},
                          {"spearman_upper", "0.375"},
                          {"prcc", "-0.5"},
                          {"prcc_lower", "-0.75"},
                          {"prcc_upper", "-0.0625"}});
}

TEST_CASE("the short table has the larger of two coefficients by size, or the one that is known") {
  const std::vector<double> some{std::nan(""), -0.9, -0.4, 0.3, 0.7};
  for (const double spearman : some)
    for (const double partial : some) {
      RankSensitivity all;
      all.runs = 90;
      all.dispersions = {"spring"};
      all.outputs.push_back(
          {"root.latch_time", 90, 0, {RankEffect{{spearman, {}}, {partial, {}}, true}}, false});
      const bool any = !std::isnan(spearman) || !std::isnan(partial);
      const double larger = std::isnan(partial)                      ? spearman
                            : std::isnan(spearman)                   ? partial
                            : std::abs(spearman) > std::abs(partial) ? spearman
                                                                     : partial;
      CAPTURE(spearman, partial);
      const std::string table = moved_by_table(all, "t");
      CHECK((table.find(fmt::format("root.latch_time               spring {:.2f}\n", larger)) !=
             std::string::npos) == any);
    }
}
