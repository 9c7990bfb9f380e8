#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/scene_file/scene_json.hpp"
#include "montecarlo/model/schema/schema.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>

#include <filesystem>

using namespace wingspread;

namespace {

Campaign read(const Json& document) { return read_campaign(document.dump(), ""); }

std::string problems(const test::Spoiled& change) {
  return test::message_of([&] { return read(test::spoil(test::small_campaign(), change)); });
}

bool same(const Dispersion& a, const Dispersion& b) {
  return a.name == b.name && a.apply == b.apply && a.targets == b.targets;
}

} // namespace

TEST_CASE("What a campaign leaves out has its default", "[campaign_json]") {
  const Campaign campaign = read({{"scene", test::small_scene()}});
  CHECK(campaign.dispersions.empty());
  CHECK(
      campaign.resolved.dump() ==
      R"({"scene":)" + write_scene(campaign.scene).dump() + R"(,"dispersions":[],)" +
          R"("sampling":{"design":"random","runs":1000,"seed":1,"replicates":1},)" +
          R"("integration":{"method":"auto","rtol":1e-08,"atol":1e-10,"latch":"event",)" +
          R"("t_end":60.0,"max_steps":1000000},)" +
          R"("outputs":["latch_time","latch_rate","peak_moment","peak_force","overtravel","peaks_final"],)" +
          R"("statistics":{"quantiles":[0.01,0.5,0.99],"confidence":0.95,"bins":"auto"}})");
}

TEST_CASE("A campaign as resolved reads back to itself", "[campaign_json]") {
  Json document = test::small_campaign();
  document["sampling"] = {{"runs", 7}, {"seed", 9}, {"replicates", 3}};
  document["integration"] = {{"latch", {{"smoothed", 0.1}}}, {"rtol", 1e-5}};
  document["outputs"] = {"rate_at"};
  document["statistics"] = {{"bins", 12}};
  const Campaign first = read(document);
  const Campaign second = read(first.resolved);
  CHECK(second.resolved == first.resolved);
  CHECK(write_scene(second.scene) == write_scene(first.scene));
  CHECK(std::ranges::equal(second.dispersions, first.dispersions, same));
  CHECK(second.sampling.runs == 7);
  CHECK(second.integration.smoothing == 0.1);
  CHECK(second.outputs == Outputs{OutputFamily::rate_at, OutputFamily::overtravel});
}

TEST_CASE("Overtravel is recorded, asked for or not, but not of what was run before",
          "[campaign_json]") {
  Json document = test::small_campaign();
  document["outputs"] = Json::array();
  CHECK(read(document).outputs == Outputs{OutputFamily::overtravel});
  document["wingspread"] = {{"version", "0.1.0"}, {"seed", 1}, {"hash", "0"}};
  CHECK(read(document).outputs.empty());
}

TEST_CASE("A results folder's stamp is known and of no account", "[campaign_json]") {
  Json stamped = read(test::small_campaign()).resolved;
  const std::string hash = campaign_hash(stamped);
  stamped["wingspread"] = {{"version", "0.1.0"}, {"seed", 1}, {"hash", hash}};
  CHECK(read(stamped).resolved == read(test::small_campaign()).resolved);
  CHECK(campaign_hash(stamped) == hash);
}

TEST_CASE("Runs and seed may be replaced, and what is resolved follows", "[campaign_json]") {
  Campaign campaign = read(test::small_campaign());
  override_sampling(campaign, 12, std::nullopt);
  CHECK(campaign.sampling.runs == 12);
  CHECK(campaign.sampling.seed == 1);
  override_sampling(campaign, std::nullopt, 5);
  CHECK(campaign.resolved["sampling"].dump() ==
        R"({"design":"random","runs":12,"seed":5,"replicates":1})");
  CHECK(read(campaign.resolved).resolved == campaign.resolved);
}

TEST_CASE("The runs are not made fewer than a design's replicates", "[campaign_json]") {
  const auto refusal = [](const char* design) {
    Json document = test::small_campaign();
    document["sampling"] = {{"design", design}, {"runs", 64}, {"replicates", 16}};
    Campaign campaign = read(document);
    override_sampling(campaign, 16, std::nullopt);
    return test::message_of([&] {
      override_sampling(campaign, 15, std::nullopt);
      return 0;
    });
  };
  CHECK(refusal("sobol") == "--runs: found 15, expected at least 16, one for each of the "
                            "campaign's replicates");
  CHECK(refusal("random").empty()); // where replicates do not matter
}

