#include "montecarlo/model/input_checks/life_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace wingspread {
namespace {

constexpr double instant = 1e-6;    // s: in this time nothing moves
constexpr double least_load = 1e-9; // N·m; heuristic: round-off of a wing without torques

/// "root waits for mid waits for root", of a hold that waits for itself; else empty, as where the next hinge may pass its
/// angle in an elastic hold.
std::string cycle_of(const Scene& scene, int hinge) {
  std::string names = scene.hinges[hinge].name;
  int at = hinge;
  for (std::size_t step = 0; step < scene.hinges.size(); ++step) {
    const std::optional<Release>& release = scene.hinges[at].release;
    if (!release || release->after < 0) return "";
    at = release->after;
    // an elastic hold lets its hinge turn a little
    if (release->event == Release::Event::passed && scene.hinges[at].hold) return "";
    names += " waits for " + scene.hinges[at].name;
    if (at == hinge) return names;
  }
  return "";
}

void check_release(const Scene& scene, int h, double t_end, InputWarnings& warnings) {
  const std::string at = fmt::format("/hinges/{}/release", h);
  const Release& release = *scene.hinges[h].release;
  if (release.fails != 0)
    warnings.add(at + "/fails", "1: the nominal wing is never released",
                 "0, and a dispersion that sets it to 1 in some runs");
  if (const std::string cycle = cycle_of(scene, h); !cycle.empty())
    warnings.add(at + "/after", "a hold that waits for itself: " + cycle,
                 "holds of which the first waits for a time, or for a hinge that is free");
  if (release.event == Release::Event::time && release.time + release.delay >= t_end)
    warnings.add(at + "/time",
                 fmt::format("{:.6g} s{}, not before t_end = {:.6g} s",
                             release.time + release.delay,
                             release.delay > 0 ? " with its delay" : "", t_end),
                 "a release within the run");
  const Hinge* other = release.after < 0 ? nullptr : &scene.hinges[release.after];
  if (release.event == Release::Event::passed && other &&
      release.angle > std::abs(other->latched - other->stowed))
    warnings.add(at + "/event/angle",
                 fmt::format("{:.4g} rad, more than the {:.4g} rad of travel that {} has",
                             release.angle, std::abs(other->latched - other->stowed), other->name),
                 "how far that hinge has turned from its stowed angle, up to its latched angle");
}

/// Load of each hold at the start if it were rigid, N·m by hinge; empty if the run fails.
std::vector<Peak> loads_at_start(Scene scene, Integration integration) {
  for (Hinge& hinge : scene.hinges) hinge.hold.reset();
  integration.t_end = instant;
  Goal goal;
  goal.peak_moment = goal.peak_force = false;
  return Deployment().run(scene, integration, goal).hold_moment;
}

/// Warns of elastic holds that start without the load that they bear at rest.
void check_holds(const Scene& scene, const Integration& integration, InputWarnings& warnings) {
  const auto is_elastic = [](const Hinge& hinge) { return hinge.release && hinge.hold; };
  if (std::ranges::none_of(scene.hinges, is_elastic)) return;
  const std::vector<Peak> loads = loads_at_start(scene, integration);
  for (std::size_t h = 0; h < loads.size(); ++h)
    if (is_elastic(scene.hinges[h]) && loads[h].value > least_load)
      warnings.add(
          fmt::format("/hinges/{}/hold", h),
          fmt::format("a hold that starts unstrained under {:.4g} N·m: it rings, and at the start "
                      "{}.hold_moment is up to twice that, {:.4g} N·m (less with damping); a latch "
                      "or another hinge may load it more later",
                      loads[h].value, scene.hinges[h].name, 2 * loads[h].value),
          "a rigid hold for the load at rest, or a `damping` that ends the ring before the "
          "release");
}

bool holds_at_the_end(const Outcome& nominal, int hinge) {
  const auto is_in = [hinge](const std::vector<int>& hinges) {
    return std::ranges::find(hinges, hinge) != hinges.end();
  };
  return is_in(nominal.never_released) || is_in(nominal.may_release_later);
}

/// Warns of a hinge that reaches its latch while an elastic hold still holds it. A hold that is due at the start holds
/// nothing and is no release.
void check_hold_lasts(int h, const Outcome& nominal, InputWarnings& warnings) {
  const auto latched = std::ranges::find(nominal.latches, h, &LatchEvent::hinge);
  const auto released = std::ranges::find(nominal.releases, h, &HingeEvent::hinge);
  if (latched == nominal.latches.end()) return;
  if (!holds_at_the_end(nominal, h) &&
      (released == nominal.releases.end() || released->time <= latched->time))
    return;
  warnings.add(
      fmt::format("/hinges/{}/hold/stiffness", h),
      fmt::format("a hinge that latches at {:.4g} s, before its hold lets go", latched->time),
      "a hold that keeps the hinge near its stowed angle");
}

/// "t waits for r, which loop L ties to t": how a hold waits for the latch of a hinge that cannot move before some hold,
/// of the same hinge in the end, lets go; else empty. A hinge that an elastic hold or none holds may move.
/// @param tied whether a loop is among the causes already
std::string tied_wait(const Scene& scene, int hinge, int from, bool tied, std::vector<char>& seen) {
  const std::optional<Release>& release = scene.hinges[from].release;
  if (!release || release->after < 0 || seen[from]) return "";
  seen[from] = 1;
  const int awaited = release->after;
  const std::string wait = scene.hinges[from].name + " waits for " + scene.hinges[awaited].name;
  if (tied && awaited == hinge) return wait;
  if (scene.hinges[awaited].release)
    if (const std::string rest = tied_wait(scene, hinge, awaited, tied, seen); !rest.empty())
      return wait + ", " + rest;
  if (release->event != Release::Event::latched) return "";
  for (const Synchronisation& loop : scene.synchronisations) {
    if (loop.first != awaited && loop.second != awaited) continue;
    const int partner = loop.first == awaited ? loop.second : loop.first;
    const Hinge& other = scene.hinges[partner];
    if (!other.release || other.hold) continue;
    const std::string ties = wait + ", which " + loop.name + " ties to " + other.name;
    if (partner == hinge) return ties;
    if (const std::string rest = tied_wait(scene, hinge, partner, true, seen); !rest.empty())
      return ties + ", " + rest;
  }
  return "";
}

/// Warns of a hold that, in the nominal run, a loop keeps from letting go. A soft loop may let the awaited hinge latch.
void check_tied(const Scene& scene, int h, const Outcome& nominal, InputWarnings& warnings) {
  std::vector<char> seen(scene.hinges.size(), 0);
  if (!holds_at_the_end(nominal, h)) return;
  if (const std::string wait = tied_wait(scene, h, h, false, seen); !wait.empty())
    warnings.add(fmt::format("/hinges/{}/release/after", h),
                 "a hold that waits through a loop for itself: " + wait,
                 "holds of hinges that a loop ties together let go together");
}

void check_capture(const Scene& scene, int h, const Outcome& nominal, InputWarnings& warnings) {
  const std::string at = fmt::format("/hinges/{}/latch", h);
  const Hinge& hinge = scene.hinges[h];
  const auto first_of = [&](const std::vector<HingeEvent>& events) {
    const auto found = std::ranges::find(events, h, &HingeEvent::hinge);
    return found == events.end() ? nullptr : &*found;
  };
  if (const HingeEvent* missed = first_of(nominal.missed))
    warnings.add(at + "/capture_rate",
                 fmt::format("{:.4g} rad/s; the nominal wing passes its latched angle at {:.4g} "
                             "rad/s ({:.4g} s)",
                             *hinge.latch->capture_rate, std::abs(missed->rate), missed->time),
                 "above the nominal rate at the latch");
  if (const HingeEvent* opened = first_of(nominal.let_go))
    warnings.add(at + "/holding_moment",
                 fmt::format("{:.4g} N·m; the latch of the nominal wing lets go at {:.4g} s",
                             *hinge.latch->holding_moment, opened->time),
                 "above the load of the nominal deployment");
  if (hinge.latch->capture_rate && !hinge.far_stop)
    warnings.add(fmt::format("/hinges/{}/stop", h),
                 "no stop at the latched side of a hinge that may miss its latch",
                 "{ \"side\": \"latched\", … }: else nothing turns the hinge back");
}

} // namespace

void check_life(const Scene& scene, const Integration& integration, const Outcome& nominal,
                InputWarnings& warnings) {
  check_holds(scene, integration, warnings);
  for (int h = 0; h < std::ssize(scene.hinges); ++h) {
    if (scene.hinges[h].release) check_release(scene, h, integration.t_end, warnings);
    if (scene.hinges[h].release) check_tied(scene, h, nominal, warnings);
    if (scene.hinges[h].release && scene.hinges[h].hold) check_hold_lasts(h, nominal, warnings);
    if (scene.hinges[h].latch && scene.hinges[h].latch->can_miss())
      check_capture(scene, h, nominal, warnings);
  }
}

} // namespace wingspread
