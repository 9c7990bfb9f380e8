#include "montecarlo/foundation/formats/printable.hpp"
#include "montecarlo/model/campaign/cases.hpp"
#include "montecarlo/results/results_folder/cases_folder.hpp"
#include "montecarlo/results/results_folder/merge.hpp"
#include "montecarlo/results/results_folder/parts.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// Makes a shard of these cases of a campaign, as `run --shard --case` does.
void make(const std::filesystem::path& path, const Campaign& campaign, const Shard& shard,
          const std::vector<std::string>& names) {
  const CasesFolder folder(path, campaign, shard, false);
  for (const CaseSpec& spec : chosen_cases(campaign, names))
    (void)run_into(path / spec.name, campaign_of_case(campaign, spec), {.shard = shard});
}

Campaign hot_and_cold(int runs) {
  Json json = quick_campaign(runs);
  json["cases"] = parse_json(R"([{ "name": "cold", "scale": { "hinges.*.spring.scale": 0.9 } },
                                 { "name": "hot", "scale": { "hinges.*.spring.scale": 1.1 } }])");
  return campaign_of(json);
}

} // namespace

TEST_CASE("the command for a missing shard makes the cases that the others have, and no more",
          "[cases]") {
  using Names = std::vector<std::string>;
  Json json = quick_campaign(6);
  json["cases"] = parse_json(R"([{ "name": "cold", "scale": { "hinges.*.spring.scale": 0.9 } },
                                 { "name": "hot", "scale": { "hinges.*.spring.scale": 1.1 } },
                                 { "name": "as_it_is" }])");
  const Campaign campaign = campaign_of(json);
  for (const Names& names :
       {Names{"cold"}, Names{"cold", "as_it_is"}, Names{"hot"}, Names{"cold", "hot", "as_it_is"}}) {
    const Folder folder;
    make(folder.path() / "a", campaign, {1, 2}, names);
    Names commands;
    try {
      (void)merge_cases({folder.path() / "a"}, folder.path() / "out");
    } catch (const MissingRuns& missing) {
      commands = missing.commands();
    }
    REQUIRE(commands.size() == 1);
    CAPTURE(commands[0]);
    for (const CaseSpec& spec : campaign.cases) {
      const bool made = std::ranges::find(names, spec.name) != names.end();
      const bool named = commands[0].find(" --case " + shell_word(spec.name)) != std::string::npos;
      CHECK(named == (made && names.size() < 3)); // all of them are what is made anyway
    }
  }
}

TEST_CASE("shards in which no case has begun lack all runs of all cases", "[cases]") {
  const Folder folder;
  const Campaign campaign = hot_and_cold(6);
  const auto a = folder.path() / "part1", b = folder.path() / "part2", out = folder.path() / "out";
  for (const long index : {1L, 2L})
    (void)CasesFolder(index == 1 ? a : b, campaign, Shard{index, 2}, false);
  const auto commands = [&](const std::vector<std::filesystem::path>& folders) {
    std::vector<std::string> found;
    try {
      (void)merge_cases(folders, out);
    } catch (const MissingRuns& missing) {
      found = missing.commands();
      for (const char* name : {"cold", "hot"})
        CHECK_THAT(missing.what(), Catch::Contains((a / name).string() + ": found no runs 0 to 2"));
    }
    CHECK_FALSE(std::filesystem::exists(out));
    return found;
  };
  const std::string run = "wingspread run " + (a / campaign_file).string() + " --out ";
  const std::string first = run + a.string() + " --shard 1/2 --resume",
                    second = run + b.string() + " --shard 2/2 --resume";
  CHECK(commands({a, b}) == std::vector{first, second});
  CHECK(commands({a}) == std::vector{first, second}); // the folder is there, though it is not given
  CHECK_THAT(message_of([&] {
               (void)merge_cases({a, b}, out, MergeKind::preview);
             }),
             Catch::Contains("no runs"));
  CHECK_FALSE(std::filesystem::exists(out));
}

TEST_CASE("a merge removes all that an earlier preview of cases wrote, before it says it is whole",
          "[cases]") {
  const Folder folder;
  const Campaign campaign = hot_and_cold(6);
  const auto a = folder.path() / "a", b = folder.path() / "b", out = folder.path() / "out";
  make(a, campaign, {1, 2}, {});
  make(b, campaign, {2, 2}, {});
  (void)merge_cases({a}, out, MergeKind::preview);
  CHECK(read_stored_campaign(out).stamp.preview == Preview{6, 12}); // of both cases
  for (const auto& page : {out / "report.html", out / "hot" / "report.html"})
    write_file(page, "of the preview");
  SECTION("an interruption leaves nothing of it beside the new campaign.json") {
    const auto obstacle = out / "cold" / runs_file; // which a file does not replace
    std::filesystem::remove(obstacle);
    std::filesystem::create_directories(obstacle / "x");
    CHECK_THROWS((void)merge_cases({a, b}, out));
    std::filesystem::remove_all(obstacle);
  }
  const auto notes = out / "hot" / "notes.txt";
  bool has_notes = false;
  SECTION("files of somebody else stay") { write_file(notes, "the user's"), has_notes = true; }
  SECTION("nothing is in the way") { has_notes = false; }
  (void)merge_cases({a, b}, out);
  CHECK(std::filesystem::remove(notes) == has_notes);
  (void)merge_cases({a, b}, folder.path() / "whole");
  for (const char* name : {".", "cold", "hot"})
    CHECK(contents(out / name) == contents(folder.path() / "whole" / name));
}

TEST_CASE("a case of an earlier preview that is not merged now is removed", "[cases]") {
  const Folder folder;
  const Campaign campaign = hot_and_cold(6);
  const auto a = folder.path() / "a", b = folder.path() / "b", out = folder.path() / "out";
  make(a, campaign, {1, 2}, {});
  (void)merge_cases({a}, out, MergeKind::preview);
  std::filesystem::remove_all(a);
  make(a, campaign, {1, 2}, {"cold"});
  make(b, campaign, {2, 2}, {"cold"});
  const bool has_others = GENERATE(false, true);
  if (has_others) write_file(out / "hot" / "notes.txt", "the user's");
  CHECK(merge_cases({a, b}, out).size() == 1);
  CHECK(made_cases(read_stored_campaign(out)).size() == 1);
  CHECK(std::filesystem::exists(out / "hot") == has_others);
  if (has_others) CHECK(contents(out / "hot").size() == 1);
}
