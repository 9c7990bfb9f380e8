#include "montecarlo/results/results_folder/parts.hpp"
#include "montecarlo/results/results_folder/version.hpp"
#include "montecarlo/results/streaming/streaming_folder.hpp"
#include "montecarlo/results/streaming/streaming_summary.hpp"
#include "montecarlo/results/summary/table.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <optional>

using namespace wingspread;
using namespace wingspread::test;

namespace {

void make_shard(const std::filesystem::path& path, const Campaign& campaign, const Shard& shard) {
  const RunPlan plan(campaign);
  StreamingFolder folder(path, plan, shard, false);
  ThreadEvaluator evaluator({.threads = 1}, never);
  REQUIRE(folder.begin(evaluator));
  const auto keep = [&](const Batch& batch) { folder.add(batch); };
  (void)evaluator.make(plan, folder.remaining(), {keep});
  folder.finish();
}

} // namespace

TEST_CASE("shards without rows are merged only if one version made them of one campaign") {
  const Folder folder;
  const auto a = folder.path() / "a", b = folder.path() / "b", c = folder.path() / "c";
  const Campaign campaign = campaign_of(quick_campaign(40));
  make_shard(a, campaign, {1, 2});
  make_shard(b, campaign, {2, 2});
  Json other = quick_campaign(40);
  other["sampling"]["seed"] = 8;
  make_shard(c, campaign_of(other), {2, 2});
  const auto out = folder.path() / "out";
  const auto refusal = [&](const std::filesystem::path& second) {
    const std::string text = message_of([&] { (void)merge_streaming({a, second}, out); });
    CHECK_FALSE(std::filesystem::exists(out));
    return text;
  };
  CHECK_THAT(refusal(c),
             Catch::Contains((c / campaign_file).string() + ": /sampling/seed: found 8") &&
                 Catch::Contains("as in " + a.string()));
  const std::string text = read_text(b / campaign_file).value(), now(version());
  for (const bool first : {true, false}) { // whichever of them another version made
    const std::string changed = read_text((first ? a : b) / campaign_file).value();
    std::string of_other = changed;
    of_other.replace(of_other.find(now), now.size(), "9.9.9");
    write_file((first ? a : b) / campaign_file, of_other);
    CHECK_THAT(refusal(b), Catch::StartsWith((b / campaign_file).string()) &&
                               Catch::Contains("found " + (first ? now : "9.9.9")) &&
                               Catch::Contains("expected " + (first ? "9.9.9" : now)));
    write_file((first ? a : b) / campaign_file, changed);
  }
  CHECK(merge_streaming({b, a}, out).runs == 40);
}

TEST_CASE("shards without rows whose files are not those of their statistics are not merged") {
  const Folder folder;
  const auto a = folder.path() / "a", b = folder.path() / "b", out = folder.path() / "out";
  const Campaign campaign = campaign_of(full_campaign(60));
  make_shard(a, campaign, {1, 2});
  make_shard(b, campaign, {2, 2});
  const auto refusal = [&] {
    const std::string text = message_of([&] { (void)merge_streaming({a, b}, out); });
    CHECK_FALSE(std::filesystem::exists(out));
    return text;
  };
  const std::string broken = read_text(a / broken_runs_file).value();
  REQUIRE(std::ranges::count(broken, '\n') > 3);
  std::filesystem::resize_file(a / broken_runs_file, broken.size() - 1);
  CHECK_THAT(refusal(), Catch::StartsWith((a / broken_runs_file).string()) &&
                            Catch::Contains(fmt::format("found {} bytes", broken.size() - 1)) &&
                            Catch::Contains(std::to_string(broken.size())));
  CHECK_FALSE(message_of([&] {
                return read_streaming_statistics(read_stored_campaign(a)).statistics.runs();
              }).empty()); // as `analyze` and `report` read it
  std::filesystem::remove(a / broken_runs_file);
  CHECK_THAT(refusal(), Catch::Contains("found 0 bytes"));
  write_file(a / broken_runs_file, broken);
  for (const char* file : {statistics_file, broken_runs_file}) // the other shard's
    std::filesystem::copy_file(b / file, a / file,
                               std::filesystem::copy_options::overwrite_existing);
  CHECK_THAT(refusal(), Catch::StartsWith((a / statistics_file).string()) &&
                            Catch::Contains("campaign and shard"));
}

TEST_CASE("shards without rows are merged only below the same header") {
  const Folder folder;
  const auto a = folder.path() / "a", b = folder.path() / "b", out = folder.path() / "out";
  const Campaign campaign = campaign_of(full_campaign(40));
  make_shard(a, campaign, {1, 2});
  make_shard(b, campaign, {2, 2});
  std::string broken = read_text(b / broken_runs_file).value();
  broken.replace(0, std::string("run,status").size(), "status,run"); // of the same length
  write_file(b / broken_runs_file, broken);
  CHECK_THAT(message_of([&] {
               (void)merge_streaming({a, b}, out);
             }),
             Catch::Contains("\"status\" as column 1"));
  CHECK_FALSE(std::filesystem::exists(out));
}