TEST_CASE("More dispersions than Sobol' points have coordinates are refused", "[campaign_json]") {
  Json document = test::small_campaign();
  for (int i = 0; i < 3665; ++i)
    document["dispersions"].push_back(
        {{"name", "bias_" + std::to_string(i)},
         {"distribution", {{"type", "uniform"}, {"lower", 0}, {"upper", 1}}},
         {"apply", "add"},
         {"to", {"bodies.inner.mass"}}});
  const auto refusal = [&](const char* design) {
    document["sampling"]["design"] = design;
    return test::message_of([&] { return read(document); });
  };
  CHECK(refusal("sobol") ==
        "/dispersions: found 3668 dispersions, expected up to 3667 with the design \"sobol\"");
  CHECK(refusal("latin_hypercube").empty());
}

TEST_CASE("Each fault of a campaign is told", "[campaign_json]") {
  const test::Spoiled change = GENERATE(values<test::Spoiled>(
      {{"", "[]", "found an array of 0, expected a campaign: an object"},
       {"/scene", "",
        "/scene: found nothing, expected a scene, or the name of the file that holds it"},
       {"/scene", "3", "/scene: found 3, expected a scene: an object"},
       {"/scene/bodies/0/mass", "-1", "/scene/bodies/0/mass: found -1, expected > 0"},
       {"/scene", "\"none.json\"",
        "/scene: found no file that can be read at \"none.json\", expected a scene, or the name of "
        "the "
        "file that holds it"},
       {"/dispersions/0/to/1", "\"hinges.root.spring.torque\"",
        "/dispersions/0/to/1: found string \"hinges.root.spring.torque\", expected the path of a "
        "parameter (did you mean \"hinges.root.spring.scale\"?)"},
       {"/sampling", R"({"runs": -5})", "/sampling/runs: found -5, expected an integer, ≥ 1"},
       {"/outputs", R"(["base_motion"])",
        "/outputs: found \"base_motion\" with a base that is not free, expected a base whose "
        "motion is "
        "\"free\""},
       {"/output", "[]",
        "/output: found the unknown key \"output\", expected \"scene\", \"dispersions\", "
        "\"cases\", \"case\", \"sampling\", \"integration\", \"outputs\", \"statistics\", "
        "\"report\", \"correlations\", \"requirements\", \"until\", \"motorization\", \"margin\", "
        "\"wingspread\" or \"$schema\" (did you mean \"outputs\"?)"}}));
  CAPTURE(change.pointer, change.value);
  CHECK(test::facts_of(problems(change)) == test::facts_of(change.message));
}

TEST_CASE("What holds for independent draws only is refused with other designs",
          "[campaign_json]") {
  const std::string design = GENERATE("latin_hypercube", "sobol");
  Json document = test::small_campaign();
  document["sampling"] = {{"design", design}};
  document["correlations"] =
      parse_json(R"([{ "between": ["spring", "mass.inner"], "spearman": 0.5 }])");
  document["requirements"] =
      parse_json(R"([{ "output": "deployed", "probability": 0.99, "confidence": 0.9 }])");
  document["until"] = parse_json(R"([{ "output": "stalled", "width": 0.01 }])");
  document["statistics"] = {{"tolerance", {{{"probability", 0.95}, {"confidence", 0.95}}}}};
  const std::string message = test::message_of([&] { return read(document); });
  const std::string reason = " with the design \"" + design + "\", expected the design \"random\"";
  CHECK_THAT(message,
             Catch::Contains("/requirements: found requirements" + reason) &&
                 Catch::Contains("/until: found goals to stop at" + reason) &&
                 Catch::Contains("/statistics/tolerance: found tolerance limits" + reason));
}

