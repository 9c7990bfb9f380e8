/// Checks of panels that bend: whether their segments vibrate as the panel does.
#pragma once

#include "core/scene/scene.hpp"
#include "montecarlo/model/input_checks/input_warning.hpp"

namespace wingspread {

/// The first frequency of a flexible body as its segments have it, clamped at its plate's beginning, Hz.
/// @pre the body is flexible, and physical
[[nodiscard]] double clamped_frequency(const Body& body);

/// Warns of hinges on a joint, of a plate whose middle is not the centre of mass, of too few joints for the frequency
/// that is stated or follows from the stiffness, of an inertia below a uniform panel's that raises this frequency, and
/// of one above it: that turns with the segments, and lowers high frequencies.
void check_bending(const Scene& scene, InputWarnings& warnings);

} // namespace wingspread
