#include "montecarlo/folder/merge.hpp"
#include "montecarlo/folder/version.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

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
    std::string message = message_of([&] { return merge_folders(folders, out); });
    CHECK_FALSE(std::filesystem::exists(out));
    const std::string here = folder.path().string() + "/";
    for (std::size_t at; (at = message.find(here)) != std::string::npos;)
      message.erase(at, here.size());
    return message;
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
        "part2: found no runs 4, expected shard 2/3 complete (run it again with --resume)");
}

TEST_CASE("runs that two folders have are named") {
  Shards shards;
  CHECK(shards.refusal({shards.parts[0], shards.parts[1], shards.parts[1], shards.parts[2]}) ==
        "part2: found runs 3 to 5, which part2 has too, expected each run in one folder");
}

TEST_CASE("folders of another campaign or version are not merged") {
  Shards shards;
  const auto other = shards.folder.path() / "other";
  Campaign campaign = shards.campaign;
  override_sampling(campaign, {}, 8);
  (void)run_into(other, campaign, {.shard = Shard{2, 3}});
  CHECK(shards.refusal({shards.parts[0], other, shards.parts[2]}) ==
        "other/campaign.json: /wingspread/hash: found " + campaign_hash(campaign.resolved) +
            ", expected " + campaign_hash(shards.campaign.resolved) + ", as in part1");
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
