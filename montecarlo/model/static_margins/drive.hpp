/// A drive: one hinge, or several hinges that synchronisation loops couple. A drive has one static margin.
///
/// | symbol | meaning                                                          | unit  |
/// |--------|------------------------------------------------------------------|-------|
/// | y_k    | travel of hinge k, from stowed                                   | rad   |
/// | x      | share of the leading hinge's travel, 0 stowed … 1 latched        |       |
/// | g      | transmission of a loop: y of its second hinge = g(y of its first)| rad   |
/// | G_k    | gear: dy_k/dy of the leading hinge                               |       |
///
/// At rest, a small turn of the leading hinge does the work of the single torque Σ_k G_k τ_k on that hinge, whatever
/// the loop's stiffness (principle of virtual work). So the drive's terms are the sums of |G_k| times each hinge's
/// terms (hinge_terms.hpp); a hinge without a spring is driven by the others' surplus. A hinge past its latched angle
/// counts with its torques at that angle. Loops have no friction. Their damping vanishes at rest, and a stated rate
/// applies to the hinges' dampers only.
#pragma once

#include "montecarlo/model/static_margins/hinge_terms.hpp"
#include "montecarlo/model/static_margins/static_margin.hpp"

#include <string>
#include <vector>

namespace wingspread {

/// The hinges of a drive. They depend on the scene's structure only, so that one object serves all draws.
struct HingeDrive {
  struct Link {
    std::size_t from; ///< index into `hinges` of the neighbour
    int loop;         ///< index into Scene::synchronisations
    bool forward;     ///< the neighbour is the loop's first hinge
  };
  std::vector<int> hinges; ///< indices into Scene::hinges; the first leads
  std::vector<Link> links; ///< one for each hinge after the first
};

/// The drives with a spring, a motor or a latch, in the order of their first hinges in the scene. A drive is led by a hinge that
/// is no loop's second hinge; if there is none, by its first hinge in the scene.
[[nodiscard]] std::vector<HingeDrive> drives_of(const Scene& scene);

/// "root", "root+mid".
[[nodiscard]] std::string name_of(const HingeDrive& drive, const Scene& scene);

/// The drive's terms at x, referred to the leading hinge.
/// @param largest_spring if not null, receives the largest part of T from one hinge's spring, N·m
[[nodiscard]] TorqueTerms terms_at(const Scene& scene, const HingeDrive& drive, double x,
                                   const StaticMarginSpec& spec, double* largest_spring = nullptr);

/// The margins at x by each standard, whether or not they apply.
[[nodiscard]] Margins margins_at(const Scene& scene, const HingeDrive& drive, double x,
                                 const StaticMarginSpec& spec);

/// The ends of the travel, and where a hinge's spring or harness changes sign or a hinge reaches an end; x, ascending.
[[nodiscard]] std::vector<double> turning_points(const Scene& scene, const HingeDrive& drive);
/// The places between which every term is a cubic of x, or nearly one (hinge_terms.hpp); x, ascending.
[[nodiscard]] std::vector<double> places_of_least(const Scene& scene, const HingeDrive& drive);

/// Whether the margin exists for the drive: one spring can only be lost where a hinge has a spring.
[[nodiscard]] bool applies(MarginKind kind, const Scene& scene, const HingeDrive& drive);

/// The least margin over the travel by each standard, whether or not it applies. Exact where every term is a cubic between
/// the places; along the table of a loop or of a motor's command, and where another spring becomes the largest, the
/// margin at the least place of a cubic through four samples.
/// @param at if not null, receives the x of each minimum
[[nodiscard]] Margins least_margins(const Scene& scene, const HingeDrive& drive,
                                    const StaticMarginSpec& spec, Margins* at = nullptr);

} // namespace wingspread
