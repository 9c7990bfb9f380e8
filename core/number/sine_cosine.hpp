/// Sine and cosine of one angle together.
///
/// For double and packs with FMA: no branches, error ≤ 1.5 ulp for |x| ≤ 1e6 rad (measured by the tests;
/// a wing's angles stay below a few turns). The angle is reduced by multiples of π/2 in three parts
/// [Cody & Waite 1980]: with a fused multiply-add x − k·P1 is exact, since both are multiples of 2⁻⁵²
/// and the difference is below one. On [−π/4, π/4] the polynomials are those of Sun's fdlibm. Other
/// number types, and double without FMA, use the library's functions.
#pragma once

#include "core/number/pack.hpp"

namespace wingspread {

template <class T> struct SineCosine {
  T sine;
  T cosine;
};

template <class T>
[[nodiscard, gnu::always_inline]] inline SineCosine<T> sine_cosine(const T& angle) {
  using std::cos;
  using std::sin;
  return {sin(angle), cos(angle)};
}

#ifdef WINGSPREAD_HAS_FMA
namespace detail {

/// sin r for |r| ≤ π/4, z = r². r_low is r with its last correction, which arrives late and is added last.
template <class P>
[[nodiscard, gnu::always_inline]] inline P sine_kernel(const P& r, const P& r_low, const P& z) {
  const P zz = z * z;
  const P high = fused(z, P(1.58969099521155010221e-10), P(-2.50507602534068634195e-08));
  const P middle = fused(z, P(2.75573137070700676789e-06), P(-1.98412698298579493134e-04));
  const P low = fused(z, P(8.33333333332248946124e-03), P(-1.66666666666666324348e-01));
  return fused(P(z * r), fused(zz, fused(zz, high, middle), low), r_low);
}

/// cos r for |r| ≤ π/4, z = r². The rounding error of 1 − z/2 is computed and added back.
template <class P> [[nodiscard, gnu::always_inline]] inline P cosine_kernel(const P& z) {
  const P zz = z * z;
  const P high = fused(z, P(-1.13596475577881948265e-11), P(2.08757232129817482790e-09));
  const P middle = fused(z, P(-2.75573143513906633035e-07), P(2.48015872894767294178e-05));
  const P low = fused(z, P(-1.38888888888741095749e-03), P(4.16666666666666019037e-02));
  const P p = fused(zz, fused(zz, high, middle), low);
  const P w = fused(z, P(-0.5), P(1.0));
  return w + fused(zz, p, fused(z, P(-0.5), P(P(1.0) - w)));
}

template <class P>
[[nodiscard, gnu::always_inline]] inline SineCosine<P> branch_free_sine_cosine(const P& angle) {
  const P rounder(0x1.8p52); // adding it leaves the nearest integer in the low mantissa bits
  const P shifted = fused(angle, P(0x1.45f306dc9c883p-1), rounder);
  const P minus_k = rounder - shifted;
  P r = fused(minus_k, P(0x1.921fb54442d18p0), angle);
  r = fused(minus_k, P(0x1.1a62633145c07p-54), r);
  // matters only next to a multiple of π/2
  const P r_low = fused(minus_k, P(-0x1.f1976b7ed8fbcp-110), r);
  const P z = r * r;
  const auto s = bits_of(sine_kernel(r, r_low, z)), c = bits_of(cosine_kernel(z));
  const auto quadrant = bits_of(shifted);
  // swaps sine and cosine by a mask of bits, so that the compiler makes no jump of it
  const auto swapped = -(quadrant & 1), difference = s ^ c;
  const auto sine = s ^ (difference & swapped), cosine = c ^ (difference & swapped);
  return {number_of(sine ^ ((quadrant & 2) << 62)),
          number_of(cosine ^ (((quadrant + 1) & 2) << 62))};
}

} // namespace detail

template <>
[[nodiscard, gnu::always_inline]] inline SineCosine<double>
sine_cosine<double>(const double& angle) {
  return detail::branch_free_sine_cosine(angle);
}
template <int W>
[[nodiscard, gnu::always_inline]] inline SineCosine<Pack<W>> sine_cosine(const Pack<W>& angle) {
  return detail::branch_free_sine_cosine(angle);
}
#endif

} // namespace wingspread
