#include "montecarlo/foundation/formats/printable.hpp"
#include "montecarlo/results/results_folder/merge.hpp"
#include "montecarlo/results/results_folder/parts.hpp"
#include "montecarlo/results/results_folder/version.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <ctime>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// A campaign of ten runs in three shards, and a folder for what they are merged into.
struct Shards {
  Folder folder{};
  Campaign campaign = campaign_of(quick_campaign(10));
  std::filesystem::path out = folder.path() / "out";
  std::vector<std::filesystem::path> parts{};

  Shards() {
    for (long i = 1; i <= 3; ++i) {
      parts.push_back(folder.path() / ("part" + std::to_string(i)));
      (void)run_into(parts.back(), campaign, {.shard = Shard{i, 3}});
    }
  }
  [[nodiscard]] std::string refusal(const std::vector<std::filesystem::path>& folders) const {
    const std::string message = message_of([&] { return merge_folders(folders, out); });
    CHECK_FALSE(std::filesystem::exists(out));
    return shortened(message);
  }
  /// The commands that make what is missing.
  [[nodiscard]] std::vector<std::string>
  commands(const std::vector<std::filesystem::path>& folders) const {
    try {
      (void)merge_folders(folders, out);
    } catch (const MissingRuns& missing) {
      std::vector<std::string> all;
      for (const std::string& command : missing.commands()) all.push_back(shortened(command));
      return all;
    }
    return {};
  }
  [[nodiscard]] std::string shortened(std::string message) const {
    const std::string here = folder.path().string() + "/";
    for (std::size_t at; (at = message.find(here)) != std::string::npos;)
      message.erase(at, here.size());
    return message;
  }
  /// Takes away a shard's rows from that run on.
  void cut(std::size_t part, long run) const {
    const auto file = parts[part] / runs_file;
    const std::string text = read_text(file).value();
    std::ofstream(file, std::ios::binary)
        << text.substr(0, text.find('\n' + std::to_string(run) + ',') + 1);
  }
};

} // namespace

TEST_CASE("merged shards are the whole, byte for byte", "[parallel]") {
  const Folder folder;
  const Campaign campaign = campaign_of(full_campaign(50));
  const auto whole = folder.path() / "whole";
  (void)run_into(whole, campaign, {.threads = 2});
  for (const long of : {1L, 2L, 3L, 7L, 60L}) { // 60: some shards are empty
    std::vector<std::filesystem::path> parts;
    const auto here = folder.path() / std::to_string(of);
    for (long i = of; i >= 1; --i) { // in any order
      parts.push_back(here / std::to_string(i));
      (void)run_into(parts.back(), campaign, {.threads = 2, .shard = Shard{i, of}});
    }
    (void)merge_folders(parts, here / "out");
    CHECK(contents(here / "out") == contents(whole));
  }
}

TEST_CASE("missing runs are named, with the folder that should have them") {
  Shards shards;
  CHECK(shards.refusal({shards.parts[0], shards.parts[2]}) ==
        "found no folder with runs 3 to 5, expected folders with all of the campaign's 10 runs");
  const auto file = shards.parts[1] / runs_file;
  const std::string text = read_text(file).value();
  std::ofstream(file, std::ios::binary) << text.substr(0, text.find("\n5,") + 4);
  CHECK(shards.refusal(shards.parts) ==
        "part2: found no runs 5, expected shard 2/3 complete (run it again with --resume)");
}

TEST_CASE("a run that is missing between others is named") {
  Shards shards;
  const auto file = shards.parts[1] / runs_file;
  std::string text = read_text(file).value();
  const std::size_t row = text.find("\n4,") + 1;
  std::ofstream(file, std::ios::binary) << text.erase(row, text.find('\n', row) + 1 - row);
  CHECK(shards.refusal(shards.parts) ==
        "part2: found no runs 4, expected shard 2/3 complete (rows were removed: delete all rows "
        "from run 5 on, then run it again with --resume)");
}

