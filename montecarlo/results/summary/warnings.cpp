#include "montecarlo/results/summary/warnings.hpp"

#include "montecarlo/foundation/formats/csv.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/model/input_checks/requirement_checks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

namespace wingspread {
namespace {

/// @pre some runs have cut peaks
std::string warn_of_cut_peaks(const PeaksCount& peaks, long runs, std::string_view never_final) {
  return cut_peaks_text(peaks, runs) +
         ": they may still rise, and break every max on a peak; statistics and "
         "correlations are of the cut values. " +
         advice_on_t_end(never_final);
}

/// Adds a warning if t_end cut the nominal run's peaks.
void add_nominal_cut(const NominalRun& nominal, std::vector<std::string>& lines) {
  PeaksCount peaks;
  peaks.add(nominal.peaks);
  if (peaks.cut == 0) return;
  lines.push_back(
      fmt::format("in the nominal run t_end cut the {}: their nominal values may still rise",
                  peaks.moments_cut == 0  ? "peak forces"
                  : peaks.forces_cut == 0 ? "peak moments"
                                          : "peaks"));
}

/// Deployed runs with a reason: latches_may_let_go is the only one.
long count_open_latches(const Summary& summary) {
  long open = 0;
  for (const ReasonCount& each : summary.reasons)
    if (each.status == Status::deployed && each.reason == latches_may_let_go) open += each.count;
  return open;
}

std::string warn_of_far_limit(const Verdict& verdict) {
  const Requirement& requirement = verdict.requirement;
  const auto in_its_unit = [&](double value) {
    const std::string unit = unit_of_limit(requirement);
    return fmt::format("{:.5g}{}{}", in_unit_of_limit(requirement, value), unit.empty() ? "" : " ",
                       unit);
  };
  const auto& [least, largest] = *verdict.beyond_zero;
  return fmt::format("{}: every value of the runs that deployed (least {}, largest {}) is on the "
                     "other side of zero from the limit{}",
                     to_string(requirement), in_its_unit(least), in_its_unit(largest),
                     requirement.absolute ? "" : "; \"abs\": true limits the magnitude");
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
  return fmt::format(
      "in {} of {} runs the draw {} is outside its law (least {:.5g}, largest {:.5g}): {:.5g} in "
      "run {}. The campaign is perhaps not that of these runs",
      draws.runs, runs, draws.name, draws.lower, draws.upper, draws.value, draws.run);
}

/// A warning, and the cases that have it, with the numbers of each (reason_pattern.hpp).
struct SharedWarning {
  std::vector<std::string> words, cases;
  std::vector<std::vector<std::string>> numbers; ///< by case
};

double number_in(const std::string& text) { return parse_csv_number(text).value_or(0); }

/// "7 to 60" where the cases differ in a number, the least and the largest.
std::string numbers_at(const SharedWarning& warning, std::size_t place) {
  std::vector<std::string> texts;
  for (const auto& numbers : warning.numbers) texts.push_back(numbers[place]);
  const auto [least, largest] = std::ranges::minmax(texts, {}, number_in);
  return least == largest ? least : fmt::format("{} to {}", least, largest);
}

bool differs(const SharedWarning& warning, std::size_t place) {
  return std::ranges::any_of(warning.numbers, [&](const auto& numbers) {
    return numbers[place] != warning.numbers.front()[place];
  });
}

/// "every case: cold 60, hot 7": each case's own number where they differ in one.
std::string cases_text(const SharedWarning& warning, const std::vector<std::size_t>& differing,
                       std::size_t cases) {
  const bool every = warning.cases.size() == cases;
  if (differing.size() != 1)
    return every ? "every case" : fmt::format("{}", fmt::join(warning.cases, ", "));
  std::vector<std::string> each;
  for (std::size_t i = 0; i < warning.cases.size(); ++i)
    each.push_back(warning.cases[i] + ' ' + warning.numbers[i][differing.front()]);
  return fmt::format("{}{}", every ? "every case: " : "", fmt::join(each, ", "));
}

/// The requirement with which a warning begins; or empty.
std::string requirement_of(std::string_view text, const Summary& summary) {
  for (const Verdict& verdict : summary.requirements)
    if (std::string name = to_string(verdict.requirement) + ": "; text.starts_with(name))
      return name;
  return "";
}

std::string to_string(const SharedWarning& warning, std::size_t cases) {
  std::string text = warning.words.front();
  std::vector<std::size_t> differing;
  for (std::size_t place = 0; place + 1 < warning.words.size(); ++place) {
    if (differs(warning, place)) differing.push_back(place);
    text += numbers_at(warning, place) + warning.words[place + 1];
  }
  return fmt::format("{} ({})", text, cases_text(warning, differing, cases));
}

} // namespace

PeaksCount count_peaks_final(const Results& results) {
  PeaksCount count;
  for (const PeaksFinal final : results.peaks_final) count.add(final);
  results.peaks_final.release();
  return count;
}

void explain_cuts(const Campaign& campaign, Summary& summary) {
  summary.never_final = why_never_final(campaign);
  for (Verdict& verdict : summary.requirements) verdict.never_final = summary.never_final;
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
  if (summary.nominal) add_nominal_cut(*summary.nominal, lines);
  if (summary.peaks && summary.peaks->cut > 0)
    lines.push_back(warn_of_cut_peaks(*summary.peaks, summary.runs, summary.never_final));
  if (const long open = count_open_latches(summary); open > 0)
    lines.push_back(warn_of_open_latches(open, summary.runs, summary.never_final));
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
      // The numbers of a requirement say which one it is: cases share the warnings of the same requirement alone.
      const std::string named = requirement_of(text, each.summary);
      ReasonPattern pattern = pattern_of(std::string_view(text).substr(named.size()));
      pattern.words.front().insert(0, named);
      auto known = std::ranges::find_if(found, [&](const SharedWarning& other) {
        return other.words == pattern.words && other.cases.back() != each.name;
      });
      if (known == found.end())
        known = found.insert(found.end(), {std::move(pattern.words), {}, {}});
      known->cases.push_back(each.name);
      known->numbers.push_back(std::move(pattern.numbers));
    }
  std::vector<std::string> lines;
  for (const SharedWarning& warning : found) lines.push_back(to_string(warning, cases.size()));
  return lines;
}

std::string warning_lines(const std::vector<std::string>& lines) {
  std::string text = lines.empty() ? "" : "\nWARNING\n";
  for (const std::string& line : lines) text += "  " + wrapped(line, 2) + '\n';
  return text;
}

} // namespace wingspread
