/// Many numbers sorted by their bits: a radix sort, some three times as fast as by comparisons from a few thousand on.
///
/// The bits of a double, the sign's turned over, and all of them where it was set, stand in the order of the numbers
/// (-0 just before 0). They are gone through eleven at a time from the lowest; digits that all have in common are passed over.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace wingspread {

/// Unsigned numbers in the order of the doubles. @pre no NaN
[[nodiscard]] constexpr std::uint64_t order_bits(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  constexpr std::uint64_t sign = std::uint64_t{1} << 63;
  return bits & sign ? ~bits : bits | sign;
}

namespace radix {
inline constexpr int digit_bits = 11;
inline constexpr std::size_t digits = 6, digit_values = std::size_t{1} << digit_bits;
using Counts = std::array<std::array<std::uint32_t, digit_values>, digits>;

[[nodiscard]] constexpr std::size_t digit(std::uint64_t bits, std::size_t place) {
  return (bits >> (place * digit_bits)) & (digit_values - 1);
}
} // namespace radix

/// What it takes to sort so many, and to make something of each, in the operations of team.hpp.
[[nodiscard]] constexpr double sorting_operations(std::size_t items) {
  return 16 * static_cast<double>(items);
}

/// Sorts by a number of each item, smallest first; equal ones keep their order. Cost O(n), and n items of memory; fewer
/// than a few thousand by comparisons.
/// @param number of an item: a double, no NaN
/// @pre fewer than 2³² items
template <class Item, class Number> void sort_by_number(std::span<Item> items, Number number) {
  constexpr std::size_t few = 3000;
  if (items.size() < few) {
    std::stable_sort(items.begin(), items.end(), [&](const Item& a, const Item& b) {
      return order_bits(number(a)) < order_bits(number(b));
    });
    return;
  }
  const auto counts = std::make_unique<radix::Counts>();
  for (const Item& item : items)
    for (std::size_t place = 0; place < radix::digits; ++place)
      ++(*counts)[place][radix::digit(order_bits(number(item)), place)];
  std::vector<Item> other(items.size());
  std::span<Item> from = items, to = other;
  for (std::size_t place = 0; place < radix::digits; ++place) {
    auto& next = (*counts)[place];
    if (next[radix::digit(order_bits(number(from.front())), place)] == items.size()) continue;
    std::uint32_t first = 0;
    for (std::uint32_t& each : next) first += std::exchange(each, first);
    for (const Item& item : from) to[next[radix::digit(order_bits(number(item)), place)]++] = item;
    std::swap(from, to);
  }
  if (from.data() != items.data()) std::ranges::copy(from, items.begin());
}

/// @pre no NaN
inline void sort_numbers(std::span<double> values) {
  sort_by_number(values, [](double value) { return value; });
}

} // namespace wingspread
