#include "montecarlo/results/results_folder/stamp.hpp"

#include "montecarlo/results/results_folder/version.hpp"

#include <fmt/format.h>

namespace wingspread {
namespace {

constexpr const char* stamp_expected = "what `wingspread run` wrote: version, seed and hash";

void read_shard(const JsonCursor& at, std::optional<Shard>& shard) {
  JsonObject object(at, "an object with index and of");
  std::int64_t index = 0, of = 0;
  const bool has_index = object.required("index", index, "an integer, ≥ 1");
  const bool has_of = object.required("of", of, "an integer, ≥ index");
  object.refuse_others();
  if (index >= 1 && index <= of && of <= most_shards)
    shard = {index, of};
  else if (has_index && has_of)
    at.refuse(fmt::format("{} of {}", index, of), "1 ≤ index ≤ of");
}

void read_preview(const JsonCursor& at, std::optional<Preview>& preview) {
  JsonObject object(at, "an object with runs and of");
  std::int64_t runs = 0, of = 0;
  const bool has_runs = object.required("runs", runs, "an integer, ≥ 1");
  const bool has_of = object.required("of", of, "an integer, > runs");
  object.refuse_others();
  if (runs >= 1 && of > runs)
    preview = {runs, of};
  else if (has_runs && has_of)
    at.refuse(fmt::format("{} of {}", runs, of), "1 ≤ runs < of");
}

} // namespace

RunRange shard_runs(long runs, const std::optional<Shard>& shard) {
  if (!shard) return {0, runs};
  const long whole = runs / shard->of, rest = runs % shard->of; // i·runs itself could overflow
  const auto end = [&](long i) { return i * whole + i * rest / shard->of; };
  return {end(shard->index - 1), end(shard->index)};
}

Stamp stamp_of(const Campaign& campaign, const std::optional<Shard>& shard) {
  return {std::string(version()), campaign.sampling.seed, campaign_hash(campaign.resolved), shard,
          std::nullopt};
}

std::string describe(const std::optional<Shard>& shard) {
  return shard ? fmt::format("shard {}/{}", shard->index, shard->of) : "all runs";
}

std::string describe(const Preview& preview) {
  return fmt::format("a preview of {} of {} runs", preview.runs, preview.of);
}

Json stamp_json(const Stamp& stamp) {
  Json json{{"version", stamp.version}, {"seed", stamp.seed}, {"hash", stamp.hash}};
  if (stamp.shard) json["shard"] = {{"index", stamp.shard->index}, {"of", stamp.shard->of}};
  if (stamp.preview) json["preview"] = {{"runs", stamp.preview->runs}, {"of", stamp.preview->of}};
  return json;
}

Stamp read_stamp(const JsonCursor& document) {
  Stamp stamp;
  JsonObject campaign(document, "a campaign: an object");
  const auto at = campaign.require(stamp_key, stamp_expected);
  if (!at) return stamp;
  JsonObject object(*at, stamp_expected);
  object.required("version", stamp.version, "a string, the program's version");
  object.required("seed", stamp.seed, "an integer from 0 to 2^64 - 1");
  object.required("hash", stamp.hash, "a string, the campaign's hash");
  if (const auto shard = object.find("shard")) read_shard(*shard, stamp.shard);
  if (const auto preview = object.find("preview")) read_preview(*preview, stamp.preview);
  object.refuse_others();
  return stamp;
}

} // namespace wingspread
