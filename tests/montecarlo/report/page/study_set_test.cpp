#include "montecarlo/analyses/fit/fit_report.hpp"
#include "montecarlo/analyses/margin/margin_report.hpp"
#include "montecarlo/analyses/rare/rare_report.hpp"
#include "montecarlo/analyses/sensitivity/design_folder.hpp"
#include "montecarlo/analyses/sensitivity/sobol_report.hpp"
#include "montecarlo/foundation/statistics/binomial_bounds.hpp"
#include "montecarlo/report/page/html_page.hpp"
#include "montecarlo/report/page/study_set.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// Indices of so many dispersions d0, d1, …; the total of d_k is k/100, but d1 has none.
SobolIndices climbing_indices(std::size_t count) {
  SobolIndices indices{64, 0, 12.5, 0.75, {}};
  for (std::size_t k = 0; k < count; ++k) {
    const double total = static_cast<double>(k) / 100;
    indices.effects.push_back(
        {{total / 2, {total / 4, total}}, {total, {total / 2, 2 * total}}, false});
  }
  indices.effects[1].total = {std::nan(""), {}};
  return indices;
}

/// A rare.json with what the page reads of it.
Json rare_study() {
  return parse_json(R"({ "wingspread": { "version": "0", "seed": 3, "hash": "h" }, "scene": "wing",
    "event": "not deployed", "beyond": null, "case": "cold", "confidence": 0.9,
    "probability": 2e-5, "lower": 1e-5, "upper": 4e-5, "reached": true, "bias": 0.125,
    "repeats": [ { "levels": [ { "share": 0.5, "threshold": 3.5 }, { "share": 0.125, "threshold": 0 } ] },
                 { "levels": [ { "share": 0.25, "threshold": 1 } ] } ],
    "strata": [
      { "draws": "no rare value", "probability": 0.9, "event": 1e-6, "upper": 2e-6, "reached": true },
      { "draws": "a = 1, b = 9000", "probability": 1e-3, "event": 0, "upper": 0.25, "reached": false },
      { "draws": "c = 0.5", "probability": 1e-5, "event": 1, "upper": 1, "reached": true } ],
    "warnings": [ "doubt" ],
    "likeliest": { "distance": 4.5, "draws": { "a": 1, "b": 2, "c": 3 },
                   "units": { "a": "", "b": "N·m", "c": "rad" }, "z": { "a": 0.5, "b": -4, "c": 2 } } })");
}

} // namespace

TEST_CASE("a folder of Sobol' indices is a set with the largest of each output", "[page]") {
  const Folder folder;
  Json json = quick_campaign(10);
  json["statistics"] = {{"confidence", 0.9}};
  json["scene"]["name"] = "dispersed_wing";
  json["case"] = "hot", json["report"] = {{"author", "A"}};
  const Campaign campaign = campaign_of(json);
  const SaltelliDesign design{campaign, 64, Shard{1, 2}};
  SobolSensitivity all{64, 250, 256, "random", {}, {}, {}};
  all.bounds.confidence = 0.99; // by --confidence
  for (int k = 0; k < 15; ++k) all.dispersions.push_back("d" + std::to_string(k));
  all.outputs.push_back({"root.latch_time", climbing_indices(15), 0});
  all.outputs.push_back({"deployment_time", climbing_indices(3), 0});
  all.outputs.back().indices.effects.resize(15, {{0, {}}, {std::nan(""), {}}, false});
  folder.write(design_file, design_text(design));
  CHECK(is_study_folder(folder.path()));
  const auto message = [&] {
    return message_of([&] { return study_sets_json(folder.path(), "s"); });
  };
  CHECK_THAT(message(),
             Catch::Contains("no sensitivity.json: shard 1/2") && Catch::Contains("merge"));
  folder.write(design_file, design_text({campaign, 64, std::nullopt}));
  CHECK_THAT(message(), Catch::Contains("unfinished") && Catch::Contains("--resume"));
  folder.write(design_file, design_text(design));
  folder.write(sensitivity_json_file, sensitivity_json(all, {}).dump());
  const auto sets = study_sets_json(folder.path(), "s");
  REQUIRE(sets.size() == 1);
  const Json& set = sets[0];
  CHECK((set["label"] == "s" && set["campaign"] == "dispersed_wing" && set["confidence"] == 0.99));
  CHECK((set["case"] == "hot" && set["document"] == Json{{"author", "A"}}));
  Json impossible = sensitivity_json(all, {});
  impossible["confidence"] = 2;
  folder.write(sensitivity_json_file, impossible.dump());
  CHECK_THAT(message_of([&] { return study_sets_json(folder.path(), "s"); }),
             Catch::Contains("sensitivity.json: /confidence: found 2"));
  CHECK((set["seed"] == "7" && set["hash"] == stamp_of(design).hash));
  CHECK((set["margin"].is_null() && set["rare"].is_null() && set["fit"].is_null()));
  CHECK(set["wing"].is_object());
  CHECK(set["static_margins"].is_object());
  CHECK(set["warnings"] == Json(warnings(all)));
  CHECK(set["sensitivity"]["kind"] == "sobol");
  std::vector<std::pair<std::string, std::string>> shown;
  for (const Json& effect : set["sensitivity"]["effects"])
    shown.emplace_back(effect["output"], effect["draw"]);
  std::vector<std::pair<std::string, std::string>> expected;
  for (int k = 14; k > 2; --k) expected.emplace_back("root.latch_time", "d" + std::to_string(k));
  expected.emplace_back("deployment_time", "d2"); // outputs in the order of the file
  expected.emplace_back("deployment_time", "d0");
  CHECK(shown == expected);
  CHECK(set["sensitivity"]["effects"][0] == Json{{"output", "root.latch_time"},
                                                 {"draw", "d14"},
                                                 {"first", 0.07},
                                                 {"first_lower", 0.035},
                                                 {"first_upper", 0.14},
                                                 {"total", 0.14},
                                                 {"total_lower", 0.07},
                                                 {"total_upper", 0.28}});
  folder.write(campaign_file, json.dump()); // then it is a campaign's results
  CHECK_FALSE(is_study_folder(folder.path()));
}

