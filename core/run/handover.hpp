/// What a run and an engine say to each other where the engine makes steps for it, several runs at
/// once:
///
///     run → engine   Handover   where the run stands, how far it may be carried, what to watch for
///     engine → run   Carried    how far it came, and the error of the step that the run must know
///
/// That step, and the state it starts from, the engine leaves in the run's own `Place`.
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

/// What a run carries from step to step beside its state. An engine has one in packs.
template <class P> struct Pace {
  P steps;              ///< accepted in this phase
  StepMemory<P> memory; ///< of step control
  HeldBackSteps<P> held_back;
};

/// A run as an engine takes it. What is referred to stays with the run.
struct Handover {
  const Step<double>& step;          ///< t, x and dxdt: where it stands
  double h;                          ///< the step to try first, s
  const Workspace<double>& work;     ///< laws, and latches that wait
  Tolerance tolerance;               ///< of a step
  double tolerance_of_dense;         ///< absolute, of the roughness of a step's dense output
  const PeakOf<double>* moments;     ///< 1 … n: so far; none: not asked for
  const PeakOf<double>* forces;      ///< the same
  const double* force_before;        ///< 1 … n: at the step's start, where forces are asked for
  const double* overtravel;          ///< 1 … n: so far, rad
  const Conserved<double>& kept;     ///< by a free base
  const BaseExcursion<double>& base; ///< of a free one, so far
  double t_end; ///< where a step has to end, s; one from which the next may reach it is the run's
  long tries;   ///< that may be made before one is the run's
  long steps;   ///< that may be accepted before one is the run's
  long evaluations; ///< so far
  Pace<double> pace;
};

/// Where an engine leaves what it brings back.
struct Place {
  Step<double>& step;                ///< t, x and dxdt, if the run was carried
  std::vector<double>& force_before; ///< 1 … n: at its start, where forces are asked for
  std::vector<PeakOf<double>>&moments, &forces; ///< 1 … n: up to there, those asked for
  std::vector<double>& overtravel;              ///< 1 … n: up to there
  State<double>&x1, &dxdt1;                     ///< the end of the step made last
  std::vector<Vec2<double>>& forces_at_end;     ///< 1 … n: there, where they are asked for
  BaseExcursion<double>& base;                  ///< of a free one, up to the step's start
};

/// How far a run was carried, without the step made last.
struct Carried {
  long tries;       ///< 0: the step made last is the one that the run asked for
  double h;         ///< of that step, s
  long evaluations; ///< of these, and of that step
  double error;     ///< of that step, as in Verdict
  Verdict judged;   ///< on it, by all that a step must satisfy
  Pace<double> pace;
};

} // namespace wingspread
