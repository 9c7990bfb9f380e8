/// The functions that integrate runs, compiled twice: with fused multiply-add instructions and without.
///
/// With fused multiply-adds a run has the same bits alone and in a lane, on every processor; without
/// them the last bits may differ. A program built for any x86-64 therefore holds both versions, and
/// uses fma_runs() if the processor has these instructions.
#pragma once

#include "core/methods/steppers.hpp"
#include "core/outcome.hpp"
#include "core/packs/instruction_set.hpp"
#include "core/packs/pack_engine.hpp"

namespace wingspread {

struct Runs {
  /// Sets a wing's numbers to those of the next run and returns the run's name; nothing when there
  /// are no more.
  using NextWing = std::function<std::optional<long>(Wing<double>&)>;
  /// done(name, outcome), called in the order in which the runs end.
  using Done = std::function<void(long, Outcome&&)>;
  /// watch(name, sample), called with each run's samples in order, those of different runs in turn.
  using Watch = std::function<void(long, const Sample&)>;

  void (*set_parameters)(Wing<double>& wing, const Scene& scene);
  /// Integrates one run.
  Outcome (*alone)(const Wing<double>& wing, Workspace<double>& scratch, const Integration& how,
                   const Goal& goal, const Observer& observer);
  /// Integrates many runs in the lanes of an engine (packed_runs.hpp). @param method of the engine
  Occupancy (*in_lanes)(const Wing<double>& structure, PackEngine& engine, Method method,
                        const Integration& how, const Goal& goal, const NextWing& next,
                        const Done& done, const Watch& watch);
};

/// Compiled for the build's own instruction set.
[[nodiscard]] const Runs& plain_runs();
/// Compiled with fused multiply-adds. @pre has_avx2(); exists only if WINGSPREAD_FMA_RUNS is defined
[[nodiscard]] const Runs& fma_runs();

} // namespace wingspread
