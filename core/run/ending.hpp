/// Why a run ends where it does, unless it fails.
#pragma once

#include "core/events/events.hpp"
#include "core/peaks/overtravel.hpp"
#include "core/proofs/modal_bounds.hpp"
#include "core/proofs/peak_bounds.hpp"
#include "core/proofs/prospects.hpp"
#include "core/proofs/stall.hpp"
#include "core/run/diary.hpp"
#include "core/run/peak_search.hpp"
#include "core/run/record.hpp"
#include "core/run/underway.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>

namespace wingspread {

/// The number of hinges, where the compiler knows it.
template <class AnySystem> inline constexpr int hinges_known = Eigen::Dynamic;
template <class T, int N, BaseMotion M>
inline constexpr int hinges_known<System<T, Chain<N>, M>> = N;

/// Decides whether a run has come to its end: at t_end, at its first latch, once all that was asked
/// is known, or by a proof that nothing more can happen.
template <class T, class AnySystem> class Ending {
public:
  Ending(Underway<T, AnySystem>& run, const Events<T, AnySystem>& events,
         const Diary<T, AnySystem>& diary, const PeakSearch<T, AnySystem>& peaks)
      : run_(run), events_(events), diary_(diary), peaks_(peaks) {}

  /// A run begins.
  void start() {
    stalled_ = bounds_ready_ = has_modes_ = false;
    why_stalled_.clear();
    begin_to_look();
    latches_were_left_ = true;
  }

  /// Whether the run ends where it stands.
  [[nodiscard]] bool is_reached() {
    const Goal& goal = run_.goal;
    if (!(run_.step.t < T(run_.how.t_end))) return true;
    if (goal.first_latch_only && diary_.any_latch()) return true;
    if (goal.to_t_end) return false;
    if (rests_for_ever() && (latches_left() || diary_.any_latch())) return true;
    if (!proofs_may_end()) return !latches_left() && diary_.any_latch() && !wants_peaks();
    if (latches_left() != latches_were_left_) begin_to_look(); // after the last: another proof
    latches_were_left_ = latches_left();
    const bool look = steps_to_look() == 0;
    ++steps_;
    if (look) next_look_ = steps_ + interval();
    if (!look || (latches_left() && !lacks_energy())) return false;
    return !wants_peaks() || no_peak_can_rise();
  }

  /// Whether a latch has engaged that ends the run, whatever the right-hand side is from there on, and no
  /// peak at t⁺ is asked for.
  [[nodiscard]] bool is_certain() const {
    if (wants_peaks() || !diary_.any_latch()) return false;
    return run_.goal.first_latch_only || (!latches_left() && !run_.goal.to_t_end);
  }

  /// Of a run that has come to its end.
  [[nodiscard]] Status status() {
    if (!latches_left()) return diary_.any_latch() ? Status::deployed : Status::timed_out;
    if (run_.goal.first_latch_only && diary_.any_latch()) return Status::timed_out; // nobody asks
    return rests_for_ever() || lacks_energy() ? Status::stalled : Status::timed_out;
  }
  [[nodiscard]] const std::string& why_stalled() const { return why_stalled_; }
  /// Of a run that has come to its end: whether no peak that was asked for would be exceeded.
  [[nodiscard]] bool peaks_are_final() {
    if (!wants_peaks()) return false;
    if (rests_for_ever()) return true;
    return (latches_left() ? lacks_energy() : diary_.any_latch()) && no_peak_can_rise();
  }

  /// Steps until the proofs are tried: they cost an evaluation and more.
  [[nodiscard]] long steps_to_look() const {
    if (!proofs_may_end()) return std::numeric_limits<long>::max();
    return std::max(0L, next_look_ - steps_ - 1);
  }
  /// So many steps were accepted elsewhere. @pre no more than `steps_to_look`
  void pass(long steps) {
    if (proofs_may_end()) steps_ += steps;
  }

private:
  /// From here on it is another proof that is sought.
  void begin_to_look() {
    steps_ = 0;
    next_look_ = interval();
  }

  /// Steps from one look to the next: where modes may tell, a quarter of those that the tail has had.
  [[nodiscard]] long interval() const {
    if (latches_left()) return stalled_ ? 16 : 64;
    if (bounds_ready_ && !has_modes_) return 16;
    return std::clamp(steps_ / 4, 4L, 64L);
  }

  [[nodiscard]] bool latches_left() const { return events_.latches_left() > 0; }
  [[nodiscard]] bool wants_peaks() const { return run_.goal.peak_moment || run_.goal.peak_force; }

  /// Whether the run may end, from here to the next event, by a proof that nothing more can happen.
  [[nodiscard]] bool proofs_may_end() const {
    if (run_.goal.to_t_end) return false;
    return latches_left() || (diary_.any_latch() && wants_peaks());
  }

  /// All hinges stick, under a load that stays as it is.
  [[nodiscard]] bool rests_for_ever() {
    if (run_.system.work().stuck < run_.at.bodies || !loads_are_constant(run_.system)) return false;
    stall("every hinge sticks, and the load on them stays as it is");
    return true;
  }

  [[nodiscard]] bool lacks_energy() {
    if (stalled_) return true;
    const std::optional<T> missing = energy_missing(run_.system, run_.step.x, run_.step.t);
    if (missing)
      stall("energy: no hinge can reach its latch, the nearest to it lacks " +
            in_words(static_cast<double>(*missing)) + " J");
    return stalled_;
  }

  void stall(const std::string& why) {
    if (stalled_) return;
    stalled_ = true;
    why_stalled_ = why + ", from t = " + in_words(static_cast<double>(run_.step.t)) + " s on";
  }

  /// Where a hinge may stand from now on.
  struct Reach {
    T rest, way; ///< rad
  };

  [[nodiscard]] bool no_peak_can_rise() {
    if (run_.system.next_knot() < T(never)) return false; // the base will be driven otherwise
    if (!bounds_ready_) prepare_bounds();
    const std::optional<T> energy =
        prospects_.energy(run_.system, run_.step.x, run_.step.t, T(run_.how.t_end));
    const auto by_modes = [&](int i) {
      return Reach{T(model_.angles(i - 1)), T(modes_.ways()(i - 1))};
    };
    if (no_mode_can_raise_a_peak(energy) && none_turns_back(by_modes)) return true;
    if (!energy) return false;
    bounds_.bound(run_.system, prospects_, *energy);
    for (int i = 1; i <= run_.at.bodies; ++i) {
      if (run_.goal.peak_moment && bounds_.moment[i] > peaks_.moments()[i].value) return false;
      if (run_.goal.peak_force && bounds_.force[i] > peaks_.forces()[i].value) return false;
    }
    return none_turns_back([&](int i) {
      return Reach{prospects_.rest()[run_.at.angle(i)], prospects_.furthest(i, *energy)};
    });
  }

  /// Whether no hinge will turn further beyond its stowed angle than it has. While latches are left it is known up
  /// to the run's end only. @param reach_of of hinge i
  template <class ReachOf> [[nodiscard]] bool none_turns_back(const ReachOf& reach_of) const {
    if (!run_.goal.overtravel || latches_left()) return true;
    for (int i = 1; i <= run_.at.bodies; ++i) {
      const Reach reach = reach_of(i);
      const T at_rest = beyond_stowed(run_.system.wing().hinges[i], reach.rest);
      if (!(at_rest + reach.way <= peaks_.overtravel()[i])) return false;
    }
    return true;
  }

  void prepare_bounds() {
    prospects_.prepare(run_.system);
    bounds_.prepare(run_.system, prospects_);
    bounds_ready_ = true;
    prepare_modes();
  }

  void prepare_modes() {
    has_modes_ = false;
    if constexpr (std::is_same_v<T, double>) {
      if (latches_left()) return;
      const Layout& at = run_.at;
      const State<double>& x = run_.step.x;
      find_modes(&x[at.rate(1)]);
      if (has_modes_) { // dampers have been made linear for the rates of an instant
        modes_.find_rates(&x[at.angle(1)], &x[at.rate(1)], run_.step.t);
        retune();
      }
    }
  }

  /// @param rates for which dampers are made linear
  void find_modes(const double* rates) {
    const double* rest = &prospects_.rest()[run_.at.angle(1)];
    has_modes_ = make_rest_model(run_.system.wing(), run_.system.work(), rest, rates, model_) &&
                 modes_.prepare(model_);
    if (has_modes_) modes_.prepare_cap(prospects_.least_stiffness(), rest);
  }

  /// Makes dampers linear for the rates that are left, where these have become others.
  void retune() {
    if (!model_.is_tuned_for(modes_.rates()))
      find_modes(State<double>(modes_.rates().begin(), modes_.rates().end()).data());
  }

  /// By the modes of the latched wing.
  [[nodiscard]] bool no_mode_can_raise_a_peak(const std::optional<T>& energy) {
    if constexpr (std::is_same_v<T, double>) {
      const Layout& at = run_.at;
      const State<double>& x = run_.step.x;
      if (!has_modes_ || !latches_are_in(x)) return false;
      const auto values = [&](const auto& peaks, State<double>& to) {
        to.resize(at.bodies);
        for (int i = 1; i <= at.bodies; ++i) to[i - 1] = peaks[i].value;
        return to.data();
      };
      if (modes_.none_exceeds(&x[at.angle(1)], &x[at.rate(1)],
                              run_.goal.peak_moment ? values(peaks_.moments(), moments_) : nullptr,
                              run_.goal.peak_force ? values(peaks_.forces(), forces_) : nullptr,
                              run_.step.t, energy, spin()))
        return true;
      retune();
    }
    return false;
  }

  /// |H| of a free base about the common centre of mass, kg·m²/s.
  [[nodiscard]] double spin() {
    if constexpr (AnySystem::base_motion != BaseMotion::free) return 0;
    using std::abs;
    return static_cast<double>(abs(total_motion(run_.system, run_.step.x, run_.step.t).spin()));
  }

  /// Whether every latch acts with its whole strength: a smoothed one comes in.
  [[nodiscard]] bool latches_are_in(const State<T>& x) const {
    if (!run_.at.smoothed) return true;
    for (int i = 1; i <= run_.at.bodies; ++i)
      if (run_.system.wing().hinges[i].has_latch && !(x[run_.at.latch(i)] >= run_.system.epsilon()))
        return false;
    return true;
  }

  Underway<T, AnySystem>& run_;
  const Events<T, AnySystem>& events_;
  const Diary<T, AnySystem>& diary_;
  const PeakSearch<T, AnySystem>& peaks_;
  Prospects<T> prospects_;
  PeakBounds<T> bounds_;
  RestModel model_;
  ModalBounds<hinges_known<AnySystem>> modes_;
  State<double> moments_, forces_;
  bool has_modes_ = false;    ///< no hinge will latch any more, and all modes decay
  bool bounds_ready_ = false; ///< no hinge will latch any more
  bool stalled_ = false;      ///< no hinge can reach its latch any more
  std::string why_stalled_;
  long steps_ = 0, next_look_ = 0; ///< since the last latch, or the start
  bool latches_were_left_ = true;  ///< then
};

} // namespace wingspread
