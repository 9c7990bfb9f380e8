/// The algorithms of std::ranges that libc++ 14 lacks, as far as the kernel in the page needs them. Included before
/// each of its files; no other compiler sees this header.
#pragma once

#include <algorithm>
#include <functional>
#include <iterator>

namespace std::ranges { // NOLINT: only where the library has none

template <class Range, class Predicate> constexpr bool any_of(Range&& range, Predicate predicate) {
  return std::any_of(std::begin(range), std::end(range), predicate);
}
template <class Range, class Predicate> constexpr bool all_of(Range&& range, Predicate predicate) {
  return std::all_of(std::begin(range), std::end(range), predicate);
}
template <class Range, class Predicate>
constexpr auto count_if(Range&& range, Predicate predicate) {
  return std::count_if(std::begin(range), std::end(range), predicate);
}
template <class Range, class Value> constexpr auto count(Range&& range, const Value& value) {
  return std::count(std::begin(range), std::end(range), value);
}
template <class Range, class Value, class Key = std::identity>
constexpr auto find(Range&& range, const Value& value, Key key = {}) {
  return std::find_if(std::begin(range), std::end(range),
                      [&](const auto& each) { return std::invoke(key, each) == value; });
}
template <class A, class B, class Same> constexpr bool equal(A&& a, B&& b, Same same) {
  return std::equal(std::begin(a), std::end(a), std::begin(b), std::end(b), same);
}
template <class Range, class Out> constexpr auto copy(Range&& range, Out out) {
  return std::copy(std::begin(range), std::end(range), out);
}
template <class Range, class Value, class Less = std::less<>>
constexpr auto upper_bound(Range&& range, const Value& value, Less less = {}) {
  return std::upper_bound(std::begin(range), std::end(range), value, less);
}
using greater = std::greater<>;
template <class Range, class Value, class Less = std::less<>, class Key = std::identity>
constexpr auto lower_bound(Range&& range, const Value& value, Less less = {}, Key key = {}) {
  return std::lower_bound(
      std::begin(range), std::end(range), value,
      [&](const auto& each, const Value& wanted) { return less(std::invoke(key, each), wanted); });
}
template <class Range, class Less = std::less<>, class Key = std::identity>
constexpr void sort(Range&& range, Less less = {}, Key key = {}) {
  std::sort(std::begin(range), std::end(range), [&](const auto& a, const auto& b) {
    return less(std::invoke(key, a), std::invoke(key, b));
  });
}
template <class Range, class Less = std::less<>, class Key = std::identity>
constexpr void stable_sort(Range&& range, Less less = {}, Key key = {}) {
  std::stable_sort(std::begin(range), std::end(range), [&](const auto& a, const auto& b) {
    return less(std::invoke(key, a), std::invoke(key, b));
  });
}

} // namespace std::ranges