TEST_CASE("a folder of a rare event is a set with its levels, strata and likeliest run", "[page]") {
  const Folder folder;
  CHECK_FALSE(is_study_folder(folder.path())); // an empty one
  const Json study = rare_study();
  folder.write(rare_json_file, study.dump());
  CHECK(is_study_folder(folder.path()));
  const auto set_of = [&](const Json& json) {
    folder.write(rare_json_file, json.dump());
    return study_sets_json(folder.path(), "r").at(0);
  };
  const Json set = set_of(study), &rare = set["rare"];
  CHECK((set["label"] == "r" && set["seed"] == "3" && set["hash"] == "h"));
  CHECK((set["campaign"] == "wing" && set["confidence"] == 0.9));
  CHECK((set["case"] == "cold" && set["document"] == Json::object()));
  CHECK((set["margin"].is_null() && set["sensitivity"].is_null() && set["wing"].is_null()));
  for (const char* key : {"beyond", "case", "confidence", "probability", "lower", "upper",
                          "reached", "bias", "warnings"}) {
    CAPTURE(key);
    CHECK(rare[key] == study[key]);
  }
  CHECK(rare["text"] == "not deployed");
  CHECK(rare["levels"] == parse_json(R"([ [ { "threshold": 3.5, "probability": 0.5 },
                                            { "threshold": 0, "probability": 0.0625 } ],
                                          [ { "threshold": 1, "probability": 0.25 } ] ])"));
  // by their parts of the sum: 2.5e-4 at most, 1e-5, 9e-7
  CHECK(rare["strata"] == parse_json(R"([
    { "text": "a = 1, b = 9000", "probability": 1e-3, "event": 0.25, "reached": false },
    { "text": "c = 0.5", "probability": 1e-5, "event": 1.0, "reached": true },
    { "text": "no rare value", "probability": 0.9, "event": 1e-6, "reached": true } ])"));
  CHECK(rare["likeliest"] == parse_json(R"({ "distance": 4.5, "draws": [
    { "name": "b", "value": 2, "unit": "N·m", "z": -4.0 },
    { "name": "c", "value": 3, "unit": "rad", "z": 2.0 },
    { "name": "a", "value": 1, "unit": "", "z": 0.5 } ] })"));
  CHECK(rare["estimated"] == false); // the stratum that was not reached cannot add a hundredth
  Json estimated = study;
  estimated["reached"] = false;
  CHECK(set_of(estimated)["rare"]["estimated"] == true);
  estimated["lower"] = 0; // by the stratum that was not reached
  CHECK(set_of(estimated)["rare"]["estimated"] == true);
  estimated["strata"][1]["reached"] = true;
  CHECK(set_of(estimated)["rare"]["estimated"] == false);
  Json older = study; // without the keys of later versions
  for (const char* key : {"scene", "beyond", "case", "confidence", "strata"}) older.erase(key);
  older["likeliest"].erase("units");
  const Json before = set_of(older);
  CHECK((before["campaign"] == "" && before["confidence"].is_null()));
  CHECK(before["rare"]["estimated"] == false);
  CHECK(before["rare"]["likeliest"]["draws"][0]["unit"] == "");

  Json many = study;
  for (int k = 1; k < 20; ++k)
    many["strata"].push_back({{"draws", fmt::format("k = {}", k)},
                              {"probability", 1e-4},
                              {"event", 0.01 * k},
                              {"upper", 1},
                              {"reached", true}});
  const Json shown = set_of(many)["rare"]["strata"];
  REQUIRE(shown.size() == 12);
  CHECK(shown[1]["text"] == "k = 19");
  CHECK(shown[9]["text"] == "k = 11"); // then k = 10, and c with as large a part
  many["strata"][0]["event"] = 0;      // a plain sample of which no run has the event: by its bound
  const Json none = set_of(many)["rare"]["strata"];
  CHECK(none[1]["text"] == "k = 19");
  for (const Json& part : none) CHECK(part["text"] != "no rare value"); // 1.8e-6 at most
  many["strata"][0]["upper"] = 1e-3;                                    // 9e-4 at most: the largest
  CHECK(set_of(many)["rare"]["strata"][0] ==
        Json{{"text", "no rare value"}, {"probability", 0.9}, {"event", 1e-3}, {"reached", false}});
  many["strata"] = many["likeliest"] = nullptr;
  many["repeats"] = Json::array();
  const Json little = set_of(many)["rare"];
  CHECK((little["strata"].empty() && little["levels"].empty() && little["likeliest"].is_null()));
  for (const char* pointer :
       {"/event", "/probability", "/lower", "/upper", "/reached", "/repeats", "/repeats/0/levels",
        "/repeats/0/levels/1/share", "/repeats/1/levels/0/share", "/repeats/0/levels/1/threshold",
        "/strata/1/draws", "/strata/1/probability", "/strata/1/upper", "/strata/1/reached",
        "/likeliest", "/likeliest/distance", "/likeliest/draws", "/likeliest/z",
        "/likeliest/z/b"}) {
    CAPTURE(pointer);
    CHECK_THAT(message_of([&] {
                 return set_of(spoil(study, {pointer, "", ""}));
               }),
               Catch::Contains("expected unchanged files"));
  }
}

