/// What t_end cuts, and how everything that reads results counts it. All commands take it from here.
///
/// A run ends where it is proven that nothing asked for can change any more, else at t_end.
///
/// | at t_end                                   | is                        | counts                                  |
/// |--------------------------------------------|---------------------------|-----------------------------------------|
/// | a peak moment or force, no larger one to   | final                     | as its value                            |
/// |   come by proof                            |                           |                                         |
/// | … without that proof                       | cut: it may still rise    | against a `max`: worse than any number  |
/// |                                            |                           |   for requirements, upper tolerance     |
/// |                                            |                           |   limits, `margin` and `rare`; for a    |
/// |                                            |                           |   `min` as its value, its least         |
/// |                                            |                           | as its value for statistics and         |
/// |                                            |                           |   sensitivities, with a warning         |
/// | a latch not engaged, no proof of a stall   | `timed_out`               | as not deployed                         |
/// | a latch with a `holding_moment`, engaged,  | `deployed`                | as deployed, with a warning             |
/// |   without proof that it stays so           |                           |                                         |
/// | any other output                           | that of the run up to its | as its value                            |
/// |                                            |   end, by its definition  |                                         |
///
/// A cut peak shows no `max`, and it disproves one only if its value is beyond the limit already (verdict.hpp). It meets a
/// `min` that it has reached; below it, it disproves none.
#pragma once

#include "core/outcome.hpp"
#include "montecarlo/model/campaign/outputs.hpp"

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace wingspread {

/// The peaks of a run that provably do not rise after its end. `yes`: all that are recorded; `moments`, `forces`: those
/// of one family; `no`: none, because t_end came before a proof. `unknown`: the run failed or was invalid.
enum class PeaksFinal : signed char { unknown, no, yes, moments, forces };
inline constexpr std::array all_peaks_final{PeaksFinal::unknown, PeaksFinal::no, PeaksFinal::yes,
                                            PeaksFinal::moments, PeaksFinal::forces};
/// "true", "false", "peak_moment" or "peak_force" for the only family that is proven, "" for unknown.
[[nodiscard]] std::string_view to_string(PeaksFinal final);
[[nodiscard]] std::optional<PeaksFinal> peaks_final_named(std::string_view text);

[[nodiscard]] PeaksFinal peaks_final_of(const Outcome& outcome);

/// Whether t_end cut a peak of this kind.
[[nodiscard]] bool is_cut(PeakKind kind, PeaksFinal final);

/// The reason of a deployed run without a proof that its latches stay engaged. Other deployed runs have no reason.
inline constexpr std::string_view latches_may_let_go =
    "t_end came before a proof that every latch stays engaged";

/// The advice where t_end cut something: "Lengthen t_end", "No t_end will do with a base that …", or, if that holds for
/// some of the runs, "Lengthen t_end, but none will do for runs with …".
/// @param never_final why_never_final (requirement_checks.hpp) of the campaign; empty: a longer t_end may do
[[nodiscard]] std::string advice_on_t_end(std::string_view never_final);

/// "in 7 of 300 runs it is not proven …", the warning of such runs. @param never_final as for advice_on_t_end
[[nodiscard]] std::string warn_of_open_latches(long open, long runs, std::string_view never_final);

/// Numbers of runs whose peaks are proven, cut by t_end, or unknown (failed or invalid runs).
struct PeaksCount {
  long proven = 0, cut = 0, unknown = 0;
  long moments_cut = 0, forces_cut = 0; ///< among those cut

  void add(PeaksFinal final, long runs = 1);
};
/// "in 12 of 300 runs t_end cut the peaks", "… the peak forces".
[[nodiscard]] std::string cut_peaks_text(const PeaksCount& count, long runs);

} // namespace wingspread