TEST_CASE("runs that two folders have are named") {
  Shards shards;
  CHECK(shards.refusal({shards.parts[0], shards.parts[1], shards.parts[1], shards.parts[2]}) ==
        "part2: found runs 3 to 5, which part2 has too, expected each run in one folder: shards of "
        "one division, as 1/N to N/N");
  const auto whole = shards.folder.path() / "whole";
  (void)run_into(whole, shards.campaign);
  std::string all = shards.refusal({shards.parts[0], shards.parts[1], shards.parts[2], whole});
  for (const char* each : {"runs 0 to 2, which part1", "runs 3 to 5, which part2",
                           "runs 6 to 9, which part3"}) // each pair of folders by itself
    CHECK_THAT(all, Catch::Contains("whole: found " + std::string(each) + " has too"));
}

TEST_CASE("folders of another campaign or version are not merged") {
  Shards shards;
  const auto other = shards.folder.path() / "other";
  Campaign campaign = shards.campaign;
  override_sampling(campaign, {}, 8);
  (void)run_into(other, campaign, {.shard = Shard{2, 3}});
  CHECK(shards.refusal({shards.parts[0], other, shards.parts[2]}) ==
        fmt::format("other/campaign.json: /sampling/seed: found 8, expected {}, as in part1",
                    shards.campaign.sampling.seed));
  const auto file = shards.parts[2] / campaign_file;
  std::string text = read_text(file).value();
  text.replace(text.find(version()), version().size(), "9.9.9");
  std::ofstream(file, std::ios::binary) << text;
  CHECK(shards.refusal(shards.parts) ==
        "part3/campaign.json: /wingspread/version: found 9.9.9, expected " +
            std::string(version()) + ", as in part1");
}

TEST_CASE("shards are not merged into a folder in use, nor from what is none") {
  Shards shards;
  CHECK(message_of([&] { return merge_folders(shards.parts, shards.parts[0]); }) ==
        shards.parts[0].string() + ": found a folder with files in it, expected a new or an empty "
                                   "folder for the merged results");
  CHECK(shards.refusal({shards.parts[0], shards.folder.path() / "no"}) ==
        "no: found no such folder, expected a results folder");
}

TEST_CASE("a finished folder is not merged into again, an interrupted merge is") {
  const Shards shards;
  (void)merge_folders(shards.parts, shards.out);
  const auto whole = contents(shards.out);
  std::ofstream(shards.out / summary_file) << "of another analyze";
  const std::string refused = message_of([&] { return merge_folders(shards.parts, shards.out); });
  CHECK_THAT(refused, Catch::Contains("finished") && Catch::Contains("--out") &&
                          Catch::Contains("wingspread analyze"));
  CHECK(read_text(shards.out / summary_file) == "of another analyze");
  std::filesystem::remove(shards.out / histograms_csv_file); // which is written last
  (void)merge_folders(shards.parts, shards.out);
  CHECK(contents(shards.out) == whole);
}

TEST_CASE("a campaign that stops at a width is not merged") {
  const Folder folder;
  Json json = quick_campaign(10);
  json["until"] = parse_json(R"([{ "output": "deployed", "width": 0.5 }])");
  const auto path = folder.path() / "r";
  (void)run_into(path, campaign_of(json));
  CHECK(message_of([&] { return merge_folders({path}, folder.path() / "out"); }) ==
        (path / campaign_file).string() +
            ": /until: found a campaign that may stop early, expected "
            "one that can have shards");
  CHECK_FALSE(std::filesystem::exists(folder.path() / "out"));
}

