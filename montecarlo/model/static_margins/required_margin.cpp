#include "montecarlo/model/static_margins/required_margin.hpp"

#include "montecarlo/foundation/formats/nearest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace wingspread {
namespace {

/// The words of the key `motorization`, by MarginKind.
constexpr std::array<std::string_view, 5> kind_words{"ECSS", "NASA", "NASA_one_spring_out", "GEVS",
                                                     "AIAA"};
constexpr std::string_view every_hinge = "*";
constexpr const char* expected_hinge = "a string, a hinge's name, or \"*\" for all";

bool has_hinge(const HingeDrive& drive, const Scene& scene, const std::string& name) {
  return std::ranges::any_of(drive.hinges,
                             [&](int hinge) { return scene.hinges[hinge].name == name; });
}

void refuse_unknown_hinge(const JsonObject& object, const Scene& scene,
                          const RequiredMargin& margin) {
  if (!required_drives(scene, margin).empty()) return;
  const bool needs_spring = margin.kind == MarginKind::nasa_one_spring_out;
  if (margin.hinge == every_hinge)
    return void(object.at()
                    .member("motorization")
                    .refuse(needs_spring
                                ? "a wing with a hinge that has a spring"
                                : "a wing with a hinge that has a spring, a motor or a latch"));
  std::vector<std::string> names;
  for (const HingeDrive& drive : required_drives(scene, {margin.kind, std::string(every_hinge)}))
    for (const int hinge : drive.hinges) names.push_back(scene.hinges[hinge].name);
  object.at().member("hinge").refuse(
      (needs_spring
           ? "the name of a hinge that a spring drives, its own or through loops, or \"*\" for all"
           : "the name of a hinge with a spring, a motor or a latch, or \"*\" for all") +
      did_you_mean(margin.hinge, names));
}

} // namespace

void read_required_margin(JsonObject& object, const Scene* scene, RequiredMargin& margin) {
  object.optional_choice("motorization", margin.kind, kind_words);
  const auto at = object.find("hinge");
  if (at && !at->read(margin.hinge, expected_hinge)) return;
  if (scene) refuse_unknown_hinge(object, *scene, margin);
}

std::string_view word_of(const RequiredMargin& margin) {
  return kind_words[static_cast<std::size_t>(margin.kind)];
}

std::string name_of(const RequiredMargin& margin) {
  return fmt::format("{} margin of {}", margin_kind_texts[static_cast<std::size_t>(margin.kind)],
                     margin.hinge == every_hinge ? "every hinge" : margin.hinge);
}

std::vector<HingeDrive> required_drives(const Scene& scene, const RequiredMargin& margin) {
  std::vector<HingeDrive> drives = drives_of(scene);
  std::erase_if(drives,
                [&](const HingeDrive& drive) { return !applies(margin.kind, scene, drive); });
  if (margin.hinge != every_hinge)
    std::erase_if(drives,
                  [&](const HingeDrive& drive) { return !has_hinge(drive, scene, margin.hinge); });
  return drives;
}

double least_margin(const Scene& scene, std::span<const HingeDrive> drives, MarginKind kind,
                    const StaticMarginSpec& spec) {
  if (!unphysical(scene).empty()) return std::numeric_limits<double>::quiet_NaN();
  double least = std::numeric_limits<double>::max();
  for (const HingeDrive& drive : drives)
    least = std::min(least, least_margins(scene, drive, spec)[static_cast<std::size_t>(kind)]);
  return least;
}

} // namespace wingspread
