/// When a run may end, and why.
///
/// | a run ends                                   | proof                                     | in                 |
/// |----------------------------------------------|-------------------------------------------|--------------------|
/// | at t_end                                     | none                                      |                    |
/// | at its first latch, if only that is wanted   | none: no later output is asked for        |                    |
/// | at its last latch, without peaks             | none: no later output is asked for        |                    |
/// | early: all hinges are stuck                  | no hinge moves any more                   | standstill.hpp     |
/// | early: no open hinge will latch …            | the energy left cannot pay for the way    | stall.hpp          |
/// |   … and no peak can rise                     | the energy left bounds every peak         | energy_bounds.hpp  |
/// | early: all have latched, no peak can rise    | the modes of the wing bound every peak,   | modal_bounds.hpp   |
/// |                                              | or the energy left does                   | energy_bounds.hpp  |
/// |   … nor a peak of a free base's motion       | the modes and the angular momentum do     | final_peaks.hpp    |
/// | … and no latch lets go                       | the energy left bounds its load           | energy_bounds.hpp  |
///
/// No run ends early while a hold may still let go, or while an output of its end may still change: the angles of
/// hinges that move (Goal::to_rest), and the energy of a motor on a hinge without an engaged latch.
///
/// The proofs are in the room proofs/ (standstill.hpp in events/); final_peaks.hpp calls modal_bounds.hpp and
/// energy_bounds.hpp. They are functions of the state. `Ending` remembers the results, and proof_schedule.hpp says at
/// which steps an attempt is worth its cost. Whether a run ends some steps earlier or later changes no output but two:
/// the reason of a stall (missing energy, and since when), and `peaks_final` by the rates for which dampers were last
/// made linear.
#pragma once