TEST_CASE("Requirements and widths name the campaign's outputs", "[campaign_json]") {
  Json document = test::small_campaign();
  document["outputs"] = {"latch_time"};
  document["requirements"] = parse_json(
      R"([{ "output": "root.latch_time", "max": 9, "probability": 0.99, "confidence": 0.9 }])");
  document["until"] =
      parse_json(R"([{ "output": "root.latch_time", "quantile": 0.5, "relative_width": 0.01 }])");
  Campaign campaign = read(document);
  CHECK(campaign.resolved["requirements"].dump() ==
        R"([{"output":"root.latch_time","max":9.0,"probability":0.99,"confidence":0.9}])");
  CHECK(campaign.resolved["until"] == document["until"]);
  CHECK(read(campaign.resolved).resolved == campaign.resolved);
  CHECK(interim_analyses(campaign).count() == 1); // of 1000 runs
  override_sampling(campaign, 5000, {});
  CHECK(interim_analyses(campaign).count() == 4);
  document["requirements"][0]["output"] = "root.peak_force";
  document["until"][0]["output"] = "root.latch_tim";
  CHECK(
      test::message_of([&] { return read(document); }) ==
      "/requirements/0/output: found string \"root.peak_force\", expected an output that the "
      "campaign asks for (\"peak_force\" is not in its \"outputs\")\n"
      "/until/0/output: found string \"root.latch_tim\", expected an output of the campaign, or a "
      "status (did you mean \"root.latch_time\"?)");
}

TEST_CASE("A campaign that asks for nothing new keeps its hash", "[campaign_json]") {
  Json document = test::small_campaign();
  const Json before = read(document).resolved;
  document["requirements"] = Json::array();
  document["until"] = Json::array();
  CHECK(read(document).resolved == before);
}

TEST_CASE("All faults of a campaign are told together", "[campaign_json]") {
  Json document = test::small_campaign();
  document["scene"]["name"] = 1;
  document["dispersions"][0]["apply"] = "times";
  document["integration"] = {{"rtol", 2}};
  document["statistics"] = {{"confidence", 2}};
  CHECK(test::message_of([&] { return read_campaign(document.dump(), "", "c.json"); }) ==
        "c.json: /scene/name: found 1, expected a string, the scene's name, not empty, "
        "without control characters\n"
        "c.json: /dispersions/0/apply: found string \"times\", expected \"set\", \"scale\" or "
        "\"add\"\n"
        "c.json: /integration/rtol: found 2, expected a number, ≥ 1e-15 and < 1, for example 1e-8\n"
        "c.json: /statistics/confidence: found 2, expected a number, > 0 and < 1");
}

TEST_CASE("Any one change is told in full, or leaves a campaign that reads back to itself",
          "[campaign_json]") {
  const Json document = read(test::small_campaign()).resolved;
  const char* value = GENERATE("", "null", "true", "-1", "0", "1e308", "2.5", "\"\"", "\"root\"",
                               "\"hinges.*.latch.stiffness\"", "[]", "[1, 2]", "[[]]", "{}",
                               R"({"name": "inner"})");
  std::vector<std::string> places;
  const Json leaves = document.flatten();
  for (const auto& [pointer, leaf] : leaves.items())
    for (std::string at = pointer; !at.empty(); at.erase(at.rfind('/'))) places.push_back(at);
  for (const std::string& place : places) {
    CAPTURE(place, value);
    const Json changed = test::spoil(document, {place.c_str(), value, ""});
    try {
      const Json resolved = read(changed).resolved;
      CHECK(read(resolved).resolved == resolved);
    } catch (const SpecError& error) {
      for (const Problem& problem : error.problems())
        CHECK_FALSE((problem.found + problem.expected).empty());
    } // anything else that is thrown fails the test
  }
}

TEST_CASE("Files are looked for beside the campaign, and end up inside it", "[campaign_json]") {
  const test::Folder folder;
  Json document = test::small_campaign();
  document["scene"] = "scene.json";
  document["dispersions"][0]["distribution"] = {
      {"type", "empirical"}, {"file", "k.csv"}, {"column", "k"}};
  folder.write("scene.json", test::small_scene().dump());
  folder.write("k.csv", "k\n1.5\n2\n");
  const Campaign campaign = read_campaign_file(folder.write("campaign.json", document.dump()));
  CHECK(campaign.scene.name == "small");
  CHECK(campaign.resolved["dispersions"][0]["distribution"].dump() ==
        R"({"type":"empirical","values":[1.5,2.0]})");
  CHECK(read(campaign.resolved).resolved == campaign.resolved);
}

