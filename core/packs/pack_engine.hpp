/// Steps of several runs at once: what an instruction set offers to the runs in its lanes.
///
/// A lane's state lives here between its steps; the run itself (integrator.hpp) stays where it is,
/// and is asked only when something happens. Every number of a lane has the bits that the scalar
/// method gives.
#pragma once

#include "core/mechanics/wing.hpp"
#include "core/methods/steppers.hpp"
#include "core/packs/instruction_set.hpp"
#include "core/run/handover.hpp"

#include <cstdint>
#include <memory>

namespace wingspread {

inline constexpr int most_lanes = 8;

/// Bit l: lane l.
using LaneSet = std::uint32_t;
[[nodiscard]] constexpr bool has(LaneSet set, int lane) { return (set >> lane & 1) != 0; }

class PackEngine {
public:
  PackEngine() = default;
  PackEngine(const PackEngine&) = delete;
  PackEngine& operator=(const PackEngine&) = delete;
  virtual ~PackEngine() = default;

  [[nodiscard]] virtual int width() const = 0;

  /// A new run takes the lane: its numbers. @pre a wing of the engine's structure
  virtual void set_wing(int lane, const Wing<double>& wing) = 0;
  /// Takes the lane's run from where it stands.
  virtual void carry(int lane, const Handover& run) = 0;
  /// There is no more run for the lane.
  virtual void set_idle(int lane) = 0;

  /// Makes steps in every lane until some must ask: the step just made holds, or may hold, an
  /// event, a peak, an angle past bounds or the end of what was handed over. @return these lanes;
  /// the others have gone on
  virtual LaneSet advance() = 0;
  /// Tries made in every lane so far.
  [[nodiscard]] virtual long rounds() const = 0;

  /// Gives the run of a lane that asks back, with that step.
  [[nodiscard]] virtual Carried hand_back(int lane, const Place& place) const = 0;
};

/// What an engine is made for.
struct PackShape {
  Method method = Method::dop853; ///< one that has_lanes
  bool forces = false;            ///< peak forces are watched
  bool moments = false;           ///< peak moments are
  bool overtravel = true;         ///< and how far hinges turn beyond their stowed angles
};

/// An engine for wings of this structure; none for `scalar`. @pre the processor has the set
[[nodiscard]] std::unique_ptr<PackEngine> make_engine(InstructionSet set, const Wing<double>& wing,
                                                      const PackShape& shape);

// each from its own translation unit
[[nodiscard]] std::unique_ptr<PackEngine> make_neon_engine(const Wing<double>& wing,
                                                           const PackShape& shape);
[[nodiscard]] std::unique_ptr<PackEngine> make_avx2_engine(const Wing<double>& wing,
                                                           const PackShape& shape);
[[nodiscard]] std::unique_ptr<PackEngine> make_avx512_engine(const Wing<double>& wing,
                                                             const PackShape& shape);

} // namespace wingspread
