#include "montecarlo/results/streaming/exact_sum.hpp"

#include "montecarlo/foundation/statistics/statistics.hpp"

#include <cmath>

namespace wingspread {

void ExactSum::propagate_carries(Digits& digits) {
  for (std::size_t i = 0; i + 1 < digits.size(); ++i) {
    digits[i + 1] += digits[i] >> 32; // rounds down, so that the remaining digit is not negative
    digits[i] &= static_cast<std::int64_t>(low_digit);
  }
}

void ExactSum::propagate_carries() {
  propagate_carries(digits_);
  waiting_ = 0;
}

void ExactSum::add(const ExactSum& other) {
  propagate_carries();
  Digits theirs = other.digits_;
  propagate_carries(theirs);
  for (std::size_t i = 0; i < digits_.size(); ++i) digits_[i] += theirs[i];
  propagate_carries();
  spoilt_ = spoilt_ || other.spoilt_;
}

void ExactSum::subtract(const ExactSum& other) {
  propagate_carries();
  Digits theirs = other.digits_;
  propagate_carries(theirs);
  for (std::size_t i = 0; i < digits_.size(); ++i) digits_[i] -= theirs[i];
  propagate_carries();
  spoilt_ = spoilt_ || other.spoilt_;
}

double ExactSum::value() const {
  if (spoilt_) return undefined;
  Digits digits = digits_;
  propagate_carries(digits);
  const bool negative = digits.back() < 0;
  if (negative) {
    for (std::int64_t& digit : digits) digit = -digit;
    propagate_carries(digits);
  }
  Sum sum; // of whole digits, the largest first: digits after the first three are below a double's last bit
  for (std::size_t i = digits.size(); i-- > 0;)
    if (digits[i] != 0)
      sum.add(std::ldexp(static_cast<double>(digits[i]), 32 * static_cast<int>(i) - 1075));
  return negative ? -sum.value() : sum.value();
}

void ExactSum::write(StateWriter& to) const {
  Digits digits = digits_;
  propagate_carries(digits);
  std::size_t first = 0, last = digits.size();
  while (first < last && digits[first] == 0) ++first;
  while (last > first && digits[last - 1] == 0) --last;
  to.put(spoilt_);
  to.put(static_cast<std::uint8_t>(first));
  to.put(static_cast<std::uint8_t>(last));
  for (std::size_t i = first; i < last; ++i) to.put(digits[i]);
}

void ExactSum::read(StateReader& from) {
  *this = {};
  spoilt_ = from.get<bool>();
  const std::size_t first = from.get<std::uint8_t>(), last = from.get<std::uint8_t>();
  if (first > last || last > digits_.size()) throw from.broken("a sum");
  for (std::size_t i = first; i < last; ++i) digits_[i] = from.get<std::int64_t>();
}

} // namespace wingspread
