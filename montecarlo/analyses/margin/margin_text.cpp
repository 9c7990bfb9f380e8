#include "montecarlo/analyses/margin/margin_report.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace wingspread {
namespace {

/// The text of one search.
class SearchText {
public:
  SearchText(const MarginReport& report, const MarginSearch& search)
      : report_(report), search_(search), by_scale_(failing_by_scale(search)),
        conditions_(condition_findings(report.campaign, report.result, search)),
        words_(words_of(search)) {}

  [[nodiscard]] std::string text() const {
    const auto windows = windows_of(by_scale_);
    const Window* best = widest(windows);
    std::string text = fmt::format("\n{}\n", heading());
    text += best ? window(*best) : no_window();
    if (windows.size() > 1) {
      text += "  Other windows, narrower:";
      for (const Window& other : windows)
        if (&other != best) text += fmt::format(" {} to {}", other.lower, other.upper);
      text += '\n';
    }
    text += present() + given_up() + requirements();
    return text + (search_.recommended ? new_values() : "") + scales();
  }

private:
  [[nodiscard]] std::string heading() const {
    const MarginSpec& spec = *report_.campaign.margin;
    const std::string what =
        search_.name == "joint" && spec.mode == MarginMode::joint
            ? search_.scaled.size() == 1
                  ? path_of(report_.campaign.scene, search_.scaled.front())
                  : fmt::format("{} parameters together", search_.scaled.size())
            : fmt::format("hinge {} alone", search_.name);
    std::string text = fmt::format("WINDOW of the {}: {}, searched from {} to {}", words_.scale,
                                   what, spec.lower, spec.upper);
    const double lowest = search_.seen.begin()->first, highest = search_.seen.rbegin()->first;
    if (lowest < spec.lower || spec.upper < highest)
      text += fmt::format(",\n  extended to {} … {} to find the edges or to include the {}", lowest,
                          highest, words_.present);
    return text;
  }

  /// The requirement, with its case if there are several. @param found a ConditionFinding or CutPeaks
  [[nodiscard]] std::string name(const auto& found) const {
    return report_.result.cases.size() == 1
               ? found.requirement
               : fmt::format("{} ({})", found.requirement, found.which_case);
  }
  [[nodiscard]] std::string name(std::size_t condition) const {
    return name(conditions_[condition]);
  }

  [[nodiscard]] const Verdict& verdict(std::size_t condition, double scale) const {
    return verdict_of(search_.seen.at(scale), conditions_[condition].condition);
  }

  [[nodiscard]] static std::string line(std::string_view label, double scale,
                                        std::string_view text) {
    return fmt::format("  {:<20}{:>8}  {}\n", label, scale, wrapped(text, 32));
  }

  /// A line with the name of a condition. Only the line of the first condition has the label and the scale.
  [[nodiscard]] std::string first_or_next(bool first, std::string_view label, double scale,
                                          std::size_t condition) const {
    return first ? line(label, scale, name(condition))
                 : fmt::format("{:32}{}\n", "", wrapped(name(condition), 32));
  }

  /// "at 1.18: pass: 2 of 2000 runs break it, 2 allowed".
  [[nodiscard]] std::string at(std::size_t condition, double scale) const {
    const Verdict& seen = verdict(condition, scale);
    return fmt::format(
        "{:34}at {}: {}: {} of {} runs break it, {} allowed\n{}", "", scale,
        to_string(seen.decision), seen.broken.size(), seen.runs, seen.allowed.value_or(0),
        seen.cut > 0 ? fmt::format("{:34}t_end cut the peak in {} of them\n", "", seen.cut) : "");
  }

