#include "montecarlo/results/summary/warnings.hpp"

#include <fmt/format.h>

namespace wingspread {
namespace {

std::string warn_of_cut_peaks(long cut, long runs) {
  return fmt::format("in {} of {} runs t_end cut the peaks: they may still rise, and break every "
                     "requirement on a peak",
                     cut, runs);
}

std::string warn_of_far_limit(const Verdict& verdict) {
  const auto& [least, largest] = *verdict.beyond_zero;
  return fmt::format("{}: every value, {:.5g} to {:.5g}, is on the other side of zero from the "
                     "limit{}",
                     to_string(verdict.requirement), least, largest,
                     verdict.requirement.absolute ? "" : "; \"abs\": true limits the magnitude");
}

std::string warn_of_moved_runs(const Accuracy& accuracy) {
  return fmt::format("in {} of the {} runs repeated at a tighter tolerance an output moves by more "
                     "than 1 %: the tolerance does not decide it; try a smaller rtol",
                     accuracy.moved.size(), accuracy.runs);
}

} // namespace

PeaksCount count_peaks_final(const Results& results) {
  PeaksCount count;
  for (const PeaksFinal final : results.peaks_final)
    ++(final == PeaksFinal::yes  ? count.proven
       : final == PeaksFinal::no ? count.cut
                                 : count.unknown);
  results.peaks_final.release();
  return count;
}

std::vector<std::string> warnings(const Summary& summary) {
  std::vector<std::string> lines;
  for (const Overtravel& overtravel : summary.overtravels)
    lines.push_back(warning(overtravel, summary.runs));
  if (!summary.latch_jumps.empty())
    lines.push_back("in the nominal run: " + warning(summary.latch_jumps));
  if (summary.peaks && summary.peaks->cut > 0)
    lines.push_back(warn_of_cut_peaks(summary.peaks->cut, summary.runs));
  if (summary.accuracy && !summary.accuracy->moved.empty())
    lines.push_back(warn_of_moved_runs(*summary.accuracy));
  for (const Verdict& verdict : summary.requirements)
    if (verdict.beyond_zero) lines.push_back(warn_of_far_limit(verdict));
  return lines;
}

} // namespace wingspread
