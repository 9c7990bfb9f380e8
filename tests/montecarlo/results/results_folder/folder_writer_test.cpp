#include "montecarlo/results/results_folder/folder_writer.hpp"
#include "montecarlo/results/results_folder/merge.hpp"
#include "montecarlo/results/results_folder/version.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <array>

using namespace wingspread;
using namespace wingspread::test;

namespace {

std::string refusal(const std::filesystem::path& path, const Campaign& campaign,
                    const Session& session) {
  return message_of([&] { return run_into(path, campaign, session); });
}

/// Replaces the first occurrence in a file of the folder.
void replace(const std::filesystem::path& file, const std::string& what, const std::string& with) {
  std::string text = read_text(file).value();
  text.replace(text.find(what), what.size(), with);
  std::ofstream(file, std::ios::binary) << text;
}

} // namespace

TEST_CASE("the files do not depend on threads and interruptions", "[parallel]") {
  const Folder folder;
  const Campaign campaign = campaign_of(full_campaign(1000));
  const auto whole = folder.path() / "whole", broken = folder.path() / "broken";
  (void)run_into(whole, campaign);
  CHECK(contents(whole).size() == 5);
  int sessions = 0;
  for (long done = 0; done < 1000; ++sessions)
    done += run_into(broken, campaign, {.threads = 3, .resume = true, .stop_after = 14});
  CHECK(sessions > 1);
  CHECK(contents(broken) == contents(whole));
}

TEST_CASE("that holds for every design, and for correlated dispersions", "[parallel]") {
  const Folder folder;
  for (const char* design : {"random", "latin_hypercube", "sobol"}) {
    Json json = quick_campaign(40);
    json["sampling"].update({{"design", design}, {"replicates", 3}});
    json["correlations"] =
        parse_json(R"([{ "between": ["root_spring", "mass.panel_2"], "spearman": 0.7 }])");
    if (design == std::string("random")) {
      json["requirements"] = parse_json(R"([
        { "output": "root.latch_time", "max": 5, "probability": 0.9, "confidence": 0.9 } ])");
      json["statistics"] = {{"tolerance", {{{"probability", 0.9}, {"confidence", 0.9}}}}};
    }
    const Campaign campaign = campaign_of(json);
    const auto here = folder.path() / design, whole = here / "whole", broken = here / "broken";
    (void)run_into(whole, campaign);
    for (long done = 0; done < 40;)
      done += run_into(broken, campaign, {.threads = 2, .resume = true, .stop_after = 9});
    CHECK(contents(broken) == contents(whole));
    std::vector<std::filesystem::path> parts;
    for (long i = 1; i <= 3; ++i) {
      parts.push_back(here / std::to_string(i));
      (void)run_into(parts.back(), campaign, {.threads = 2, .shard = Shard{i, 3}});
    }
    (void)merge_folders(parts, here / "merged");
    CHECK(contents(here / "merged") == contents(whole));
    const Json summary = parse_json(contents(whole)[summary_file]);
    CHECK_THAT(
        summary["definitions"]["rate_bounds"].get<std::string>(),
        Catch::StartsWith(design == std::string("random") ? "Clopper-Pearson" : "Korn-Graubard"));
  }
}

TEST_CASE("of replicates only those count of which there are runs") {
  const Folder folder;
  Json json = quick_campaign(64);
  json["sampling"].update({{"design", "sobol"}, {"replicates", 16}});
  const Campaign campaign = campaign_of(json);
  const auto bounds = [&](const Session& session, const char* name) {
    (void)run_into(folder.path() / name, campaign, session);
    return parse_json_file(folder.path() / name / summary_file)["definitions"]["quantile_bounds"]
        .get<std::string>();
  };
  CHECK_THAT(bounds({}, "all"), Catch::EndsWith("over 16 independent replicates"));
  CHECK_THAT(bounds({.shard = Shard{8, 8}}, "part"), Catch::EndsWith("over 8 independent "
                                                                     "replicates"));
  CHECK_THAT(bounds({.shard = Shard{64, 64}}, "one"), Catch::StartsWith("no bounds: "));
}

