/// A run in motion: what the page plays. As many samples as were asked for, where something happens.
#pragma once

#include "core/deployment.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace wingspread {

/// A sample of a run in one row of numbers: angles, rates and moments of all hinges, then the base's x, y and angle.
struct MotionSample {
  double t = 0;
  std::vector<double> values;
  bool pinned = false; ///< one of the two sides of an engagement
};

/// Where the numbers of a sample stand.
struct MotionLayout {
  std::size_t hinges = 0;
  [[nodiscard]] std::size_t angle(std::size_t hinge) const { return hinge; }
  [[nodiscard]] std::size_t rate(std::size_t hinge) const { return hinges + hinge; }
  [[nodiscard]] std::size_t moment(std::size_t hinge) const { return 2 * hinges + hinge; }
  [[nodiscard]] std::size_t base() const { return 3 * hinges; }
  [[nodiscard]] std::size_t size() const { return 3 * hinges + 3; }
};

/// Keeps the samples of a run as it goes on: all of a short one, every n-th step of a long one, and both sides of each
/// engagement.
class MotionRecorder {
public:
  explicit MotionRecorder(std::size_t hinges) : layout_{hinges} {}

  /// What to hand to the run. @pre the recorder outlives it
  [[nodiscard]] Observer observer();
  [[nodiscard]] std::vector<MotionSample>& samples() { return samples_; }

private:
  static constexpr std::size_t most_kept = 1 << 14;

  void take(const Sample& sample);
  void thin();

  MotionLayout layout_;
  std::vector<MotionSample> samples_;
  long stride_ = 1, seen_ = 0;
};

/// Between two samples: angles by the cubic that has their rates at both ends, rates by its slope, all else straight.
/// @param t from the first to the second; they are apart
[[nodiscard]] MotionSample between(const MotionSample& from, const MotionSample& to,
                                   const MotionLayout& layout, double t);

/// Pins the two sides of the engagements at these times, and no others: a hinge that sticks has two sides too.
void pin_only(std::span<MotionSample> samples, std::span<const double> times);

/// At most `most` samples and the pinned ones. They stand where much changes: a third of them by time, a third by the
/// ways of all angles, a third by those of all moments.
[[nodiscard]] std::vector<MotionSample> resample(std::span<const MotionSample> samples,
                                                 const MotionLayout& layout, std::size_t most);

} // namespace wingspread
