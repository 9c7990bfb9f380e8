#include "montecarlo/report/data/page_detail.hpp"
#include "montecarlo/report/data/page_numbers.hpp"
#include "montecarlo/report/page/glossary.hpp"
#include "montecarlo/report/page/html_page.hpp"
#include "montecarlo/report/page/page_files.hpp"
#include "montecarlo/report/page/static_margins_json.hpp"
#include "montecarlo/report/page/study_set.hpp"
#include "tests/montecarlo/margin_support.hpp"
#include "tests/support/source_folder.hpp"

#include <catch2/catch.hpp>

#include <fstream>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("the page has all of its files, and asks no network", "[page]") {
  const std::string before(page_before_data), behind(page_after_data);
  CHECK(before.starts_with("<!DOCTYPE html>"));
  CHECK(before.find("default-src 'none'") != before.npos);
  CHECK((before + behind).find("<!-- data -->") == std::string::npos);
  for (const char* outside : {"src=\"http", "href=\"http", "@import", "url(http"})
    CHECK((before + behind).find(outside) == std::string::npos);
  CHECK(behind.find("Copyright: 2010-2017, Mike Bostock") !=
        behind.npos); // d3's licence, before d3
  CHECK(behind.find("https://d3js.org v5") > behind.find("Redistribution and use"));
  const std::filesystem::path folder =
      std::filesystem::path(source_folder) / "montecarlo/report/page";
  long scripts = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".js" && entry.path().extension() != ".css") continue;
    CAPTURE(entry.path());
    ++scripts;
    CHECK((before + behind).find(read_text(entry.path()).value()) != std::string::npos);
  }
  CHECK(scripts > 1);
}

TEST_CASE("the block stands between the page's halves", "[page]") {
  const std::string page = html_page({{"title", "a < b"}});
  CHECK(page.find(
            "<script type=\"application/json\" id=\"data\">{\"title\":\"a \\u003c b\"}</script>") !=
        page.npos);
  CHECK(page.ends_with(page_after_data));
}

TEST_CASE("the page of a large scene or of many sets keeps to its size", "[page]") {
  const auto numbers = [](const PageExtent& extent) { // of all sets, at the most
    const PageDetail d = page_detail(extent);
    const std::size_t output = 9 * d.bins + 4 * d.knots + 7 * d.convergence_points + 8 * d.effects;
    const std::size_t outputs = std::min(extent.outputs, d.outputs);
    return extent.sets *
           (outputs * output + 2 * outputs * d.correlated_draws +
            d.motions * 3 * extent.hinges * d.motion_samples +
            extent.hinges * (14 * d.envelope_times + d.latch_times) + d.scatters * 2690);
  };
  CHECK(page_detail({1, 6, 40}).bins == 80); // a usual wing has all
  CHECK(page_detail({1, 3, 13}).motion_samples == 400);
  for (const PageExtent& extent :
       {PageExtent{1, 40, 281}, PageExtent{12, 5, 26}, PageExtent{12, 40, 281}})
    CHECK(numbers(extent) * 9 <
          5'000'000); // counts, of two digits or so, are more than half of them
}

TEST_CASE("static margins of the page, by hand", "[page][motorization]") {
  Json json = one_panel_margin(50);
  json["scene"]["hinges"][0]["friction"] = {
      {"model", "exact"}, {"coulomb", 0.05}, {"static", 0.05}};
  const Campaign campaign = campaign_of(json);
  const Json margins = static_margins_json(campaign);
  CHECK(margins["kind"] == "NASA");
  REQUIRE(margins["hinges"].size() == 1);
  const Json& hinge = margins["hinges"][0];
  CHECK(hinge["angle"].size() == 21);
  CHECK(hinge["margin"].size() == 21);
  CHECK(hinge["margin"].back() == page_number(0.2 / (3 * 0.05) - 1, 5)); // at the latch
  CHECK(hinge["least"] == hinge["margin"].back());
  CHECK(hinge["lower"].get<double>() < hinge["least"].get<double>());
  CHECK(hinge["required"] == 0);
  CHECK(margins["formula"] == "T / (1.5 ΣT_fixed + 3 ΣT_variable) − 1");
}

