/// What says which campaign, seed and program results are from.
#pragma once

#include "montecarlo/engine/runs/evaluator.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"
#include "montecarlo/model/campaign/campaign.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace wingspread {

/// Part `index` of `of`, counted from 1.
struct Shard {
  long index = 1, of = 1;
  bool operator==(const Shard&) const = default;
};
inline constexpr long most_shards = 1'000'000;

/// Its runs of R: from ⌊(I − 1)R/N⌋ up to, not including, ⌊I·R/N⌋. All of them without a shard.
/// @pre 1 ≤ index ≤ of ≤ most_shards
[[nodiscard]] RunRange shard_runs(long runs, const std::optional<Shard>& shard);

/// Results that some runs of the campaign are missing from, anywhere: a look at what there is so far, and no more.
struct Preview {
  long runs = 0, of = 0;
  bool operator==(const Preview&) const = default;
};

/// What identifies a file of results and its folder: the value of its key "wingspread".
struct Stamp {
  std::string version; ///< of the program
  std::uint64_t seed = 0;
  std::string hash; ///< of the campaign; the same for all of its shards
  std::optional<Shard> shard;
  std::optional<Preview> preview{};
  bool operator==(const Stamp&) const = default;
};

/// That of a campaign as this program runs it.
[[nodiscard]] Stamp stamp_of(const Campaign& campaign, const std::optional<Shard>& shard);

/// "shard 2/5", or "all runs".
[[nodiscard]] std::string describe(const std::optional<Shard>& shard);
/// "a preview of 300 of 1000 runs".
[[nodiscard]] std::string describe(const Preview& preview);

[[nodiscard]] Json stamp_json(const Stamp& stamp);

/// Reads the stamp of a document, which has to have one, and notes what is wrong.
[[nodiscard]] Stamp read_stamp(const JsonCursor& document);

} // namespace wingspread
