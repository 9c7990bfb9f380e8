/// What integrates runs, by the level of scalar instructions that it is built for.
///
/// With fused multiply-adds a run has the same bits in a lane of a pack and alone, whatever the
/// processor; without them the last bits may differ. A program built for any x86-64 therefore holds
/// both, and takes the second where the processor has them.
#pragma once

#include "core/methods/steppers.hpp"
#include "core/outcome.hpp"
#include "core/packs/instruction_set.hpp"
#include "core/packs/pack_engine.hpp"

namespace wingspread {

struct Runs {
  /// Sets the next wing's numbers and returns its run's name; none when there are no more.
  using NextWing = std::function<std::optional<long>(Wing<double>&)>;
  /// done(name, outcome), in the order in which the runs end.
  using Done = std::function<void(long, Outcome&&)>;

  void (*set_parameters)(Wing<double>& wing, const Scene& scene);
  Outcome (*alone)(const Wing<double>& wing, Workspace<double>& scratch, const Integration& how,
                   const Goal& goal, const Observer& observer);
  /// @param method of the engine
  Occupancy (*in_lanes)(const Wing<double>& structure, PackEngine& engine, Method method,
                        const Integration& how, const Goal& goal, const NextWing& next,
                        const Done& done);
};

/// For the build's own instruction set.
[[nodiscard]] const Runs& plain_runs();
/// With fused multiply-adds. @pre has_avx2(), and plain_runs() is built without
[[nodiscard]] const Runs& fma_runs();

} // namespace wingspread
