/// Scenes with elastic joints and flexible bodies, and the oracle's own way to make segments of a panel.
#pragma once

#include "core/scene/scene.hpp"

#include <cstdint>
#include <vector>

namespace wingspread::oracle {

/// A flexible scene as rigid segments, made apart from core/: a panel is cut at stations along its plate, and its parts
/// are put together from one end to the other, whichever segment hangs on the hinge.
struct Segmented {
  Scene scene;                          ///< the given scene's hinges first
  std::vector<std::vector<int>> joints; ///< by the given scene's bodies: indices of hinges
};
[[nodiscard]] Segmented in_segments(const Scene& scene);

/// Makes a third of the scene's hinges elastic joints, but for the first, and half of its bodies flexible: panels whose
/// first frequency is 2 to 6 Hz, in a random direction.
[[nodiscard]] Scene with_bending(Scene scene, std::uint64_t seed);

/// A uniform rod of length 1 m, mass 1 kg and EI = 1 N·m² along x, on a hinge at its end with a latch of this stiffness.
/// The hinge starts where it latches, less 1e-9 rad, at `rate`.
[[nodiscard]] Scene bending_rod(int joints, double latch_stiffness, double rate = 0);

/// The first three β L of a cantilever: cos β cosh β = −1.
inline constexpr double cantilever_roots[] = {1.8751040687119612, 4.6940911329741746,
                                              7.8547574382376126};

} // namespace wingspread::oracle
