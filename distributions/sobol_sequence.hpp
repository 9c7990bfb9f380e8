/// Sobol' points. Each point is computed without the others.
///
///   symbol  meaning
///   x       a coordinate: 64 binary digits after the point, as an unsigned number
///   v_j     a dimension's direction numbers
///
///   x_k = ⊕ v_j over the binary digits j of k that are 1                                   (1)
///
/// Points 0 … 2ᵐ − 1, and any later block of 2ᵐ that begins at a multiple of it, are a digital
/// (t, m, s)-net. Gray-code order, in which generators produce the points one by one, has the same blocks.
/// The direction numbers are those of Boost.Random's sobol_engine: S. Joe, F. Y. Kuo, "Constructing
/// Sobol sequences with better two-dimensional projections", SIAM J. Sci. Comput. 30 (2008)
/// 2635–2654. The engine itself omits point 0, without which the points are no net.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace wingspread {

/// The number of dimensions with direction numbers in Boost.
inline constexpr std::size_t most_sobol_dimensions = 3667;

/// The direction numbers of one dimension.
using SobolDimension = std::array<std::uint64_t, 64>;

/// The direction numbers of the first `count` dimensions. @pre count ≤ most_sobol_dimensions
[[nodiscard]] std::vector<SobolDimension> sobol_dimensions(std::size_t count);

/// (1): the coordinate of point k. Cost: one ⊕ for each 1 in k.
[[nodiscard]] std::uint64_t sobol_coordinate(const SobolDimension& dimension, std::uint64_t k);

} // namespace wingspread
