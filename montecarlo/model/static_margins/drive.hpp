/// What turns as one: a hinge by itself, or hinges that synchronisation loops keep together.
///
/// | symbol | meaning                                                          | unit  |
/// |--------|------------------------------------------------------------------|-------|
/// | y_k    | travel of hinge k, from stowed                                   | rad   |
/// | x      | share of the leading hinge's travel, 0 stowed … 1 latched        |       |
/// | g      | the function of a loop: y of its second hinge = g(y of its first)| rad   |
/// | G_k    | gear: dy_k/dy of the leading hinge                               |       |
///
/// At rest a loop only hands on: the work of all torques on a small turn of the leading hinge is that of
/// one torque at it, Σ_k G_k τ_k, as stiff as the loop may be. So hinges of a loop have one margin
/// together, of terms that are sums of |G_k| times each hinge's own (hinge_terms.hpp): a hinge without a
/// spring of its own lives on the others' surplus. A hinge beyond its latched angle counts as it is there.
/// Loops take no friction of their own; their damping does nothing at rest, and stated rates are those
/// of hinges' own dampers.
#pragma once

#include "montecarlo/model/static_margins/hinge_terms.hpp"
#include "montecarlo/model/static_margins/motorization.hpp"

#include <string>
#include <vector>

namespace wingspread {

/// By the scene's structure alone: the same for all draws.
struct HingeDrive {
  struct Link {
    std::size_t from; ///< place in `hinges` of the one that it turns with
    int loop;         ///< index into Scene::synchronisations
    bool forward;     ///< from the loop's first to its second
  };
  std::vector<int> hinges; ///< indices into Scene::hinges; the first leads
  std::vector<Link> links; ///< one for each hinge after the first
};

/// All with a spring or a latch, in the order of their first hinges in the scene. Of hinges in loops one leads
/// that no loop has as its second, where there is one.
[[nodiscard]] std::vector<HingeDrive> drives_of(const Scene& scene);

/// "root", "root+mid".
[[nodiscard]] std::string name_of(const HingeDrive& drive, const Scene& scene);

/// The terms at x of the leading hinge's travel.
[[nodiscard]] MotorizationTerms terms_at(const Scene& scene, const HingeDrive& drive, double x,
                                         const MotorizationSpec& spec);

/// The turning points of all hinges, and where one of them is at its end; by x, ascending.
[[nodiscard]] std::vector<double> turning_points(const Scene& scene, const HingeDrive& drive);
/// Where the margins may have their least.
[[nodiscard]] std::vector<double> places_of_least(const Scene& scene, const HingeDrive& drive);

/// The least margins over the travel, kind by kind.
/// @param at if given: the x of each
[[nodiscard]] Margins least_margins(const Scene& scene, const HingeDrive& drive,
                                    const MotorizationSpec& spec, Margins* at = nullptr);

} // namespace wingspread