TEST_CASE("the commands that make what is missing are the ones to type") {
  using Commands = std::vector<std::string>;
  Shards shards;
  const auto& parts = shards.parts;
  CHECK(
      shards.commands({parts[1]}) ==
      Commands{"wingspread run part2/campaign.json --out part1 --shard 1/3 --resume", // it is there
               "wingspread run part2/campaign.json --out part3 --shard 3/3 --resume"});
  shards.cut(1, 5);
  CHECK(shards.commands(parts) ==
        Commands{"wingspread run part1/campaign.json --out part2 --shard 2/3 --resume"});
  // a folder at which a process is at work needs no command
  {
    const FolderLock lock(parts[1]);
    CHECK_THAT(shards.refusal(parts), Catch::Contains("part2: found no runs 5 yet: process ") &&
                                          Catch::Contains("wait until that process ends"));
    CHECK_THROWS_AS(shards.commands(parts), SpecError); // which would be caught if it had commands
  }
  std::filesystem::remove_all(parts[2]);
  CHECK(shards.commands({parts[0], parts[1]}) ==
        Commands{"wingspread run part1/campaign.json --out part2 --shard 2/3 --resume",
                 "wingspread run part1/campaign.json --out part3 --shard 3/3"});
  // a shard of another division, which leaves runs that are a shard of neither
  const auto odd = shards.folder.path() / "two halves";
  (void)run_into(odd, shards.campaign, {.shard = Shard{2, 2}});
  CHECK(shards.commands({odd}) ==
        Commands{"wingspread run 'two halves/campaign.json' --out shard_1_of_2 --shard 1/2"});
  // the number is the folder's own only where it stands once, and is no part of a longer one
  for (const auto& [name, other] :
       std::vector<std::pair<const char*, const char*>>{{"2", "1"},
                                                        {"a-2.b", "a-1.b"},
                                                        {"2_of", "1_of"},
                                                        {"run 2!", "'run 1!'"},
                                                        {"12", ""},
                                                        {"20", ""},
                                                        {"a29b", ""},
                                                        {"v02", ""},
                                                        {"2 of 2", ""},
                                                        {"second", ""}}) {
    CAPTURE(name);
    const auto half = shards.folder.path() / name;
    std::filesystem::rename(odd, half);
    const std::string expected = *other == '\0' ? "shard_1_of_2" : other;
    CHECK_THAT(shards.commands({half}).at(0),
               Catch::EndsWith(" --out " + expected + " --shard 1/2"));
    std::filesystem::rename(half, odd);
  }
  CHECK(shards.refusal({odd, parts[0]}) == "found no folder with runs 3 to 4, expected folders "
                                           "with all of the campaign's 10 runs");
  CHECK(shards.commands({odd, parts[0]}) == // runs 3 and 4 are one of six parts
        Commands{"wingspread run 'two halves/campaign.json' --out shard_3_of_6 --shard 3/6"});
  CHECK(shell_word("it's") == R"('it'\''s')");
  CHECK(shell_word("") == "''");
}

TEST_CASE("a preview has the rows that there are, says so, and is taken for nothing else") {
  Shards shards;
  shards.cut(2, 8);
  const std::vector<std::filesystem::path> some{shards.parts[2], shards.parts[0]};
  const Summary summary = merge_folders(some, shards.out, MergeKind::preview);
  CHECK(summary.runs == 5); // 0 to 2, 6 and 7
  const StoredCampaign stored = read_stored_campaign(shards.out);
  CHECK(stored.stamp.preview == Preview{5, 10});
  std::vector<long> runs;
  for_each_stored_row(stored, [&](const ResultRow& row) { runs.push_back(row.run); });
  CHECK(runs == std::vector<long>{0, 1, 2, 6, 7});
  // its gaps are no selection; the same rows of a folder that runs were made into would be
  Results rows(RunPlan(stored.campaign).names());
  for_each_stored_row(stored, [&](const ResultRow& row) { rows.append(row); });
  CHECK_FALSE(gaps_text(stored, rows, false));
  StoredCampaign own = stored;
  own.stamp.preview.reset();
  CHECK_THAT(gaps_text(own, rows, false).value_or(""),
             Catch::StartsWith("5 of 10 runs, with gaps"));
  CHECK_FALSE(gaps_text(own, rows, true)); // its goals were reached
  const Json about = parse_json_file(shards.out / summary_file)["wingspread"];
  CHECK(about["preview"] == Json{{"runs", 5}, {"of", 10}});
  CHECK(about["partial"] == Json{{"done", 5}, {"of", 10}});
  CHECK(message_of([&] { return run_into(shards.out, shards.campaign, {.resume = true}); }) ==
        (shards.out / campaign_file).string() +
            ": /wingspread/preview: found a preview of 5 of 10 runs, expected a folder that runs "
            "are made into: go on with the shards, and merge them");
  CHECK(message_of([&] { return merge_folders({shards.out}, shards.folder.path() / "o2"); }) ==
        (shards.out / campaign_file).string() +
            ": /wingspread/preview: found a preview of 5 of 10 runs, expected shards: what is "
            "merged has each run once");
  // the next preview takes its place, and so does the whole
  (void)merge_folders({shards.parts[0], shards.parts[1], shards.parts[2]}, shards.out,
                      MergeKind::preview);
  CHECK(read_stored_campaign(shards.out).stamp.preview == Preview{8, 10});
  (void)run_into(shards.parts[2], shards.campaign, {.shard = Shard{3, 3}, .resume = true});
  (void)merge_folders(shards.parts, shards.out);
  const auto whole = shards.folder.path() / "whole";
  (void)run_into(whole, shards.campaign);
  CHECK(contents(shards.out) == contents(whole));
  const auto at_once = shards.folder.path() / "at_once"; // nothing is missing: it is no preview
  (void)merge_folders(shards.parts, at_once, MergeKind::preview);
  CHECK(contents(at_once) == contents(whole));
}

