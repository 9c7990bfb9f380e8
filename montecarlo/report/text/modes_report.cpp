#include "montecarlo/report/text/modes_report.hpp"

#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/report/data/wing_json.hpp"

#include <fmt/format.h>

#include <vector>

namespace wingspread {
namespace {

/// The hinges that the scene's author named: those of the segmented scene up to the joints.
std::size_t named_hinges(const WingModes& modes) { return modes.wing.joints.size(); }

/// An angle of a shape to three decimals, without a "-0.000".
std::string three_decimals(double angle) {
  const std::string text = fmt::format("{:.3f}", angle);
  return text == "-0.000" ? "0.000" : text;
}

std::string shape_text(const WingModes& modes, const NaturalMode& mode) {
  const Scene& scene = modes.wing.scene;
  std::string text;
  for (std::size_t h = 0; h < named_hinges(modes); ++h)
    text += fmt::format("{}{}={}", text.empty() ? "" : ", ", scene.hinges[h].name,
                        three_decimals(mode.shape[h]));
  if (scene.base.motion == BaseMotion::free) text += ", base=" + three_decimals(mode.base_angle);
  return text;
}

Json angles_by_hinge(const Scene& scene, const std::vector<double>& values) {
  Json json = Json::object();
  for (std::size_t h = 0; h < values.size(); ++h)
    json[scene.hinges[h].name] = json_number(values[h]);
  return json;
}

} // namespace

std::string modes_text(const WingModes& modes) {
  std::string text = "mode  frequency, Hz  damping ratio  shape: angles of the hinges\n";
  constexpr std::size_t indent = 36;
  for (std::size_t k = 0; k < modes.modes.size(); ++k) {
    const NaturalMode& mode = modes.modes[k];
    const std::string numbers =
        fmt::format("{:>4}{}{}  ", k + 1, right_aligned(in_digits(mode.frequency), 15),
                    right_aligned(in_digits(mode.damping_ratio), 15));
    text += numbers + wrapped(shape_text(modes, mode), indent) + "\n";
  }
  for (const std::string& each : modes_notes(modes)) text += "note: " + wrapped(each, 6) + "\n";
  return text;
}

Json modes_json(const WingModes& modes) {
  const Scene& scene = modes.wing.scene;
  Json list = Json::array();
  for (const NaturalMode& mode : modes.modes) {
    Json shape = angles_by_hinge(scene, mode.shape);
    if (scene.base.motion == BaseMotion::free) shape["base"] = json_number(mode.base_angle);
    list.push_back({{"frequency", json_number(mode.frequency)},
                    {"damping_ratio", json_number(mode.damping_ratio)},
                    {"shape", std::move(shape)}});
  }
  return {{"modes", std::move(list)},
          {"rest", angles_by_hinge(scene, modes.rest)},
          {"notes", modes_notes(modes)}};
}

} // namespace wingspread
