#include "montecarlo/model/static_margins/drive.hpp"

#include "core/scene/curve.hpp"
#include "montecarlo/model/static_margins/least_quotient.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace wingspread {
namespace {

/// The state of one hinge of a drive.
struct HingeState {
  double travel; ///< y_k, rad
  double gear;   ///< G_k
};

double whole_travel(const Hinge& hinge) { return std::abs(hinge.latched - hinge.stowed); }

/// y as a share of the hinge's own travel; 0 for a hinge without travel.
double share_of(const Hinge& hinge, double travel) {
  const double whole = whole_travel(hinge);
  return whole > 0 ? travel / whole : 0;
}

/// g(y).
double transmitted(const Synchronisation& loop, double travel) {
  return loop.table ? loop.table->value_at(travel) : loop.ratio * travel;
}

double slope_of(const Synchronisation& loop, double travel) {
  return loop.table ? loop.table->slope_at(travel) : loop.ratio;
}

/// y of the first hinge with g(y) = y of the second, by bisection.
double inverse_transmitted(const Synchronisation& loop, double travel_of_second, double whole) {
  if (!loop.table) return travel_of_second / loop.ratio;
  double from = 0, to = whole;
  const bool rises = transmitted(loop, to) > transmitted(loop, from);
  for (double middle = std::midpoint(from, to); from < middle && middle < to;
       middle = std::midpoint(from, to))
    ((transmitted(loop, middle) < travel_of_second) == rises ? from : to) = middle;
  return to;
}

/// The state of a hinge, from its neighbour's.
HingeState follow(const Scene& scene, const HingeDrive& drive, std::size_t member,
                  const HingeState& from) {
  const HingeDrive::Link& link = drive.links[member - 1];
  const Synchronisation& loop = scene.synchronisations[link.loop];
  if (link.forward)
    return {transmitted(loop, from.travel), slope_of(loop, from.travel) * from.gear};
  const Hinge& hinge = scene.hinges[drive.hinges[member]];
  const double travel = inverse_transmitted(loop, from.travel, whole_travel(hinge));
  const double gear = slope_of(loop, travel);
  return {travel, gear != 0 ? from.gear / gear : 0}; // a flat piece of g transmits no torque
}

std::vector<HingeState> states_at(const Scene& scene, const HingeDrive& drive, double x) {
  std::vector<HingeState> states{{x * whole_travel(scene.hinges[drive.hinges.front()]), 1}};
  for (std::size_t member = 1; member < drive.hinges.size(); ++member)
    states.push_back(follow(scene, drive, member, states[drive.links[member - 1].from]));
  return states;
}

/// states_at(…)[member], without those that it does not depend on: bisections ask for it millions of times.
HingeState state_at(const Scene& scene, const HingeDrive& drive, std::size_t member, double x) {
  if (member == 0) return {x * whole_travel(scene.hinges[drive.hinges.front()]), 1};
  return follow(scene, drive, member, state_at(scene, drive, drive.links[member - 1].from, x));
}

double share_at(const Scene& scene, const HingeDrive& drive, std::size_t member, double x) {
  return share_of(scene.hinges[drive.hinges[member]], state_at(scene, drive, member, x).travel);
}

/// Adds the x at which a hinge passes the given places of its own travel. Places it does not pass are left out.
void add_places(const Scene& scene, const HingeDrive& drive, std::size_t member,
                const std::vector<double>& places, std::vector<double>& points) {
  const double first = share_at(scene, drive, member, 0), last = share_at(scene, drive, member, 1);
  for (const double place : places) {
    if (!((first < place && place < last) || (last < place && place < first))) continue;
    double from = 0, to = 1;
    const auto halve_at = [&](double x) {
      ((share_at(scene, drive, member, x) < place) == (first < last) ? from : to) = x;
    };
    // Loops without a table are straight: the place lies within rounding of the chord's, between these two. Shares are
    // monotone, so the place does not depend on where the bisection begins.
    constexpr double rounding = 8 * std::numeric_limits<double>::epsilon();
    const double chord = (place - first) / (last - first);
    for (const double x : {chord * (1 - rounding), chord * (1 + rounding)})
      if (from < x && x < to) halve_at(x);
    for (double middle = std::midpoint(from, to); from < middle && middle < to;
         middle = std::midpoint(from, to))
      halve_at(middle);
    points.push_back(to);
  }
}

/// Adds places along the loops' tables: between knots, g is a cubic.
void add_loop_places(const Scene& scene, const HingeDrive& drive, std::vector<double>& points) {
  for (std::size_t member = 1; member < drive.hinges.size(); ++member) {
    const HingeDrive::Link& link = drive.links[member - 1];
    const Synchronisation& loop = scene.synchronisations[link.loop];
    if (!loop.table) continue;
    const std::size_t first = link.forward ? link.from : member; // the knots are its travels
    std::vector<double> knots;
    for (const double travel : loop.table->knots())
      if (const double x = share_of(scene.hinges[drive.hinges[first]], travel); x > 0 && x < 1)
        knots.push_back(x);
    if (first == 0)
      std::ranges::copy(parts_between(std::move(knots)), std::back_inserter(points));
    else
      add_places(scene, drive, first, parts_between(std::move(knots)), points);
  }
}

/// Whether a term may be no line between two places.
bool has_curves(const Scene& scene, const HingeDrive& drive) {
  const auto is_curved = [&](int hinge) {
    const Hinge& each = scene.hinges[hinge];
    return each.spring.table || each.harness.table || (each.motor && each.motor->table);
  };
  return std::ranges::any_of(drive.hinges, is_curved) ||
         std::ranges::any_of(drive.links, [&](const HingeDrive::Link& link) {
           return bool(scene.synchronisations[link.loop].table);
         });
}

/// The places between two at which margins may be less than these.
std::vector<double> places_below(const Margins& least, const Scene& scene, const HingeDrive& drive,
                                 const StaticMarginSpec& spec, double from, double to) {
  std::array<std::array<double, cubic_samples.size()>, margin_kind_names.size()> available,
      required;
  for (std::size_t k = 0; k < cubic_samples.size(); ++k) {
    double largest_spring = 0;
    const double x = std::lerp(from, to, cubic_samples[k]);
    const TorqueTerms terms = terms_at(scene, drive, x, spec, &largest_spring);
    const auto quotients = torque_quotients(terms, largest_spring, spec);
    for (std::size_t kind = 0; kind < quotients.size(); ++kind)
      available[kind][k] = quotients[kind].available, required[kind][k] = quotients[kind].required;
  }
  std::vector<double> places;
  for (std::size_t kind = 0; kind < least.size(); ++kind) {
    const Cubic over = Cubic::through(available[kind]), under = Cubic::through(required[kind]);
    if (const auto u = place_of_least_quotient(over, under, least[kind] + 1))
      places.push_back(std::lerp(from, to, *u));
  }
  return places;
}

/// Every hinge's places, as x of the leading hinge.
template <class PlacesOf>
std::vector<double> by_leader(const Scene& scene, const HingeDrive& drive,
                              const PlacesOf& places_of) {
  std::vector<double> points = places_of(scene.hinges[drive.hinges.front()]);
  for (std::size_t member = 1; member < drive.hinges.size(); ++member)
    add_places(scene, drive, member, places_of(scene.hinges[drive.hinges[member]]), points);
  return points;
}

bool has_spring(const Hinge& hinge) {
  const HingeTorque& spring = hinge.spring;
  return spring.table || spring.torque_stowed != 0 || spring.torque_latched != 0 ||
         spring.offset != 0;
}

bool has_drive(const Hinge& hinge) { return hinge.latch || hinge.motor || has_spring(hinge); }

/// The hinges coupled to this one by loops, directly or through others, and itself; ascending.
std::vector<int> connected_with(const Scene& scene, int hinge) {
  std::vector<int> group{hinge};
  for (std::size_t k = 0; k < group.size(); ++k)
    for (const Synchronisation& loop : scene.synchronisations)
      for (const auto& [a, b] : {std::pair{loop.first, loop.second}, {loop.second, loop.first}})
        if (loop.stiffness > 0 && a == group[k] && std::ranges::find(group, b) == group.end())
          group.push_back(b);
  std::ranges::sort(group);
  return group;
}

int leader_of(const Scene& scene, const std::vector<int>& group) {
  const auto follows = [&](int hinge) {
    return std::ranges::any_of(scene.synchronisations, [&](const Synchronisation& loop) {
      return loop.stiffness > 0 && loop.second == hinge;
    });
  };
  const auto free = std::ranges::find_if_not(group, follows);
  return free == group.end() ? group.front() : *free;
}

/// The hinges coupled to the leader; each is reached by one loop.
HingeDrive drive_led_by(const Scene& scene, int leader) {
  HingeDrive drive{{leader}, {}};
  const auto add = [&](std::size_t from, int loop, int hinge, bool forward) {
    if (std::ranges::find(drive.hinges, hinge) != drive.hinges.end()) return;
    drive.hinges.push_back(hinge);
    drive.links.push_back({from, loop, forward});
  };
  for (std::size_t k = 0; k < drive.hinges.size(); ++k)
    for (int i = 0; i < std::ssize(scene.synchronisations); ++i) {
      const Synchronisation& loop = scene.synchronisations[i];
      if (!(loop.stiffness > 0)) continue;
      const int hinge = drive.hinges[k];
      if (loop.first == hinge) add(k, i, loop.second, true);
      if (loop.second == hinge) add(k, i, loop.first, false);
    }
  return drive;
}

HingeExtras extras_of(const StaticMarginSpec& spec, int hinge) {
  return {spec.torques[hinge], spec.rates[hinge]};
}

} // namespace

