/// A histogram of numbers as they come, in one line of a terminal.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace wingspread {

/// Its range is that of the first values with a little room; what comes beyond counts in the outermost bins.
class LiveHistogram {
public:
  /// @param name, unit of the quantity
  explicit LiveHistogram(std::string name, std::string unit)
      : name_(std::move(name)), unit_(std::move(unit)) {}

  /// NaN is passed over.
  void add(double value);

  /// "deployment_time 4.8 ▁▂▅█▇▃▁▁ 5.3 s"; nothing before there are a few values that differ.
  [[nodiscard]] std::string text() const;

private:
  static constexpr std::size_t bins = 48, first_values = 50;

  void settle_range();
  void count(double value);

  std::string name_, unit_;
  std::vector<double> first_; ///< until there are enough of them for a range
  double least_ = 0, most_ = 0;
  std::array<long, bins> counts_{};
};

} // namespace wingspread