TEST_CASE("static margins of the page have the campaign's factors, and what its requirements ask",
          "[page][motorization]") {
  Json json = one_panel_margin(50);
  json.erase("margin");
  json["motorization"] = {{"nasa", {{"basis", "development_test"}}}};
  const auto required = [&](Json requirements) {
    json["requirements"] = std::move(requirements);
    const Json margins = static_margins_json(campaign_of(json));
    CHECK(margins["formula"] == "T / (1.35 ΣT_fixed + 2.5 ΣT_variable) − 1");
    return margins["hinges"][0]["required"];
  };
  const auto margin_of = [](const char* hinge, double min) {
    return Json{{"motorization", "NASA"},
                {"hinge", hinge},
                {"min", min},
                {"probability", 0.9},
                {"confidence", 0.9}};
  };
  CHECK(required(Json::array({margin_of("root", 0.2)})) == 0.2);
  CHECK(required(Json::array({margin_of("*", 0.1), margin_of("root", 0.05)})) == 0.1);
}

TEST_CASE("static margins of the page are of 1000 draws, or of all of a design, by the standard "
          "asked for",
          "[page][motorization]") {
  Json json = one_panel_margin(1200);
  json.erase("margin");
  CHECK(static_margins_json(campaign_of(json))["draws"] == 1000);
  json["sampling"]["runs"] = 900;
  CHECK(static_margins_json(campaign_of(json))["draws"] == 900);
  json["sampling"].update({{"runs", 1200}, {"design", "latin_hypercube"}, {"replicates", 2}});
  json.erase("requirements");
  const Json all = static_margins_json(campaign_of(json));
  CHECK(all["draws"] == 1200);
  CHECK(all["kind"] == "NASA");
  json["sampling"] = {{"runs", 20}, {"seed", 7}};
  json["requirements"] =
      parse_json(R"([ { "motorization": "ECSS", "probability": 0.9, "confidence": 0.9 } ])");
  json["cases"] = parse_json(R"([ { "name": "hot" },
    { "name": "cold", "scale": { "hinges.root.spring.torque_latched": 0.8 } } ])");
  const Json cases = static_margins_json(campaign_of(json));
  CHECK(cases["kind"] == "ECSS");
  REQUIRE(cases["hinges"].size() == 2);
  CHECK(cases["hinges"][0]["hinge"] == "root (hot)");
  CHECK(cases["hinges"][1]["hinge"] == "root (cold)");
  CHECK(cases["hinges"][1]["least"] < cases["hinges"][0]["least"]);
}

TEST_CASE("a required static margin is that of the hinge of its name, not of names that contain it",
          "[page][motorization]") {
  const std::vector<std::string> names{"root", "root2", "oot", "2root", "r"};
  for (const std::string& first : names)
    for (const std::string& second : names) {
      if (first == second) continue;
      Json json = one_panel_margin(4);
      json.erase("margin");
      Json& scene = json["scene"];
      Json hinge = scene["hinges"][0], panel = scene["bodies"][0];
      hinge["name"] = second, hinge["child"] = panel["name"] = "other";
      scene["hinges"][0]["name"] = first;
      scene["bodies"].push_back(panel), scene["hinges"].push_back(hinge);
      json["dispersions"] = Json::array();
      json["requirements"] = {{{"motorization", "NASA"},
                               {"hinge", second},
                               {"min", 0.2},
                               {"probability", 0.5},
                               {"confidence", 0.5}}};
      const Json hinges = static_margins_json(campaign_of(json))["hinges"];
      REQUIRE(hinges.size() == 2);
      CAPTURE(first, second);
      for (const Json& each : hinges)
        CHECK(each["required"] == (each["hinge"] == second ? 0.2 : 0));
    }
}

