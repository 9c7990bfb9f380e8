/// The samples of a run that the page plays: a given number, denser where angles and moments change.
#pragma once

#include "core/deployment.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace wingspread {

/// A sample of a run as one row: angles, rates and moments of all hinges, then the base's x, y and angle.
struct MotionSample {
  double t = 0;
  std::vector<double> values;
  bool pinned = false; ///< one of the two sides of an engagement
};

/// The indices of a sample's values.
struct MotionLayout {
  std::size_t hinges = 0;
  [[nodiscard]] std::size_t angle(std::size_t hinge) const { return hinge; }
  [[nodiscard]] std::size_t rate(std::size_t hinge) const { return hinges + hinge; }
  [[nodiscard]] std::size_t moment(std::size_t hinge) const { return 2 * hinges + hinge; }
  [[nodiscard]] std::size_t base() const { return 3 * hinges; }
  [[nodiscard]] std::size_t size() const { return 3 * hinges + 3; }
};

/// Records the samples of a run: all of a short run, every n-th step of a long one, and both sides of each engagement (unless
/// thousands of instants have two sides: hinges that stick and slip).
class MotionRecorder {
public:
  explicit MotionRecorder(std::size_t hinges) : layout_{hinges} {}

  /// The observer to pass to the run. @pre the recorder outlives it
  [[nodiscard]] Observer observer();
  [[nodiscard]] std::vector<MotionSample>& samples() { return samples_; }

private:
  static constexpr std::size_t most_kept = 1 << 14;

  void record_sample(const Sample& sample);
  void drop_every_second();

  MotionLayout layout_;
  std::vector<MotionSample> samples_;
  long stride_ = 1, seen_ = 0;
  bool pins_ = true; ///< an instant with two samples is pinned
};

/// Heuristic: a ring is over once its swing is below this share of the whole swing. A smaller share shows
/// a long picture of rest.
inline constexpr double settled_share = 0.05;

/// Whether the ring after `since` is over: in the last quarter of the time since then no moment moves by more than
/// settled_share of its whole swing. A whole quarter counts, because at a turning point the ring stands still too.
[[nodiscard]] bool has_settled(std::span<const MotionSample> samples, const MotionLayout& layout,
                               double since);

/// Interpolates between two samples: angles by the Hermite cubic through angles and rates, rates by its slope, others
/// linearly. @param t between the samples' times, which differ
[[nodiscard]] MotionSample between(const MotionSample& from, const MotionSample& to,
                                   const MotionLayout& layout, double t);

/// Pins the samples at these times (engagements) and unpins all others (a hinge that sticks has two sides too).
void pin_only(std::span<MotionSample> samples, std::span<const double> times);

/// At most `most` samples and the pinned ones, evenly spaced in progress. Progress is made up in equal parts of time,
/// the path length of all angles, and the path length of all moments.
[[nodiscard]] std::vector<MotionSample> resample(std::span<const MotionSample> samples,
                                                 const MotionLayout& layout, std::size_t most);

} // namespace wingspread