TEST_CASE("a page of studies has the first scene for its title, or the first label without any",
          "[page]") {
  const Folder folder;
  const std::filesystem::path named = folder.path() / "named", older = folder.path() / "older";
  for (const auto& path : {named, older}) std::filesystem::create_directories(path);
  Json study = rare_study();
  folder.write("named/rare.json", study.dump());
  study.erase("scene"); // as older versions wrote it
  folder.write("older/rare.json", study.dump());
  const auto title_of_page = [](const std::vector<std::filesystem::path>& folders) {
    return page_json(read_page_sources(folders, 1), {}, "", 1)["title"].get<std::string>();
  };
  CHECK(title_of_page({named}) == "wing");
  CHECK(title_of_page({older}) == "older");
  CHECK(title_of_page({older, named}) == "wing");
}

TEST_CASE("a page of studies has the words of the first campaign that has them", "[page]") {
  const Folder folder;
  Json study = rare_study();
  const auto written = [&](const char* name, const Json& words) {
    std::filesystem::create_directories(folder.path() / name);
    study["report"] = words;
    folder.write((std::string(name) + "/rare.json").c_str(), study.dump());
    return folder.path() / name;
  };
  const std::vector<std::filesystem::path> folders{
      written("plain", Json::object()), written("first", {{"title", "T1"}, {"unknown", 3}}),
      written("second", {{"title", "T2"}, {"author", "A2"}, {"date", "D2"}})};
  ReportHeader given;
  given.date = "today";
  CHECK(page_json(read_page_sources(folders, 1), given, "", 1)["document"] ==
        Json{{"title", "T1"}, {"author", "A2"}, {"date", "today"}});
  (void)written("first", {{"title", 3}});
  CHECK_THAT(message_of([&] { return study_sets_json(folders[1], "r"); }),
             Catch::Contains("expected unchanged files"));
}

