#include "montecarlo/model/static_margins/drive.hpp"

#include "core/scene/curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace wingspread {
namespace {

/// Where a hinge stands.
struct Stand {
  double travel; ///< y_k, rad
  double gear;   ///< G_k
};

double whole_travel(const Hinge& hinge) { return std::abs(hinge.latched - hinge.stowed); }

/// The share of its own way; what has none stays at its beginning.
double share_of(const Hinge& hinge, double travel) {
  const double whole = whole_travel(hinge);
  return whole > 0 ? travel / whole : 0;
}

double given(const Synchronisation& loop, double travel) {
  return loop.table ? loop.table->value_at(travel) : loop.ratio * travel;
}

double slope_of(const Synchronisation& loop, double travel) {
  return loop.table ? loop.table->slope_at(travel) : loop.ratio;
}

/// The travel of a loop's first hinge at which it gives this to the second.
double taken_back(const Synchronisation& loop, double travel_of_second, double whole) {
  if (!loop.table) return travel_of_second / loop.ratio;
  double from = 0, to = whole;
  const bool rises = given(loop, to) > given(loop, from);
  for (double middle = std::midpoint(from, to); from < middle && middle < to;
       middle = std::midpoint(from, to))
    ((given(loop, middle) < travel_of_second) == rises ? from : to) = middle;
  return to;
}

Stand follow(const Scene& scene, const HingeDrive& drive, std::size_t member, const Stand& from) {
  const HingeDrive::Link& link = drive.links[member - 1];
  const Synchronisation& loop = scene.synchronisations[link.loop];
  if (link.forward) return {given(loop, from.travel), slope_of(loop, from.travel) * from.gear};
  const Hinge& hinge = scene.hinges[drive.hinges[member]];
  const double travel = taken_back(loop, from.travel, whole_travel(hinge));
  const double gear = slope_of(loop, travel);
  return {travel, gear != 0 ? from.gear / gear : 0}; // a loop that hands on nothing
}

std::vector<Stand> stands_at(const Scene& scene, const HingeDrive& drive, double x) {
  std::vector<Stand> stands{{x * whole_travel(scene.hinges[drive.hinges.front()]), 1}};
  for (std::size_t member = 1; member < drive.hinges.size(); ++member)
    stands.push_back(follow(scene, drive, member, stands[drive.links[member - 1].from]));
  return stands;
}

double share_at(const Scene& scene, const HingeDrive& drive, std::size_t member, double x) {
  return share_of(scene.hinges[drive.hinges[member]], stands_at(scene, drive, x)[member].travel);
}

/// Adds the x at which a hinge is at places of its own way, of those that it comes past.
void add_places(const Scene& scene, const HingeDrive& drive, std::size_t member,
                const std::vector<double>& places, std::vector<double>& points) {
  const double first = share_at(scene, drive, member, 0), last = share_at(scene, drive, member, 1);
  for (const double place : places) {
    if (!((first < place && place < last) || (last < place && place < first))) continue;
    double from = 0, to = 1;
    for (double middle = std::midpoint(from, to); from < middle && middle < to;
         middle = std::midpoint(from, to))
      ((share_at(scene, drive, member, middle) < place) == (first < last) ? from : to) = middle;
    points.push_back(to);
  }
}

/// Places along the curves of the loops' tables.
void add_loop_places(const Scene& scene, const HingeDrive& drive, std::vector<double>& points) {
  for (std::size_t member = 1; member < drive.hinges.size(); ++member) {
    const HingeDrive::Link& link = drive.links[member - 1];
    const Synchronisation& loop = scene.synchronisations[link.loop];
    if (!loop.table) continue;
    const std::size_t first = link.forward ? link.from : member; // has the table's knots
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

/// A hinge's own places in terms of x, hinge by hinge.
template <class PlacesOf>
std::vector<double> by_leader(const Scene& scene, const HingeDrive& drive,
                              const PlacesOf& places_of) {
  std::vector<double> points = places_of(scene.hinges[drive.hinges.front()]);
  for (std::size_t member = 1; member < drive.hinges.size(); ++member)
    add_places(scene, drive, member, places_of(scene.hinges[drive.hinges[member]]), points);
  return points;
}

bool has_drive(const Hinge& hinge) {
  const HingeTorque& spring = hinge.spring;
  return hinge.latch || spring.table || spring.torque_stowed != 0 || spring.torque_latched != 0 ||
         spring.offset != 0;
}

/// The hinges that loops connect with this one, ascending.
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

/// The hinges that turn with the leading one, each by one loop.
HingeDrive drive_led_by(const Scene& scene, int leader) {
  HingeDrive drive{{leader}, {}};
  const auto take = [&](std::size_t from, int loop, int hinge, bool forward) {
    if (std::ranges::find(drive.hinges, hinge) != drive.hinges.end()) return;
    drive.hinges.push_back(hinge);
    drive.links.push_back({from, loop, forward});
  };
  for (std::size_t k = 0; k < drive.hinges.size(); ++k)
    for (int i = 0; i < std::ssize(scene.synchronisations); ++i) {
      const Synchronisation& loop = scene.synchronisations[i];
      if (!(loop.stiffness > 0)) continue;
      const int hinge = drive.hinges[k];
      if (loop.first == hinge) take(k, i, loop.second, true);
      if (loop.second == hinge) take(k, i, loop.first, false);
    }
  return drive;
}

HingeExtras extras_of(const MotorizationSpec& spec, int hinge) {
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

MotorizationTerms terms_at(const Scene& scene, const HingeDrive& drive, double x,
                           const MotorizationSpec& spec) {
  const int leader = drive.hinges.front();
  MotorizationTerms terms = terms_at(scene.hinges[leader], x, extras_of(spec, leader));
  if (drive.hinges.size() == 1) return terms;
  const std::vector<Stand> stands = stands_at(scene, drive, x);
  for (std::size_t member = 1; member < stands.size(); ++member) {
    const int index = drive.hinges[member];
    const Hinge& hinge = scene.hinges[index];
    const double share = std::clamp(share_of(hinge, stands[member].travel), 0.0, 1.0);
    add_terms(hinge, share, stands[member].gear, extras_of(spec, index), terms);
  }
  return terms;
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

Margins least_margins(const Scene& scene, const HingeDrive& drive, const MotorizationSpec& spec,
                      Margins* at) {
  Margins least;
  least.fill(std::numeric_limits<double>::infinity());
  for (const double x : places_of_least(scene, drive)) {
    const Margins margins = margins_of(terms_at(scene, drive, x, spec), spec);
    for (std::size_t kind = 0; kind < margins.size(); ++kind)
      if (margins[kind] < least[kind]) {
        least[kind] = margins[kind];
        if (at) (*at)[kind] = x;
      }
  }
  return least;
}

} // namespace wingspread
