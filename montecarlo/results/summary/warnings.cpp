#include "montecarlo/results/summary/warnings.hpp"

#include "montecarlo/foundation/formats/text_layout.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

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

/// "a, b and 3 more outputs".
std::string first_names(std::span<const std::string> names) {
  constexpr std::size_t most = 3;
  const std::size_t shown = names.size() > most + 1 ? most : names.size();
  std::string text = fmt::format("{}", fmt::join(names.first(shown), ", "));
  if (shown < names.size()) text += fmt::format(" and {} more outputs", names.size() - shown);
  return text;
}

std::string warn_of_moved_runs(const Accuracy& accuracy) {
  const bool one = accuracy.moved_outputs.size() == 1;
  return fmt::format("in {} of the {} runs repeated at a tighter tolerance {} {} by more than 1 %: "
                     "the tolerance does not decide {} there. Try a smaller rtol and atol; if {} "
                     "still, the motion is too sensitive for a value of a single run",
                     accuracy.moved.size(), accuracy.runs, first_names(accuracy.moved_outputs),
                     one ? "moves" : "move", one ? "its value" : "their values",
                     one ? "it moves" : "they move");
}

std::string warn_of_draws(const StrangeDraws& draws, long runs) {
  return fmt::format("in {} of {} runs the draw {} is outside its law, {:.5g} to {:.5g}: {:.5g} in "
                     "run {}. The campaign is perhaps not that of these runs",
                     draws.runs, runs, draws.name, draws.lower, draws.upper, draws.value,
                     draws.run);
}

/// The text without the digits of its numbers: equal for warnings of the same kind about the same parts.
std::string kind_of(std::string_view text) {
  std::string kind;
  for (std::size_t i = 0; i < text.size(); ++i) {
    // digits of a name ("panel_2") follow a letter or an underscore, those of a number do not
    const bool digit = std::isdigit(static_cast<unsigned char>(text[i])) != 0;
    const bool in_name =
        i > 0 && (std::isalpha(static_cast<unsigned char>(text[i - 1])) != 0 || text[i - 1] == '_');
    if (!digit || in_name) kind += text[i];
  }
  return kind;
}

/// A warning, and the cases that have it.
struct SharedWarning {
  std::string text;
  std::vector<std::string> cases;
  bool same = true; ///< the numbers are equal in all of them
};

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
  if (summary.one_run && summary.runs > 1)
    lines.push_back(
        fmt::format("nothing is dispersed: all {} runs are the same run. Shares, bounds "
                    "and verdicts show no probability",
                    summary.runs));
  for (const StrangeDraws& draws : summary.strange_draws)
    lines.push_back(warn_of_draws(draws, summary.runs));
  for (const Overtravel& overtravel : summary.overtravels)
    lines.push_back(warning(overtravel, summary.runs));
  if (!summary.latch_jumps.empty())
    lines.push_back("in the nominal run: " + warning(summary.latch_jumps));
  if (!summary.jump_forces.empty())
    lines.push_back("in the nominal run: " + warning_of_forces(summary.jump_forces));
  if (summary.peaks && summary.peaks->cut > 0)
    lines.push_back(warn_of_cut_peaks(summary.peaks->cut, summary.runs));
  if (summary.accuracy && !summary.accuracy->moved.empty())
    lines.push_back(warn_of_moved_runs(*summary.accuracy));
  for (const Verdict& verdict : summary.requirements)
    if (verdict.beyond_zero) lines.push_back(warn_of_far_limit(verdict));
  return lines;
}

std::vector<std::string> warnings(std::span<const CaseSummary> cases) {
  std::vector<SharedWarning> found;
  for (const CaseSummary& each : cases)
    for (const std::string& text : warnings(each.summary)) {
      const auto known = std::ranges::find_if(
          found, [&](const SharedWarning& other) { return kind_of(other.text) == kind_of(text); });
      if (known == found.end())
        found.push_back({text, {each.name}});
      else
        known->cases.push_back(each.name), known->same = known->same && known->text == text;
    }
  std::vector<std::string> lines;
  for (const auto& [text, names, same] : found)
    lines.push_back(fmt::format(
        "{} ({}{})", text,
        names.size() == cases.size() ? "every case" : fmt::format("{}", fmt::join(names, ", ")),
        same ? "" : "; numbers of " + names.front()));
  return lines;
}

std::string warning_lines(const std::vector<std::string>& lines) {
  std::string text = lines.empty() ? "" : "\nWARNING\n";
  for (const std::string& line : lines) text += "  " + wrapped(line, 2) + '\n';
  return text;
}

} // namespace wingspread