TEST_CASE("A problem in the scene's own file is told under its name", "[campaign_json]") {
  const test::Folder folder;
  const auto scene =
      folder.write("scene.json", test::spoil(test::small_scene(), {"/name", "", ""}).dump());
  const auto path = folder.write("campaign.json", R"({"scene": "scene.json", "sampling": 3})");
  CHECK(test::message_of([&] { return read_campaign_file(path); }) ==
        scene.string() +
            ": /name: found nothing, expected a string, the scene's name, not empty, "
            "without control characters\n" +
            path.string() + ": /sampling: found 3, expected an object with the sampling");
  folder.write("scene.json", "{");
  CHECK_THAT(test::message_of([&] { return read_campaign_file(path); }),
             Catch::StartsWith(scene.string() + ": found line 1, column 2: syntax error") &&
                 Catch::Contains("/sampling: found 3"));
}

TEST_CASE("A file is a scene or a campaign by its keys", "[campaign_json]") {
  const test::Folder folder;
  const auto kind = [&](const char* text) {
    return test::message_of([&] { return read_file(folder.write("f.json", text)); });
  };
  CHECK(
      std::holds_alternative<Scene>(read_file(folder.write("f.json", test::small_scene().dump()))));
  CHECK(std::holds_alternative<Campaign>(
      read_file(folder.write("f.json", test::small_campaign().dump()))));
  CHECK(read_scene_file(folder.write("f.json", test::small_scene().dump())).bodies.size() == 2);
  CHECK_THAT(kind(R"({"sampling": {}})"),
             Catch::EndsWith("/scene: found nothing, expected a scene, or "
                             "the name of the file that holds it"));
  CHECK_THAT(kind("[]"), Catch::EndsWith("found an array of 0, expected a scene: an object"));
}

TEST_CASE("Exact friction is read and resolved wherever the scene stands", "[campaign_json]") {
  const test::Folder folder;
  const Json friction{{"model", "exact"}, {"coulomb", 0.1}, {"viscous", 0.01}, {"static", 0.15}};
  Json scene = test::small_scene();
  scene["hinges"][1]["friction"] = friction;
  const auto file = folder.write("scene.json", scene.dump());
  const Campaign inside = read({{"scene", scene}});
  const Campaign beside = read_campaign(R"({"scene": "scene.json"})", folder.path());
  for (const Scene& read : {inside.scene, beside.scene, read_scene_file(file)}) {
    CHECK(read.hinges[1].friction.model == FrictionModel::exact);
    CHECK(read.hinges[1].friction.static_level == 0.15);
  }
  CHECK(inside.resolved["scene"]["hinges"][1]["friction"] == friction);
  CHECK(read(inside.resolved).resolved == inside.resolved);
}

TEST_CASE("A fixed step is part of what tells campaigns apart", "[campaign_json]") {
  const auto hash_with = [](const Json& integration) {
    Json document = test::small_campaign();
    document["integration"] = integration;
    const Campaign campaign = read(document);
    CHECK(read(campaign.resolved).resolved == campaign.resolved);
    return campaign_hash(campaign.resolved);
  };
  const std::string by_default = hash_with({{"method", "runge_kutta4"}});
  CHECK(hash_with({{"method", "runge_kutta4"}, {"step", 1e-4}}) == by_default);
  CHECK(hash_with({{"method", "runge_kutta4"}, {"step", 2e-4}}) != by_default);
}

TEST_CASE("Correlated independent draws may have requirements, and all of it reads back",
          "[campaign_json]") {
  Json document = test::small_campaign();
  document["correlations"] =
      parse_json(R"([{ "between": ["spring", "mass.inner"], "spearman": 0.5 }])");
  document["requirements"] =
      parse_json(R"([{ "output": "deployed", "probability": 0.99, "confidence": 0.9 }])");
  document["until"] = parse_json(R"([{ "output": "stalled", "width": 0.01 }])");
  const Campaign campaign = read(document);
  CHECK((campaign.wanted_correlations.size() == 1 && campaign.requirements.size() == 1));
  CHECK(campaign.until.size() == 1);
  CHECK(read(campaign.resolved).resolved == campaign.resolved);
}