  [[nodiscard]] std::string edge(std::string_view label, const MarginEdge& edge) const {
    if (!edge.failing)
      return line(label, edge.passing,
                  "no edge: all requirements are met up to the end of the search");
    std::string text;
    for (const std::size_t condition : edge.set_by)
      text += first_or_next(text.empty(), label, edge.passing, condition) +
              at(condition, edge.passing) + at(condition, *edge.failing);
    if (!edge.as_well.empty())
      text += fmt::format(
          "{:32}{} because those runs do not deploy\n", "",
          counted(std::ssize(edge.as_well), "other requirement fails", "other requirements fail"));
    return text;
  }

  [[nodiscard]] std::string window(const Window& window) const {
    return edge(words_.lowest, lower_edge(search_, window)) + recommended() +
           edge(words_.highest, upper_edge(search_, window)) + together(window) + unseen(window);
  }

  /// The widest gap between the window's scales.
  [[nodiscard]] std::string unseen(const Window& window) const {
    const auto [lower, upper] = widest_gap(search_, window);
    if (!(upper > lower)) return "";
    const double apart = 100 * (upper / lower - 1); // %
    return paragraph(
        fmt::format("nothing was run between neighbouring scales of the window, up to "
                    "{} % apart ({} and {}): what fails only there is not seen. More "
                    "\"points\" bring them closer",
                    apart < 10 ? fmt::format("{:.2g}", apart) : fmt::format("{:.0f}", apart), lower,
                    upper),
        2);
  }

  [[nodiscard]] static std::string below(std::string_view words) { return paragraph(words, 34); }

  [[nodiscard]] std::string recommended() const {
    if (!search_.recommended)
      return fmt::format("  {:<20}{:>8}  none:\n", "recommended", "–") +
             below(why_withheld(search_));
    const double scale = *search_.recommended;
    std::string text = line("recommended", scale, confirmation());
    const std::size_t worst = most_strained(search_.seen.at(scale));
    const Verdict& verdict = verdict_of(search_.seen.at(scale), conditions_[worst].condition);
    text += below((verdict.broken.empty()
                       ? "no run breaks any requirement there"
                       : fmt::format("closest to its limit: {}: {} of {} runs break it",
                                     name(worst), verdict.broken.size(), verdict.runs)) +
                  why_this_one(search_));
    if (search_.passed_over)
      text += below(fmt::format("scale {} breaks fewer runs, but its static margin is too low: {}",
                                search_.passed_over->scale, to_string(*search_.passed_over)));
    return text;
  }

  /// The drawbacks of the recommended values against the present ones.
  [[nodiscard]] std::string given_up() const {
    if (!search_.recommended) return "";
    const double scale = *search_.recommended;
    if (scale == 1)
      return line("drawbacks", 1, fmt::format("none: the {} are kept", words_.present));
    std::string text;
    for (const Concession& each : concessions(report_.campaign, report_.result, search_))
      text += first_or_next(text.empty(), "drawbacks", scale, each.condition) + change(each);
    const auto lowered = lowered_margins(report_.result.campaigns, search_.scaled, scale);
    if (const auto least = std::ranges::min_element(lowered, {}, &Shortfall::margin);
        least != lowered.end())
      text += line(text.empty() ? "drawbacks" : "", scale, "static margins: " + to_string(*least));
    return text.empty() ? line("drawbacks", scale, "none: no requirement comes closer to its limit")
                        : text;
  }

  /// "67 of 3000 runs break it now, 1 recommended; 99 % quantile among runs with a value: 230.1 now, 264.2
  /// recommended".
  [[nodiscard]] static std::string change(const Concession& each) {
    const Verdict& before = *each.present;
    std::string text =
        fmt::format("{} of {} runs break it now, {} recommended", before.broken.size(), before.runs,
                    each.recommended->broken.size());
    if (!std::isnan(each.present_quantile) && !std::isnan(each.quantile))
      text += fmt::format(
          "; {:.10g} % quantile among runs with a value: {:.5g} now, {:.5g} recommended",
          100 * (before.requirement.min ? 1 - before.requirement.probability
                                        : before.requirement.probability),
          in_unit_of_limit(before.requirement, each.present_quantile),
          in_unit_of_limit(before.requirement, each.quantile));
    return below(text);
  }

