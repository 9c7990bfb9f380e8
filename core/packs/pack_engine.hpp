/// The interface of an engine: makes steps of several runs at once, one run in each lane of a vector
/// register. Each instruction set has its own engine (pack_stepper.hpp).
///
/// Between its steps a run's state lives in its lane, and the run itself (Integrator) is asked only
/// when something happens: lane_protocol.hpp says when, and what is copied. Every number of a lane has
/// the bits that the run alone would compute.
#pragma once

#include "core/mechanics/wing.hpp"
#include "core/methods/steppers.hpp"
#include "core/packs/instruction_set.hpp"
#include "core/run/lane_protocol.hpp"

#include <cstdint>
#include <memory>

namespace wingspread {

inline constexpr int most_lanes = 8;

/// A set of lanes: bit l stands for lane l.
using LaneSet = std::uint32_t;
[[nodiscard]] constexpr bool has(LaneSet set, int lane) { return (set >> lane & 1) != 0; }

class PackEngine {
public:
  PackEngine() = default;
  PackEngine(const PackEngine&) = delete;
  PackEngine& operator=(const PackEngine&) = delete;
  virtual ~PackEngine() = default;

  /// Number of lanes.
  [[nodiscard]] virtual int width() const = 0;
  /// Trial steps made so far in every lane.
  [[nodiscard]] virtual long rounds() const = 0;

  /// Copies the numbers of a new run's wing into the lane. @pre `wing` has the engine's structure
  virtual void set_wing(int lane, const Wing<double>& wing) = 0;
  /// Copies the run's state into the lane. @pre set_wing with this run's wing
  virtual void load(int lane, const LaneTask& task) = 0;
  /// Marks the lane as one without a run.
  virtual void set_idle(int lane) = 0;

  /// Makes trial steps in all lanes until at least one lane needs its run.
  /// @return the lanes that need their runs; all others have already accepted or rejected their last trial step
  virtual LaneSet advance() = 0;

  /// Why a lane needs its run. @pre advance() has returned it
  [[nodiscard]] virtual Cause cause(int lane) const = 0;
  /// Copies the run's state and the last trial step out of a lane. @pre advance() has returned it
  virtual void unload(int lane, LaneResult& result) const = 0;
};

/// The method of an engine and the peaks that it watches: each costs time in every lane.
struct PackShape {
  Method method = Method::dop853; ///< has_lanes(method)
  bool forces = false;
  bool moments = false;
  bool holds = false;
  bool motor_energy = false;
  bool overtravel = true; ///< how far hinges turn beyond their stowed angles
};

/// Makes an engine for wings of this structure; null for InstructionSet::scalar.
/// @pre the processor has the set
[[nodiscard]] std::unique_ptr<PackEngine> make_engine(InstructionSet set, const Wing<double>& wing,
                                                      const PackShape& shape);

// each from a translation unit of its own
[[nodiscard]] std::unique_ptr<PackEngine> make_neon_engine(const Wing<double>& wing,
                                                           const PackShape& shape);
[[nodiscard]] std::unique_ptr<PackEngine> make_avx2_engine(const Wing<double>& wing,
                                                           const PackShape& shape);
[[nodiscard]] std::unique_ptr<PackEngine> make_avx512_engine(const Wing<double>& wing,
                                                             const PackShape& shape);

} // namespace wingspread
