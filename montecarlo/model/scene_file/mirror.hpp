/// The key `mirror` of a scene: the second wing made from the first, left and right of the base's y axis.
#pragma once

#include "core/scene/scene.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// Two patterns with one `*` each: "R_*" → "L_*".
struct MirrorNames {
  std::string of, as;

  [[nodiscard]] bool covers(std::string_view name) const;
  /// The copy's name. @pre covers(name)
  [[nodiscard]] std::string copy_of(std::string_view name) const;
};

/// Reads the key; empty patterns, with a problem, if it is not valid.
[[nodiscard]] MirrorNames read_mirror(const JsonCursor& at);

/// Rewords each problem from index `first` on whose value is the name of a copy: nothing can name a copy, because copies
/// are made after all names have been looked up.
void explain_copies(const MirrorNames& names, const Scene& scene, std::size_t first,
                    std::vector<Problem>& problems);

/// Appends a mirrored copy of each body, hinge and loop whose name is covered: points have x → −x, angles and rates the
/// other sign; torques, which count along the travel, stay. Notes a problem where names, or the tree, allow no copy.
/// @param at the key
/// @pre the scene has no problem yet
void add_mirrored(const JsonCursor& at, const MirrorNames& names, Scene& scene);

} // namespace wingspread