TEST_CASE("a folder of a margin study is a set without runs, by hand", "[page]") {
  const Folder folder;
  folder.write(
      "margin.json",
      R"({ "wingspread": { "version": "0", "seed": 18446744073709551615, "hash": "h" }, "scene": "wing",
    "searches": [ { "name": "joint", "window": { "lower": { "scale": 0.9, "range_end": false },
      "upper": { "scale": 2, "range_end": true } },
      "recommended": { "scale": 1.2, "as_good": { "from": 1.1, "to": 1.3 } }, "why_none": null } ],
    "confidence": 0.95 })");
  folder.write("margin.csv",
               "search,scale,case,runs,requirement,verdict,broken\n"
               "joint,0.5,nominal,100,\"A, b\",fail,100\njoint,1,nominal,100,\"A, b\",pass,1\n"
               "joint,0.5,cold,100,\"A, b\",undecided,0\njoint,1,cold,100,\"A, b\",pass,0\n");
  CHECK(is_study_folder(folder.path()));
  const auto sets = study_sets_json(folder.path(), "m");
  REQUIRE(sets.size() == 1);
  CHECK(sets[0]["seed"] == "18446744073709551615"); // whole, as text
  CHECK(sets[0]["campaign"] == "wing");
  std::filesystem::create_directories(folder.path() / "x");
  const auto label_of = [](const std::filesystem::path& asked) {
    const std::vector<std::filesystem::path> folders{asked};
    return read_page_sources(folders, 1).studies.at(0)["label"].get<std::string>();
  };
  const std::string name = folder.path().filename().string();
  CHECK(label_of(folder.path() / "") == name);
  for (const auto& nameless : {folder.path() / ".", folder.path() / "x" / ".."})
    CHECK(label_of(nameless) == nameless.string()); // as it was written
  const Json& margin = sets[0]["margin"];
  CHECK(margin["scales"] == Json{0.5, 1.0});
  CHECK(margin["window"] == Json{0.9, nullptr}); // the end of the range is no edge
  CHECK(margin["recommended"] == 1.2);
  CHECK(margin["as_good"] == Json{1.1, 1.3});
  REQUIRE(margin["requirements"].size() == 2);
  CHECK(margin["requirements"][0]["passed"] == Json{0.0, 0.99});
  CHECK(margin["requirements"][0]["verdict"] == Json{"failed", "passed"});
  CHECK(margin["requirements"][0]["upper"][0].get<double>() ==
        Approx(1 - std::pow(0.025, 0.01)).epsilon(1e-4));
  CHECK(margin["requirements"][1]["text"] == "A, b · cold");
  CHECK(margin["requirements"][1]["verdict"][0] == "open");
  // what only runs have is empty, and nothing says that runs are missing
  const Json expected =
      parse_json(R"({ "label": "m", "case": null, "foreign": false, "hash": "h", "version": "0",
         "runs": 0, "planned": 0, "partial": false, "stopped": false, "shard": null, "design": "",
         "confidence": 0.95, "looks": 1, "replicates": 0, "made_by": "", "statuses": [],
         "reasons": [], "orders": [], "outputs": [], "scatters": [], "motions": [],
         "wing_orders": [], "order_kinds": 0, "without_latch": 0, "accuracy": null,
         "correlations": null, "sensitivity": null, "wing": null, "envelopes": null, "rare": null,
         "kernel": null, "fit": null,
         "inputs": { "scene": [], "dispersions": [], "settings": [] } })");
  for (const auto& [key, value] : expected.items()) {
    CAPTURE(key);
    CHECK(sets[0][key] == value);
  }
  CHECK(sets[0]["folder"] == folder.path().string());
  folder.write("margin.json", "{ \"searches\": [ {} ] }");
  CHECK(message_of([&] {
          return study_sets_json(folder.path(), "m");
        }).find("expected unchanged files") != std::string::npos);
}

TEST_CASE("every output that a campaign can have is in the glossary", "[page]") {
  const Json glossary = glossary_json();
  const Scene scene =
      read_scene_file(std::filesystem::path(source_folder) / "studies/scenes/two_wing_free.json");
  for (const OutputColumn& column : output_columns(scene, all_outputs())) {
    const std::string hinge =
        column.hinge < 0 ? "" : scene.hinges[static_cast<std::size_t>(column.hinge)].name + '.';
    std::string name = hinge.empty() ? column.name : "HINGE." + column.name.substr(hinge.size());
    if (column.other >= 0) name = "HINGE.rate_at.OTHER";
    if (column.quantity == OutputQuantity::frequency) name = "mode_K.frequency";
    CAPTURE(column.name);
    REQUIRE(glossary.contains(name));
    CHECK(!glossary[name]["unit"].get<std::string>().empty());
  }
}

TEST_CASE("equal labels give way to paths, for all sets of an argument alike", "[page]") {
  PageSources sources;
  const auto add = [&](std::size_t argument, const char* label, const char* folder) {
    PageSource& source = *sources.runs.emplace_back(std::make_unique<PageSource>());
    source.label = label;
    source.argument = argument;
    source.stored.folder = folder;
  };
  add(0, "results · cold", "A/results/cold");
  add(1, "results · cold", "B/results/cold");
  add(1, "results · extra", "B/results/extra"); // no other set has this label
  add(2, "seed7 · cold", "B/seed7/cold");
  sources.unmade = {{"results · hot", 5, true, "B/results/hot", 1},
                    {"seed7 · hot", 5, true, "B/seed7/hot", 2}};
  const auto study = [&](const char* label, const char* folder) {
    sources.studies.push_back({{"label", label}, {"folder", folder}});
  };
  study("margin · joint", "A/margin");
  study("margin · joint", "B/margin/");
  study("rare", "A/rare");
  label_by_path(sources);
  std::vector<std::string> labels;
  for (const auto& source : sources.runs) labels.push_back(source->label);
  for (const UnmadeCase& each : sources.unmade) labels.push_back(each.label);
  for (const Json& set : sources.studies) labels.push_back(set["label"]);
  CHECK(labels == std::vector<std::string>{"A/results/cold", "B/results/cold", "B/results/extra",
                                           "seed7 · cold", "B/results/hot", "seed7 · hot",
                                           "A/margin · joint", "B/margin/ · joint", "rare"});
}