TEST_CASE("a preview too refuses runs that two folders have, and wants one run") {
  Shards shards;
  CHECK(message_of([&] {
          return merge_folders({shards.parts[0], shards.parts[0]}, shards.out, MergeKind::preview);
        }).ends_with("expected each run in one folder: shards of one division, as 1/N to N/N"));
  shards.cut(0, 0);
  CHECK(shards.shortened(message_of([&] {
    return merge_folders({shards.parts[0]}, shards.out, MergeKind::preview);
  })) == "part1: found no runs, expected at least one");
  CHECK_FALSE(std::filesystem::exists(shards.out));
}

TEST_CASE("a preview is advised only if it can be made") {
  const Shards shards;
  const auto can_preview = [&](const std::vector<std::filesystem::path>& folders) {
    try {
      (void)merge_folders(folders, shards.out);
    } catch (const MissingRuns& missing) {
      return missing.can_preview();
    }
    FAIL("runs are missing");
    return false;
  };
  CHECK(can_preview({shards.parts[0]}));
  CHECK_FALSE(can_preview({shards.parts[0], shards.parts[0]}));
  std::filesystem::remove(shards.parts[0] / runs_file);
  CHECK_FALSE(can_preview({shards.parts[0]}));
  CHECK(can_preview({shards.parts[0], shards.parts[1]}));
}

TEST_CASE("the commands of very many missing shards take no longer than their number") {
  constexpr long of = 40'000;
  const ShardMaker maker{"wingspread run c.json"};
  const auto commands = [&](const std::vector<Part>& parts) {
    PartFaults faults;
    find_doubles(parts, faults);
    find_missing(parts, 2 * of, maker, faults);
    try {
      faults.refuse();
    } catch (const MissingRuns& missing) {
      return missing.commands();
    }
    return std::vector<std::string>{};
  };
  const auto part = [&](long index) {
    const std::string folder = "no_such/part" + std::to_string(index);
    Stamp stamp;
    stamp.shard = Shard{index, of};
    const RunRange own = shard_runs(2 * of, stamp.shard);
    return Part{folder, folder, stamp, own, {own}};
  };
  const std::clock_t start = std::clock();
  const std::vector<std::string> but_one = commands({part(7)});
  REQUIRE(but_one.size() == of - 1);
  CHECK(but_one[6] == fmt::format("wingspread run c.json --out no_such/part8 --shard 8/{}", of));
  std::vector<Part> odd;
  for (long index = 1; index <= of; index += 2) odd.push_back(part(index));
  CHECK(commands(odd).size() == of / 2);
  // 0.3 s of processor time; half a minute, if each looked at those before it
  CHECK(static_cast<double>(std::clock() - start) < 8.0 * CLOCKS_PER_SEC);
}
