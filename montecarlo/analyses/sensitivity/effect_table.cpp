#include "montecarlo/analyses/sensitivity/effect_table.hpp"

#include "montecarlo/engine/runs/finality.hpp"
#include "montecarlo/foundation/formats/output_name.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace wingspread {
namespace {

/// Indices of the dispersions, the largest size first, NaN last.
std::vector<std::size_t> by_size(std::size_t count,
                                 const std::function<double(std::size_t)>& size) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t j) {
    const double value = size(j);
    return std::isnan(value) ? -1.0 : value;
  });
  return order;
}

} // namespace

Json value_json(double value, const Bounds& bounds) {
  return {{"value", json_number(value)},
          {"lower", json_number(bounds.lower)},
          {"upper", json_number(bounds.upper)}};
}

std::string value_text(double value, const Bounds& bounds) {
  if (std::isnan(value)) return fmt::format("{:>9}{:>21}", "–", "–");
  const std::string range =
      bounds.lower ? fmt::format("{:.3f} … {:.3f}", *bounds.lower, *bounds.upper) : "–";
  return fmt::format("{:>9.3f}{:>21}", value, range);
}

std::string column_names(std::string_view first, std::string_view second, double confidence) {
  const std::string bounds = fmt::format("{:g} % bounds", 100 * confidence);
  return fmt::format("  {:<{}}{:>9}{:>21}{:>9}{:>21}", "dispersion", name_width, first, bounds,
                     second, bounds);
}

std::string heading_of(const std::string& output, long count, std::string_view counted,
                       long missing, std::string_view what_of_them) {
  const std::string unit = parse_output_name(output).unit;
  std::string text =
      fmt::format("{}{}{} · {} {}", output, unit.empty() ? "" : ", ", unit, count, counted);
  if (missing > 0) text += fmt::format(" · {} {}", missing, what_of_them);
  return text;
}

std::string cut_heading(long cut) { return cut > 0 ? fmt::format(" · {} cut by t_end", cut) : ""; }

std::string effect_block(const std::string& heading, const std::string& columns, std::size_t count,
                         const std::function<double(std::size_t)>& size,
                         const std::function<std::string(std::size_t)>& line) {
  std::string text = fmt::format("\n{}\n{}\n", heading, columns);
  const std::vector<std::size_t> order = by_size(count, size);
  for (const std::size_t each : order) text += line(each);
  return text;
}

void MovedBy::add(const std::string& output, const EffectsOnOutput& effects) {
  const auto& [dispersions, value, least, visible, text] = effects;
  const auto size = [&](std::size_t j) { return std::abs(value(j)); };
  const std::vector<std::size_t> order = by_size(dispersions.size(), size);
  std::vector<std::string> parts;
  long others = 0;
  double largest = 0; // of the others
  for (const std::size_t j : order) {
    if (std::isnan(size(j))) break;
    if (size(j) >= std::max(least, least_beside_largest * size(order.front())) &&
        parts.size() < most_shown_effects)
      parts.push_back(dispersions[j] + ' ' + text(value(j)));
    else if (visible(j))
      ++others, largest = std::max(largest, size(j));
  }
  if (others > 0)
    parts.push_back(fmt::format("{}{} with visible effect, at most {}", parts.empty() ? "" : "and ",
                                parts.empty() ? counted(others, "dispersion", "dispersions")
                                              : counted(others, "other", "others"),
                                text(largest)));
  if (parts.empty())
    unmoved_.push_back(output);
  else
    lines_ += in_column("  " + output, name_width + 2) +
              wrapped(fmt::format("{}", fmt::join(parts, ", ")), name_width + 2) + '\n';
}

std::string MovedBy::table(std::string_view heading, std::string_view limits) const {
  std::string text = in_column("OUTPUT", name_width + 2) + std::string(heading) + '\n' + lines_;
  if (!unmoved_.empty())
    text +=
        "  " +
        wrapped(fmt::format("no visible effect on {}{}", fmt::join(unmoved_, ", "), limits), 2) +
        '\n';
  if (!unknown_.empty())
    text +=
        "  " +
        wrapped(fmt::format("not known, as some rows lack it: {}", fmt::join(unknown_, ", ")), 2) +
        '\n';
  return text;
}

std::string quoted(const std::vector<std::string>& names) {
  return fmt::format("\"{}\"", fmt::join(names, "\", \""));
}

void warn_of_t_end(const std::vector<CutOutput>& outputs, long open_latches, long runs,
                   std::string_view never_final, std::vector<std::string>& warnings) {
  std::vector<std::string> names;
  long least = runs, most = 0;
  for (const auto& [name, cut] : outputs) {
    if (cut == 0) continue;
    names.push_back(name);
    least = std::min(least, cut), most = std::max(most, cut);
  }
  if (!names.empty())
    warnings.push_back(fmt::format(
        "in {}{} of {} runs t_end cut the peaks of {}: the effects are those on the values cut at "
        "t_end, not on the peaks. Sign and order may differ. {}",
        least < most ? fmt::format("{} to ", least) : "", most, runs, quoted(names),
        advice_on_t_end(never_final)));
  if (open_latches > 0) warnings.push_back(warn_of_open_latches(open_latches, runs, never_final));
}

} // namespace wingspread
