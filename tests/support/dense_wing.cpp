#include "tests/support/dense_wing.hpp"

#include <Eigen/Cholesky>

#include <cmath>
#include <stdexcept>

namespace wingspread::oracle {

namespace {

constexpr int base_coordinates = 3; ///< x_0, y_0, θ_0 come before the bodies' angles

} // namespace

template <class Scalar>
typename DenseWing<Scalar>::Link DenseWing<Scalar>::make_link(const Scene& scene, int hinge) {
  const Hinge& h = scene.hinges[hinge];
  const Body& body = scene.bodies[h.child];
  if (h.friction.model == FrictionModel::exact)
    throw std::invalid_argument("DenseWing: exact friction is not smooth");
  if (h.harness.table && h.harness.table->both_ways())
    throw std::invalid_argument("DenseWing: only springs are measured both ways");
  Link link{};
  link.hinge = hinge;
  link.mass = body.mass;
  link.inertia = body.inertia;
  link.parent_point = h.parent_point.cast<Scalar>();
  link.child_point = h.child_point.cast<Scalar>();
  link.stowed = h.stowed;
  link.latched = h.latched;
  link.initial_rate = h.initial_rate;
  link.sense = h.latched > h.stowed ? 1 : -1;
  link.spring = {h, h.spring};
  link.harness = {h, h.harness};
  link.coulomb = h.friction.coulomb;
  link.viscous = h.friction.viscous;
  link.friction_scale = h.friction.scale;
  link.regularization_rate = h.friction.regularization_rate;
  link.damper = h.damper;
  link.stop = h.stop;
  link.far_stop = h.far_stop;
  link.latch = h.latch;
  link.joint = h.joint;
  link.plate = body.plate;
  return link;
}

/// Numbers the links so that parents come first, by repeated passes over the hinges.
template <class Scalar> void DenseWing<Scalar>::number_outward(const Scene& scene) {
  const std::size_t n = scene.hinges.size();
  std::vector<int> link_of_body(scene.bodies.size(), -1);
  link_of_hinge_.assign(n, -1);
  for (std::size_t before = n; links_.size() < n && links_.size() != before;) {
    before = links_.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Hinge& h = scene.hinges[i];
      const bool on_base = h.parent == base_index;
      if (link_of_hinge_[i] >= 0 || (!on_base && link_of_body[h.parent] < 0)) continue;
      Link link = make_link(scene, static_cast<int>(i));
      link.parent = on_base ? -1 : link_of_body[h.parent];
      link_of_hinge_[i] = link_of_body[h.child] = static_cast<int>(links_.size());
      links_.push_back(link);
    }
  }
  if (links_.size() != n || n != scene.bodies.size())
    throw std::invalid_argument("DenseWing: the hinges do not form a tree");
}

template <class Scalar>
DenseWing<Scalar>::DenseWing(const Scene& scene)
    : base_motion_(scene.base.motion), base_mass_(scene.base.mass),
      base_inertia_(scene.base.inertia), gravity_(scene.environment.gravity.cast<Scalar>()),
      air_density_(scene.environment.air_density), driven_(scene.base) {
  number_outward(scene);
  for (const Synchronisation& loop : scene.synchronisations) loops_.emplace_back(loop);
  const Base& base = scene.base;
  for (int k = 0; k < size(); ++k) {
    const int parent = links_[k].parent;
    paths_.push_back(parent < 0 ? std::vector<int>{0, 1, 2} : paths_[parent]);
    paths_.back().push_back(base_coordinates + k);
  }

  initial_.angles.resize(size());
  initial_.rates.resize(size());
  initial_.engagement = Vector<Scalar>::Zero(size());
  for (const Link& link : links_) {
    initial_.angles(link.hinge) = link.stowed;
    initial_.rates(link.hinge) = link.initial_rate;
  }
  if (base.motion != BaseMotion::fixed) {
    initial_.base_angle = base.angle;
    initial_.base_rate =
        base.motion == BaseMotion::prescribed ? driven_.initial_rate() : Scalar(base.rate);
  }
  if (base.motion == BaseMotion::free) {
    initial_.base_position = base.position.cast<Scalar>();
    initial_.base_velocity = base.velocity.cast<Scalar>();
  }
}

