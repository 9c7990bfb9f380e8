/// Uniform random numbers that depend on (seed, run, name) only.
///
/// The generator is counter-based (Philox4x64-10; Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", SC
/// 2011): it has no state, and any number of any stream can be computed alone. Threads, shards, order and resumption
/// cannot change a draw.
///
///   word       holds
///   key 0      the campaign's seed
///   key 1      the purpose: 0 for a dispersion's draws, else a StreamUse
///   counter 0  the block within the stream (four numbers each); of a design, its level or round
///   counter 1  the run; of a design, the node or half that the level or round depends on
///   counter 2  the hash of the dispersion's name
///   counter 3  the design's replicate; 0 for draws
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>

namespace wingspread {

/// A name's stream. Two names share a stream only if their hashes collide; the campaign's reader refuses that.
struct StreamName {
  std::uint64_t hash = 0;
  friend bool operator==(StreamName, StreamName) = default;
};

/// The stream of a name: FNV-1a, 64 bits, over the name's bytes (Fowler, Noll, Vo; RFC 9923). Its
/// weak mixing is harmless: Philox mixes. Cost: one multiplication a byte.
[[nodiscard]] constexpr StreamName stream_name(std::string_view name) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return {hash};
}

using PhiloxKey = std::array<std::uint64_t, 2>;
using PhiloxBlock = std::array<std::uint64_t, 4>;

/// Philox4x64-10's bijection of the counter under the key. Cost: 20 wide multiplications.
[[nodiscard]] PhiloxBlock philox(const PhiloxKey& key, const PhiloxBlock& counter);

/// Turns 64 random bits into a uniform number: an odd multiple of 2⁻⁵³, so that u and 1 − u are both exact and neither
/// is ever 0 or 1. This leaves 52 random bits; with 53 bits k, (k + ½)·2⁻⁵³ would round to 1 for the largest k.
/// Extremes: 2⁻⁵³ = 1.1e-16 and 1 − 2⁻⁵³ (±8.2 σ of a normal law).
[[nodiscard]] constexpr double open_uniform(std::uint64_t bits) {
  return static_cast<double>((bits >> 11) | 1u) * 0x1p-53;
}

/// The stream's first number in (0, 1): the draw of a dispersion in a run.
[[nodiscard]] double uniform(std::uint64_t seed, std::uint64_t run, StreamName name);

/// The purposes of random numbers other than draws.
enum class StreamUse : std::uint64_t { scrambling = 1, permutation = 2, stratum = 3, choice = 4 };

/// A run's rank among runs to choose from: the runs with the least ranks are a simple random sample without replacement.
[[nodiscard]] std::uint64_t choice_rank(std::uint64_t seed, std::uint64_t run);

/// The random numbers of a dispersion in one replicate of a design.
struct ReplicateStream {
  std::uint64_t seed;
  StreamName name;
  std::uint64_t replicate;

  [[nodiscard]] PhiloxBlock block(StreamUse use, std::uint64_t level, std::uint64_t at) const {
    return philox({seed, static_cast<std::uint64_t>(use)}, {level, at, name.hash, replicate});
  }
};

/// One stream as a uniform random bit generator for std and Boost.Random. `uniform` uses its first number. Period 2⁶⁶.
class RandomStream {
public:
  using result_type = std::uint64_t;
  static constexpr bool has_fixed_range = false; ///< required by Boost.Random

  RandomStream(std::uint64_t seed, std::uint64_t run, StreamName name)
      : key_{seed, 0}, counter_{0, run, name.hash, 0} {}

  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }
  result_type operator()();

private:
  PhiloxKey key_;
  PhiloxBlock counter_;
  PhiloxBlock block_{};
  std::size_t used_ = 4; ///< how many numbers of block_ have been handed out
};

} // namespace wingspread
