/// Proof that no peak can be exceeded any more, so that a run may stop.
///
/// Once no hinge will latch any more, energy has a bound E that it keeps to (prospects.hpp), and
/// friction adds at most τ_s to a moment. What E allows at any angles stands in coarse_bounds.hpp;
/// what it allows near rest, ten times less, in sharp_bounds.hpp.
#pragma once

#include "core/proofs/coarse_bounds.hpp"
#include "core/proofs/sharp_bounds.hpp"

namespace wingspread {

/// Bounds on what every hinge will see from now on.
template <class T> class PeakBounds {
public:
  using Numbers = Eigen::Matrix<T, Eigen::Dynamic, 1>;
  Numbers moment; ///< 1 … n, N·m
  Numbers force;  ///< 1 … n, N

  /// Finds all that does not depend on the energy. Cost O(n³), and none of it for more than
  /// `most_bodies`, where the coarse bounds must do. @param prospects prepared
  template <class AnySystem> void prepare(const AnySystem& system, const Prospects<T>& prospects) {
    const int n = system.layout().bodies;
    moment.setZero(n + 1), force.setZero(n + 1);
    weigh(system.wing(), system.topology());
    near_rest_ =
        AnySystem::base_motion != BaseMotion::free && n <= most_bodies && prospects.rests();
    if (near_rest_) sharp_.prepare(system, prospects, outward_mass_);
  }

  /// For an energy that `prospects` has found. Cost O(n). @pre prepared
  template <class AnySystem>
  void bound(const AnySystem& system, const Prospects<T>& prospects, const T& energy) {
    if (near_rest_ && sharp_.hold(energy))
      sharp_.bound(energy, outward_mass_, moment, force);
    else
      coarse_.bound(system, prospects, energy, outward_mass_, moment, force);
  }

private:
  static constexpr int most_bodies = 24;

  template <class Topology> void weigh(const Wing<T>& wing, const Topology& tree) {
    outward_mass_.setZero(wing.size() + 1);
    for (int i = wing.size(); i >= 1; --i) {
      outward_mass_(i) = outward_mass_(i) + wing.bodies[i].mass;
      T& parents = outward_mass_(tree.parent_of(i));
      parents = parents + outward_mass_(i);
    }
  }

  bool near_rest_ = false; ///< the sharp ones are there
  Numbers outward_mass_;   ///< of body i and all that hangs on it, kg
  CoarseBounds<T> coarse_;
  SharpBounds<T> sharp_;
};

} // namespace wingspread
