/// Nested uniform scrambling: A. B. Owen, "Randomly permuted (t,m,s)-nets and (t,s)-sequences", in
/// Monte Carlo and Quasi-Monte Carlo Methods in Scientific Computing (1995) 299–317.
///
/// A random bit decides for each binary digit, and each value of the digits before it, whether the digit is flipped. A
/// net stays a net, and each point becomes uniform, so means are unbiased. Their variance is o(1/n) for every integrand
/// with finite variance (Owen, SIAM J. Numer. Anal. 34 (1997) 1884–1910) and nearly O(1/n³) for smooth ones (Owen,
/// Ann. Statist. 25 (1997) 1541–1562).
///
/// The random bits are Philox's, one for each node of the binary tree of digits, so the scrambling is exact. Hashes
/// that approximate the scrambling (Laine and Karras; Burley) were ruled out: their quality can only be tested, and a
/// run costs far more than its draws.
#pragma once

#include "distributions/random_stream.hpp"

#include <cstdint>

namespace wingspread {

/// The point's coordinate x, scrambled by the stream's tree. Its first 56 digits are scrambled,
/// more than a double has. Cost: 7 Philox blocks, some 0.1 µs.
[[nodiscard]] std::uint64_t owen_scrambled(std::uint64_t x, const ReplicateStream& stream);

} // namespace wingspread
