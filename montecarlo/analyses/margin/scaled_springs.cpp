#include "montecarlo/analyses/margin/scaled_springs.hpp"

#include "montecarlo/model/campaign/distribution_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace wingspread {
namespace {

std::string free_name(const Campaign& campaign) {
  const auto is_taken = [&](const std::string& name) {
    return std::ranges::find(campaign.dispersions, name, &Dispersion::name) !=
           campaign.dispersions.end();
  };
  std::string name = "margin_scale";
  for (int number = 2; is_taken(name); ++number) name = fmt::format("margin_scale_{}", number);
  return name;
}

} // namespace

Campaign scaled(const Campaign& campaign, const std::vector<SceneParameter>& parameters,
                double scale) {
  Campaign sized = campaign;
  Dispersion& factor = sized.dispersions.emplace_back();
  factor.name = free_name(campaign);
  factor.distribution.law = Constant{scale};
  factor.apply = Apply::scale;
  factor.targets = parameters;
  sized.resolved["dispersions"].push_back(
      {{"name", factor.name},
       {"distribution", write_distribution(factor.distribution)},
       {"apply", apply_names[static_cast<std::size_t>(factor.apply)]},
       {"to", paths_of(campaign.scene, parameters)}});
  return sized;
}

} // namespace wingspread
