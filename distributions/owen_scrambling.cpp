#include "distributions/owen_scrambling.hpp"

#include <cstddef>

namespace wingspread {
namespace {

constexpr int levels = 7; // of eight digits each

/// The flips of eight digits. Their subtree has 1 + 2 + … + 128 = 255 nodes, a bit of the block for
/// each: node 2ʲ − 1 + p for digit j when those before it in the subtree are p.
std::uint64_t flips(std::uint64_t digits, const PhiloxBlock& bits) {
  std::uint64_t flipped = 0;
  for (unsigned j = 0; j < 8; ++j) {
    const std::uint64_t node = (1u << j) - 1 + (digits >> (8 - j));
    flipped = 2 * flipped + ((bits[static_cast<std::size_t>(node / 64)] >> (node % 64)) & 1);
  }
  return flipped;
}

} // namespace

std::uint64_t owen_scrambled(std::uint64_t x, const ReplicateStream& stream) {
  std::uint64_t flipped = 0, prefix = 0; // the digits before the level's
  for (unsigned level = 0; level < levels; ++level) {
    const unsigned shift = 56 - 8 * level;
    const std::uint64_t digits = (x >> shift) & 0xFF;
    flipped |= flips(digits, stream.block(StreamUse::scrambling, level, prefix)) << shift;
    prefix = x >> shift;
  }
  return x ^ flipped;
}

} // namespace wingspread