TEST_CASE("the page says which runs are missing, of which set or case", "[page]") {
  struct Made {
    const char *label, *of_case;
    long made, planned;
    bool stopped = false;
  };
  const auto text_of = [](std::initializer_list<Made> sets,
                          std::initializer_list<const char*> unmade = {}) {
    PageSources sources;
    for (const Made& each : sets) {
      PageSource& source = *sources.runs.emplace_back(std::make_unique<PageSource>());
      source.label = each.label;
      source.stored.campaign.of_case = each.of_case;
      source.stored.campaign.sampling.runs = each.planned;
      source.summary.runs = each.made;
      source.summary.stopped = each.stopped;
    }
    for (const char* label : unmade) sources.unmade.push_back({label, 5, true});
    return incomplete_text(sources);
  };
  CHECK(text_of({{"a", "", 5, 5}}).empty());
  CHECK(text_of({{"a", "", 3, 5, true}}).empty());
  CHECK(text_of({{"a", "", 3, 5}}) == "3 of 5 runs");
  CHECK(text_of({{"a", "", 0, 5}}) == "none of 5 runs");
  CHECK(text_of({{"a", "", 3, 5}, {"b", "", 5, 5}}) == "3 of 5 runs of a");
  CHECK(text_of({{"a", "", 3, 5}, {"b", "", 2, 6}}) == "3 of 5 runs of a, 2 of 6 of b");
  CHECK(text_of({{"a", "", 0, 5}, {"b", "", 5, 5}}) == "no run of a");
  CHECK(text_of({{"a", "", 0, 5}, {"b", "", 2, 5}}) == "2 of 5 runs of b, none of a");
  CHECK(text_of({{"cold", "cold", 3, 5}, {"hot", "hot", 5, 5}}) == "3 of 5 runs of case cold");
  CHECK(text_of({{"cold", "cold", 0, 5}, {"hot", "hot", 5, 5}}) == "no run of case cold");
  CHECK(text_of({{"cold", "cold", 5, 5}}, {"hot"}) == "no run of case hot");
  CHECK(text_of({{"cold", "cold", 3, 5}}, {"hot"}) == "3 of 5 runs of case cold, none of hot");
  CHECK(text_of({{"cold", "cold", 0, 5}}, {"hot"}) == "no run of case cold and hot");
  CHECK(text_of({{"x · cold", "cold", 5, 5}, {"a", "", 3, 5}}) == "3 of 5 runs of a");
  CHECK(text_of({{"x · cold", "cold", 5, 5}, {"a", "", 0, 5}}) == "no run of a");
  CHECK(text_of({{"a", "", 0, 5}, {"x · cold", "cold", 2, 5}}) ==
        "2 of 5 runs of case x · cold, none of a");
}

TEST_CASE("the sets that are not judged are named beside others that are", "[page]") {
  const auto text_of = [](std::initializer_list<std::pair<const char*, std::optional<bool>>> sets,
                          std::initializer_list<const char*> unmade = {}) {
    PageSources sources;
    for (const auto& [label, of_part] : sets) {
      PageSource& source = *sources.runs.emplace_back(std::make_unique<PageSource>());
      source.label = label;
      if (of_part) source.summary.requirements.emplace_back().of_part = *of_part;
    }
    for (const char* label : unmade) sources.unmade.push_back({label, 5, true});
    return unjudged_text(sources);
  };
  CHECK(text_of({{"a", true}}) == "requirements are not judged");
  CHECK(text_of({{"a", true}, {"b", std::nullopt}}, {"c"}) == "requirements are not judged");
  CHECK(text_of({{"a", true}, {"b", false}}) == "requirements of a are not judged");
  CHECK(text_of({{"a", true}, {"b", false}, {"c", true}}, {"d"}) ==
        "requirements of a, c and d are not judged");
  CHECK(text_of({{"a", std::nullopt}, {"b", false}}).empty()); // a has none
  CHECK(text_of({{"a", std::nullopt}}).empty());
  PageSources stateless;
  stateless.unmade.push_back({"a", 5, false});
  CHECK(unjudged_text(stateless).empty());
}