#include "core/events/events.hpp"
#include "core/events/standstill.hpp"
#include "core/proofs/final_peaks.hpp"
#include "core/proofs/stall.hpp"
#include "core/run/diary.hpp"
#include "core/run/peak_search.hpp"
#include "core/run/proof_schedule.hpp"
#include "core/run/record.hpp"
#include "core/run/underway.hpp"

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace wingspread {

/// How a run has ended.
struct End {
  Status status = Status::timed_out;
  std::string reason; ///< of a stall
  Finality final{};   ///< of the peaks that were asked for, and of the latches
  std::vector<int> never_released{}, may_release_later{}; ///< of a stall, as in Outcome
};

/// Decides whether a run ends at its present state.
template <class T, class AnySystem> class Ending {
public:
  Ending(Underway<T, AnySystem>& run, const Events<T, AnySystem>& events,
         const Diary<T, AnySystem>& diary, const PeakSearch<T, AnySystem>& peaks)
      : run_(run), events_(events), diary_(diary), peaks_(peaks) {}

  /// A run begins.
  void start() {
    stall_.reset();
    final_peaks_.reset();
    standstill_.reset();
    latches_were_left_ = true, peaks_are_proven_ = false;
    latch_events_before_ = diary_.latch_events();
    schedule_.restart(SoughtProof::stall);
  }

  /// Whether the run ends after the step just counted. Attempts the proofs that are due.
  [[nodiscard]] bool ends_here() {
    const Goal& goal = run_.goal;
    watch_standstill();
    watch_latches();
    if (!(run_.step.t < T(run_.how.t_end))) return true;
    if (goal.first_latch_only && diary_.any_latch()) return true;
    if (goes_to_t_end()) {
      note_stall();
      return false;
    }
    if (is_stuck() && (latches_left() || diary_.any_latch())) return true;
    if (!seeks_proof()) return diary_.any_latch();
    if (!is_attempt_due()) return false;
    if (latches_left() && !prove_stall()) return false;
    if (!latches_stay()) return false;
    if (!wants_peaks()) return true;
    peaks_are_proven_ = prove_peaks_final(watches_base());
    return peaks_are_proven_;
  }

  /// Whether the run ends at the latch just engaged, without an evaluation of the new right-hand side. Only where no
  /// peak is asked for.
  [[nodiscard]] bool ends_at_latch() const {
    if (wants_peaks() || may_let_go() || !diary_.any_latch()) return false;
    return run_.goal.first_latch_only || (!latches_left() && !goes_to_t_end());
  }

  /// @pre ends_here()
  [[nodiscard]] End describe_end() {
    End end;
    const bool is_cut_short = run_.goal.first_latch_only && diary_.any_latch();
    // the time at which motion ended says more than the earlier time at which its end was proven
    if ((goes_to_t_end() || waits_for_rest()) && is_stuck()) stall_.reset();
    const bool no_latch = latches_left() && prove_stall();
    const auto& releases = events_.releases();
    if (!is_cut_short && (no_latch || releases.held() > 0)) {
      end.status = Status::stalled, end.reason = stall_.value_or("");
      end.never_released = releases.never_released();
      end.may_release_later = releases.may_release_later(no_latch, is_stuck());
    } else if (!latches_left())
      end.status = diary_.any_latch() ? Status::deployed : Status::timed_out;
    if (end.status == Status::deployed && !is_cut_short) end.final.latches = latches_stay();
    if (wants_peaks()) describe_peaks(end.final);
    return end;
  }

  /// Steps that may be accepted before one at whose end a proof is attempted.
  [[nodiscard]] long steps_to_attempt() const {
    return seeks_proof() && !cannot_prove_stall() ? schedule_.steps_to_attempt()
                                                  : std::numeric_limits<long>::max();
  }
  /// Counts steps that a lane has made. @pre no more than `steps_to_attempt`
  void count_lane_steps(long steps) {
    if (seeks_proof()) schedule_.skip_steps(steps, sought());
  }

private:
  [[nodiscard]] bool latches_left() const { return events_.latches_left() > 0; }
  [[nodiscard]] bool wants_peaks() const {
    return run_.goal.peak_moment || run_.goal.peak_force ||
           (run_.goal.hold_moment && events_.releases().held() > 0) || watches_base();
  }
  /// Whether peaks of a free base's motion are asked for.
  [[nodiscard]] bool watches_base() const {
    return run_.goal.base_motion && AnySystem::base_motion == BaseMotion::free;
  }
  /// Whether no proof may end the run from here. A base turns on where no hinge moves, and only the modes of a latched
  /// wing bound how it turns.
  [[nodiscard]] bool goes_to_t_end() const {
    return run_.goal.to_t_end || (watches_base() && (latches_left() || is_stuck())) ||
           may_release() || (waits_for_rest() && !is_stuck());
  }
  /// Whether all latches are engaged, and a hold may still let go. Where latches are left, the proof of a stall asks.
  [[nodiscard]] bool may_release() const {
    return !latches_left() &&
           events_.releases().may_release(is_stuck_for_good(run_.system, run_.step.x));
  }
  /// Whether any motion changes an output. @see motor_energy.hpp for what counts as a motor's energy
  [[nodiscard]] bool waits_for_rest() const {
    if (run_.goal.to_rest) return true;
    const auto& motors = run_.system.wing().motors;
    for (int i = 1; run_.goal.motor_energy && i < static_cast<int>(motors.size()); ++i)
      if (motors[i].present && !run_.system.work().engaged[i] && !events_.releases().is_held(i))
        return true;
    return false;
  }

  [[nodiscard]] bool is_stuck() const {
    return is_stuck_for_good(run_.system, run_.step.x) && !events_.releases().may_release(true);
  }

  /// Whether an engaged latch may let go, as far as its holding moment tells.
  [[nodiscard]] bool may_let_go() const { return run_.system.wing().can_let_go; }
  /// Whether it is proven that no engaged latch lets go. @pre no open hinge will latch any more
  [[nodiscard]] bool latches_stay() {
    return !may_let_go() || is_stuck() ||
           final_peaks_.latches_stay(run_.system, run_.step.x, run_.step.t, T(run_.how.t_end),
                                     !latches_left());
  }

  /// Proofs hold for the latches that are engaged.
  void watch_latches() {
    if (diary_.latch_events() == latch_events_before_) return;
    latch_events_before_ = diary_.latch_events();
    if (!may_let_go()) return;
    stall_.reset();
    final_peaks_.reset();
    if (latches_were_left_ != latches_left()) return; // is_attempt_due will note that
    schedule_.restart(sought());
  }

  /// Keeps the time since which every hinge sticks under constant loads, and no hold may let go.
  void watch_standstill() {
    if (!is_stuck())
      standstill_.reset();
    else if (!standstill_)
      standstill_ = run_.step.t;
  }

  /// Counts a step of a search for a proof.
  [[nodiscard]] bool is_attempt_due() {
    if (latches_left() != latches_were_left_) schedule_.restart(sought());
    latches_were_left_ = latches_left();
    return schedule_.count_step(sought());
  }

  /// In a run to t_end: attempts the proof of a stall at the same steps as other runs, so that the reason is theirs
  /// unless motion ends.
  void note_stall() {
    if (seeks_proof() && (is_stuck() || is_attempt_due())) prove_stall();
  }

  /// Whether a proof may end the run before its next event; in a run to t_end, whether it may say why the run stalls.
  [[nodiscard]] bool seeks_proof() const {
    if (goes_to_t_end()) return latches_left() && !stall_;
    return latches_left() || (diary_.any_latch() && (wants_peaks() || may_let_go()));
  }
  [[nodiscard]] SoughtProof sought() const {
    if (latches_left()) return stall_ ? SoughtProof::peaks_after_stall : SoughtProof::stall;
    return final_peaks_.lacks_modes() ? SoughtProof::peaks_by_energy : SoughtProof::peaks_by_modes;
  }

  /// Whether no attempt before the next event can prove a stall: a hold may let go, or no energy bound holds for this
  /// wing.
  [[nodiscard]] bool cannot_prove_stall() const {
    if (stall_ || !latches_left()) return false;
    if (events_.releases().may_release(is_stuck())) return true;
    return !is_stuck() && events_.latches_left() != events_.releases().latches_held() &&
           !energy_bound_holds(run_.system);
  }

  /// Proves that no open hinge will latch, and keeps the reason. @return whether that is proven
  bool prove_stall() {
    if (stall_) return true;
    const auto from = [](const T& t) {
      return ", from t = " + in_words(static_cast<double>(t)) + " s on";
    };
    if (cannot_prove_stall()) return false;
    if (is_stuck())
      stall_ = "every hinge sticks, and the load on them stays as it is" + from(*standstill_);
    else if (!latches_stay())
      return false;
    else if (events_.latches_left() == events_.releases().latches_held())
      stall_ = ""; // the outcome names the held hinges
    else if (const auto missing = energy_missing(run_.system, run_.step.x, run_.step.t))
      stall_ = "energy: no hinge can reach its latch, the nearest to it lacks " +
               in_words(static_cast<double>(*missing)) + " J" + from(run_.step.t);
    return stall_.has_value();
  }

  /// Proves that no peak will rise. @pre no hinge will latch any more
  /// @param base whether to prove it of a free base's motion too
  [[nodiscard]] bool prove_peaks_final(bool base) {
    const Goal& goal = run_.goal;
    // of a stalled run overtravel is reported up to the run's end only: it need not be final
    const bool tells_overtravel = goal.overtravel && !latches_left();
    const SeenPeaks<T> seen{goal.peak_moment ? &peaks_.moments() : nullptr,
                            goal.peak_force ? &peaks_.forces() : nullptr,
                            tells_overtravel ? &peaks_.overtravel() : nullptr,
                            base ? &peaks_.base() : nullptr,
                            peaks_.holds().empty() ? nullptr : &peaks_.holds()};
    return final_peaks_.prove(run_.system, run_.step.x, run_.step.t, T(run_.how.t_end), seen,
                              !latches_left());
  }

  /// Whether the base turns faster and faster. Proofs then hold up to t_end, and not for ever.
  [[nodiscard]] bool base_quickens() const {
    if constexpr (AnySystem::base_motion != BaseMotion::prescribed) return false;
    return run_.system.drive(run_.step.t).angular_acceleration != T(0);
  }

  /// Sets what is proven of the peaks. Those of a base, of holds and of overtravel are the ones up to t_end.
  void describe_peaks(Finality& final) {
    if (base_quickens() && !is_stuck()) return;
    const Goal& goal = run_.goal;
    final_peaks_.end();
    final.peaks = peaks_are_proven_ || is_stuck();
    const bool settled =
        final.peaks || ((latches_left() ? prove_stall() : diary_.any_latch()) && latches_stay());
    final.peaks = final.peaks || (settled && prove_peaks_final(false));
    final.moments = final.peaks || (settled && goal.peak_moment && prove_moments_final());
    final.forces = final.peaks || (settled && goal.peak_force && prove_forces_final());
    if (goal.peak_moment || goal.peak_force)
      final.peaks = (final.moments || !goal.peak_moment) && (final.forces || !goal.peak_force);
  }
  /// Proves it of the moments alone, or of the forces alone, where not all peaks are proven. @pre as above
  [[nodiscard]] bool prove_moments_final() {
    return final_peaks_.proven().moments || prove_loads_final(&peaks_.moments(), nullptr);
  }
  [[nodiscard]] bool prove_forces_final() {
    return final_peaks_.proven().forces || prove_loads_final(nullptr, &peaks_.forces());
  }
  [[nodiscard]] bool prove_loads_final(const std::vector<PeakOf<T>>* moments,
                                       const std::vector<PeakOf<T>>* forces) {
    return final_peaks_.prove(run_.system, run_.step.x, run_.step.t, T(run_.how.t_end),
                              {moments, forces, nullptr, nullptr, nullptr}, !latches_left());
  }

  Underway<T, AnySystem>& run_;
  const Events<T, AnySystem>& events_;
  const Diary<T, AnySystem>& diary_;
  const PeakSearch<T, AnySystem>& peaks_;
  ProofSchedule schedule_;
  FinalPeaks<T, AnySystem> final_peaks_;
  std::optional<std::string> stall_;    ///< why no open hinge will latch; none: not proven
  std::optional<T> standstill_;         ///< since when is_stuck(), s
  bool latches_were_left_ = true;       ///< at the step counted last
  std::size_t latch_events_before_ = 0; ///< at the step before
  bool peaks_are_proven_ = false;       ///< no peak can rise after the present time
};

} // namespace wingspread
