/// Sine and cosine of one angle together.
///
/// For double with FMA: branch-free, ≤ 1.5 ulp for |x| ≤ 1e6 rad (measured in the tests; the angle
/// of a wing stays below a few turns). Reduction by multiples of π/2 in three parts [Cody & Waite
/// 1980]: with a fused multiply-add x − k·P1 is exact, since both are multiples of 2⁻⁵² and the
/// difference is below one. On [−π/4, π/4] the polynomials are those of Sun's fdlibm. Any other
/// number, and double without FMA, uses its library's functions.
#pragma once

#include "core/scalar.hpp"

#include <bit>
#include <cstdint>

namespace wingspread {

template <class T> struct SineCosine {
  T sine;
  T cosine;
};

template <class T> [[nodiscard]] inline SineCosine<T> sine_cosine(const T& angle) {
  using std::cos;
  using std::sin;
  return {sin(angle), cos(angle)};
}

#ifdef __FMA__
namespace detail {

/// sin r for |r| ≤ π/4, z = r²; r_low: r with its last correction, which the rest need not wait
/// for.
[[nodiscard]] inline double sine_kernel(double r, double r_low, double z) {
  const double zz = z * z;
  const double high = fused(z, 1.58969099521155010221e-10, -2.50507602534068634195e-08);
  const double middle = fused(z, 2.75573137070700676789e-06, -1.98412698298579493134e-04);
  const double low = fused(z, 8.33333333332248946124e-03, -1.66666666666666324348e-01);
  return fused(z * r, fused(zz, fused(zz, high, middle), low), r_low);
}

/// cos r for |r| ≤ π/4, z = r²; 1 − z/2 is split so that its rounding error is added back.
[[nodiscard]] inline double cosine_kernel(double z) {
  const double zz = z * z;
  const double high = fused(z, -1.13596475577881948265e-11, 2.08757232129817482790e-09);
  const double middle = fused(z, -2.75573143513906633035e-07, 2.48015872894767294178e-05);
  const double low = fused(z, -1.38888888888741095749e-03, 4.16666666666666019037e-02);
  const double p = fused(zz, fused(zz, high, middle), low);
  const double w = fused(z, -0.5, 1.0);
  return w + fused(zz, p, fused(z, -0.5, 1.0 - w));
}

[[nodiscard]] inline double flip_sign(double x, std::uint64_t sign_bit) {
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) ^ sign_bit);
}

/// Bits of a where the mask is set, of b elsewhere: a blend that no compiler turns into a jump.
[[nodiscard]] inline double blend(std::uint64_t mask, double a, double b) {
  return std::bit_cast<double>((std::bit_cast<std::uint64_t>(a) & mask) |
                               (std::bit_cast<std::uint64_t>(b) & ~mask));
}

} // namespace detail

template <> [[nodiscard]] inline SineCosine<double> sine_cosine<double>(const double& angle) {
  constexpr double rounder =
      0x1.8p52; // adding it leaves the nearest integer in the low mantissa bits
  const double shifted = fused(angle, 0x1.45f306dc9c883p-1, rounder);
  const double k = shifted - rounder;
  double r = fused(-k, 0x1.921fb54442d18p0, angle);
  r = fused(-k, 0x1.1a62633145c07p-54, r);
  const double r_low =
      fused(-k, -0x1.f1976b7ed8fbcp-110, r); // counts only beside a multiple of π/2
  const double z = r * r;
  const double s = detail::sine_kernel(r, r_low, z);
  const double c = detail::cosine_kernel(z);
  const std::uint64_t quadrant = std::bit_cast<std::uint64_t>(shifted);
  const std::uint64_t swapped = -(quadrant & 1);
  return {detail::flip_sign(detail::blend(swapped, c, s), (quadrant & 2) << 62),
          detail::flip_sign(detail::blend(swapped, s, c), ((quadrant + 1) & 2) << 62)};
}
#endif

} // namespace wingspread