TEST_CASE("An output that is not known is told beside the faults of other parts",
          "[campaign_json]") {
  Json document = test::small_campaign();
  document["correlations"] = parse_json(R"([{ "between": ["spring", "no"], "spearman": 0.5 }])");
  document["requirements"] =
      parse_json(R"([{ "output": "deploys", "probability": 0.99, "confidence": 0.9 }])");
  const auto message = [&] { return test::message_of([&] { return read(document); }); };
  CHECK_THAT(message(), Catch::Contains("/correlations/0/between/1: ") &&
                            Catch::Contains("/requirements/0/output: found string \"deploys\""));
  document["outputs"] = {"no_family"}; // then nobody knows which outputs there are
  CHECK_THAT(message(),
             Catch::Contains("/outputs/0: ") && !Catch::Contains("/requirements/0/output"));
}

TEST_CASE("A requirement to be decided is one of the campaign's", "[campaign]") {
  Json document = test::small_campaign();
  document["requirements"] =
      parse_json(R"([{ "output": "deployed", "probability": 0.99, "confidence": 0.9 }])");
  document["until"] = parse_json(R"([{ "requirement": "deployed" }])");
  const Campaign campaign = read(document);
  CHECK(campaign.resolved["until"] == document["until"]);
  CHECK(read(campaign.resolved).resolved == campaign.resolved);
  document["until"][0]["requirement"] = "deploy";
  CHECK(test::message_of([&] { return read(document); }) ==
        "/until/0/requirement: found string \"deploy\", expected a requirement of the campaign, by "
        "its "
        "name or its output (did you mean \"deployed\"?)");
  document["requirements"][0]["probability"] = 2; // one that is wrong itself is not missed
  CHECK(test::message_of([&] { return read(document); }) ==
        "/requirements/0/probability: found 2, expected a number, > 0 and < 1");
}

TEST_CASE("An extended campaign's looks are its own, and none of another seed's", "[campaign]") {
  Json document = test::small_campaign();
  document["sampling"] = {{"runs", 4000}, {"extended_from", {1000, 2000}}};
  Campaign campaign = read(document);
  CHECK(interim_analyses(campaign).count() == 3);
  CHECK(read(campaign.resolved).resolved == campaign.resolved);
  override_sampling(campaign, 2000, std::nullopt);
  CHECK(campaign.resolved["sampling"]["extended_from"] == Json::array({1000}));
  override_sampling(campaign, 8000, campaign.sampling.seed); // given, but its own: the same draws
  CHECK(interim_analyses(campaign).count() == 2);
  override_sampling(campaign, 8000, 77);
  CHECK_FALSE(campaign.resolved["sampling"].contains("extended_from"));
  CHECK(interim_analyses(campaign).count() == 1);
  document["until"] = parse_json(R"([{ "output": "stalled", "width": 0.01 }])");
  CHECK_THAT(test::message_of([&] { return read(document); }),
             Catch::StartsWith("/until: found goals to stop at") && Catch::Contains("extended"));
}

TEST_CASE("a scene or a dispersion with a problem of its own causes no other one in the campaign") {
  const auto lines = [](const Json& campaign) {
    std::istringstream said(test::message_of([&] { return read_campaign(campaign.dump(), ""); }));
    std::vector<std::string> found;
    for (std::string line; std::getline(said, line);) found.push_back(line);
    return found;
  };
  for (const Json& campaign : campaign_specimens()) {
    if (!lines(campaign).empty()) continue; // it names files that are not there
    CAPTURE(campaign.dump().substr(0, 200));
    Json spoilt = campaign;
    spoilt["scene"]["bodies"][0]["mass"] = "heavy";
    CHECK_THAT(lines(spoilt).at(0), Catch::StartsWith("/scene/bodies/0/mass: "));
    CHECK(lines(spoilt).size() == 1);
    if (!campaign.contains("dispersions") || campaign["dispersions"].empty()) continue;
    spoilt = campaign;
    spoilt["dispersions"][0]["to_"] = 1;
    CHECK_THAT(lines(spoilt).at(0), Catch::StartsWith("/dispersions/0/to_: "));
    CHECK(lines(spoilt).size() == 1);
  }
}
