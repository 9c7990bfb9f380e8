/// The largest or smallest of many values, with their runs.
#pragma once

#include "montecarlo/results/streaming/state_file.hpp"

#include <algorithm>
#include <vector>

namespace wingspread {

/// A value and its run.
struct RunValue {
  double value;
  long run;
  bool operator==(const RunValue&) const = default;
};

/// Keeps the `most` smallest (or largest) values; ties go to the lowest run. The result does not depend on the order in
/// which values are added.
class Extremes {
public:
  enum class End { lowest, highest };
  Extremes(End end, std::size_t most) : sign_(end == End::lowest ? 1 : -1), most_(most) {}

  /// @param value not NaN; may be infinite
  void add(double value, long run) {
    const RunValue mine{sign_ * value, run};
    if (heap_.size() == most_ && !is_before(mine, heap_.front())) return;
    put(mine);
  }
  void add(const Extremes& other) {
    for (const RunValue& each : other.heap_) add(sign_ * each.value, each.run);
  }

  [[nodiscard]] std::size_t size() const { return heap_.size(); }
  /// The most extreme value first.
  [[nodiscard]] std::vector<RunValue> sorted() const;

  void write(StateWriter& to) const;
  void read(StateReader& from);

private:
  /// Whether `a` is more extreme. Values are multiplied by sign_, so that the lower one is more extreme.
  static bool is_before(const RunValue& a, const RunValue& b) {
    return a.value != b.value ? a.value < b.value : a.run < b.run;
  }
  void put(const RunValue& mine);

  double sign_;
  std::size_t most_;
  std::vector<RunValue> heap_; ///< the least extreme first
};

} // namespace wingspread