TEST_CASE("a campaign is not continued with fewer runs, nor where draws or looks depend on them") {
  const Folder folder;
  const auto path = folder.path() / "r", file = path / campaign_file;
  const auto sized = [](const char* design, int runs, const char* until = nullptr) {
    Json json = quick_campaign(runs);
    json["sampling"]["design"] = design;
    if (until) json["until"] = Json{parse_stopping_goal(until).value()};
    return campaign_of(json);
  };
  const auto refused = [&](const Campaign& campaign, const Session& session = {.resume = true}) {
    return refusal(path, campaign, session);
  };
  (void)run_into(path, sized("latin_hypercube", 4));
  CHECK_THAT(refused(sized("latin_hypercube", 6)),
             Catch::StartsWith(file.string() +
                               ": /sampling/runs: found 4, expected 6: a Latin hypercube's strata, "
                               "and so all of its draws, depend on the number of runs; run it into "
                               "a new folder"));
  std::filesystem::remove_all(path);
  (void)run_into(path, sized("random", 4));
  CHECK_THAT(refused(sized("random", 3)), Catch::Contains("found 4, expected 3: ") &&
                                              Catch::Contains("none taken away") &&
                                              Catch::Contains("--runs 4 "));
  const auto of_looks =
      Catch::Contains("found 4, expected 6: the interim analyses of a campaign that may stop early "
                      "depend on the number of runs; run it into a new folder\n");
  CHECK_THAT(refused(sized("random", 6, "deployed 0.1")), of_looks);
  CHECK_THAT(
      refused(sized("random", 6), {.shard = Shard{1, 2}, .resume = true}),
      Catch::Contains("found 4, expected 6: a shard's runs depend on the number of all; run it "
                      "into a new folder\n"));
  Json other = quick_campaign(6);
  other["integration"]["t_end"] = 19;
  CHECK_THAT(refused(campaign_of(other)), Catch::Contains("/integration/t_end: found 20"));
  other = quick_campaign(6);
  other["sampling"]["seed"] = 8;
  CHECK_THAT(refused(campaign_of(other)), Catch::Contains("/sampling/seed: found 7"));
  std::filesystem::remove_all(path);
  (void)run_into(path, sized("random", 4, "deployed 0.1"));
  CHECK_THAT(refused(sized("random", 6)), of_looks);
}

TEST_CASE("more runs are added to a campaign as one more look, and give what one go would have") {
  const auto design = GENERATE(as<std::string>{}, "random", "sobol");
  const Folder folder;
  const auto path = folder.path() / "r", whole = folder.path() / "whole";
  const auto sized = [&](int runs) {
    Json json = quick_campaign(runs);
    json["sampling"]["design"] = design;
    json["sampling"]["replicates"] = 2;
    return campaign_of(json);
  };
  CHECK(run_into(path, sized(8)) == 8);
  const std::string first = read_text(path / runs_file).value();
  for (const int runs : {12, 16}) // extended, and interrupted: twice without a run, so one look
    CHECK(run_into(path, sized(runs), {.resume = true, .stop_after = 0}) == 0);
  CHECK(run_into(path, sized(16), {.resume = true}) == 8);
  CHECK(run_into(path, sized(16), {.resume = true}) == 0); // the same command once more: no look
  const Json stored = parse_json_file(path / campaign_file);
  CHECK(stored["sampling"]["runs"] == 16);
  CHECK(stored["sampling"]["extended_from"] == Json::array({8}));
  CHECK(read_text(path / runs_file).value().starts_with(first));
  (void)run_into(whole, read_campaign_file(path / campaign_file));
  CHECK(contents(path) == contents(whole));

  Campaign other = sized(16);
  override_sampling(other, {}, 9);
  CHECK(refusal(path, other, {.resume = true}) ==
        (path / campaign_file).string() + // no word of extensions, which the user did not write
            ": /sampling/seed: found 7 (when the folder was made), expected 9 (now), to continue "
            "what is there");

  (void)run_into(path, sized(20), {.resume = true});
  const Json summary = parse_json_file(path / summary_file);
  CHECK(summary["extended"]["analysed_at"] == Json::array({8, 16}));
  CHECK(summary["extended"]["analyses"] == 3);
  CHECK(summary["runs"] == 20);
}

