/// Pack<W>: a number type that holds one double for each of W runs, in the lanes of a vector register.
///
/// Every operation acts on each lane alone and rounds as for a double. A lane's result therefore has the
/// same bits as that of a run alone, for every W and instruction set. A comparison yields a mask.
#pragma once

#include "core/number/scalar.hpp"

#include <bit>
#include <cstdint>
#if defined(__x86_64__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

namespace wingspread {

namespace detail {
/// The compiler's vector types of a width. Written one by one: GCC 12 takes vectors whose size depends on
/// a template parameter for scalars when it compares overloads.
template <int W> struct Lanes;
template <> struct Lanes<2> {
  typedef double Vector __attribute__((vector_size(16)));
  typedef std::int64_t Bits __attribute__((vector_size(16)));
};
template <> struct Lanes<4> {
  typedef double Vector __attribute__((vector_size(32)));
  typedef std::int64_t Bits __attribute__((vector_size(32)));
};
template <> struct Lanes<8> {
  typedef double Vector __attribute__((vector_size(64)));
  typedef std::int64_t Bits __attribute__((vector_size(64)));
};
} // namespace detail

template <int W> struct Pack {
  static constexpr int width = W;
  using Vector = typename detail::Lanes<W>::Vector;
  using Bits = typename detail::Lanes<W>::Bits;

  /// One truth value a lane: −1 is true, 0 is false.
  struct Mask {
    Bits bits;
    friend Mask operator&&(Mask a, Mask b) { return {a.bits & b.bits}; }
    friend Mask operator||(Mask a, Mask b) { return {a.bits | b.bits}; }
    friend Mask operator!(Mask a) { return {~a.bits}; }
  };

  Vector v;

  Pack() = default;
  Pack(Vector lanes) : v(lanes) {}    // NOLINT: a vector is a pack
  Pack(double x) : v(x - Vector{}) {} // NOLINT: the same number in every lane

  friend Pack operator+(Pack a, Pack b) { return a.v + b.v; }
  friend Pack operator-(Pack a, Pack b) { return a.v - b.v; }
  friend Pack operator*(Pack a, Pack b) { return a.v * b.v; }
  friend Pack operator/(Pack a, Pack b) { return a.v / b.v; }
  friend Pack operator-(Pack a) { return -a.v; }
  friend Mask operator<(Pack a, Pack b) { return {a.v < b.v}; }
  friend Mask operator>(Pack a, Pack b) { return {a.v > b.v}; }
  friend Mask operator<=(Pack a, Pack b) { return {a.v <= b.v}; }
  friend Mask operator>=(Pack a, Pack b) { return {a.v >= b.v}; }
  friend Mask operator==(Pack a, Pack b) { return {a.v == b.v}; }
};

template <int W>
[[nodiscard, gnu::always_inline]] inline Pack<W> select(typename Pack<W>::Mask mask,
                                                        const Pack<W>& a, const Pack<W>& b) {
  return mask.bits ? a.v : b.v;
}

template <int W> inline constexpr double epsilon_of<Pack<W>> = epsilon_of<double>;

/// Whether T is double or Pack<W>.
template <class T> inline constexpr bool is_of_doubles = false;
template <> inline constexpr bool is_of_doubles<double> = true;
template <int W> inline constexpr bool is_of_doubles<Pack<W>> = true;

/// Whether the mask is true in any lane.
template <class Mask>
requires requires(Mask mask) { mask.bits; }
[[nodiscard, gnu::always_inline]] inline bool any(const Mask& mask) {
#ifdef __AVX512DQ__
  if constexpr (sizeof mask.bits == 64)
    return _mm512_movepi64_mask(reinterpret_cast<__m512i>(mask.bits)) != 0;
#endif
#ifdef __AVX2__
  if constexpr (sizeof mask.bits == 32)
    return _mm256_movemask_pd(reinterpret_cast<__m256d>(mask.bits)) != 0;
#endif
  std::int64_t some = 0;
  for (int lane = 0; lane < static_cast<int>(sizeof mask.bits / 8); ++lane) some |= mask.bits[lane];
  return some != 0;
}

/// a·b + c with one rounding.
template <int W>
[[nodiscard, gnu::always_inline]] inline Pack<W> fused(const Pack<W>& a, const Pack<W>& b,
                                                       const Pack<W>& c) {
#ifdef __AVX512F__
  if constexpr (W == 8) return _mm512_fmadd_pd(a.v, b.v, c.v);
#endif
#ifdef __FMA__
  if constexpr (W == 4) return _mm256_fmadd_pd(a.v, b.v, c.v);
  if constexpr (W == 2) return _mm_fmadd_pd(a.v, b.v, c.v);
#endif
#ifdef __aarch64__
  if constexpr (W == 2) return vfmaq_f64(c.v, a.v, b.v);
#endif
  Pack<W> result;
  for (int lane = 0; lane < W; ++lane)
    result.v[lane] = __builtin_fma(a.v[lane], b.v[lane], c.v[lane]);
  return result;
}

template <int W> [[nodiscard, gnu::always_inline]] inline Pack<W> sqrt(const Pack<W>& a) {
#ifdef __AVX512F__
  if constexpr (W == 8) return _mm512_sqrt_pd(a.v);
#endif
#ifdef __AVX__
  if constexpr (W == 4) return _mm256_sqrt_pd(a.v);
#endif
#ifdef __aarch64__
  if constexpr (W == 2) return vsqrtq_f64(a.v);
#endif
  Pack<W> result;
  for (int lane = 0; lane < W; ++lane) result.v[lane] = __builtin_sqrt(a.v[lane]);
  return result;
}

template <int W> [[nodiscard, gnu::always_inline]] inline Pack<W> abs(const Pack<W>& a) {
  using Bits = typename Pack<W>::Bits;
  return reinterpret_cast<typename Pack<W>::Vector>(reinterpret_cast<Bits>(a.v) &
                                                    (0x7fffffffffffffff - Bits{}));
}

namespace detail {

/// The bits of a double as an integer, lane by lane, and the reverse.
[[nodiscard, gnu::always_inline]] inline std::int64_t bits_of(double x) {
  return std::bit_cast<std::int64_t>(x);
}
[[nodiscard, gnu::always_inline]] inline double number_of(std::int64_t bits) {
  return std::bit_cast<double>(bits);
}
template <int W> [[nodiscard, gnu::always_inline]] inline auto bits_of(const Pack<W>& x) {
  return reinterpret_cast<typename Pack<W>::Bits>(x.v);
}
template <class Bits> [[nodiscard, gnu::always_inline]] inline auto number_of(Bits bits) {
  constexpr int width = sizeof(Bits) / 8;
  return Pack<width>(reinterpret_cast<typename Pack<width>::Vector>(bits));
}

} // namespace detail

} // namespace wingspread
