/// Steps of several runs at once: what an instruction set offers to the runs in its lanes.
///
/// A lane's state lives here between its steps; the run itself (integrator.hpp) stays where it is,
/// and is asked only when something happens. Every number of a lane has the bits that the scalar
/// method gives.
#pragma once

#include "core/peaks.hpp"

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

class PackEngine {
public:
  PackEngine() = default;
  PackEngine(const PackEngine&) = delete;
  PackEngine& operator=(const PackEngine&) = delete;
  virtual ~PackEngine() = default;

  [[nodiscard]] virtual int width() const = 0;

  /// A new run takes the lane: its numbers. @pre a wing of the engine's structure
  virtual void set_wing(int lane, const Wing<double>& wing) = 0;
  /// Its laws and waiting latches, state and derivative, and what is watched, as they are now.
  virtual void set_run(int lane, const Workspace<double>& work, const Step<double>& step,
                       const Watch& watch) = 0;
  /// State and derivative of the lane at its step's start, and the forces' magnitudes there.
  virtual void get_start(int lane, Step<double>& step, std::vector<double>& forces) const = 0;
  /// The same at the end of the step last tried; the forces themselves.
  virtual void get_end(int lane, State<double>& x1, State<double>& dxdt1,
                       std::vector<Vec2<double>>& forces) const = 0;

  /// A step of h in every lane, and the judgement of it. @return evaluations made
  virtual long attempt(const PerLane<double>& h) = 0;
  [[nodiscard]] virtual double error(int lane) const = 0;     ///< as Verdict::error
  [[nodiscard]] virtual double roughness(int lane) const = 0; ///< as of steppers.hpp
  /// Lanes in which an event, a peak or an angle past bounds may lie inside the step.
  [[nodiscard]] virtual LaneSet worth_a_look() const = 0;
  /// Goes on from the step's end in these lanes.
  virtual void accept(LaneSet lanes) = 0;
};

/// What an engine is made for.
struct PackShape {
  BaseMotion motion = BaseMotion::fixed;
  bool eighth_order = true; ///< dop853, else dopri5
  bool forces = false;      ///< peak forces are watched
  bool moments = false;     ///< peak moments are
};

/// Whether this processor, and this build, have the instruction set.
[[nodiscard]] bool has_avx2();
[[nodiscard]] bool has_avx512();

/// An engine for wings of this structure. @pre the instruction set is there
[[nodiscard]] std::unique_ptr<PackEngine> make_avx2_engine(const Wing<double>& wing,
                                                           const PackShape& shape);
[[nodiscard]] std::unique_ptr<PackEngine> make_avx512_engine(const Wing<double>& wing,
                                                             const PackShape& shape);

} // namespace wingspread