std::vector<HingeDrive> drives_of(const Scene& scene) {
  std::vector<HingeDrive> drives;
  for (int hinge = 0; hinge < std::ssize(scene.hinges); ++hinge) {
    const std::vector<int> group = connected_with(scene, hinge);
    const auto drives_any = [&](int each) { return has_drive(scene.hinges[each]); };
    if (group.front() == hinge && std::ranges::any_of(group, drives_any))
      drives.push_back(drive_led_by(scene, leader_of(scene, group)));
  }
  return drives;
}

std::string name_of(const HingeDrive& drive, const Scene& scene) {
  std::string name;
  for (const int hinge : drive.hinges) name += (name.empty() ? "" : "+") + scene.hinges[hinge].name;
  return name;
}

TorqueTerms terms_at(const Scene& scene, const HingeDrive& drive, double x,
                     const StaticMarginSpec& spec, double* largest_spring) {
  const int leader = drive.hinges.front();
  TorqueTerms terms;
  double largest = add_terms(scene.hinges[leader], x, 1, extras_of(spec, leader), terms);
  if (largest_spring) *largest_spring = largest;
  if (drive.hinges.size() == 1) return terms;
  const std::vector<HingeState> states = states_at(scene, drive, x);
  for (std::size_t member = 1; member < states.size(); ++member) {
    const int index = drive.hinges[member];
    const Hinge& hinge = scene.hinges[index];
    const double share = std::clamp(share_of(hinge, states[member].travel), 0.0, 1.0);
    const double spring =
        add_terms(hinge, share, states[member].gear, extras_of(spec, index), terms);
    largest = std::max(largest, spring);
  }
  if (largest_spring) *largest_spring = largest;
  return terms;
}

