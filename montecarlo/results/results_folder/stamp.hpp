/// The stamp: which campaign, seed and program version results belong to.
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

/// The shard's runs of R: ⌊(I − 1)R/N⌋ up to, excluding, ⌊I·R/N⌋. All runs without a shard.
/// @pre 1 ≤ index ≤ of ≤ most_shards
[[nodiscard]] RunRange shard_runs(long runs, const std::optional<Shard>& shard);

/// Marks the result of `merge --preview` that lacks runs: it has `runs` of the `of` runs.
struct Preview {
  long runs = 0, of = 0;
  bool operator==(const Preview&) const = default;
};

/// Identifies a file of results and its folder: the value of the key "wingspread".
struct Stamp {
  std::string version; ///< of the program
  std::uint64_t seed = 0;
  std::string hash; ///< of the campaign; equal for all its shards
  std::optional<Shard> shard;
  std::optional<Preview> preview{};
  /// Whether the folder has a part of the campaign's runs, which is not judged.
  [[nodiscard]] bool is_part() const { return shard || preview; }
  bool operator==(const Stamp&) const = default;
};

/// The stamp of a campaign run by this program.
[[nodiscard]] Stamp stamp_of(const Campaign& campaign, const std::optional<Shard>& shard);

/// "shard 2/5", or "all runs".
[[nodiscard]] std::string describe(const std::optional<Shard>& shard);
/// "a preview of 300 of 1000 runs".
[[nodiscard]] std::string describe(const Preview& preview);

[[nodiscard]] Json stamp_json(const Stamp& stamp);

/// Reads the stamp of a document, which must have one; notes problems in the cursor.
[[nodiscard]] Stamp read_stamp(const JsonCursor& document);

} // namespace wingspread