template <class Scalar> WingState<Scalar> DenseWing<Scalar>::initial_state() const {
  return initial_;
}

template <class Scalar> Scalar DenseWing<Scalar>::overtravel(int hinge, const Scalar& angle) const {
  const Link& link = link_of(hinge);
  return link.sense * (angle - link.latched);
}

template <class Scalar> Scalar DenseWing<Scalar>::sense(int hinge) const {
  return link_of(hinge).sense;
}

template <class Scalar> Scalar DenseWing<Scalar>::travel(int hinge, const Scalar& angle) const {
  const Link& link = link_of(hinge);
  return link.sense * (angle - link.stowed);
}

template <class Scalar> bool DenseWing<Scalar>::has_latch(int hinge) const {
  return link_of(hinge).latch.has_value();
}

template <class Scalar>
Scalar DenseWing<Scalar>::friction(const Link& link, const Scalar& angle,
                                   const Scalar& rate) const {
  using std::sqrt;
  const Scalar w = link.regularization_rate, level = link.coulomb + link.spring.level(angle);
  return -link.friction_scale * (level * rate / sqrt(rate * rate + w * w) + link.viscous * rate);
}

/// The moments across the hinges, without those of loops.
template <class Scalar>
Scalar DenseWing<Scalar>::moment(const Link& link, const WingState<Scalar>& state) const {
  const Scalar& angle = state.angles(link.hinge);
  const Scalar& rate = state.rates(link.hinge);
  const Scalar& engaged = state.engagement(link.hinge);
  if (link.joint)
    return -Scalar(link.joint->stiffness) * (angle - link.stowed) -
           Scalar(link.joint->damping) * rate;
  Scalar sum = link.sense * (link.spring.torque(angle) - link.harness.torque(angle)) +
               friction(link, angle, rate);
  if (link.damper) sum += damper_moment(*link.damper, angle, rate);
  if (link.latch) sum += engaged * latch_moment(*link.latch, Scalar(angle - link.latched), rate);
  if (link.stop)
    sum +=
        link.sense * stop_moment(*link.stop, travel(link.hinge, angle), Scalar(link.sense * rate));
  if (link.far_stop) // the mirror image: its travel is the way back from the latched angle
    sum -= link.sense * stop_moment(*link.far_stop, Scalar(-overtravel(link.hinge, angle)),
                                    Scalar(-link.sense * rate));
  return sum;
}

/// The potential energy of a hinge: s ∫ (spring − harness) dφ from φ to φ_latched, and the energy in latch and stop.
template <class Scalar>
Scalar DenseWing<Scalar>::potential(const Link& link, const WingState<Scalar>& state) const {
  const Scalar& angle = state.angles(link.hinge);
  if (link.joint) {
    const Scalar bent = angle - link.stowed;
    return Scalar(link.joint->stiffness) * bent * bent / 2;
  }
  Scalar sum = link.sense * (link.spring.integral(angle, link.latched) -
                             link.harness.integral(angle, link.latched));
  if (link.latch)
    sum += state.engagement(link.hinge) * latch_energy(*link.latch, Scalar(angle - link.latched));
  if (link.stop) sum += stop_energy(*link.stop, travel(link.hinge, angle));
  if (link.far_stop) sum += stop_energy(*link.far_stop, Scalar(-overtravel(link.hinge, angle)));
  return sum;
}

template <class Scalar>
Scalar DenseWing<Scalar>::out_of_step(const Loop<Scalar>& loop,
                                      const WingState<Scalar>& state) const {
  return loop.out_of_step(travel(loop.first, state.angles(loop.first)),
                          travel(loop.second, state.angles(loop.second)));
}

