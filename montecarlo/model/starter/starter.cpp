#include "montecarlo/model/starter/starter.hpp"

#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/model/starter/starter_campaign.hpp"
#include "montecarlo/model/starter/starter_scene.hpp"

#include <fmt/format.h>

namespace wingspread {
namespace {

constexpr std::string_view page_text = R"(# {name}: {wing}

`{scene}` is the wing, `{campaign}` says what varies, how often, and what has to be shown. Both were made by

    {command}

JSON has no comments, so this page explains each line. Every number is a starting value: replace it by your own. A
number may have a unit: `"1.8 m"`, `"90 deg"`, `"12 in*lbf"`; without one it is in SI units and radians.

    wingspread check {campaign} --draw wing.svg      # the wing in a picture, warnings, static margins
    wingspread simulate {campaign}                   # one deployment
    wingspread run {campaign} --out results --table  # the campaign: all cases, verdicts
    wingspread report results                           # one HTML page for a review

## {scene}: the wing

All hinges' axes are parallel, and the wing is seen along them: x points away from the spacecraft, y along its wall.

{scene_notes}
Other bodies, hinges and loops say the same for themselves.

## {campaign}: what varies, and what is required

Paths name parameters of the scene; `*` matches every name. `"apply": "scale"` multiplies the scene's value.

{campaign_notes}
## What to replace first

1. Spring torques by the torque test, both ways: `"spring": {{ "measured": {{ "angle": […], "deploying": […], "stowing": […] }} }}`.
2. Harness torques measured cold, and the temperatures of the cases.
3. Latch stiffness by the joint's test, masses and inertias by the mass budget.
4. Limits of the requirements by those of the project: {limits}

`wingspread schema scene` and `wingspread schema campaign` list every key for an editor.
)";

std::string described(const WingDesign& design) {
  return counted(design.wings, "wing", "wings") + (design.yoke ? " with a yoke and " : " of ") +
         counted(design.panels, "panel", "panels") + (design.wings == 2 ? " each" : "");
}

} // namespace

Starter make_starter(WingDesign design, const std::string& command) {
  check_design(design);
  if (!design.damper) {
    design.damper = suggested_damper(design);
    design.damper_suggested = true;
  }
  const auto limits = starter_limits(design);
  StarterLimits used;
  if (limits)
    used = *limits;
  else
    used = {60, 60, std::vector<double>(static_cast<std::size_t>(design.wings), 1), true};
  const AnnotatedLines scene = starter_scene(design);
  const AnnotatedLines campaign = starter_campaign(design, starter_scene_file, used);
  Starter starter{json_file_text(scene), json_file_text(campaign), "", limits.has_value()};
  starter.page = fmt::format(
      page_text, fmt::arg("name", design.name), fmt::arg("wing", described(design)),
      fmt::arg("scene", starter_scene_file), fmt::arg("campaign", starter_campaign_file),
      fmt::arg("command", command),
      fmt::arg("limits", limits ? "these are twice the nominal time and three times the\n"
                                  "   nominal moments."
                                : "these are placeholders, as the nominal wing does not\n"
                                  "   deploy in every case."),
      fmt::arg("scene_notes", notes_table(scene)),
      fmt::arg("campaign_notes", notes_table(campaign)));
  return starter;
}

} // namespace wingspread
