#include "tests/cli/program.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// All wings latch within 6 s: 40 runs would show 90 % at 90 %, were they different ones.
Json undispersed(Json dispersions) {
  Json json = quick_campaign(40);
  json["dispersions"] = std::move(dispersions);
  json["requirements"] = {
      {{"output", "deployed"}, {"probability", 0.9}, {"confidence", 0.9}},
      {{"output", "root.latch_time"}, {"max", 6}, {"probability", 0.9}, {"confidence", 0.9}},
      {{"output", "root.latch_time"}, {"max", 1}, {"probability", 0.9}, {"confidence", 0.9}}};
  return json;
}

Json stowed_torque_by(Json distribution) {
  return {{"name", "s"},
          {"distribution", std::move(distribution)},
          {"apply", "scale"},
          {"to", {"hinges.root.spring.torque_stowed"}}};
}

constexpr const char* one_run_warning = "nothing is dispersed: all 40 runs are the same run";

} // namespace

TEST_CASE("runs that are all the same show no probability, and say so everywhere") {
  const Folder folder;
  const auto constant = parse_json(R"({ "type": "constant", "value": 1 })");
  const auto one_atom =
      parse_json(R"({ "type": "discrete", "values": [1, 2], "weights": [1, 0] })");
  for (const Json& dispersions : {Json::array(), Json::array({stowed_torque_by(constant)}),
                                  Json::array({stowed_torque_by(one_atom)})}) {
    const std::string file = folder.write("c.json", undispersed(dispersions).dump());
    CAPTURE(dispersions.dump());
    const auto checked = run_program(folder, {"check", file});
    CHECK(checked.code == 0);
    CHECK_THAT(checked.error, HasFacts({"/dispersions", "all 40 runs are the same run"}));
    CHECK(run_program(folder, {"check", file, "--strict"}).code == 2);
    const std::string with_rows = folder.path() / "rows", without = folder.path() / "no_rows";
    for (const std::string& out : {with_rows, without}) {
      std::filesystem::remove_all(out);
      std::vector<std::string> words{"run", file, "--out", out, "--table"};
      if (out == without) words.emplace_back("--no-rows");
      const auto ran = run_program(folder, words);
      CHECK(ran.code == 1);
      CHECK_THAT(ran.out, Catch::Contains("nothing is dispersed"));
      CHECK_THAT(ran.error, Catch::Contains("deployed") && Catch::Contains("undecided") &&
                                Catch::Contains("No probability is shown"));
      CHECK(ran.error.find("--until") == std::string::npos); // more of the same run decide nothing
      const Json summary = parse_json_file(std::filesystem::path(out) / summary_file);
      CHECK(summary["warnings"][0].get<std::string>().starts_with(one_run_warning));
      const Json& requirements = summary["requirements"];
      CHECK(requirements[0]["verdict"] == "undecided");
      CHECK(requirements[0]["guaranteed"]["share"].is_null());
      CHECK(requirements[1]["verdict"] == "undecided");
      CHECK(requirements[1]["margin"].is_null());
      CHECK(requirements[2]["verdict"] == "fail"); // one run is enough to break it
    }
    CHECK(run_program(folder, {"report", with_rows}).code == 0);
    const Json set = page_data(with_rows + "/report.html")["sets"][0];
    CHECK(set["warnings"][0].get<std::string>().starts_with(one_run_warning));
    CHECK(set["requirements"][0]["verdict"] == "open");
    CHECK(set["requirements"][0]["guaranteed"].is_null());
  }
}

TEST_CASE("few runs that are all the same are not said to need more of them") {
  const Folder folder;
  Json json = undispersed(Json::array());
  json["sampling"]["runs"] = 5; // 22 would show 90 % at 90 %, were they different ones
  const std::string file = folder.write("c.json", json.dump());
  const auto ran = run_program(folder, {"run", file, "--out", folder.path() / "r"});
  const auto checked = run_program(folder, {"check", file});
  CHECK_THAT(ran.error, HasFacts({"deployed", "undecided", "all 5 runs are the same"}));
  for (const std::string& text : {ran.error, checked.out})
    CHECK_THAT(text, !Catch::Contains("it takes") && !Catch::Contains("--resume"));
}

TEST_CASE("the note on further tests is printed for any case that they may decide", "[cases]") {
  const auto law = parse_json(R"({ "type": "normal", "mean": 1, "std": 0.01 })");
  Json json = undispersed(Json::array({stowed_torque_by(law)}));
  const DoneCampaign done(json);
  const Results results = read_stored_results(read_stored_campaign(done.path)).results;
  auto times = std::ranges::find(results.outputs, "root.latch_time", &Column::name)->values;
  std::ranges::sort(times);
  json["requirements"] = Json::array({{{"output", "root.latch_time"},
                                       {"max", times[35]}, // four of 40 runs break it, one may
                                       {"probability", 0.9},
                                       {"confidence", 0.9}}});
  const auto spread = parse_json(R"({ "name": "spread" })"), fixed = parse_json(R"({
    "name": "fixed", "distributions": { "s": { "type": "constant", "value": 1 } } })");
  for (const Json& cases : {Json::array({spread, fixed}), Json::array({fixed, spread})}) {
    json["cases"] = cases;
    const std::string name = cases[0]["name"];
    const std::string file = done.folder.write("c.json", json.dump());
    const auto ran = done.program({"run", file, "--out", done.folder.path() / name});
    CAPTURE(name, ran.error);
    CHECK_THAT(ran.error, HasFacts({"root.latch_time", "note: each further test", "--resume"}));
  }
}

