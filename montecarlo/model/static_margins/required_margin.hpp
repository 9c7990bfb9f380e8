/// A static margin that a campaign requires: by which standard, of which hinges.
///
///     { "motorization": "NASA", "hinge": "*", "min": 0, "probability": 0.99, "confidence": 0.9 }
///
/// A draw's value is its least margin over the travel. With "*" it is the margin of the worst hinge.
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

/// Reads the keys `motorization` and `hinge` of a requirement, and notes problems.
/// @param scene null if the scene has problems: then the hinge is not looked up
void read_required_margin(JsonObject& object, const Scene* scene, RequiredMargin& margin);

/// "NASA": the word of the key `motorization`.
[[nodiscard]] std::string_view word_of(const RequiredMargin& margin);
/// "NASA margin of root", "NASA margin of every hinge".
[[nodiscard]] std::string name_of(const RequiredMargin& margin);

/// The drives that the requirement is about: those that it applies to.
[[nodiscard]] std::vector<HingeDrive> required_drives(const Scene& scene,
                                                      const RequiredMargin& margin);

/// The least margin over the travels of these drives; the largest finite number if nothing resists, NaN for an
/// unphysical scene.
[[nodiscard]] double least_margin(const Scene& scene, std::span<const HingeDrive> drives,
                                  MarginKind kind, const StaticMarginSpec& spec);

} // namespace wingspread
