#include "montecarlo/results/results_folder/stamp.hpp"
#include "montecarlo/results/results_folder/version.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <utility>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("shards are consecutive and make up the whole") {
  CHECK(shard_runs(100, {}) == RunRange{0, 100});
  CHECK(shard_runs(10, Shard{2, 3}) == RunRange{3, 6});
  for (const long runs : {1L, 7L, 100L, 1'000'000'000'000'000'000L})
    for (const long of : {1L, 3L, 7L, 64L, most_shards}) {
      long next = 0;
      for (long i = 1; i <= std::min(of, 100L); ++i) {
        const RunRange range = shard_runs(runs, Shard{i, of});
        CHECK(range.first == next);
        CHECK(std::abs(range.size() - runs / of) <= 1);
        next = range.last;
      }
      CHECK(shard_runs(runs, Shard{of, of}).last == runs);
    }
}

TEST_CASE("a stamp reads back from its JSON, and has its keys in one order") {
  const Campaign campaign = campaign_of(quick_campaign(10));
  const Stamp stamp = stamp_of(campaign, Shard{2, 3});
  CHECK(stamp_json(stamp).dump() ==
        R"({"version":")" + std::string(version()) + R"(","seed":7,"hash":")" +
            campaign_hash(campaign.resolved) + R"(","shard":{"index":2,"of":3}})");
  const Json document{{stamp_key, stamp_json(stamp)}};
  std::vector<Problem> problems;
  CHECK(read_stamp(JsonCursor(document, "", problems)) == stamp);
  CHECK(problems.empty());
}

TEST_CASE("no object of a stamp has a key that is not read") {
  Stamp stamp = stamp_of(campaign_of(quick_campaign(10)), Shard{2, 3});
  stamp.preview = Preview{5, 10};
  const auto message_for = [](const Json& json) {
    return problems_of(Json{{stamp_key, json}}, [](const JsonCursor& at) { (void)read_stamp(at); });
  };
  CHECK(message_for(stamp_json(stamp)).empty());
  CHECK(objects_with_unread_keys(stamp_json(stamp), message_for) == std::vector<std::string>{});
}

TEST_CASE("a stamp's shard and preview that cannot be are refused with their numbers") {
  const auto problems = [](const char* key, Json value) {
    Json json = stamp_json(stamp_of(campaign_of(quick_campaign(10)), {}));
    json[key] = std::move(value);
    return problems_of(Json{{stamp_key, json}}, [](const JsonCursor& at) { (void)read_stamp(at); });
  };
  for (const auto& [index, of] : {std::pair(1L, 1L), {1L, 3L}, {3L, 3L}, {1L, most_shards}})
    CHECK(problems("shard", {{"index", index}, {"of", of}}).empty());
  for (const auto& [index, of] :
       {std::pair(0L, 3L), {-2L, 3L}, {4L, 3L}, {0L, 0L}, {1L, most_shards + 1}})
    CHECK_THAT(problems("shard", {{"index", index}, {"of", of}}),
               Catch::StartsWith("/wingspread/shard: ") &&
                   Catch::Contains(fmt::format("found {} of {}, ", index, of)));
  for (const auto& [runs, of] : {std::pair(1L, 2L), {9L, 10L}})
    CHECK(problems("preview", {{"runs", runs}, {"of", of}}).empty());
  for (const auto& [runs, of] : {std::pair(0L, 3L), {-2L, 3L}, {3L, 3L}, {4L, 3L}})
    CHECK_THAT(problems("preview", {{"runs", runs}, {"of", of}}),
               Catch::StartsWith("/wingspread/preview: ") &&
                   Catch::Contains(fmt::format("found {} of {}, ", runs, of)));
  // a key that is missing is refused once, without a number that nobody wrote
  CHECK_THAT(problems("shard", {{"index", 1}}),
             Catch::Contains("/of: found nothing") && !Catch::Contains(" of 0"));
  CHECK_THAT(problems("preview", {{"runs", 3}}),
             Catch::Contains("/of: found nothing") && !Catch::Contains(" of 0"));
}
