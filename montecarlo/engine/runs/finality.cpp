#include "montecarlo/engine/runs/finality.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace wingspread {

std::string_view to_string(PeaksFinal final) {
  switch (final) {
  case PeaksFinal::no:
    return "false";
  case PeaksFinal::yes:
    return "true";
  case PeaksFinal::moments:
    return "peak_moment";
  case PeaksFinal::forces:
    return "peak_force";
  case PeaksFinal::unknown:
    break;
  }
  return "";
}

std::optional<PeaksFinal> peaks_final_named(std::string_view text) {
  const auto found = std::ranges::find_if(
      all_peaks_final, [&](PeaksFinal final) { return to_string(final) == text; });
  return found == all_peaks_final.end() ? std::nullopt : std::optional(*found);
}

PeaksFinal peaks_final_of(const Outcome& outcome) {
  if (outcome.status == Status::invalid || outcome.status == Status::failed)
    return PeaksFinal::unknown;
  if (outcome.peaks_final) return PeaksFinal::yes;
  if (outcome.moments_final) return PeaksFinal::moments;
  return outcome.forces_final ? PeaksFinal::forces : PeaksFinal::no;
}

bool is_cut(PeakKind kind, PeaksFinal final) {
  switch (final) {
  case PeaksFinal::no:
    return kind != PeakKind::none;
  case PeaksFinal::moments:
    return kind == PeakKind::force;
  case PeaksFinal::forces:
    return kind == PeakKind::moment;
  case PeaksFinal::unknown: // such a run counts by its status
  case PeaksFinal::yes:
    break;
  }
  return false;
}

std::string advice_on_t_end(std::string_view never_final) {
  if (never_final.empty()) return "Lengthen t_end";
  return fmt::format("{} {}",
                     never_final.starts_with("for runs") ? "Lengthen t_end, but none will do"
                                                         : "No t_end will do",
                     never_final);
}

std::string warn_of_open_latches(long open, long runs, std::string_view never_final) {
  return fmt::format(
      "in {} of {} runs it is not proven that every latch with a holding_moment stays engaged "
      "after t_end: they count as deployed. {}",
      open, runs, advice_on_t_end(never_final));
}

void PeaksCount::add(PeaksFinal final, long runs) {
  if (final == PeaksFinal::unknown) unknown += runs;
  if (final == PeaksFinal::yes) proven += runs;
  if (is_cut(PeakKind::moment, final)) moments_cut += runs;
  if (is_cut(PeakKind::force, final)) forces_cut += runs;
  if (is_cut(PeakKind::moment, final) || is_cut(PeakKind::force, final)) cut += runs;
}

std::string cut_peaks_text(const PeaksCount& count, long runs) {
  const auto& [proven, cut, unknown, moments, forces] = count;
  const bool one_kind = moments == 0 || forces == 0;
  if (moments == forces || one_kind)
    return fmt::format("in {} of {} runs t_end cut the {}", cut, runs,
                       moments == forces ? "peaks"
                       : moments > 0     ? "peak moments"
                                         : "peak forces");
  return fmt::format("in {} of {} runs t_end cut peaks (moments in {}, forces in {})", cut, runs,
                     moments, forces);
}

} // namespace wingspread
