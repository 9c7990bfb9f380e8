/// `"rtol": "auto"`: a campaign's tolerance that follows from how large its sampling error is, and what a pilot
/// of its own runs has found (accuracy/automatic_tolerance.hpp). Here is what is asked for, and the record.
#pragma once

#include "core/outcome.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace wingspread {

/// What the tolerance of a campaign was chosen by: enough to make the same choice again.
struct TolerancePilot {
  std::uint64_t seed = 0;             ///< of the campaign's draws
  std::int64_t runs = 0;              ///< the first so many of the campaign, for the sampling error
  std::vector<std::int64_t> repeated; ///< those of them whose errors were measured
  std::int64_t for_runs = 0;          ///< of the campaign: what its sampling error was taken for
  bool reached = true; ///< whether errors came below the share; no: it is the tightest there is
  bool operator==(const TolerancePilot&) const = default;
};

struct ToleranceChoice {
  double share = 0.01;                 ///< of the sampling error that errors may take up, in (0, 1)
  bool has_atol = false;               ///< atol was given, and stays; else it is rtol/100
  std::optional<TolerancePilot> pilot; ///< none: not chosen yet, `rtol` means nothing
};

/// Reads the keys of the integration that are about it: `rtol_share`, `rtol_pilot`. Notes what is wrong.
/// @param automatic whether `rtol` is "auto"
void read_tolerance_choice(JsonObject& integration, bool automatic,
                           std::optional<ToleranceChoice>& choice);

/// Puts them into an integration's JSON: a choice that is not made has no tolerances.
void write_tolerance_choice(const ToleranceChoice& choice, Json& integration);

} // namespace wingspread