  /// The joint confidence of all requirements in all cases, at both edges.
  [[nodiscard]] std::string together(const Window& window) const {
    const double confidence = window_confidence(report_.campaign, report_.result, window);
    const std::string of = counted(std::ssize(conditions_), "requirement", "requirements");
    if (!(confidence > 0)) return fmt::format("  joint confidence of {}: no guarantee\n", of);
    return fmt::format(
        "  joint confidence of {}: at least {:.10g} %, over all cases and both edges\n", of,
        100 * confidence);
  }

  [[nodiscard]] std::string confirmation() const {
    const std::string runs = fmt::format("{} runs of seed {}: ", report_.campaign.sampling.runs,
                                         report_.result.confirmation_seed);
    if (is_confirmed(search_)) return runs + "all requirements are met";
    std::vector<std::string> broken;
    for (const std::size_t condition : failing(*search_.confirmation)) {
      const Verdict& seen = verdict_of(*search_.confirmation, conditions_[condition].condition);
      broken.push_back(fmt::format("{} ({} runs break it, {} allowed)", name(condition),
                                   seen.broken.size(), seen.allowed.value_or(0)));
    }
    return fmt::format("{}NOT confirmed: {}", runs, fmt::join(broken, "; "));
  }

  [[nodiscard]] std::string no_window() const {
    std::string text =
        fmt::format("  {}\n", wrapped(fmt::format("EMPTY: {}.", why_withheld(search_)), 4));
    for (const std::size_t condition : closed_by(by_scale_))
      text += fmt::format("    {}\n", wrapped(name(condition) + ": " + holds(condition), 6));
    for (const CutPeaks& each : cut_peaks(report_.result, search_))
      text += fmt::format("    {}\n",
                          wrapped(fmt::format("t_end cut the peak in {} of {} runs at scale {}: {}",
                                              each.cut, each.runs, each.scale, name(each)),
                                  6));
    return text;
  }

  /// The passing scale of an edge; both scales if the edge was not located to the tolerance, because no window depends
  /// on it.
  [[nodiscard]] std::string between(double passing, double failing) const {
    const double ratio = std::max(passing / failing, failing / passing);
    if (ratio <= 1 + report_.campaign.margin->edge_tolerance) return fmt::format("{}", passing);
    return fmt::format("{} – {}", std::min(passing, failing), std::max(passing, failing));
  }

  /// The scales that pass: "1.18 to 1.63", "from 1.18", "up to 1.63", or several of these.
  [[nodiscard]] std::string holds(std::size_t condition) const {
    if (conditions_[condition].kind == "never") return "nowhere";
    std::string text;
    for (const auto& [lower, upper, below, above] : conditions_[condition].holds) {
      if (!text.empty()) text += ", ";
      if (below) text += (above ? "" : "from ") + between(lower, *below);
      if (above) text += (below ? " to " : "up to ") + between(upper, *above);
    }
    return text.empty() ? "everywhere" : text;
  }

  [[nodiscard]] std::string present() const {
    const auto found = search_.seen.find(1);
    if (found == search_.seen.end()) return "";
    const Failing why = to_report(found->second);
    if (why.empty()) return line(words_.present, 1, "all requirements are met");
    std::string text;
    for (const std::size_t condition : why)
      text += first_or_next(text.empty(), words_.present, 1, condition) + at(condition, 1);
    return text;
  }

  [[nodiscard]] std::string requirements() const {
    std::string text = fmt::format("\n{:<52}{:>12}  {}\n", "REQUIREMENT", "out of order", "holds");
    const std::string* previous = nullptr; // case
    for (std::size_t k = 0; k < conditions_.size(); ++k) {
      const auto& each = conditions_[k];
      if (report_.result.cases.size() > 1 && !(previous && *previous == each.which_case))
        text += each.which_case + '\n';
      previous = &each.which_case;
      text += fmt::format("{}{:>12}  {}\n", in_column("  " + each.requirement, 52), disorder(k),
                          wrapped(holds(k), 66));
    }
    return text;
  }