TEST_CASE("a verdict of a campaign that was extended is held to the looks that were taken") {
  const Folder folder;
  const auto path = folder.path() / "r";
  const auto sized = [&](int runs) {
    Json json = quick_campaign(runs);
    json["requirements"] = {{{"output", "deployed"}, {"probability", 0.5}, {"confidence", 0.9}}};
    return campaign_of(json);
  };
  const auto verdict = [&] { return parse_json_file(path / summary_file)["requirements"][0]; };
  (void)run_into(path, sized(8));
  CHECK_FALSE(verdict().contains("confidence_at_this_analysis"));
  (void)run_into(path, sized(16), {.resume = true});
  const PassingRule rule = passing_rule({1, {8}}, 16, 0.5, 0.9, std::array{0L});
  CHECK(verdict()["confidence_at_this_analysis"].get<double>() == rule.confidence);
  CHECK(verdict()["failures"]["allowed"] == *rule.allowed);
  CHECK(verdict()["failures"]["allowed_if_alone"] == *allowed_failures(16, 0.5, 0.9));
  CHECK(verdict()["risk_of_wrong_pass"].get<double>() == rule.joint->risk);
  CHECK_THAT(verdict()["evidence"].get<std::string>(),
             Catch::Contains("This is analysis 2 of the same draws, after 8 runs: the risk of a "
                             "wrong pass at any of them is at most 10 %"));
}

TEST_CASE("a campaign extended before it was complete was looked at where it was left") {
  const Folder folder;
  const auto path = folder.path() / "r";
  const auto campaign = [](int runs) { return campaign_of(quick_campaign(runs)); };
  (void)run_into(path, campaign(6), {.stop_after = 0}); // campaign.json, and no run
  (void)run_into(path, campaign(8), {.resume = true});
  CHECK_FALSE(parse_json_file(path / campaign_file)["sampling"].contains("extended_from"));
}

TEST_CASE("a folder that was left at any byte is completed to the same bytes") {
  const Folder folder;
  const Campaign campaign = campaign_of(quick_campaign(6));
  const auto whole = folder.path() / "whole";
  (void)run_into(whole, campaign);
  const std::string runs = read_text(whole / runs_file).value();
  for (const std::size_t bytes :
       {std::size_t{0}, std::size_t{5}, runs.find('\n'), runs.find('\n') + 1, runs.size() / 2,
        runs.size() - 1, runs.size()}) {
    CAPTURE(bytes);
    const auto path = folder.path() / std::to_string(bytes);
    std::filesystem::create_directory(path);
    std::filesystem::copy_file(whole / campaign_file, path / campaign_file);
    std::ofstream(path / runs_file, std::ios::binary) << runs.substr(0, bytes);
    (void)run_into(path, campaign, {.threads = 2, .resume = true});
    CHECK(contents(path) == contents(whole));
  }
}

TEST_CASE("a folder left before its first row is completed too") {
  const Folder folder;
  const Campaign campaign = campaign_of(quick_campaign(3));
  const auto whole = folder.path() / "whole", path = folder.path() / "early";
  (void)run_into(whole, campaign);
  std::filesystem::create_directory(path);
  SECTION("in the middle of campaign.json") {
    std::ofstream(path / ".campaign.json.part") << "{ \"wing";
  }
  SECTION("before runs.csv") {
    std::filesystem::copy_file(whole / campaign_file, path / campaign_file);
  }
  SECTION("while empty"){}(void)run_into(path, campaign, {.resume = true});
  CHECK(contents(path) == contents(whole));
}

TEST_CASE("a folder in use is refused, and left as it is") {
  const Folder folder;
  const Campaign campaign = campaign_of(quick_campaign(3));
  const auto path = folder.path() / "r";
  const std::string theirs = folder.write("notes.part", "what somebody wrote");
  CHECK_THAT(refusal(folder.path(), campaign, {}), Catch::Contains("a folder with files in it"));
  CHECK(read_text(theirs) == "what somebody wrote");
  (void)run_into(path, campaign);
  const auto before = contents(path);
  CHECK(refusal(path, campaign, {}) ==
        path.string() + ": found a folder with files in it, expected a new or an empty folder "
                        "(--resume continues a campaign)");
  CHECK(contents(path) == before);

  const auto file = folder.write("file", "text");
  CHECK(refusal(file, campaign, {}) ==
        file.string() + ": found a file, expected a new or an empty folder (--resume continues a "
                        "campaign)");
  const auto other = folder.path() / "other";
  std::filesystem::create_directory(other);
  std::ofstream(other / "notes.txt") << "mine";
  CHECK(refusal(other, campaign, {.resume = true}) ==
        other.string() + ": found no campaign.json in it, expected a results folder: one that "
                         "`wingspread run` or `merge` wrote");
  CHECK(contents(other).size() == 1);
}

