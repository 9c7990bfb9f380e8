#include "montecarlo/results/export/export_columns.hpp"

#include "montecarlo/foundation/formats/output_name.hpp"
#include "montecarlo/model/campaign/describe.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>
#include <string_view>

namespace wingspread {
namespace {

using Kind = ExportColumn::Kind;

std::string describe_draw(const Campaign& campaign, const Dispersion& dispersion) {
  constexpr std::size_t most_paths = 20;
  std::vector<std::string> effects;
  for_each_effect(dispersion, [&](Apply how, const auto& targets, const Curve* table) {
    std::vector<std::string> paths = paths_of(campaign.scene, targets);
    const std::size_t more = paths.size() > most_paths ? paths.size() - most_paths : 0;
    paths.resize(paths.size() - more);
    effects.push_back(fmt::format("{}{} {}{}", apply_names[static_cast<std::size_t>(how)],
                                  table ? " by a table" : "", fmt::join(paths, ", "),
                                  more > 0 ? fmt::format(" and {} more", more) : ""));
  });
  return fmt::format("drawn: {}; {}", describe(dispersion.distribution), fmt::join(effects, "; "));
}

} // namespace

std::string describe_output(const std::string& name) {
  const OutputName parsed = parse_output_name(name);
  return parsed.kind ? meaning_of(*parsed.kind, parsed.hinge, parsed.other) : "";
}

std::string draw_unit(const Dispersion& dispersion) {
  std::set<std::string_view> units;
  for_each_effect(dispersion, [&](Apply how, const auto& targets, const Curve* table) {
    for (const SceneParameter& target : targets)
      units.insert(how == Apply::scale || table ? "" : unit_of(target));
  });
  return units.size() == 1 ? std::string(*units.begin()) : "";
}

std::vector<ExportColumn> export_columns(const Campaign& campaign, const ResultNames& names) {
  std::vector<ExportColumn> columns{
      {Kind::run, 0, "run", "", "the run's number, from 0: what replay --run takes"},
      {Kind::status, 0, "status", "", "deployed, stalled, timed_out, invalid or failed"}};
  for (std::size_t i = 0; i < names.draws.size(); ++i) {
    const Dispersion& dispersion = campaign.dispersions[i];
    columns.push_back({Kind::draw, i, names.draws[i], draw_unit(dispersion),
                       describe_draw(campaign, dispersion)});
  }
  for (std::size_t i = 0; i < names.outputs.size(); ++i)
    columns.push_back({Kind::output, i, names.outputs[i], parse_output_name(names.outputs[i]).unit,
                       describe_output(names.outputs[i])});
  if (names.peaks_final)
    columns.push_back({Kind::peaks_final, 0, std::string(peaks_final_column), "",
                       "1: the peaks are proven, 0: t_end cut them, 2 and 3: proven of the moments "
                       "alone, of the forces alone, -1: not known"});
  columns.push_back({Kind::latch_order, 0, "latch_order", "",
                     "the hinges that latched, in order of time; empty: none"});
  columns.push_back(
      {Kind::reason, 0, "reason", "",
       "why the run is not deployed, or that its latches may let go after t_end; else empty"});
  return columns;
}

} // namespace wingspread