/// Adds the moments of the loops: τ along the second hinge's travel, −g' τ along the first hinge's.
template <class Scalar>
void DenseWing<Scalar>::pull(const Loop<Scalar>& loop, const WingState<Scalar>& state,
                             Vector<Scalar>& moments) const {
  const int a = loop.first, b = loop.second;
  const Scalar slope = loop.slope(travel(a, state.angles(a)));
  const Scalar rate = slope * sense(a) * state.rates(a) - sense(b) * state.rates(b);
  const Scalar tau = loop.pull(out_of_step(loop, state), rate);
  moments(a) -= sense(a) * slope * tau;
  moments(b) += sense(b) * tau;
}

template <class Scalar>
Vector<Scalar> DenseWing<Scalar>::moments(const WingState<Scalar>& state) const {
  Vector<Scalar> result(size());
  for (const Link& link : links_) result(link.hinge) = moment(link, state);
  for (const Loop<Scalar>& loop : loops_) pull(loop, state, result);
  return result;
}

/// Gravity, and the air on a plate.
template <class Scalar> Load<Scalar> DenseWing<Scalar>::load(int k, const Motion& at) const {
  Load<Scalar> load{gravity_ * links_[k].mass, Scalar(0)};
  if (!links_[k].plate) return load;
  const Vector2<Scalar> velocity = at.velocity.col(k);
  const Load<Scalar> air =
      air_on_plate<Scalar>(*links_[k].plate, air_density_, at.angles(k), velocity, at.rates(k));
  return {load.force + air.force, air.moment};
}

/// Positions by (1), and velocities by its derivative.
template <class Scalar>
typename DenseWing<Scalar>::Motion DenseWing<Scalar>::motion(const WingState<Scalar>& state) const {
  Motion result{Vector<Scalar>(size()), Vector<Scalar>(size()), Columns2<Scalar>(2, size()),
                Columns2<Scalar>(2, size())};
  for (int k = 0; k < size(); ++k) {
    const Link& link = links_[k];
    const int p = link.parent;
    const Scalar parent_angle = p < 0 ? state.base_angle : result.angles(p);
    const Scalar parent_rate = p < 0 ? state.base_rate : result.rates(p);
    const Scalar angle = parent_angle + state.angles(link.hinge);
    const Scalar rate = parent_rate + state.rates(link.hinge);
    const Vector2<Scalar> out = rotated(link.parent_point, parent_angle);
    const Vector2<Scalar> in = rotated(link.child_point, angle);
    const Vector2<Scalar> origin = p < 0 ? state.base_position : result.positions.col(p);
    const Vector2<Scalar> drift = p < 0 ? state.base_velocity : result.velocity.col(p);
    result.angles(k) = angle;
    result.rates(k) = rate;
    result.positions.col(k) = origin + out - in;
    result.velocity.col(k) = drift + turned(out) * parent_rate - turned(in) * rate;
  }
  return result;
}

/// J_k of (2), only its columns paths_[k]; the last one belongs to the link's own angle.
template <class Scalar>
std::vector<Columns2<Scalar>> DenseWing<Scalar>::jacobians(const Motion& at,
                                                           const Scalar& base_angle) const {
  Columns2<Scalar> of_base = Columns2<Scalar>::Zero(2, base_coordinates);
  of_base.template leftCols<2>().setIdentity();
  std::vector<Columns2<Scalar>> result(links_.size());
  for (int k = 0; k < size(); ++k) {
    const Link& link = links_[k];
    const int p = link.parent;
    const Columns2<Scalar>& parent = p < 0 ? of_base : result[p];
    const Eigen::Index inherited = parent.cols();
    Columns2<Scalar> jacobian(2, inherited + 1);
    jacobian.leftCols(inherited) = parent;
    jacobian.col(inherited - 1) +=
        turned(rotated(link.parent_point, p < 0 ? base_angle : at.angles(p)));
    jacobian.col(inherited) = -turned(rotated(link.child_point, at.angles(k)));
    result[k] = std::move(jacobian);
  }
  return result;
}

