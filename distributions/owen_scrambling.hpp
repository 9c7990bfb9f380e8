/// Nested uniform scrambling: A. B. Owen, "Randomly permuted (t,m,s)-nets and (t,s)-sequences", in
/// Monte Carlo and Quasi-Monte Carlo Methods in Scientific Computing (1995) 299–317.
///
/// Each binary digit is flipped or not by a random bit of its own for each value of the digits
/// before it. That leaves a net a net and makes each point uniform, so that means are unbiased;
/// their variance is o(1/n) for whatever has a variance at all (Owen, SIAM J. Numer. Anal. 34
/// (1997) 1884–1910), and nearly O(1/n³) for what is smooth (Owen, Ann. Statist. 25 (1997)
/// 1541–1562).
///
/// The random bits are Philox's own: one for each node of the binary tree of digits, computed where
/// it is wanted. So this is the exact scrambling, given Philox. Hashes that imitate it in a few
/// operations (Laine and Karras; Burley) were ruled out: their quality can only be tested, and a
/// draw's cost is nothing beside its run's.
#pragma once

#include "distributions/random_stream.hpp"

#include <cstdint>

namespace wingspread {

/// The point's coordinate x, scrambled by the stream's tree. Its first 56 digits are scrambled,
/// more than a double has. Cost: 7 Philox blocks, some 0.1 µs.
[[nodiscard]] std::uint64_t owen_scrambled(std::uint64_t x, const ReplicateStream& stream);

} // namespace wingspread
