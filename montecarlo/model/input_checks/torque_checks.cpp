#include "montecarlo/model/input_checks/torque_checks.hpp"

#include "core/scene/torque.hpp"
#include "montecarlo/model/static_margins/drive.hpp"
#include "montecarlo/model/static_margins/least_quotient.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace wingspread {
namespace {

constexpr double negligible =
    1e-9; // of the largest torque; far above rounding, far below any real torque

double angle_at(const Hinge& hinge, double share) {
  return std::lerp(hinge.stowed, hinge.latched, share);
}

/// The least of some values (at most 0), its place, and the largest magnitude of all.
struct Least {
  double value = 0, at = 0, largest = 0;
  void add(double next, double x) {
    largest = std::max(largest, std::abs(next));
    if (next < value) value = next, at = x;
  }
};

bool is_negative(const Least& least) { return least.value < -negligible * least.largest; }

/// Whether the hinge's spring has a torque somewhere.
bool spring_acts(const Hinge& hinge) {
  return std::ranges::any_of(places_of_least(hinge),
                             [&](double x) { return torque_at(hinge.spring, hinge, x) != 0; });
}

/// Returns false if the spring pushes away from the latch somewhere.
bool check_spring(const std::string& at, const Hinge& hinge, InputWarnings& warnings) {
  Least least;
  for (const double x : places_of_least(hinge)) least.add(torque_at(hinge.spring, hinge, x), x);
  if (!is_negative(least)) return true;
  warnings.add(at + "/spring",
               fmt::format("{:.4g} N·m at {:.4g} rad, which pushes away from the latch",
                           least.value, angle_at(hinge, least.at)),
               "a torque > 0: positive deploys, in whichever sense the hinge turns");
  return false;
}

void check_latch(const std::string& at, const Hinge& hinge, InputWarnings& warnings) {
  if (!hinge.latch)
    warnings.add(at + "/latch", "no latch",
                 "a latch: `deployed` does not judge a hinge without one, wherever it stops, "
                 "and nothing holds it");
  else if (hinge.latch->stiffness == 0)
    warnings.add(at + "/latch/stiffness", "0 N·m/rad",
                 "> 0: a latch without stiffness does not hold the hinge");
}

/// Spring and motor less harness less friction at rest, referred to the drive's leading hinge, N·m.
double net_torque(const Scene& scene, const HingeDrive& drive, double x,
                  const StaticMarginSpec& spec) {
  const TorqueTerms terms = terms_at(scene, drive, x, spec);
  return terms.available - terms.spring - terms.friction - terms.harness;
}

void check_net(const Scene& scene, const HingeDrive& drive, InputWarnings& warnings) {
  const StaticMarginSpec spec = default_static_margins(scene);
  Least least;
  const auto add = [&](double x) { least.add(net_torque(scene, drive, x, spec), x); };
  const std::vector<double> places = places_of_least(scene, drive);
  std::ranges::for_each(places, add);
  for (std::size_t k = 1; k < places.size(); ++k) {
    std::array<double, cubic_samples.size()> inside;
    for (std::size_t s = 0; s < inside.size(); ++s)
      inside[s] =
          net_torque(scene, drive, std::lerp(places[k - 1], places[k], cubic_samples[s]), spec);
    add(std::lerp(places[k - 1], places[k], Cubic::through(inside).place_of_least()));
  }
  if (!is_negative(least)) return;
  const int leading = drive.hinges.front();
  const bool motor =
      std::ranges::any_of(drive.hinges, [&](int h) { return bool(scene.hinges[h].motor); });
  warnings.add(
      fmt::format("/hinges/{}{}", leading, spring_acts(scene.hinges[leading]) ? "/spring" : ""),
      fmt::format("a net static torque of {:.4g} N·m at {:.4g} rad of {}: spring{} less "
                  "harness less friction at rest",
                  least.value, angle_at(scene.hinges[leading], least.at), name_of(drive, scene),
                  motor ? " and motor" : ""),
      "≥ 0 on the whole travel: a wing that stops where it is < 0 does not start again");
}

/// Whether the hinge has a torque or a rate of its own.
bool is_driven(const Hinge& hinge) {
  return hinge.motor || hinge.initial_rate != 0 || spring_acts(hinge);
}

/// Whether the hinges' torques cancel at the start, and nothing else holds or moves them.
bool is_balanced(const Scene& scene, const HingeDrive& drive) {
  const auto moves = [&](int h) {
    const Hinge& hinge = scene.hinges[static_cast<std::size_t>(h)];
    return hinge.motor || hinge.initial_rate != 0 || hinge.friction.coulomb != 0;
  };
  if (std::ranges::any_of(drive.hinges, moves)) return false;
  const TorqueTerms terms = terms_at(scene, drive, 0, default_static_margins(scene));
  const double pull =
      std::max({std::abs(terms.available), std::abs(terms.spring), std::abs(terms.harness)});
  return terms.friction == 0 &&
         std::abs(terms.available - terms.spring - terms.harness) <= negligible * pull;
}

} // namespace

void check_torques(const Scene& scene, InputWarnings& warnings) {
  std::vector<bool> pushes;
  for (std::size_t h = 0; h < scene.hinges.size(); ++h) {
    const std::string at = fmt::format("/hinges/{}", h);
    if (scene.hinges[h].joint) { // has no travel
      pushes.push_back(false);
      continue;
    }
    pushes.push_back(check_spring(at, scene.hinges[h], warnings));
    check_latch(at, scene.hinges[h], warnings);
  }
  const bool still = scene.base.motion == BaseMotion::fixed && scene.environment.gravity.isZero();
  if (still && std::ranges::none_of(scene.hinges, is_driven))
    warnings.add("/hinges", "no spring with a torque, no motor and no initial rate",
                 "one of them: nothing moves the wing");
  const std::vector<HingeDrive> drives = drives_of(scene);
  const auto balanced = [&](const HingeDrive& drive) { return is_balanced(scene, drive); };
  if (scene.base.motion != BaseMotion::prescribed && scene.environment.gravity.isZero() &&
      std::ranges::any_of(scene.hinges, spring_acts) && std::ranges::all_of(drives, balanced))
    warnings.add(
        "/hinges",
        "torques that cancel at the stowed angle of every hinge: rounding decides whether the wing "
        "moves, which way and when",
        "a net torque, or friction that holds, at the stowed angle");
  for (const HingeDrive& drive : drives)
    if (std::ranges::all_of(drive.hinges, [&](int h) { return pushes[h]; }))
      check_net(scene, drive, warnings);
}

} // namespace wingspread