TEST_CASE("another campaign, shard or version is not continued") {
  const Folder folder;
  const Campaign campaign = campaign_of(quick_campaign(6));
  const auto path = folder.path() / "r", file = path / campaign_file;
  (void)run_into(path, campaign, {.shard = Shard{1, 2}});
  const auto before = contents(path);
  const std::string to_continue = ", to continue what is there";

  Campaign other = campaign_of(quick_campaign(6));
  override_sampling(other, {}, 8);
  CHECK(refusal(path, other, {.shard = Shard{1, 2}, .resume = true}) ==
        file.string() + ": /sampling/seed: found 7 (when the folder was made), expected 8 (now)" +
            to_continue);
  CHECK(refusal(path, campaign, {.resume = true}) ==
        file.string() + ": /wingspread/shard: found shard 1/2, expected all runs" + to_continue);
  CHECK(contents(path) == before);

  replace(file, std::string(version()), "0.0.1");
  CHECK(refusal(path, campaign, {.shard = Shard{1, 2}, .resume = true}) ==
        file.string() + ": /wingspread/version: found 0.0.1, expected " + std::string(version()) +
            to_continue);
}

TEST_CASE("what differs in a campaign that is not continued is named with both values") {
  const Folder folder;
  const auto path = folder.path() / "r";
  Json json = quick_campaign(6);
  (void)run_into(path, campaign_of(json));
  const auto line = [&](const std::string& pointer, const char* found, const char* expected) {
    return (path / campaign_file).string() + ": " + pointer + ": found " + found +
           " (when the folder was made), expected " + expected +
           " (now), to continue what is there";
  };
  Json other = json;
  other["scene"]["bodies"][1]["mass"] = 11.5;
  other["sampling"]["seed"] = 8;
  other["statistics"]["quantiles"] = {0.5};
  other["requirements"] =
      parse_json(R"([{ "output": "deployed", "probability": 0.5, "confidence": 0.5 }])");
  const std::string told = refusal(path, campaign_of(other), {.resume = true});
  CHECK(told == line("/scene/bodies/1/mass", "10.0", "11.5") + '\n' +
                    line("/sampling/seed", "7", "8") + '\n' +
                    line("/statistics/quantiles", "an array of 3", "an array of 1") + '\n' +
                    line("/requirements", "nothing", "an array of 1"));

  other = json;
  for (Json& hinge : other["scene"]["hinges"]) {
    hinge["latch"]["stiffness"] = 12345;
    hinge["latch"]["damping"] = 123;
  }
  const std::string many = refusal(path, campaign_of(other), {.resume = true});
  CHECK(std::ranges::count(many, '\n') == 5);
  CHECK_THAT(many, Catch::Contains("/scene/hinges/2/latch/stiffness: found ") &&
                       Catch::Contains("/wingspread/hash: found ") &&
                       Catch::EndsWith(", to continue what is there: 6 values differ"));

  other = json;
  Json& dispersion = other["dispersions"][0];
  const Json name = dispersion["name"];
  dispersion.erase("name");
  dispersion["name"] = name;
  const Campaign reordered = campaign_of(other);
  CHECK(refusal(path, reordered, {.resume = true}) ==
        (path / campaign_file).string() + ": /wingspread/hash: found " +
            campaign_hash(campaign_of(json).resolved) + ", expected " +
            campaign_hash(reordered.resolved) +
            ", to continue what is there: the same values in another order");
}

TEST_CASE("rows with a gap between them are not continued") {
  const Folder folder;
  const Campaign campaign = campaign_of(quick_campaign(6));
  const auto path = folder.path() / "r", file = path / runs_file;
  (void)run_into(path, campaign);
  const std::string whole = read_text(file).value();
  std::string text = whole;
  const std::size_t start = text.find("\n2,") + 1;
  text.erase(start, text.find('\n', start) + 1 - start);
  std::ofstream(file, std::ios::binary) << text;
  CHECK_THAT(refusal(path, campaign, {.resume = true}),
             Catch::StartsWith(file.string() + ": found run 3, expected run 2, the next one") &&
                 Catch::Contains("delete the rows from run 3 on"));
  std::ofstream(file, std::ios::binary) << text.substr(0, text.find("\n3,") + 1);
  (void)run_into(path, campaign, {.resume = true}); // as the refusal says
  CHECK(read_text(file) == whole);
}