/// b_k of (2): the centripetal terms along the path.
template <class Scalar>
Columns2<Scalar> DenseWing<Scalar>::biases(const Motion& at, const WingState<Scalar>& state) const {
  Columns2<Scalar> result(2, size());
  for (int k = 0; k < size(); ++k) {
    const Link& link = links_[k];
    const int p = link.parent;
    const Scalar parent_angle = p < 0 ? state.base_angle : at.angles(p);
    const Scalar parent_rate = p < 0 ? state.base_rate : at.rates(p);
    Vector2<Scalar> bias = Vector2<Scalar>::Zero();
    if (p >= 0) bias = result.col(p);
    result.col(k) = bias - rotated(link.parent_point, parent_angle) * (parent_rate * parent_rate) +
                    rotated(link.child_point, at.angles(k)) * (at.rates(k) * at.rates(k));
  }
  return result;
}

/// M by (3), only its lower triangle: the indices in each path ascend.
template <class Scalar>
Matrix<Scalar>
DenseWing<Scalar>::mass_matrix(const std::vector<Columns2<Scalar>>& jacobians) const {
  const int dimension = base_coordinates + size();
  Matrix<Scalar> mass = Matrix<Scalar>::Zero(dimension, dimension);
  if (base_motion_ == BaseMotion::free) {
    mass(0, 0) = mass(1, 1) = base_mass_;
    mass(2, 2) = base_inertia_;
  }
  for (int k = 0; k < size(); ++k) {
    const std::vector<int>& path = paths_[k];
    const Columns2<Scalar>& jacobian = jacobians[k];
    for (std::size_t j = 0; j < path.size(); ++j) {
      const Vector2<Scalar> weighted = jacobian.col(j) * links_[k].mass;
      for (std::size_t i = j; i < path.size(); ++i)
        mass(path[i], path[j]) += jacobian(0, i) * weighted.x() + jacobian(1, i) * weighted.y();
    }
    mass(base_coordinates + k, base_coordinates + k) += links_[k].inertia;
  }
  return mass;
}

/// The part of (6) from the hinge moments: each acts on its child with one sign and on its parent with the other.
template <class Scalar>
Vector<Scalar> DenseWing<Scalar>::applied(const Vector<Scalar>& moments) const {
  Vector<Scalar> force = Vector<Scalar>::Zero(base_coordinates + size());
  for (int k = 0; k < size(); ++k) {
    const Scalar& across = moments(links_[k].hinge);
    force(base_coordinates + k) += across;
    force(base_coordinates + links_[k].parent) -= across; // parent −1: θ_0, coordinate 2
  }
  return force;
}

template <class Scalar>
Eigen::Matrix<Scalar, 3, 1> DenseWing<Scalar>::prescribed(const Scalar& time) const {
  if (base_motion_ != BaseMotion::prescribed) return Eigen::Matrix<Scalar, 3, 1>::Zero();
  return driven_.accelerations(time);
}

/// q̈ from (4). The terms of a prescribed base motion are known and move to the right-hand side.
template <class Scalar>
Vector<Scalar> DenseWing<Scalar>::solve(const Matrix<Scalar>& mass, const Vector<Scalar>& force,
                                        const Scalar& time) const {
  using Lower = Eigen::LDLT<Matrix<Scalar>, Eigen::Lower>;
  if (base_motion_ == BaseMotion::free) return Lower(mass).solve(force);
  const int n = size();
  Vector<Scalar> result(base_coordinates + n);
  const Eigen::Matrix<Scalar, 3, 1> base = prescribed(time);
  result.template head<base_coordinates>() = base;
  const Vector<Scalar> rest = force.tail(n) - mass.bottomLeftCorner(n, base_coordinates) * base;
  result.tail(n) = Lower(mass.bottomRightCorner(n, n)).solve(rest);
  return result;
}

