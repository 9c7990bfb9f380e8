#include "montecarlo/engine/runs/run_plan.hpp"
#include "montecarlo/model/campaign/dispersion.hpp"
#include "montecarlo/results/results_folder/replay.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <numbers>
#include <set>

using namespace wingspread;
using namespace wingspread::test;

namespace {

constexpr const char* table = "spring,mass,unused\n0.9,9,0\n1.1,11,0\n1,10.5,0\n1.05,9.5,0\n";

/// The seed scene with a spring and a mass of one table, and a dispersion of its own.
Json rows_campaign(const std::filesystem::path& folder, int runs) {
  write_file(folder / "posterior.csv", table);
  Json json = quick_campaign(runs);
  json["dispersions"].erase(1);
  json["dispersions"][0]["name"] = "own";
  json["dispersions"].push_back(parse_json(R"({ "name": "fitted",
    "rows": { "file": "posterior.csv", "apply": "scale",
              "columns": { "spring": "hinges.*.spring.scale",
                           "mass": { "to": ["bodies.panel_1.mass"], "apply": "set" } } } })"));
  return json;
}

std::string problems_of_rows(const std::string& rows, const char* more = "") {
  const Folder folder;
  Json json = rows_campaign(folder.path(), 1);
  json["dispersions"][1]["rows"] = parse_json(rows);
  if (*more) json.update(parse_json(more));
  std::string message = message_of([&] { return read_campaign(json.dump(), folder.path()); });
  if (const auto at = message.find(folder.path().string()); at != std::string::npos)
    message.replace(at, folder.path().string().size() + 1, "");
  return message;
}

} // namespace

TEST_CASE("columns of rows are drawn together, in every design, each row equally often") {
  const Folder folder;
  for (const char* design : {"random", "latin_hypercube", "sobol"}) {
    Json json = rows_campaign(folder.path(), 64);
    json["sampling"]["design"] = design;
    const Campaign campaign = read_campaign(json.dump(), folder.path());
    const RunPlan plan(campaign);
    CHECK(plan.names().draws == std::vector<std::string>{"own", "spring", "mass"});
    CHECK(plan.coordinates().names == std::vector<std::string>{"own", "fitted"});
    std::map<std::pair<double, double>, int> seen;
    std::vector<double> draws(3);
    for (long k = 0; k < 64; ++k) {
      plan.draw(k, draws);
      ++seen[{draws[1], draws[2]}];
    }
    const std::map<std::pair<double, double>, int> all{
        {{0.9, 9}, 16}, {{1.1, 11}, 16}, {{1, 10.5}, 16}, {{1.05, 9.5}, 16}};
    if (std::string(design) != "random")
      CHECK(seen == all);
    else
      for (const auto& [row, count] : seen) CHECK(all.contains(row));
    CHECK(seen.size() == 4);
  }
}

TEST_CASE("rows are applied as written, column by column, and replayed alone") {
  const Folder folder, results;
  const Campaign campaign = read_campaign(rows_campaign(folder.path(), 6).dump(), folder.path());
  const RunPlan plan(campaign);
  std::vector<double> draws(3);
  plan.draw(3, draws);
  Scene scene = campaign.scene;
  apply(campaign, draws, campaign.scene, scene);
  CHECK(scene.hinges[0].spring.scale == draws[1]);
  CHECK(scene.hinges[2].spring.scale == draws[1]);
  CHECK(scene.bodies[0].mass == draws[2]);
  const Scene nominal = nominal_scene(campaign);
  CHECK(nominal.hinges[0].spring.scale == 1); // the medians, column by column
  CHECK(nominal.bodies[0].mass == 9.5);
  (void)run_into(results.path() / "out", campaign);
  const StoredCampaign stored = read_stored_campaign(results.path() / "out");
  CHECK(campaign_hash(stored.campaign.resolved) == campaign_hash(campaign.resolved));
  for (const long k : {0L, 5L}) CHECK(ReplayRequest(stored, k).replay({}).differences.empty());
}

TEST_CASE("a resolved campaign has the rows themselves") {
  const Folder folder;
  const Campaign campaign = read_campaign(rows_campaign(folder.path(), 4).dump(), folder.path());
  const Json rows = campaign.resolved["dispersions"][1]["rows"];
  CHECK_FALSE(rows.contains("file"));
  CHECK(rows["values"]["spring"] == Json({0.9, 1.1, 1, 1.05}));
  const Campaign again = read_campaign(campaign.resolved.dump(), "");
  CHECK(again.resolved == campaign.resolved);
  std::vector<double> one(3), other(3);
  RunPlan(campaign).draw(2, one);
  RunPlan(again).draw(2, other);
  CHECK(one == other);
}