Margins margins_at(const Scene& scene, const HingeDrive& drive, double x,
                   const StaticMarginSpec& spec) {
  double largest_spring = 0;
  const TorqueTerms terms = terms_at(scene, drive, x, spec, &largest_spring);
  return margins_of(terms, largest_spring, spec);
}

std::vector<double> turning_points(const Scene& scene, const HingeDrive& drive) {
  std::vector<double> points =
      by_leader(scene, drive, [](const Hinge& hinge) { return turning_points(hinge); });
  std::ranges::sort(points);
  return points;
}

std::vector<double> places_of_least(const Scene& scene, const HingeDrive& drive) {
  std::vector<double> points =
      by_leader(scene, drive, [](const Hinge& hinge) { return places_of_least(hinge); });
  add_loop_places(scene, drive, points);
  std::ranges::sort(points);
  return points;
}

bool applies(MarginKind kind, const Scene& scene, const HingeDrive& drive) {
  return kind != MarginKind::nasa_one_spring_out ||
         std::ranges::any_of(drive.hinges,
                             [&](int hinge) { return has_spring(scene.hinges[hinge]); });
}

Margins least_margins(const Scene& scene, const HingeDrive& drive, const StaticMarginSpec& spec,
                      Margins* at) {
  Margins least;
  least.fill(std::numeric_limits<double>::infinity());
  const auto take = [&](double x) {
    const Margins margins = margins_at(scene, drive, x, spec);
    for (std::size_t kind = 0; kind < margins.size(); ++kind)
      if (margins[kind] < least[kind]) {
        least[kind] = margins[kind];
        if (at) (*at)[kind] = x;
      }
  };
  const std::vector<double> places = places_of_least(scene, drive);
  std::ranges::for_each(places, take);
  if (!has_curves(scene, drive)) return least;
  for (std::size_t k = 1; k < places.size(); ++k)
    if (places[k - 1] < places[k])
      std::ranges::for_each(places_below(least, scene, drive, spec, places[k - 1], places[k]),
                            take);
  return least;
}

} // namespace wingspread
