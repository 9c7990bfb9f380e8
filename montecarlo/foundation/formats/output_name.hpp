/// Parses names of outputs: "root.latch_time", "root.rate_at.tip", "deployment_time".
#pragma once

#include <string>
#include <string_view>

namespace wingspread {

struct OutputName {
  std::string hinge;    ///< empty for an output of the whole wing
  std::string quantity; ///< "latch_time"; the whole name if unknown
  std::string other;    ///< of a `rate_at`, the hinge that latches; else empty
  const char* unit;     ///< "s", "rad/s", "N·m", "N", "rad"; "" when unknown
};

/// Splits a name. A hinge's name may contain dots.
[[nodiscard]] OutputName parse_output_name(std::string_view name);

/// Whether no value of the output is below 0: a time, a magnitude or a number.
[[nodiscard]] bool is_never_negative(const OutputName& name);

} // namespace wingspread
