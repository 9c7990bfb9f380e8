#include "montecarlo/foundation/platform/live_histogram.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace wingspread {

void LiveHistogram::add(double value) {
  if (std::isnan(value)) return;
  if (least_ < most_) return count(value);
  first_.push_back(value);
  if (first_.size() >= first_values) settle_range();
}

void LiveHistogram::settle_range() {
  const auto [least, most] = std::minmax_element(first_.begin(), first_.end());
  const double room = 0.25 * (*most - *least);
  if (room > 0) {
    least_ = *least - room;
    most_ = *most + room;
    for (const double value : first_) count(value);
  }
  first_.clear(); // of equal ones the next are waited for
}

void LiveHistogram::count(double value) {
  const double place = std::floor((value - least_) / (most_ - least_) * static_cast<double>(bins));
  ++counts_[static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(bins - 1)))];
}

std::string LiveHistogram::text() const {
  constexpr std::array levels{" ", "▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
  const long highest = *std::max_element(counts_.begin(), counts_.end());
  if (highest == 0) return "";
  std::string picture;
  for (const long count : counts_) // a bin with a single run is seen
    picture += levels[static_cast<std::size_t>((8 * count + highest - 1) / highest)];
  return fmt::format("{} {:.4g} {} {:.4g}{}{}", name_, least_, picture, most_,
                     unit_.empty() ? "" : " ", unit_);
}

} // namespace wingspread
