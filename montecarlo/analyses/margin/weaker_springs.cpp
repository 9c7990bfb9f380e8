#include "montecarlo/analyses/margin/weaker_springs.hpp"

#include "montecarlo/analyses/margin/scaled_springs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace wingspread {
namespace {

constexpr std::array advised_by{MarginKind::ecss, MarginKind::nasa, MarginKind::gevs,
                                MarginKind::aiaa};

/// Adds the static margins that the scale lowers in one case.
void add_lowered(const Campaign& campaign, const std::vector<SceneParameter>& parameters,
                 double scale, std::vector<Shortfall>& all) {
  const Scene nominal = nominal_scene(campaign),
              weaker = nominal_scene(scaled(campaign, parameters, scale));
  const std::string of_case = campaign.of_case.empty() ? "" : " (" + campaign.of_case + ")";
  for (const HingeDrive& drive : drives_of(nominal)) {
    const Margins present = least_margins(nominal, drive, campaign.motorization);
    const Margins then = least_margins(weaker, drive, campaign.motorization);
    for (const MarginKind kind : advised_by) {
      const auto k = static_cast<std::size_t>(kind);
      if (then[k] < present[k])
        all.push_back({scale, name_of(drive, nominal) + of_case, kind, then[k], present[k]});
    }
  }
}

} // namespace

std::vector<Shortfall> lowered_margins(std::span<const Campaign> campaigns,
                                       const std::vector<SceneParameter>& parameters,
                                       double scale) {
  std::vector<Shortfall> all;
  for (const Campaign& campaign : campaigns) add_lowered(campaign, parameters, scale, all);
  return all;
}

std::optional<Shortfall> shortfall_at(std::span<const Campaign> campaigns,
                                      const std::vector<SceneParameter>& parameters, double scale) {
  if (scale >= 1) return std::nullopt;
  const auto all = lowered_margins(campaigns, parameters, scale);
  const auto lowest = std::ranges::min_element(all, {}, &Shortfall::margin);
  return lowest == all.end() || lowest->margin >= 0 ? std::nullopt : std::optional(*lowest);
}

std::string to_string(const Shortfall& shortfall) {
  return fmt::format("{} margin of {} {:+.2f}, now {:+.2f}",
                     margin_kind_texts[static_cast<std::size_t>(shortfall.kind)], shortfall.drive,
                     shortfall.margin, shortfall.present);
}

} // namespace wingspread
