#include "montecarlo/results/export/export_columns.hpp"

#include "montecarlo/foundation/formats/output_name.hpp"
#include "montecarlo/model/campaign/describe.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <set>
#include <string_view>

namespace wingspread {
namespace {

using Kind = ExportColumn::Kind;

struct Description {
  std::string_view quantity;
  const char* text; ///< {0}: the hinge, {1}: the other one
};

constexpr std::array descriptions{
    Description{"latch_time", "when {0} reaches its latched angle for the first time; of a latch "
                              "that may miss or let go, when it engaged for good"},
    Description{"latch_rate", "the relative rate of {0} when it latches, signed"},
    Description{"peak_moment", "the largest magnitude of the moment about {0}"},
    Description{"peak_force", "the largest magnitude of the force across {0}"},
    Description{"overtravel", "how far {0} turned beyond its stowed angle"},
    Description{"hold_moment", "the largest magnitude of the moment that the hold of {0} bore"},
    Description{"captures", "how many times the latch of {0} engaged"},
    Description{"held", "1 if the latch of {0} holds at the end of the run, else 0"},
    Description{"final_angle", "the angle of {0} at t_end, from its latched angle"},
    Description{"motor_energy", "the work of the motor of {0} until its latch engaged"},
    Description{"rate_at", "the relative rate of {0} when {1} latches, signed"},
    Description{"peak_angle", "the largest change of the base's angle from the start"},
    Description{"peak_rate", "the largest change of the base's rate from the start"},
    Description{"deployment_time", "when the last of the hinges latched"}};

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
  for (const Description& each : descriptions)
    if (parsed.quantity == each.quantity)
      return fmt::format(fmt::runtime(each.text), parsed.hinge, parsed.other);
  return "";
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
