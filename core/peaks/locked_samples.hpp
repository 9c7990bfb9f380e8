/// Loads of locked hinges inside a step. One evaluation gives those of all hinges, so the searches of a step share it.
#pragma once

#include "core/mechanics/system.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace wingspread {

template <class T> class LockedSamples {
public:
  /// The loads at one place.
  struct Sample {
    T s;                    ///< fraction of the step
    std::vector<T> moments; ///< 1 … n: moments on locked hinges, N·m
    std::vector<T> borne;   ///< 1 … n: what rigid holds bear, N·m; empty unless it is asked for
  };

  /// A new step: forgets all samples.
  void begin() { count_ = 0; }

  /// The sample at s, made by an evaluation if it is the first there. Keeps the first places of a step: those of
  /// StepInterpolant, which all searches visit.
  /// @param borne whether to keep what holds bear @param evaluate evaluate(s): the state at s, last evaluated there
  template <class AnySystem, class Evaluate>
  [[nodiscard]] const Sample& at(const T& s, const AnySystem& system, bool borne,
                                 Evaluate&& evaluate) {
    const auto end = samples_.begin() + static_cast<std::ptrdiff_t>(count_);
    const auto known =
        std::find_if(samples_.begin(), end, [&](const Sample& k) { return k.s == s; });
    if (known != end) return *known;
    Sample& made = samples_[std::min(count_, samples_.size() - 1)];
    count_ = std::min(count_ + 1, samples_.size() - 1); // the last one is overwritten
    const State<T>& x = evaluate(s);
    made.s = s, made.moments = system.work().holding;
    if (!borne) return made;
    made.borne.assign(made.moments.size(), T(0));
    for (int i = 1; i < static_cast<int>(made.borne.size()); ++i)
      if (system.is_held(i)) made.borne[i] = system.locking_moment(x, i);
    return made;
  }

private:
  std::array<Sample, 16> samples_; ///< the places of an interpolant between its ends, and one more
  std::size_t count_ = 0;
};

} // namespace wingspread