  /// The number of draws out of order (OutOfOrder) at the condition's edges.
  [[nodiscard]] std::string disorder(std::size_t condition) const {
    const auto& each = conditions_[condition];
    if (!each.out_of_order || each.kind == "always" || each.kind == "never") return "–";
    const bool lower = each.kind != "upper", upper = each.kind != "lower";
    return fmt::format("{}", (lower ? each.out_of_order->lower : 0) +
                                 (upper ? each.out_of_order->upper : 0));
  }

  [[nodiscard]] std::string new_values() const {
    std::string text =
        fmt::format("\n{:<60}{:>12}{:>14}\n", words_.heading, "present", "recommended");
    for (const SceneParameter& parameter : search_.scaled) {
      const double value = parameter.in(report_.campaign.scene);
      const std::string_view unit = unit_of(parameter);
      text += fmt::format("{}{:>12.5g}{:>14.5g}{}{}\n",
                          in_column("  " + path_of(report_.campaign.scene, parameter), 60), value,
                          value * *search_.recommended, unit.empty() ? "" : " ", unit);
    }
    return text;
  }

  [[nodiscard]] std::string scales() const {
    const bool several = report_.result.cases.size() > 1;
    const int width = several ? 22 : 12;
    std::string text = fmt::format("\n{:<10}{:>{}}{:>26}   {}\n", "SCALE",
                                   several ? "deployed, worst case" : "deployed", width,
                                   fmt::format("{:g} % bounds", 100 * confidence()), "not met");
    for (const auto& [scale, cases] : search_.seen) {
      const DeployedShare deployed = least_deployed(cases);
      text += fmt::format("  {:<8}{:>{}}{:>26}{}\n", scale, percent(deployed.share), width,
                          percent_range(deployed.bounds.lower, deployed.bounds.upper),
                          outputs_of(to_report(cases)));
    }
    return text;
  }

  /// Of the case in which the fewest runs deployed.
  [[nodiscard]] DeployedShare least_deployed(const ScaleResult& cases) const {
    DeployedShare least = deployed_share(cases.front(), confidence());
    for (const CaseResult& one : cases)
      if (const DeployedShare own = deployed_share(one, confidence()); own.share < least.share)
        least = own;
    return least;
  }

  [[nodiscard]] double confidence() const { return report_.campaign.statistics.confidence; }

  /// The outputs of the failing requirements, each once, padded to the column where they start.
  [[nodiscard]] std::string outputs_of(const Failing& failing) const {
    std::vector<std::string> outputs;
    for (const std::size_t condition : failing) {
      const Requirement& requirement =
          report_.campaign.requirements[conditions_[condition].condition.requirement];
      if (std::ranges::find(outputs, requirement.output) == outputs.end())
        outputs.push_back(requirement.output);
    }
    if (outputs.empty()) return "";
    return "   " + wrapped(fmt::format("{}", fmt::join(outputs, ", ")), 51);
  }

  const MarginReport& report_;
  const MarginSearch& search_;
  FailingByScale by_scale_;
  std::vector<ConditionFinding> conditions_;
  ScaledWords words_;
};

} // namespace

std::string margin_text(const MarginReport& report) {
  const Sampling& sampling = report.campaign.sampling;
  std::string text =
      fmt::format("{} · margin · {} runs per scale and case, {} in all · {}, seed {}\n",
                  report.campaign.scene.name, sampling.runs, report.result.runs,
                  design_names[static_cast<std::size_t>(sampling.design)], sampling.seed);
  for (const MarginSearch& search : report.result.searches)
    text += SearchText(report, search).text();
  return text + static_margins_text(report.static_margins);
}

} // namespace wingspread
