/// The protocol between a run (Integrator) and the lane of an engine (PackEngine) that makes steps
/// for it. PackedRuns speaks for both, lane by lane:
///
///     1. engine.set_wing(lane, wing)     copies the numbers of a new run's wing
///     2. engine.load(lane, task)         copies the state of the run: LaneTask, run → lane
///     3. engine.advance()                makes trial steps in all lanes at once, and returns the
///                                        lanes that need their runs
///     4. engine.unload(lane, result)     copies the state back: LaneResult, lane → run
///     5. run.resume(result)              judges the last trial step and goes on to 2, or ends
///
/// A lane accepts and rejects plain steps alone. A lane needs its run when the last trial step may
/// hold an event or a peak, may reach the end of the stretch (t_end, a knot of a table, a hold's release), or uses up
/// the steps that the task allows. The run then treats that trial step as one that it made itself. A lane says whether
/// it has found that the step holds no event (LaneResult::none), and how each peak may rise over it
/// (LaneResult::peaks_searched): the run searches only those again that may rise inside. Lane and run use the same
/// expressions, so every number has the same bits with and without a lane.
#pragma once

#include "core/dense/step.hpp"
#include "core/mechanics/energy.hpp"
#include "core/mechanics/workspace.hpp"
#include "core/methods/held_back_steps.hpp"
#include "core/methods/method.hpp"
#include "core/methods/step_control.hpp"
#include "core/peaks/base_peaks.hpp"
#include "core/peaks/peak.hpp"

#include <vector>

namespace wingspread {

/// The memory of step control and of `auto`. An engine keeps one in packs.
template <class P> struct StepHistory {
  P steps;              ///< accepted in this phase
  StepMemory<P> memory; ///< of step control
  HeldBackSteps<P> held_back;
};

/// Run → lane: the state from which the lane makes steps, and when it must return control. Refers to
/// storage of the run; the lane copies all of it.
struct LaneTask {
  const Step<double>& step;      ///< its t, x and dxdt: the state
  double h;                      ///< the first trial step, s
  const Workspace<double>& work; ///< laws, contacts, and latches that have not engaged
  Tolerance tolerance;           ///< of a step
  double dense_tolerance;        ///< absolute, of the roughness of a step's dense output
  const PeakOf<double>* moments; ///< 1 … n: peaks so far; null: not asked for
  const PeakOf<double>* forces;  ///< the same
  const PeakOf<double>* holds;   ///< the same of what holds have borne
  const double* force_before;    ///< 1 … n: at the state, N; null: not asked for
  const double* overtravel;      ///< 1 … n: so far, rad
  const double* motor_energy;    ///< 1 … n: so far, J; null: not asked for
  const double*
      held_before; ///< 1 … n: moments on stuck hinges at the state, N·m; null: none sticks
  const double* excess_before; ///< 1 … n: of their friction over its limit, N·m; null: none sticks
  const BaseExcursion<double>& base; ///< of a free base, so far
  double end_of_stretch;             ///< Stepping::end_of_stretch: the run makes the step to it, s
  long most_trial_steps;             ///< after so many the run must judge the next trial step
  long most_steps;                   ///< the same, after so many accepted steps
  long evaluations;                  ///< so far, without those of peak searches
  StepHistory<double> history;
};

/// Events that a lane has excluded in a step.
struct NoEvents {
  bool at_all = false;                  ///< if not, LaneResult::may_happen says of which hinges
  bool kinks = false, releases = false; ///< of stuck hinges
};

/// Lane → run: how far the run has come, and the last trial step, which the run has yet to judge.
struct LaneResult {
  // storage of the run, which the lane writes to
  Step<double>& step;                       ///< its t, x and dxdt: start of the last trial step
  std::vector<double>& force_before;        ///< 1 … n: there, N; if asked for
  std::vector<PeakOf<double>>& moments;     ///< 1 … n: up to there; if asked for
  std::vector<PeakOf<double>>& forces;      ///< the same
  std::vector<PeakOf<double>>& holds;       ///< the same
  std::vector<double>& overtravel;          ///< 1 … n: up to there, rad
  std::vector<double>& motor_energy;        ///< 0 … n: up to there, J; empty if not asked for
  State<double>&x1, &dxdt1;                 ///< end of the last trial step
  std::vector<Vec2<double>>& forces_at_end; ///< 1 … n: there, N; if asked for
  // where hinges stick
  std::vector<double>&
      held_before; ///< 1 … n: their moments at the start of the last trial step, N·m
  std::vector<double>& excess_before; ///< 1 … n: of their friction over its limit there, N·m
  std::vector<double>& held_at_end; ///< 1 … n: their moments at the end of the last trial step, N·m
  BaseExcursion<double>& base;      ///< of a free base, up to the start of that step
  // over that step; written only if `peaks_searched`. Null: a step inside another one, whose peaks count
  std::vector<Rise>* moments_rise; ///< 1 … n
  std::vector<Rise>* holds_rise;   ///< 1 … n, where a hold is rigid; if asked for
  std::vector<char>&
      may_happen; ///< 1 … n: whether a hinge may have an event of its own in the last trial step, if accepted
  // values
  long trial_steps = 0;     ///< before the last one; 0: the state is the task's, and not written
  double h = 0;             ///< the last trial step, s
  long evaluations = 0;     ///< made by the lane, those of the last trial step included
  long searched = 0;        ///< those of them of peak searches
  double error = 0;         ///< of the last trial step, as in StepVerdict
  StepVerdict judged{0, 1}; ///< on it, by all that a whole step must satisfy
  StepHistory<double> history{};
  bool peaks_searched = false; ///< the last trial step is accepted, and its peaks are searched
  bool forces_may_rise = true; ///< over that step
  NoEvents none{};             ///< that the lane has found in that step, if it is accepted
};

} // namespace wingspread
