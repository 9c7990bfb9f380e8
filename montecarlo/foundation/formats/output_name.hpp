/// What the name of an output says: "root.latch_time", "root.rate_at.tip", "deployment_time".
#pragma once

#include <string>
#include <string_view>

namespace wingspread {

struct OutputName {
  std::string hinge;    ///< empty for an output of the whole wing
  std::string quantity; ///< "latch_time"; the whole name when it is none of those known
  std::string other;    ///< the hinge that latches, of a `rate_at`; else empty
  const char* unit;     ///< "s", "rad/s", "N·m", "N", "rad"; "" when unknown
};

/// Takes a name apart. A hinge's own name may hold dots.
[[nodiscard]] OutputName parse_output_name(std::string_view name);

} // namespace wingspread