template <class Scalar>
WingResponse<Scalar> DenseWing<Scalar>::respond(const WingState<Scalar>& state) const {
  return respond(state, moments(state));
}

template <class Scalar>
WingResponse<Scalar> DenseWing<Scalar>::respond(const WingState<Scalar>& state,
                                                const Vector<Scalar>& moments) const {
  const Motion at = motion(state);
  const std::vector<Columns2<Scalar>> jacobian = jacobians(at, state.base_angle);
  const Columns2<Scalar> bias = biases(at, state);

  WingResponse<Scalar> result;
  result.moments = moments;
  Vector<Scalar> force = applied(result.moments);
  if (base_motion_ == BaseMotion::free) force.template head<2>() += gravity_ * base_mass_;
  std::vector<Load<Scalar>> loads;
  for (int k = 0; k < size(); ++k) {
    loads.push_back(load(k, at));
    const Vector2<Scalar> net = loads[k].force - bias.col(k) * links_[k].mass;
    for (std::size_t j = 0; j < paths_[k].size(); ++j)
      force(paths_[k][j]) += jacobian[k].col(j).dot(net);
    force(base_coordinates + k) += loads[k].moment;
  }
  const Vector<Scalar> accelerations = solve(mass_matrix(jacobian), force, state.time);

  result.base_acceleration = accelerations.template head<2>();
  result.base_angular_acceleration = accelerations(2);
  result.hinge_accelerations.resize(size());
  Columns2<Scalar> inertial(2, size()); // m r̈ − F, then summed inward: (5)
  for (int k = 0; k < size(); ++k) {
    result.hinge_accelerations(links_[k].hinge) =
        accelerations(base_coordinates + k) - accelerations(base_coordinates + links_[k].parent);
    Vector2<Scalar> acceleration = bias.col(k);
    for (std::size_t j = 0; j < paths_[k].size(); ++j)
      acceleration += jacobian[k].col(j) * accelerations(paths_[k][j]);
    inertial.col(k) = acceleration * links_[k].mass - loads[k].force;
  }
  result.forces.resize(2, size());
  for (int k = size() - 1; k >= 0; --k) {
    result.forces.col(links_[k].hinge) = inertial.col(k);
    if (links_[k].parent >= 0) inertial.col(links_[k].parent) += inertial.col(k);
  }
  return result;
}

template <class Scalar>
WingBalance<Scalar> DenseWing<Scalar>::balance(const WingState<Scalar>& state) const {
  const Motion at = motion(state);
  WingBalance<Scalar> sum{Scalar(0), Scalar(0), Vector2<Scalar>::Zero(), Scalar(0)};
  const auto add = [&](const Scalar& mass, const Scalar& inertia, const Vector2<Scalar>& position,
                       const Vector2<Scalar>& velocity, const Scalar& rate) {
    sum.kinetic += (mass * velocity.squaredNorm() + inertia * rate * rate) / 2;
    sum.potential -= mass * gravity_.dot(position);
    sum.linear_momentum += velocity * mass;
    sum.angular_momentum += mass * cross(position, velocity) + inertia * rate;
  };
  if (base_motion_ == BaseMotion::free)
    add(base_mass_, base_inertia_, state.base_position, state.base_velocity, state.base_rate);
  for (int k = 0; k < size(); ++k) {
    add(links_[k].mass, links_[k].inertia, at.positions.col(k), at.velocity.col(k), at.rates(k));
    sum.potential += potential(links_[k], state);
  }
  for (const Loop<Scalar>& loop : loops_) sum.potential += loop.energy(out_of_step(loop, state));
  return sum;
}

template class DenseWing<double>;
template class DenseWing<long double>;
template class DenseWing<Quad>;

} // namespace wingspread::oracle
