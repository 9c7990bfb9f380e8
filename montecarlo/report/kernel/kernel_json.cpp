#include "montecarlo/report/kernel/kernel_json.hpp"

#include "core/scene/segments.hpp"
#include "montecarlo/report/kernel/campaign_numbers.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <utility>

namespace wingspread {
namespace {

constexpr std::size_t most_numbers = 40'000; // of one set: some 400 kB

/// Lists the numbers of what it visits.
class NumberWriter {
public:
  static constexpr bool reads = false;

  void number(double& value) {
    place_.emplace(&value, static_cast<int>(place_.size()));
    add(value);
  }
  void integer(int& value) { add(value); }
  void list(std::vector<double>& values) {
    add(static_cast<double>(values.size()));
    for (const double value : values) add(value);
  }
  void text(std::string& text) {
    add(static_cast<double>(text.size()));
    for (const char byte : text) add(static_cast<unsigned char>(byte));
  }
  /// The place of a number of the scene. @pre it was visited
  [[nodiscard]] int place_of(const double& number) const { return place_.at(&number); }
  [[nodiscard]] const Json& json() const { return json_; }

private:
  void add(double value) {
    if (std::isinf(value))
      json_.push_back(value > 0 ? "Infinity" : "-Infinity");
    else
      json_.push_back(value);
  }

  std::map<const double*, int> place_;
  Json json_ = Json::array();
};

void add_effects(const Dispersion& dispersion, Scene& scene, const NumberWriter& writing,
                 NumberedDispersion& numbered) {
  for_each_effect(dispersion, [&](Apply how, const auto& targets, const Curve* table) {
    for (const SceneParameter& target : targets) {
      NumberedEffect effect{static_cast<int>(how), writing.place_of(target.in(scene)), {}, {}};
      if (table)
        for (const double knot : table->knots()) {
          effect.at.push_back(knot);
          effect.value.push_back(table->value_at(knot));
        }
      numbered.effects.push_back(std::move(effect));
    }
  });
}

/// The places that the sliders change, by hinge; null where the hinge has no such part.
Json sliders_of(Scene& scene, const NumberWriter& writing) {
  Json json = Json::array();
  for (Hinge& hinge : scene.hinges) {
    json.push_back({{"spring", writing.place_of(hinge.spring.scale)},
                    {"friction", writing.place_of(hinge.friction.scale)},
                    {"damper", nullptr},
                    {"latch", nullptr}});
    if (hinge.damper) json.back()["damper"] = writing.place_of(hinge.damper->scale);
    if (hinge.latch) json.back()["latch"] = writing.place_of(hinge.latch->stiffness);
  }
  return json;
}

} // namespace

Json kernel_json(const Campaign& campaign) {
  if (has_flexible_bodies(campaign.scene)) return nullptr;
  const auto of_rows = [](const Dispersion& dispersion) { return !dispersion.rows.empty(); };
  if (std::ranges::any_of(campaign.dispersions, of_rows)) return nullptr;
  NumberedCampaign numbered{campaign.scene,
                            {},
                            campaign.wanted_correlations,
                            design_of(campaign.sampling),
                            campaign.integration,
                            goal_of(campaign.outputs)};
  NumberWriter writing;
  CampaignNumbers<NumberWriter> visit(writing);
  visit.scene(numbered.scene);
  Json draws = Json::array();
  for (const Dispersion& dispersion : campaign.dispersions) {
    numbered.dispersions.push_back({dispersion.name, dispersion.distribution, {}});
    add_effects(dispersion, numbered.scene, writing, numbered.dispersions.back());
    draws.push_back(dispersion.name);
  }
  Json sliders = sliders_of(numbered.scene, writing);
  visit.rest(numbered);
  if (writing.json().size() > most_numbers) return nullptr;
  return {{"numbers", writing.json()}, {"draws", std::move(draws)}, {"hinges", std::move(sliders)}};
}

} // namespace wingspread
