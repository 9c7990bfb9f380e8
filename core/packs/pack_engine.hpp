/// Steps of several runs at once: what an instruction set offers to the runs in its lanes.
///
/// A lane's state lives here between its steps; the run itself (integrator.hpp) stays where it is,
/// and is asked only when something happens. Every number of a lane has the bits that the scalar
/// method gives.
#pragma once

#include "core/dense/step.hpp"
#include "core/mechanics/workspace.hpp"
#include "core/methods/step_control.hpp"
#include "core/peaks/peak.hpp"

#include <array>
#include <cstdint>
#include <memory>

namespace wingspread {

inline constexpr int most_lanes = 8;

/// One number a lane.
template <class N> using PerLane = std::array<N, most_lanes>;

/// Bit l: lane l.
using LaneSet = std::uint32_t;
[[nodiscard]] constexpr bool has(LaneSet set, int lane) { return (set >> lane & 1) != 0; }

/// What decides whether a step is worth a look by its run.
struct Watch {
  const std::vector<PeakOf<double>>* moments = nullptr; ///< so far; none: not asked for
  const std::vector<PeakOf<double>>* forces = nullptr;
  const std::vector<double>* force_before = nullptr; ///< at the step's start
  double rtol = 0, atol = 0;
  double atol_of_interpolant = 0; ///< of its roughness
};

/// How far a lane may go by itself, by plain steps, before its run must be asked.
struct Stretch {
  double h = 0; ///< the step to try first, s
  StepMemory<double> memory;
  long tries = 0;   ///< that may be made before
  double t_end = 0; ///< s; a step from which the next may reach it asks
  /// One longer than this asks, s, where `enough` have been made since the last that was not, and
  /// `wait` altogether (both counted from here; the last may lie in the past).
  double held_back_step = 0;
  double last_free = 0, enough = 0, wait = 0;
};

/// How far it has gone.
struct Progress {
  long tries = 0, steps = 0; ///< made, and accepted; without the one that is asked about
  double t = 0, h = 0;       ///< of that one, s
  StepMemory<double> memory;
  /// The last step accepted that was not longer than `held_back_step`: which one (≤ 0: none), after
  /// how many tries, and its end.
  long last_free = 0, tries_to_free = 0;
  double free_time = 0;
};

class PackEngine {
public:
  PackEngine() = default;
  PackEngine(const PackEngine&) = delete;
  PackEngine& operator=(const PackEngine&) = delete;
  virtual ~PackEngine() = default;

  [[nodiscard]] virtual int width() const = 0;
  [[nodiscard]] virtual int evaluations_per_try() const = 0;

  /// A new run takes the lane: its numbers. @pre a wing of the engine's structure
  virtual void set_wing(int lane, const Wing<double>& wing) = 0;
  /// Its laws and waiting latches, state and derivative, and what is watched, as they are now.
  virtual void set_run(int lane, const Workspace<double>& work, const Step<double>& step,
                       const Watch& watch, const Stretch& stretch) = 0;
  /// There is no more run for the lane.
  virtual void set_idle(int lane) = 0;

  /// Makes steps in every lane until some must ask: the step just made holds, or may hold, an
  /// event, a peak, an angle past bounds or the end of the stretch. @return these lanes; the others
  /// have gone on
  virtual LaneSet advance() = 0;
  /// Tries made in every lane so far.
  [[nodiscard]] virtual long rounds() const = 0;

  // ---- of a lane that asks

  [[nodiscard]] virtual Progress progress(int lane) const = 0;
  [[nodiscard]] virtual double error(int lane) const = 0; ///< as Verdict::error
  /// State and derivative at its step's start, and the forces' magnitudes there.
  virtual void get_start(int lane, Step<double>& step, std::vector<double>& forces) const = 0;
  /// The same at the step's end; the forces themselves.
  virtual void get_end(int lane, State<double>& x1, State<double>& dxdt1,
                       std::vector<Vec2<double>>& forces) const = 0;
};

/// What an engine is made for.
struct PackShape {
  BaseMotion motion = BaseMotion::fixed;
  bool eighth_order = true; ///< dop853, else dopri5
  bool forces = false;      ///< peak forces are watched
  bool moments = false;     ///< peak moments are
};

/// An engine for wings of this structure. @pre the instruction set is there
[[nodiscard]] std::unique_ptr<PackEngine> make_neon_engine(const Wing<double>& wing,
                                                           const PackShape& shape);
[[nodiscard]] std::unique_ptr<PackEngine> make_avx2_engine(const Wing<double>& wing,
                                                           const PackShape& shape);
[[nodiscard]] std::unique_ptr<PackEngine> make_avx512_engine(const Wing<double>& wing,
                                                             const PackShape& shape);

} // namespace wingspread