TEST_CASE("problems of rows have their places") {
  constexpr const char* good = R"("columns": { "spring": "hinges.*.spring.scale" })";
  const auto with = [&](const std::string& rest) { return problems_of_rows("{ " + rest + " }"); };
  CHECK(with(R"("file": "posterior.csv", "apply": "scale", )" + std::string(good)).empty());
  CHECK(with(R"("file": "none.csv", "apply": "scale", )" + std::string(good)) ==
        "/dispersions/1/rows/file: found no file that can be read at \"none.csv\", expected a CSV "
        "file");
  CHECK(with(std::string(good) + R"(, "apply": "scale")") ==
        "/dispersions/1/rows: found neither a file nor values, expected one of them");
  CHECK(with(R"("file": "posterior.csv", "apply": "scale", "columns": { "x": "bodies.*.mass" })") ==
        "posterior.csv: line 1, column 'x': found no such column, expected the column once in the "
        "header");
  CHECK(with(R"("values": { "a": [1, 2], "b": [1] }, "apply": "set",
                "columns": { "a": "bodies.panel_1.mass", "b": "bodies.panel_2.mass" })") ==
        "/dispersions/1/rows: found 1 rows in the column \"b\", expected 2, as in the others");
  CHECK(with(R"("values": { "a": [1, 2], "c": [1, 2] }, "apply": "set",
                "columns": { "a": "bodies.panel_1.mass" })")
            .find("the unknown key \"c\"") != std::string::npos);
  CHECK(with(R"("file": "posterior.csv", "apply": "scale", "columns": {})").find("at least one") !=
        std::string::npos);
  CHECK(with(R"("file": "posterior.csv", "apply": "scale", "columns": { "mass": "bodies.x.mass" })")
            .starts_with("/dispersions/1/rows/columns/mass"));
  CHECK(problems_of_rows(
            R"({ "file": "posterior.csv", "apply": "scale",
                              "columns": { "spring": "hinges.*.spring.scale" } })",
            R"({ "correlations": [ { "between": ["own", "spring"], "spearman": 0.5 } ] })") ==
        "/correlations/0/between/1: found \"spring\", a column of the rows \"fitted\", expected a "
        "dispersion with a draw of its own: rows are drawn whole");
  CHECK(problems_of_rows(R"({ "file": "posterior.csv", "apply": "scale",
                              "columns": { "spring": "hinges.*.spring.scale" } })",
                         R"({ "cases": [ { "name": "cold", "distributions": {
                              "fitted": { "type": "constant", "value": 1 } } } ] })") ==
        "/cases/0/distributions/fitted: found \"fitted\", which draws rows, expected the name of a "
        "dispersion with a distribution");
}

TEST_CASE("a unit in a column's header counts, of rows and of an empirical law") {
  const Folder folder;
  folder.write("t.csv",
               "torque [N*mm],angle (deg),factor [-],side (left)\n100,90,1.5,0.25\n200,45,2,0.5\n");
  const auto read = [&](const char* column, const char* path, const char* how, bool rows) {
    Json json = quick_campaign(2);
    const Json effect{{"to", {path}}, {"apply", how}};
    if (rows)
      json["dispersions"] = {
          {{"name", "all"},
           {"rows", {{"file", "t.csv"}, {"apply", how}, {"columns", {{column, effect}}}}}}};
    else
      json["dispersions"] = {
          {{"name", "one"},
           {"to", {path}},
           {"apply", how},
           {"distribution", {{"type", "empirical"}, {"file", "t.csv"}, {"column", column}}}}};
    const Campaign campaign = read_campaign(json.dump(), folder.path());
    return std::get<Empirical>(campaign.dispersions[0].distribution.law).values;
  };
  const char* torque = "hinges.root.spring.torque_stowed";
  for (const bool rows : {true, false}) {
    CAPTURE(rows);
    for (const char* column : {"torque", "torque [N*mm]"}) {
      const std::vector<double> values = read(column, torque, "add", rows);
      CHECK(values[0] == Approx(0.1).epsilon(1e-15));
      CHECK(values[1] == Approx(0.2).epsilon(1e-15));
    }
    CHECK(read("angle", "hinges.root.angle.latched", "add", rows)[0] ==
          Approx(std::numbers::pi / 2).epsilon(1e-15));
    CHECK(read("factor [-]", torque, "scale", rows)[0] == 1.5);
    CHECK(read("side (left)", torque, "add", rows)[1] == 0.5); // no unit, but a name
    for (const auto& [column, how] : {std::pair("angle", "add"), {"torque", "scale"}})
      CHECK_THAT(message_of([&] { (void)read(column, torque, how, rows); }),
                 Catch::Contains(column) && Catch::Contains("the unit \""));
  }
}

TEST_CASE("a unit in a column's header is refused where its parameters have several, or its values "
          "overflow in SI") {
  const auto problems = [](const std::string& header, const std::string& cell,
                           const std::string& to) {
    const Folder folder;
    Json json = rows_campaign(folder.path(), 1);
    write_file(folder.path() / "posterior.csv", header + "\n" + cell + "\n");
    json["dispersions"][1]["rows"]["columns"] = {{"x", {{"to", parse_json(to)}, {"apply", "set"}}}};
    return message_of([&] { return read_campaign(json.dump(), folder.path()); });
  };
  const char* several = R"(["bodies.panel_1.mass", "bodies.panel_1.inertia"])";
  CHECK(problems("x", "9", several).empty());
  CHECK_THAT(problems("x [g]", "9000", several),
             Catch::Contains("the unit \"g\", expected no unit"));
  CHECK(problems("x [g]", "9000", R"(["bodies.*.mass"])").empty());
  CHECK_THAT(problems("x [kg]", "1e309", R"(["bodies.*.mass"])"), Catch::Contains("1e309"));
  CHECK_THAT(problems("x [kN*m]", "1e307", R"(["hinges.root.spring.torque_stowed"])"),
             Catch::Contains("1e307"));
}
