/// Proof that no peak of a run can rise any more, so that the run may end.
///
/// Once no hinge will latch any more there are bounds on every later moment and force: by the modes
/// of the latched wing (modal_bounds.hpp), or by the energy that is left (energy_bounds.hpp). The
/// peaks are final where all of the bounds lie below the peaks seen so far.
#pragma once

#include "core/peaks/base_peaks.hpp"
#include "core/peaks/overtravel.hpp"
#include "core/peaks/peak.hpp"
#include "core/proofs/energy_bounds.hpp"
#include "core/proofs/modal_bounds.hpp"
#include "core/proofs/remaining_energy.hpp"

#include <cmath>
#include <optional>
#include <vector>

namespace wingspread {

/// The peaks of a run so far, each 1 … n. Null: not asked for.
template <class T> struct SeenPeaks {
  const std::vector<PeakOf<T>>*moments, *forces; ///< N·m, N
  const std::vector<T>* overtravel;              ///< rad
  const BaseExcursion<T>* base;                  ///< of a free base
  const std::vector<PeakOf<T>>* holds;           ///< what holds have borne, N·m
};

/// Whether the peak moments and peak forces seen are at least the bounds on all later ones. True if not asked for.
struct FinalLoads {
  bool moments = true, forces = true;
};

/// @param moment, force bounds, hinge i at [i − first]
template <class T, class Bounds>
[[nodiscard]] FinalLoads final_loads(const SeenPeaks<T>& seen, int bodies, const Bounds& moment,
                                     const Bounds& force, int first) {
  FinalLoads all;
  for (int i = 1; i <= bodies; ++i) {
    if (seen.moments && !(moment[i - first] <= (*seen.moments)[i].value)) all.moments = false;
    if (seen.forces && !(force[i - first] <= (*seen.forces)[i].value)) all.forces = false;
  }
  return all;
}

/// Whether no hinge can turn further beyond its stowed angle than it has.
/// @param rest, way hinge i stays within way(i) of rest(i), rad
template <class T, class Rest, class Way>
[[nodiscard]] bool no_overtravel_can_rise(const SeenPeaks<T>& seen, const Wing<T>& wing,
                                          const Rest& rest, const Way& way) {
  for (int i = 1; seen.overtravel && i <= wing.size(); ++i)
    if (wing.hinges[i].sense != T(0) && // an elastic joint has none
        !(beyond_stowed(wing.hinges[i], T(rest(i))) + T(way(i)) <= (*seen.overtravel)[i]))
      return false;
  return true;
}

/// Whether a free base cannot turn further or faster than it has.
///
///     θ(t') = θ(t) − (S u(t))_0 + (S u(t'))_0 + ∫ r          H/I − drift ≤ r ≤ H/I + drift
///
/// in the symbols of rest_model.hpp.
/// @param at_rest θ(t) − (S u(t))_0, rad
/// @param mean    H/I, rad/s
/// @param time    t_end − t, s
template <class T>
[[nodiscard]] bool no_base_peak_can_rise(const BaseExcursion<T>& seen, const BaseBounds& bounds,
                                         const T& at_rest, const T& mean, const T& time) {
  const auto stays = [](const T& low, const T& high, const T& most) {
    return -low <= most && high <= most;
  };
  const T slow = mean - T(bounds.drift), fast = mean + T(bounds.drift);
  const T turn = at_rest - seen.first_angle, rate(bounds.rate), way(bounds.way);
  return stays(slow - rate - seen.first_rate, fast + rate - seen.first_rate, seen.rate) &&
         stays(turn - way + smaller(T(0), T(slow * time)),
               turn + way + larger(T(0), T(fast * time)), seen.angle);
}

/// The largest ratio of a bound on later loads to the load seen; at most 1 if no load can rise.
template <class T>
[[nodiscard]] T excess_of_loads(const SeenPeaks<T>& seen, const HingeBounds& bounds) {
  T excess(0);
  for (int i = 0; i < static_cast<int>(bounds.moment.size()); ++i) {
    if (seen.moments)
      excess = larger(excess, T(T(bounds.moment(i)) / (*seen.moments)[i + 1].value));
    if (seen.forces) excess = larger(excess, T(T(bounds.force(i)) / (*seen.forces)[i + 1].value));
  }
  return excess;
}

/// Says which attempts also ask for the energy's box, after all cheaper bounds have refused: that box costs several
/// times as much as they do. Heuristic: the first two refusals do not lead to it, because the cheaper bounds often
/// prove the peaks at the third attempt. If its bounds exceed a peak by the factor r, it is asked for again when the
/// energy has fallen to 1/r: loads fall no faster than the energy. It is also asked for when the number of refusals has
/// doubled, because loads may fall while the energy stays. A run may end some attempts late. At its end nothing is left to
/// wait for, and every attempt asks for the box.
template <class T> class ThoroughAttempts {
public:
  /// Counts an attempt that the cheaper bounds refused. @return whether to ask for the energy's box
  /// @param energy E' of remaining_energy.hpp (3): E has the rigid turning of a free base, which never decays
  [[nodiscard]] bool is_due(const T& energy) {
    constexpr int before_first = 2;
    ++refusals_;
    if (is_last_) return true;
    return refusals_ > before_first && (!below_ || energy <= *below_ || refusals_ >= again_);
  }
  /// Notes that the box proved nothing. @param excess largest ratio of its bounds to the peaks; none: there was no box
  void note_failure(const T& energy, const std::optional<T>& excess) {
    constexpr double least = 4.0 / 3, without_box = 2; // heuristic
    below_ = energy / (excess ? larger(*excess, T(least)) : T(without_box));
    again_ = 2 * refusals_; // the loads may fall though the energy stays
  }

  /// The run ends here: there is no later attempt to wait for.
  void end() { is_last_ = true; }
  [[nodiscard]] bool is_last() const { return is_last_; }

private:
  bool is_last_ = false;
  int refusals_ = 0, again_ = 0;
  std::optional<T> below_; ///< J; none: not asked yet
};

/// The proofs of one run. Terms that depend on the wing alone are computed at the first attempt.
template <class T, class AnySystem> class FinalPeaks {
public:
  /// A run begins: no hinge is known to have latched.
  void reset() {
    is_prepared_ = false;
    modes_.reset();
    thorough_ = {};
    proven_ = {false, false};
  }

  /// The run ends here: what `prove` is asked from now on, it tries to prove by all means.
  void end() { thorough_.end(); }

  /// The loads (moments, forces) proven final by any call of `prove` since `reset`, even one that failed for other
  /// peaks.
  [[nodiscard]] const FinalLoads& proven() const { return proven_; }

  /// Whether the modes of the latched wing can prove nothing: some do not decay, or there is no
  /// linear model.
  [[nodiscard]] bool lacks_modes() const { return is_prepared_ && !modes_; }

  /// Proves that none of the peaks will rise after the state x at t. Cost: O(n²), at first O(n³).
  /// @param t_end the run's end, s
  /// @param all_latched false: some hinges never latch, and only the energy can tell
  /// @pre no hinge will latch any more, and no hinge has latched since the first call after `reset`
  [[nodiscard]] bool prove(AnySystem& system, const State<T>& x, const T& t, const T& t_end,
                           const SeenPeaks<T>& seen, bool all_latched) {
    if (system.next_knot() < T(never))
      return false; // the base's motion, or a motor's command, will change
    if (holds_forbid(system)) return false;
    if (!is_prepared_) prepare(system, x, t, t_end, all_latched);
    if (!modes_ || !latches_act_fully(system, x)) {
      const std::optional<EnergyLeft<T>> energy = remaining_.energy(system, x, t);
      return energy && prove_by_energy(system, x, *energy, seen);
    }
    const auto start = modes_->start(&x[system.layout().angle(1)], &x[system.layout().rate(1)], t);
    bool is_proven = false;
    // The linear model alone refuses most attempts, and costs less than the energy. Heuristic: the energy is then not
    // asked either. Its bounds ignore damping and are as a rule wider; where they are not, the run ends some attempts
    // later; at the last attempt there is no later.
    if (thorough_.is_last() || linear_loads_are_below(seen, start)) {
      const std::optional<EnergyLeft<T>> energy = remaining_.energy(system, x, t);
      is_proven = prove_by_modes(system, x, t, t_end, start, energy, seen);
    }
    if (!is_proven) tune_dampers(system, start);
    return is_proven;
  }

  /// Proves that no engaged latch lets go: the energy left bounds the load on each.
  /// @param all_latched, @pre as of `prove`
  [[nodiscard]] bool latches_stay(AnySystem& system, const State<T>& x, const T& t, const T& t_end,
                                  bool all_latched) {
    if (system.next_knot() < T(never) || holds_forbid(system)) return false;
    if (!is_prepared_) prepare(system, x, t, t_end, all_latched);
    const std::optional<EnergyLeft<T>> energy = remaining_.energy(system, x, t);
    if (!energy) return false;
    bounds_.bound(system, remaining_, *energy);
    for (int i = 1; i <= system.layout().bodies; ++i)
      if (system.latch_acts(i) && !bounds_.keeps_latched(system, remaining_, energy->within, i))
        return false;
    return true;
  }

private:
  /// Whether a hold excludes all bounds: an elastic hold, a hold of a hinge with a loop, or a hold of a hinge without a
  /// latch, which may still let go. (The caller knows that the other holds do not let go.)
  [[nodiscard]] static bool holds_forbid(const AnySystem& system) {
    if (system.wing().releases.empty()) return false;
    for (int i = 1; i <= system.layout().bodies; ++i) {
      if (system.is_restrained(i)) return true;
      if (!system.is_held(i)) continue;
      if (!system.wing().hinges[i].has_latch) return true;
      for (const LoopTerms<T>& loop : system.wing().loops)
        if (joins(loop, i)) return true;
    }
    return false;
  }

  /// Whether no hold will bear more than its peak. The load of a hold is the moment across its hinge less the hinge's
  /// own moment, which is constant.
  [[nodiscard]] bool no_hold_rises(const AnySystem& system, const State<T>& x,
                                   const SeenPeaks<T>& seen) const {
    using std::abs;
    for (int i = 1; seen.holds && i < static_cast<int>(seen.holds->size()); ++i)
      if (system.is_held(i) &&
          !(bounds_.moment(i) + abs(system.sliding_moment(x, i)) <= (*seen.holds)[i].value))
        return false;
    return true;
  }

  void prepare(AnySystem& system, const State<T>& x, const T& t, const T& t_end, bool all_latched) {
    t_end_ = t_end;
    remaining_.prepare(system);
    bounds_.prepare(system);
    is_prepared_ = true;
    if (!all_latched) return;
    const Layout& at = system.layout();
    find_modes(system, &x[at.rate(1)]);
    if (modes_) tune_dampers(system, modes_->start(&x[at.angle(1)], &x[at.rate(1)], t));
  }

  /// @param rates of the hinges, for which dampers are made linear
  void find_modes(AnySystem& system, const T* rates) {
    const T* rest = &remaining_.rest()[system.layout().angle(1)];
    modes_.reset();
    if (make_rest_model(system.wing(), system.work(), rest, rates, t_end_, model_))
      modes_ = ModalBounds::make(model_, remaining_.least_stiffness(), rest);
  }

  /// Linearizes the dampers anew if the rates have left the range for which the model's dampers were linearized.
  /// @param start of the modes @pre modes_
  void tune_dampers(AnySystem& system, const ModalBounds::ModeVector& start) {
    if (!model_.depends_on_rates()) return;
    const HingeVector rates = modes_->rates(start);
    if (!model_.is_tuned_for(rates)) find_modes(system, rates.data());
  }

  /// Whether the peaks seen lie above the loads of the linear model. @pre modes_
  [[nodiscard]] bool linear_loads_are_below(const SeenPeaks<T>& seen,
                                            const ModalBounds::ModeVector& start) const {
    for (int i = 1; i <= model_.size(); ++i) {
      if (seen.moments && !(modes_->linear_moment(i - 1, start) <= (*seen.moments)[i].value))
        return false;
      if (seen.forces && !(modes_->linear_force(i - 1, start) <= (*seen.forces)[i].value))
        return false;
    }
    return true;
  }

  /// Tries the modes, then the energy alone, then (if due) both together: the cheapest first. @pre modes_
  [[nodiscard]] bool prove_by_modes(AnySystem& system, const State<T>& x, const T& t,
                                    const T& t_end, const ModalBounds::ModeVector& start,
                                    const std::optional<EnergyLeft<T>>& energy,
                                    const SeenPeaks<T>& seen) {
    using std::abs;
    const T momentum = spin(system, x, t);
    const auto proves = [&](const std::optional<HingeBounds>& most) {
      return most && no_peak_can_rise(system, x, T(t_end - t), momentum, *most, seen);
    };
    constexpr bool is_driven = AnySystem::base_motion == BaseMotion::prescribed;
    std::optional<T> cap;    // of the modes' energy
    std::optional<T> so_far; // an energy that may grow
    if (energy)
      cap = is_driven ? energy->elastic : energy->within;
    else if (is_driven)
      so_far = remaining_.energy_so_far(system, x, t);
    if (proves(modes_->bound(start, cap, abs(momentum)))) return true;
    if (!energy && !(so_far && *so_far > T(0))) return false;
    if (energy && prove_by_energy(system, x, *energy, seen)) return true;
    const T at_hand = energy ? energy->within : *so_far;
    if (!thorough_.is_due(at_hand)) return false;
    const std::optional<T> whole =
        energy ? std::optional(energy->elastic) : most_energy(system, x, T(t_end - t), *so_far);
    const auto closest =
        whole ? modes_->bound_in_reach(start, *whole, abs(momentum)) : std::nullopt;
    if (proves(closest)) return true;
    thorough_.note_failure(at_hand,
                           closest ? std::optional(excess_of_loads(seen, *closest)) : std::nullopt);
    return false;
  }

  /// Bounds an energy that may grow. @param time t_end − t, s @return none where no bound was found, or a κ may not hold
  [[nodiscard]] std::optional<T> most_energy(const AnySystem& system, const State<T>& x,
                                             const T& time, const T& so_far) {
    const std::optional<double> most = modes_->most_energy(so_far, time);
    if (!most || !remaining_.keeps_laws(system, x, T(*most))) return std::nullopt;
    return T(*most);
  }

  /// @param time t_end − t, s @param momentum H @param most bounds on all that follows
  [[nodiscard]] bool no_peak_can_rise(const AnySystem& system, const State<T>& x, const T& time,
                                      const T& momentum, const HingeBounds& most,
                                      const SeenPeaks<T>& seen) {
    if (seen.base) {
      const int base = BaseExcursion<T>::coordinate;
      const T at_rest = x[base] - T(modes_->turn_of_base(&x[system.layout().angle(1)]));
      if (!no_base_peak_can_rise(*seen.base, most.base, at_rest, T(model_.rigid * momentum), time))
        return false;
    }
    return no_load_can_rise(seen, model_.size(), most.moment, most.force, 1) &&
           no_overtravel_can_rise(
               seen, system.wing(), [&](int i) { return model_.angles(i - 1); },
               [&](int i) { return most.way(i - 1); });
  }

  [[nodiscard]] bool prove_by_energy(const AnySystem& system, const State<T>& x,
                                     const EnergyLeft<T>& energy, const SeenPeaks<T>& seen) {
    if (seen.base) return false; // the energy does not bound how the base turns
    const Layout& at = system.layout();
    bounds_.bound(system, remaining_, energy);
    return no_load_can_rise(seen, at.bodies, bounds_.moment, bounds_.force, 0) &&
           no_hold_rises(system, x, seen) &&
           no_overtravel_can_rise(
               seen, system.wing(), [&](int i) { return remaining_.rest()[at.angle(i)]; },
               [&](int i) { return remaining_.furthest(i, energy.within); });
  }

  /// H of a free base about the common centre of mass, kg·m²/s; else 0.
  [[nodiscard]] static T spin(AnySystem& system, const State<T>& x, const T& t) {
    if constexpr (AnySystem::base_motion != BaseMotion::free) return T(0);
    return total_motion(system, x, t).spin();
  }

  /// Whether every latch acts with its whole strength: a smoothed one comes in gradually.
  [[nodiscard]] static bool latches_act_fully(const AnySystem& system, const State<T>& x) {
    const Layout& at = system.layout();
    for (int i = 1; at.smoothed && i <= at.bodies; ++i)
      if (system.wing().hinges[i].has_latch && !(x[at.latch(i)] >= system.epsilon())) return false;
    return true;
  }

  /// Whether neither moments nor forces can rise. Notes each of the two that is proven.
  /// @param moment, force, first as of final_loads
  template <class Bounds>
  [[nodiscard]] bool no_load_can_rise(const SeenPeaks<T>& seen, int bodies, const Bounds& moment,
                                      const Bounds& force, int first) {
    const FinalLoads now = final_loads(seen, bodies, moment, force, first);
    proven_.moments = proven_.moments || (seen.moments && now.moments);
    proven_.forces = proven_.forces || (seen.forces && now.forces);
    return now.moments && now.forces;
  }

  RemainingEnergy<T> remaining_;
  EnergyBounds<T> bounds_;
  RestModel model_;
  std::optional<ModalBounds> modes_; ///< none: not all modes decay
  ThoroughAttempts<T> thorough_;
  FinalLoads proven_{false, false};
  bool is_prepared_ = false;
  T t_end_{}; ///< for which the bounds were prepared, s
};

} // namespace wingspread
