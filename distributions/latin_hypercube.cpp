#include "distributions/latin_hypercube.hpp"

#include <cassert>
#include <cmath>

namespace wingspread {
namespace {

__extension__ typedef unsigned __int128 Wide; // NOLINT(modernize-use-using): takes __extension__

constexpr unsigned rounds = 16;

/// An integer below `bound` from 64 random bits; its bias, bound/2⁶⁴, is negligible.
std::uint64_t below(std::uint64_t bound, std::uint64_t bits) {
  return static_cast<std::uint64_t>((Wide{bits} * bound) >> 64);
}

std::uint64_t divided_up(std::uint64_t n, std::uint64_t by) { return n / by + (n % by != 0); }

std::uint64_t root_up(std::uint64_t n) {
  auto root = static_cast<std::uint64_t>(std::sqrt(static_cast<double>(n)));
  while (Wide{root} * root < n) ++root;
  while (root > 1 && Wide{root - 1} * (root - 1) >= n) --root;
  return root;
}

/// The Feistel network: the sizes of its halves, and one pass through it.
struct Network {
  std::uint64_t a, b;

  explicit Network(std::uint64_t n) : a(root_up(n)), b(divided_up(n, a)) {}

  [[nodiscard]] std::uint64_t pass(std::uint64_t x, const ReplicateStream& stream) const {
    std::uint64_t left = x / b, right = x % b;
    for (unsigned round = 0; round < rounds; round += 2) {
      left = turned(left, a, round, right, stream);
      right = turned(right, b, round + 1, left, stream);
    }
    return left * b + right;
  }

  /// half + F_round(other) mod size
  static std::uint64_t turned(std::uint64_t half, std::uint64_t size, unsigned round,
                              std::uint64_t other, const ReplicateStream& stream) {
    return (half + below(size, stream.block(StreamUse::permutation, round, other)[0])) % size;
  }
};

/// The first q with (2q + 1)·2⁻⁵³ ≥ s/n.
std::uint64_t first_in(std::uint64_t s, std::uint64_t n) {
  return static_cast<std::uint64_t>(((Wide{s} << 53) + n - 1) / (Wide{2} * n));
}

} // namespace

std::uint64_t latin_stratum(std::uint64_t i, std::uint64_t n, const ReplicateStream& stream) {
  assert(i < n);
  const Network network(n);
  std::uint64_t x = network.pass(i, stream);
  while (x >= n) x = network.pass(x, stream); // a·b < n + a: rare
  const std::uint64_t shift = below(n, stream.block(StreamUse::permutation, rounds, 0)[0]);
  return x < n - shift ? x + shift : x - (n - shift);
}

double latin_coordinate(std::uint64_t i, std::uint64_t n, const ReplicateStream& stream) {
  const std::uint64_t s = latin_stratum(i, n, stream);
  const std::uint64_t first = first_in(s, n), last = first_in(s + 1, n);
  const std::uint64_t q = first + below(last - first, stream.block(StreamUse::stratum, 0, i)[0]);
  return static_cast<double>(2 * q + 1) * 0x1p-53;
}

} // namespace wingspread
