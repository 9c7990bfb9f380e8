#include "montecarlo/model/input_checks/torque_notices.hpp"

#include "core/scene/torque.hpp"
#include "montecarlo/model/static_margins/drive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace wingspread {
namespace {

constexpr double negligible = 1e-9; // of the largest torque there is: rounding

double angle_at(const Hinge& hinge, double share) {
  return std::lerp(hinge.stowed, hinge.latched, share);
}

/// The least of some values, where it is, and the largest magnitude among them.
struct Least {
  double value = 0, at = 0, largest = 0;
  void take(double next, double x) {
    largest = std::max(largest, std::abs(next));
    if (next < value) value = next, at = x;
  }
};

bool is_negative(const Least& least) { return least.value < -negligible * least.largest; }

/// @return whether its spring pushes the right way all along
bool notice_spring(const std::string& at, const Hinge& hinge, Notices& notices) {
  Least least;
  for (const double x : places_of_least(hinge)) least.take(torque_at(hinge.spring, hinge, x), x);
  if (!is_negative(least)) return true;
  notices.add(at + "/spring",
              fmt::format("{:.4g} N·m at {:.4g} rad: it pushes away from the latch", least.value,
                          angle_at(hinge, least.at)),
              "a torque > 0: positive deploys, whichever way the hinge turns");
  return false;
}

void notice_latch(const std::string& at, const Hinge& hinge, Notices& notices) {
  if (!hinge.latch)
    notices.add(at + "/latch", "no latch",
                "one: a hinge without it never counts as deployed, and nothing holds it");
  else if (hinge.latch->stiffness == 0)
    notices.add(at + "/latch/stiffness", "0 N·m/rad",
                "> 0: nothing holds the hinge when it is latched");
}

/// Spring less what resists at rest, of all that turns as one, for a turn of the first.
double net_torque(const Scene& scene, const HingeDrive& drive, double x,
                  const MotorizationSpec& spec) {
  const MotorizationTerms terms = terms_at(scene, drive, x, spec);
  return terms.available - terms.spring - terms.friction - terms.harness;
}

void notice_net(const Scene& scene, const HingeDrive& drive, Notices& notices) {
  const MotorizationSpec spec = default_motorization(scene);
  Least least;
  for (const double x : places_of_least(scene, drive))
    least.take(net_torque(scene, drive, x, spec), x);
  if (!is_negative(least)) return;
  const int leading = drive.hinges.front();
  notices.add(fmt::format("/hinges/{}/spring", leading),
              fmt::format("a net static torque of {} of {:.4g} N·m at {:.4g} rad: spring less "
                          "harness less friction at rest",
                          name_of(drive, scene), least.value,
                          angle_at(scene.hinges[leading], least.at)),
              "≥ 0 on the whole travel: a wing that stops there does not start again");
}

} // namespace

void notice_torques(const Scene& scene, Notices& notices) {
  std::vector<bool> pushes;
  for (std::size_t h = 0; h < scene.hinges.size(); ++h) {
    const std::string at = fmt::format("/hinges/{}", h);
    pushes.push_back(notice_spring(at, scene.hinges[h], notices));
    notice_latch(at, scene.hinges[h], notices);
  }
  for (const HingeDrive& drive : drives_of(scene))
    if (std::ranges::all_of(drive.hinges, [&](int h) { return pushes[h]; }))
      notice_net(scene, drive, notices);
}

} // namespace wingspread
