/// When a proof attempt that may end a run early is worth its cost: an evaluation and more.
#pragma once

#include <algorithm>

namespace wingspread {

/// The proof that a run needs next (ending.hpp).
enum class SoughtProof {
  stall,             ///< no open hinge can reach its latch
  peaks_after_stall, ///< no peak can rise; some hinges never latch
  peaks_by_modes,    ///< no peak can rise; all latches have engaged
  peaks_by_energy    ///< the same without modes (FinalPeaks::lacks_modes): by the energy alone
};

/// Counts the accepted steps of a search for one proof, and spaces the attempts.
class ProofSchedule {
public:
  /// A new search begins.
  void restart(SoughtProof sought) {
    steps_ = 0;
    next_attempt_ = interval(sought);
  }

  /// Counts a step. @return whether an attempt is due at its end
  [[nodiscard]] bool count_step(SoughtProof sought) {
    const bool due = steps_to_attempt() == 0;
    ++steps_;
    if (due) next_attempt_ = steps_ + interval(sought);
    return due;
  }

  /// Counts steps that an engine of packs has made. Attempts at a stall proof that were due among them count as made,
  /// because an engine goes past them only while no attempt can succeed.
  void skip_steps(long steps, SoughtProof sought) {
    steps_ += steps;
    while (sought == SoughtProof::stall && next_attempt_ <= steps_)
      next_attempt_ += interval(sought);
  }

  /// Steps that may be accepted before one whose end is due for an attempt.
  [[nodiscard]] long steps_to_attempt() const { return std::max(0L, next_attempt_ - steps_ - 1); }

private:
  /// Steps from one attempt to the next. Heuristic: attempts too rare lengthen runs, attempts too
  /// frequent cost more than the steps they save. Of the outputs, only the reason of a stall and `peaks_final`
  /// depend on the intervals. A latched wing decays exponentially: with a quarter of the steps so far, a run
  /// overshoots its earliest end by at most a quarter.
  [[nodiscard]] long interval(SoughtProof sought) const {
    switch (sought) {
    case SoughtProof::stall:
      return 64;
    case SoughtProof::peaks_after_stall:
    case SoughtProof::peaks_by_energy:
      return 16;
    case SoughtProof::peaks_by_modes:
      break;
    }
    return std::clamp(steps_ / 4, 4L, 64L);
  }

  long steps_ = 0;        ///< since the search began
  long next_attempt_ = 0; ///< the step that is due
};

} // namespace wingspread