TEST_CASE("margin, rare and goals to stop at are refused where nothing is dispersed") {
  const Folder folder;
  const std::string file = folder.write("c.json", undispersed(Json::array()).dump());
  const auto constant = stowed_torque_by(parse_json(R"({ "type": "constant", "value": 1 })"));
  const std::string one_value = folder.write("o.json", undispersed(Json::array({constant})).dump());
  const std::string out = folder.path() / "out";
  const auto margin = run_program(folder, {"margin", file, "--scale", "hinges.*.spring.scale",
                                           "--range", "0.9", "1.2", "--out", out});
  CHECK(margin.code == 2);
  CHECK_THAT(margin.error, HasFacts({"/dispersions: found none, expected a parameter that varies",
                                     "show no probability"}));
  const auto rare = run_program(
      folder, {"rare", one_value, "--output", "root.latch_time", "--above", "3", "--out", out});
  CHECK(rare.code == 2);
  CHECK_THAT(rare.error, HasFacts({"/dispersions: found laws with a single value only"}));
  for (const char* goal : {"requirement deployed", "deployed 1 %"}) {
    const auto run = run_program(folder, {"run", file, "--out", out, "--until", goal});
    CHECK(run.code == 2);
    CHECK_THAT(run.error, HasFacts({"/until: found goals to stop at, though nothing is dispersed",
                                    "wingspread simulate"}));
  }
  CHECK_FALSE(std::filesystem::exists(out));
  Json json = undispersed(Json::array(
      {stowed_torque_by(parse_json(R"({ "type": "normal", "mean": 1, "std": 0.01 })"))}));
  CHECK(run_program(folder, {"run", folder.write("v.json", json.dump()), "--out", out, "--until",
                             "deployed 50 %"})
            .code != 2);
}

TEST_CASE("goals and check look at each case: one that does not vary is named") {
  const Folder folder;
  Json json = undispersed(
      Json::array({stowed_torque_by(parse_json(R"({ "type": "constant", "value": 1 })"))}));
  json["cases"] = parse_json(R"([ { "name": "amb" }, { "name": "hot", "distributions": {
    "s": { "type": "normal", "mean": 1, "std": 0.01 } } } ])");
  const std::string file = folder.write("c.json", json.dump()), out = folder.path() / "out";
  const std::vector<std::string> words{"run", file,      "--out",
                                       out,   "--until", "requirement deployed"};
  const auto refused = run_program(folder, words);
  CHECK(refused.code == 2);
  CHECK_THAT(refused.error, HasFacts({"/until: found goals to stop at", "in case amb"}));
  CHECK_FALSE(std::filesystem::exists(out));
  std::vector<std::string> one = words;
  one.insert(one.end(), {"--case", "hot"});
  CHECK(run_program(folder, one).code <= 1);
  CHECK_THAT(run_program(folder, {"check", file}).error,
             HasFacts({"/dispersions", "in case amb", "all 40 runs are the same run"}));
}

TEST_CASE("a law with any spread, in the campaign or in a case, is not warned of") {
  const Folder folder;
  Json json = undispersed(Json::array(
      {stowed_torque_by(parse_json(R"({ "type": "normal", "mean": 1, "std": 0.01 })"))}));
  const auto error = [&] {
    return run_program(folder, {"check", folder.write("c.json", json.dump())}).error;
  };
  CHECK(error().find("the same run") == std::string::npos);
  json["dispersions"][0]["distribution"] = parse_json(R"({ "type": "constant", "value": 1 })");
  json["cases"] = parse_json(R"([ { "name": "worn", "distributions": {
    "s": { "type": "normal", "mean": 1, "std": 0.01 } } } ])");
  CHECK(error().find("the same run") == std::string::npos);
}

TEST_CASE("check names correlated dispersions that a stratified design does not stratify") {
  const Folder folder;
  Json json = quick_campaign(40);
  json["correlations"] =
      parse_json(R"([ { "between": ["root_spring", "mass.panel_1"], "spearman": 0.5 } ])");
  const auto told = [&](const char* design) {
    json["sampling"]["design"] = design;
    return run_program(folder, {"check", folder.write("c.json", json.dump())}).out;
  };
  CHECK_THAT(told("latin_hypercube"), Catch::Contains("root_spring is not stratified"));
  CHECK_THAT(told("sobol"), Catch::Contains("root_spring is not stratified"));
  CHECK_THAT(told("random"), !Catch::Contains("not stratified"));
}
