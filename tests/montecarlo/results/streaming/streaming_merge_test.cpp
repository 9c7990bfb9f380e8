#include "montecarlo/results/results_folder/version.hpp"
#include "montecarlo/results/streaming/streaming_folder.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

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
  const auto refusal = [&](const std::filesystem::path& second) {
    const std::string text = message_of([&] {
      (void)merge_streaming({a, second}, folder.path() / "out");
    });
    CHECK_FALSE(std::filesystem::exists(folder.path() / "out"));
    return text;
  };
  CHECK_THAT(refusal(c), Catch::StartsWith(c.string() + ": found campaign "));
  const std::string text = read_text(b / campaign_file).value(), now(version());
  for (const bool first : {true, false}) { // whichever of them another version made
    const std::string changed = read_text((first ? a : b) / campaign_file).value();
    std::string of_other = changed;
    of_other.replace(of_other.find(now), now.size(), "9.9.9");
    write_file((first ? a : b) / campaign_file, of_other);
    CHECK_THAT(refusal(b), Catch::StartsWith(b.string() + ": found campaign ") &&
                               Catch::Contains("by version " + (first ? now : "9.9.9")) &&
                               Catch::Contains("by " + (first ? "9.9.9" : now)));
    write_file((first ? a : b) / campaign_file, changed);
  }
  CHECK(merge_streaming({b, a}, folder.path() / "out").runs == 40);
}
