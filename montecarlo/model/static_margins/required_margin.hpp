/// A static margin that is required: of which hinges, by which standard.
///
///     { "motorization": "NASA", "hinge": "*", "min": 0, "probability": 0.99, "confidence": 0.9 }
///
/// What counts of a draw is the least margin over the travel, and of several hinges that of the worst: the
/// requirement speaks of wings, and a wing has the margin of its worst hinge.
#pragma once

#include "montecarlo/model/static_margins/drive.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

struct RequiredMargin {
  MarginKind kind = MarginKind::nasa;
  std::string hinge = "*"; ///< a hinge's name, or "*" for all that drive
  bool operator==(const RequiredMargin&) const = default;
};

/// Reads the keys `motorization` and `hinge` of a requirement, and notes what is wrong with them.
/// @param scene null when it has problems of its own: then hinges are not looked up
void read_required_margin(JsonObject& object, const Scene* scene, RequiredMargin& margin);

/// "NASA": the kind as a campaign has it.
[[nodiscard]] std::string_view word_of(const RequiredMargin& margin);
/// "NASA margin of root", "NASA margin of every hinge": what a report calls the quantity.
[[nodiscard]] std::string name_of(const RequiredMargin& margin);

/// The drives of the scene whose margins count.
[[nodiscard]] std::vector<HingeDrive> required_drives(const Scene& scene,
                                                      const RequiredMargin& margin);

/// The least margin of a scene over the travels of these. +∞ where nothing resists any of them.
[[nodiscard]] double least_margin(const Scene& scene, std::span<const HingeDrive> drives,
                                  MarginKind kind, const MotorizationSpec& spec);

} // namespace wingspread