TEST_CASE("a fit's set has the fit's scene and confidence", "[page]") {
  const Folder folder;
  Json study = parse_json(R"({ "scene": "wing", "confidence": 0.5, "finished": true,
    "findings": [], "unseen": [], "parameters": {}, "tests": [] })");
  folder.write(traces_csv_file, "test,column,t,measured,fitted,lower,upper\n");
  const auto set_of = [&] {
    folder.write(fit_json_file, study.dump());
    return study_sets_json(folder.path(), "f").at(0);
  };
  const Json set = set_of();
  CHECK((set["campaign"] == "wing" && set["confidence"] == 0.5));
  study.erase("confidence"); // of an older version, which had one confidence
  CHECK(set_of()["confidence"] == 0.95);
}

TEST_CASE("a study's confidence is a share, or is refused by its key", "[page]") {
  const Json margin = parse_json(R"({ "scene": "wing", "searches": [ { "name": "joint",
    "window": { "lower": { "scale": 0.9, "range_end": false },
                "upper": { "scale": 2, "range_end": true } }, "recommended": null, "why_none": "none" } ] })");
  const Json fit = parse_json(R"({ "scene": "wing", "finished": true, "findings": [], "unseen": [],
    "parameters": {}, "tests": [] })");
  for (const auto& [file, study] : std::vector<std::pair<const char*, Json>>{
           {margin_json_file, margin}, {fit_json_file, fit}, {rare_json_file, rare_study()}}) {
    CAPTURE(file);
    const Folder folder;
    folder.write(margin_csv_file, "search,scale,case,runs,requirement,verdict,broken\n");
    folder.write(traces_csv_file, "test,column,t,measured,fitted,lower,upper\n");
    const auto confidence_of = [&](const Json& confidence) {
      Json changed = study;
      changed["confidence"] = confidence;
      folder.write(file, changed.dump());
      return study_sets_json(folder.path(), "s").at(0)["confidence"];
    };
    CHECK(confidence_of(0.8) == 0.8);
    for (const Json& wrong : {Json(2), Json(-1), Json(0), Json(1), Json("x"), Json(Json::array())})
      CHECK_THAT(message_of([&] { return confidence_of(wrong); }),
                 Catch::Contains(std::string(file) + ": /confidence: found") &&
                     Catch::Contains("expected a number, > 0 and < 1"));
  }
}

TEST_CASE("a key that a margin study lacks is refused by its folder, but one of later versions",
          "[page]") {
  const Folder folder;
  const Json study = parse_json(R"({ "scene": "wing", "searches": [ { "name": "joint",
    "window": { "lower": { "scale": 0.9, "range_end": false },
                "upper": { "scale": 2, "range_end": true } },
    "recommended": { "scale": 1.2, "as_good": { "from": 1.1, "to": 1.3 } }, "why_none": null } ] })");
  folder.write(margin_csv_file, "search,scale,case,runs,requirement,verdict,broken\n"
                                "joint,1,nominal,100,A,pass,1\n");
  const auto set_of = [&](const Json& json) {
    folder.write(margin_json_file, json.dump());
    return study_sets_json(folder.path(), "m").at(0);
  };
  CHECK(set_of(study)["margin"]["window"] == Json{0.9, nullptr});
  for (const char* pointer :
       {"/searches", "/searches/0/name", "/searches/0/window", "/searches/0/window/lower",
        "/searches/0/window/upper", "/searches/0/window/lower/scale",
        "/searches/0/window/lower/range_end", "/searches/0/recommended",
        "/searches/0/recommended/scale", "/searches/0/recommended/as_good/from",
        "/searches/0/recommended/as_good/to", "/searches/0/why_none"}) {
    CAPTURE(pointer);
    const std::string said = message_of([&] { return set_of(spoil(study, {pointer, "", ""})); });
    CHECK_THAT(said, Catch::StartsWith(folder.path().string() + ": ") &&
                         Catch::Contains("expected unchanged files"));
  }
  CHECK(set_of(spoil(study, {"/searches/0/recommended/as_good", "", ""}))["margin"]["as_good"]
            .is_null());
  CHECK(set_of(study)["margin"]["not_confirmed"].is_null()); // of an older version
  Json confirmed = study;
  Json& runs = confirmed["searches"][0]["recommended"]["confirmation"];
  runs = parse_json(
      R"({ "passes": true, "verdicts": [ { "output": "deployed", "verdict": "pass" } ] })");
  CHECK(set_of(confirmed)["margin"]["not_confirmed"].is_null());
  runs = parse_json(R"({ "passes": false, "verdicts": [
    { "output": "deployed", "verdict": "pass" },
    { "name": "M-2", "output": "x", "case": "ambient", "verdict": "fail" },
    { "output": "tip.latch_rate", "verdict": "undecided" } ] })");
  CHECK(set_of(confirmed)["margin"]["not_confirmed"] == "not met: M-2 in ambient, tip.latch_rate");
}

