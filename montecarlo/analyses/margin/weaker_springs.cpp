#include "montecarlo/analyses/margin/weaker_springs.hpp"

#include "montecarlo/analyses/margin/scaled_springs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace wingspread {
namespace {

constexpr std::array advised_by{MarginKind::ecss, MarginKind::nasa, MarginKind::gevs,
                                MarginKind::aiaa};

/// Adds the static margins at the scale in one case.
void add_margins(const Campaign& campaign, const std::vector<SceneParameter>& parameters,
                 double scale, std::vector<Shortfall>& all) {
  const Scene nominal = nominal_scene(campaign),
              weaker = nominal_scene(scaled(campaign, parameters, scale));
  const std::string of_case = campaign.of_case.empty() ? "" : " (" + campaign.of_case + ")";
  for (const HingeDrive& drive : drives_of(nominal)) {
    const Margins present = least_margins(nominal, drive, campaign.motorization);
    const Margins then = least_margins(weaker, drive, campaign.motorization);
    for (const MarginKind kind : advised_by) {
      const auto k = static_cast<std::size_t>(kind);
      all.push_back({scale, name_of(drive, nominal) + of_case, kind, then[k], present[k]});
    }
  }
}

std::vector<Shortfall> margins_at(std::span<const Campaign> campaigns,
                                  const std::vector<SceneParameter>& parameters, double scale) {
  std::vector<Shortfall> all;
  for (const Campaign& campaign : campaigns) add_margins(campaign, parameters, scale, all);
  return all;
}

} // namespace

std::vector<Shortfall> lowered_margins(std::span<const Campaign> campaigns,
                                       const std::vector<SceneParameter>& parameters,
                                       double scale) {
  std::vector<Shortfall> all = margins_at(campaigns, parameters, scale);
  std::erase_if(all, [](const Shortfall& each) { return !(each.margin < each.present); });
  return all;
}

std::optional<Shortfall> shortfall_at(std::span<const Campaign> campaigns,
                                      const std::vector<SceneParameter>& parameters, double scale) {
  if (scale >= 1) return std::nullopt;
  const auto all = lowered_margins(campaigns, parameters, scale);
  const auto lowest = std::ranges::min_element(all, {}, &Shortfall::margin);
  return lowest == all.end() || lowest->margin >= 0 ? std::nullopt : std::optional(*lowest);
}

std::vector<Shortfall> short_margins(std::span<const Campaign> campaigns,
                                     const std::vector<SceneParameter>& parameters, double scale) {
  const std::vector<Shortfall> all = margins_at(campaigns, parameters, scale);
  std::vector<Shortfall> lowest;
  for (const MarginKind kind : advised_by) {
    const Shortfall* least = nullptr;
    for (const Shortfall& each : all)
      if (each.kind == kind && each.margin < 0 && !(least && least->margin <= each.margin))
        least = &each;
    if (least) lowest.push_back(*least);
  }
  return lowest;
}

std::string to_string(const Shortfall& shortfall) {
  return fmt::format("{} margin of {} {:+.2f}, now {:+.2f}",
                     margin_kind_texts[static_cast<std::size_t>(shortfall.kind)], shortfall.drive,
                     shortfall.margin, shortfall.present);
}

} // namespace wingspread