TEST_CASE("missing shards without rows are named, with the commands that make them") {
  const Folder folder;
  const Campaign campaign = campaign_of(quick_campaign(30));
  std::vector<std::filesystem::path> parts;
  for (const long index : {1L, 2L, 3L}) {
    parts.push_back(folder.path() / fmt::format("part{}", index));
    if (index != 2) make_shard(parts.back(), campaign, {index, 3});
  }
  const auto refused = [&](const std::vector<std::filesystem::path>& folders) {
    std::optional<MissingRuns> found;
    try {
      (void)merge_streaming(folders, folder.path() / "out");
    } catch (const MissingRuns& missing) {
      found = missing;
    }
    CHECK_FALSE(std::filesystem::exists(folder.path() / "out"));
    REQUIRE(found);
    return *found;
  };
  const auto command = [&](long index, const char* more) {
    return fmt::format("wingspread run {} --out {} --shard {}/3 --no-rows{}",
                       (parts[2] / campaign_file).string(),
                       parts[static_cast<std::size_t>(index - 1)].string(), index, more);
  };
  const MissingRuns two = refused({parts[2], parts[0]});
  CHECK_THAT(two.what(), Catch::Contains("no folder with runs 10 to 19"));
  CHECK(two.commands() == std::vector{command(2, "")});
  const MissingRuns ends = refused({parts[2]});
  CHECK(ends.commands() == std::vector{command(1, " --resume"), command(2, "")});

  const RunPlan plan(campaign);
  {
    StreamingFolder begun(parts[1], plan, Shard{2, 3}, false);
    ThreadEvaluator evaluator({.threads = 1}, never);
    REQUIRE(begun.begin(evaluator));
  }
  CHECK(refused({parts[2], parts[0], parts[1]}).commands() == std::vector{command(2, " --resume")});
  for (const char* file : {statistics_file, broken_runs_file}) // killed before it wrote them
    std::filesystem::remove(parts[1] / file);
  CHECK(refused({parts[2], parts[0], parts[1]}).commands() == std::vector{command(2, " --resume")});
  CHECK_THAT(message_of([&] {
               (void)merge_streaming({parts[0], parts[2], parts[0]}, "out");
             }),
             Catch::Contains("runs 0 to 9, which " + parts[0].string() + " has too"));
}

TEST_CASE("an interrupted merge without rows is repeated, a finished folder is not merged into") {
  const Folder folder;
  const auto a = folder.path() / "a", b = folder.path() / "b", out = folder.path() / "out",
             whole = folder.path() / "whole";
  const Campaign campaign = campaign_of(full_campaign(40));
  make_shard(a, campaign, {1, 2});
  make_shard(b, campaign, {2, 2});
  (void)merge_streaming({a, b}, whole);
  const auto expected = contents(whole);
  std::vector<const char*> written{campaign_file, broken_runs_file, statistics_file, summary_file,
                                   extremes_file}; // in this order
  CHECK_THAT(message_of([&] {
               (void)merge_streaming({a, b}, whole);
             }),
             Catch::Contains("a new or an empty folder"));
  while (written.size() > 1) {
    written.pop_back();
    CAPTURE(written.back());
    std::filesystem::remove_all(out);
    std::filesystem::create_directory(out);
    for (const char* file : written) std::filesystem::copy_file(whole / file, out / file);
    (void)merge_streaming({a, b}, out);
    CHECK(contents(out) == expected);
  }
  std::filesystem::remove(out / extremes_file);
  write_file(out / runs_file, "run\n"); // of the same campaign, with rows
  CHECK_THAT(message_of([&] {
               (void)merge_streaming({a, b}, out);
             }),
             Catch::Contains("a new or an empty folder"));
}

TEST_CASE("shards whose latch orders together exceed the limit are not merged") {
  constexpr long half = 60'000;
  const Folder folder;
  Json json = quick_campaign(2 * half);
  json["outputs"] = {"latch_time"};
  const Campaign campaign = campaign_of(json);
  const ResultNames names = RunPlan(campaign).names();
  std::string header;
  append_header(header, names);
  const auto row = [&](long run, long order) {
    return ResultRow{run,
                     Status::deployed,
                     std::vector<double>(names.draws.size(), 1.0),
                     std::vector<double>(names.outputs.size(), 1.0),
                     "order" + std::to_string(order),
                     ""};
  };
  std::vector<std::filesystem::path> parts;
  std::vector<StreamingStatistics> statistics;
  const auto write_shard = [&](const Shard& shard, long first_order) {
    const StoredCampaign stored{parts.emplace_back(folder.path() / std::to_string(parts.size())),
                                campaign, stamp_of(campaign, shard)};
    StreamingStatistics& made = statistics.emplace_back(campaign, names, Results(names));
    for (long run = stored.runs().first; run < stored.runs().last; ++run)
      (void)made.add(row(run, first_order + run % half), {});
    make_folder(stored.folder);
    write_file(stored.folder / campaign_file, campaign_text(campaign, stored.stamp));
    write_file(stored.folder / broken_runs_file, header);
    write_file(stored.folder / statistics_file,
               streaming_statistics_text(stored, made, header.size()));
  };
  statistics.reserve(3);
  write_shard({1, 2}, 0);
  write_shard({2, 2}, half);
  const auto out = folder.path() / "out";
  CHECK_THAT(message_of([&] { (void)merge_streaming(parts, out); }),
             Catch::Contains("more than 100000 latch orders"));
  CHECK_FALSE(std::filesystem::exists(out));
  CHECK_THROWS_AS(statistics[0].add(statistics[1]), SpecError);
  CHECK(statistics[0].runs() == half);
  CHECK(statistics[0].latch_orders().size() == half);

  write_shard({2, 2}, half / 2); // 30,000 orders of the first shard, and 30,000 others
  const Summary merged = merge_streaming({parts[0], parts[2]}, out);
  CHECK(merged.latch_order_kinds == 3 * half / 2);
  CHECK_THAT(summary_table(merged, "title", ""), !Catch::Contains("more than"));

  for (long run = half; run < 2 * half; ++run) (void)statistics[0].add(row(run, run), {});
  CHECK(statistics[0].other_orders() == 20'000);
  const StoredCampaign whole{"whole", campaign, stamp_of(campaign, {})};
  CHECK_THAT(
      summary_table(streaming_summary(whole, statistics[0], campaign.statistics), "title", ""),
      Catch::Contains("more than 99992 other orders"));
}