TEST_CASE("bounds of a margin study have its own confidence, and none where it is not known",
          "[page]") {
  const Folder folder;
  Json study = parse_json(R"({ "scene": "wing", "confidence": 0.5, "searches": [ { "name": "joint",
    "window": null, "recommended": null, "why_none": "EMPTY" } ] })");
  folder.write(margin_csv_file, "search,scale,case,runs,requirement,verdict,broken\n"
                                "joint,1,nominal,100,A,fail,7\n");
  const auto set_of = [&](const Json& json) {
    folder.write(margin_json_file, json.dump());
    return study_sets_json(folder.path(), "m").at(0);
  };
  const auto check_bounds = [&](const Json& set, double confidence) {
    const Interval bounds = clopper_pearson(93, 100, confidence);
    const Json& one = set["margin"]["requirements"][0];
    CHECK(set["confidence"] == confidence);
    CHECK(one["lower"][0].get<double>() == Approx(bounds.lower).epsilon(1e-4));
    CHECK(one["upper"][0].get<double>() == Approx(bounds.upper).epsilon(1e-4));
  };
  check_bounds(set_of(study), 0.5);
  Json campaign = quick_campaign(10); // an older version writes it only in recommended.json
  campaign["statistics"] = {{"confidence", 0.8}};
  folder.write(recommended_file, campaign.dump());
  check_bounds(set_of(study), 0.5);
  study.erase("confidence");
  check_bounds(set_of(study), 0.8);
  std::filesystem::remove(folder.path() / recommended_file);
  const Json unknown = set_of(study);
  CHECK(unknown["confidence"].is_null());
  const Json& one = unknown["margin"]["requirements"][0];
  CHECK((one["passed"] == Json{0.93} && one["lower"][0].is_null() && one["upper"][0].is_null()));
}

TEST_CASE("a margin's page has what limits its window: gaps, further windows, joint confidence",
          "[page]") {
  const Folder folder;
  Json study = parse_json(R"({ "searches": [ { "name": "joint",
    "window": { "lower": { "scale": 0.9, "range_end": false },
                "upper": { "scale": 2, "range_end": false },
                "widest_gap": { "from": 1, "to": 1.5 }, "joint_confidence": 0.4 },
    "other_windows": [ { "lower": { "scale": 3 }, "upper": { "scale": 4 } } ],
    "passed_over": { "scale": 1.1, "drive": "root", "margin": "gevs" }, "recommended": { "scale": 1.2, "given_up": {
      "requirements": [ { "requirement": "A", "case": "cold",
                          "at_1": { "failures": { "seen": 1, "allowed": 9 } },
                          "at_scale": { "failures": { "seen": 2, "allowed": 9 } } } ],
      "static_margins": [ { "drive": "root", "margin": "nasa", "at_1": 0.5, "at_scale": 0.25 } ] } },
    "why_none": null } ] })");
  folder.write(margin_csv_file, "search,scale,case,runs,requirement,verdict,broken\n");
  const auto block_of = [&](const Json& json) {
    folder.write(margin_json_file, json.dump());
    return study_sets_json(folder.path(), "m").at(0)["margin"];
  };
  const Json margin = block_of(study);
  CHECK(margin["widest_gap"] == Json{1, 1.5});
  CHECK(margin["joint_confidence"] == 0.4);
  REQUIRE(margin["other_windows"].size() == 1);
  CHECK(margin["other_windows"][0] == Json{3, 4});
  CHECK(margin["passed_over"] ==
        parse_json(R"({ "scale": 1.1, "drive": "root", "margin": "GEVS" })"));
  Json given_up = study["searches"][0]["recommended"]["given_up"];
  given_up["static_margins"][0]["margin"] = "NASA";
  CHECK(margin["given_up"] == given_up);
  study["searches"][0]["window"]["widest_gap"]["to"] = 1; // a window of one scale
  CHECK(block_of(study)["widest_gap"].is_null());
  for (const char* key : {"other_windows", "passed_over"}) study["searches"][0].erase(key);
  study["searches"][0]["window"] = study["searches"][0]["recommended"] = nullptr;
  const Json none = block_of(study);
  for (const char* key : {"widest_gap", "joint_confidence", "given_up", "passed_over"})
    CHECK(none[key].is_null());
  CHECK(none["other_windows"].empty());
}
