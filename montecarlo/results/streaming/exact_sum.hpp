/// Sums of doubles without rounding: independent of the order of the terms and of how they are split.
#pragma once

#include "montecarlo/results/streaming/state_file.hpp"

#include <array>
#include <bit>
#include <cstdint>

namespace wingspread {

/// All bits of a sum down to 2^-1074: a number of 67 digits to the base 2^32. Each digit has 64 bits, so that carries
/// can be postponed. A term costs two additions. Source: R. M. Neal, Fast exact summation using small and large
/// superaccumulators, arXiv:1505.05571 (2015).
class ExactSum {
public:
  /// @param term if not finite, it is not added and value() is NaN from then on
  void add(double term) { put(std::bit_cast<std::uint64_t>(term)); }
  void subtract(double term) { put(std::bit_cast<std::uint64_t>(term) ^ sign_bit); }
  void add(const ExactSum& other);
  void subtract(const ExactSum& other);

  /// The nearest double, or its neighbour.
  [[nodiscard]] double value() const;

  /// Equal sums give equal bytes.
  void write(StateWriter& to) const;
  void read(StateReader& from);

private:
  static constexpr std::uint64_t sign_bit = std::uint64_t{1} << 63;
  static constexpr std::uint64_t fraction_bits = (std::uint64_t{1} << 52) - 1;
  static constexpr std::uint64_t low_digit = 0xffffffff;
  /// Terms until carries are due: a digit grows by at most 2^52 per term, so 2^11 = 2048 terms fit in 63 bits.
  static constexpr int most_waiting = 2000;
  using Digits = std::array<std::int64_t, 67>;

  void put(std::uint64_t bits) {
    const auto exponent = static_cast<int>(bits >> 52 & 0x7ff);
    if (exponent == 0x7ff) {
      spoilt_ = true;
      return;
    }
    // A subnormal number has the exponent of the least normal one, and no leading 1.
    const std::uint64_t mantissa =
        exponent == 0 ? bits & fraction_bits : (bits & fraction_bits) | (fraction_bits + 1);
    const int place = exponent == 0 ? 1 : exponent;
    const int digit = place >> 5, shift = place & 31;
    const auto low = static_cast<std::int64_t>(mantissa << shift & low_digit);
    const auto high = static_cast<std::int64_t>(mantissa >> (32 - shift));
    const std::int64_t sign = (bits & sign_bit) != 0 ? -1 : 1;
    digits_[static_cast<std::size_t>(digit)] += sign * low;
    digits_[static_cast<std::size_t>(digit) + 1] += sign * high;
    if (++waiting_ == most_waiting) propagate_carries();
  }

  /// Propagates carries: every digit but the last is in [0, 2^32) afterwards.
  void propagate_carries();
  static void propagate_carries(Digits& digits);

  Digits digits_{};
  int waiting_ = 0;
  bool spoilt_ = false;
};

} // namespace wingspread
