/// The functions of Runs, with one instance of the templates for each kind of wing. Two translation
/// units include it: one compiles with fused multiply-adds, the other without (runs.hpp).
#pragma once

#include "core/mechanics/structure.hpp"
#include "core/packs/packed_runs.hpp"
#include "core/packs/runs.hpp"
#include "core/run/integrator.hpp"

// Code for different instruction sets passes Eigen matrices to each other. Eigen allocates with malloc up to an alignment
// of 16 bytes and with its own allocator beyond, so all translation units must agree on the alignment.
#ifdef __x86_64__
static_assert(EIGEN_DEFAULT_ALIGN_BYTES >= 32,
              "the first CMakeLists.txt sets EIGEN_MAX_ALIGN_BYTES");
#endif

namespace wingspread::detail {

inline void set_numbers(Wing<double>& wing, const Scene& scene) { set_parameters(wing, scene); }

inline Outcome run_alone(const Wing<double>& wing, Workspace<double>& scratch,
                         const Integration& how, const Goal& goal, const Observer& observer) {
  return with_structure(wing, [&]<class Topology, BaseMotion M>(Structure<Topology, M>) {
    System<double, Topology, M> system(wing, how.smoothing, scratch);
    return Integrator<double, Topology, M>(system, how, goal, observer).run();
  });
}

inline Occupancy run_in_lanes(const Wing<double>& structure, PackEngine& engine, Method method,
                              const Integration& how, const Goal& goal, const Runs::NextWing& next,
                              const Runs::Done& done, const Runs::Watch& watch) {
  return with_structure(structure, [&]<class Topology, BaseMotion M>(Structure<Topology, M>) {
    return PackedRuns<Topology, M>(structure, engine, method, how, goal, watch).run(next, done);
  });
}

inline constexpr Runs runs_here{&set_numbers, &run_alone, &run_in_lanes};

} // namespace wingspread::detail
