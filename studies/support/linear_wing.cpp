#include "studies/support/linear_wing.hpp"

#include "core/mechanics/linear_solve.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>

namespace wingspread::study {
namespace {

Wing<double> wing_of(const Scene& scene) {
  Wing<double> wing = make_wing<double>(scene, outward_order(scene));
  set_parameters(wing, scene);
  return wing;
}

} // namespace

LinearWing::LinearWing(const Scene& scene)
    : wing_(wing_of(scene)), system_(wing_, std::nullopt, work_) {}

void LinearWing::engage(int hinge) {
  for (int i = 1; i <= hinges(); ++i)
    if (wing_.hinge_of[i] == hinge) system_.engage(i);
}

void LinearWing::engage_all() {
  for (int i = 1; i <= hinges(); ++i) system_.engage(i);
}

State<double> LinearWing::state(const std::vector<double>& angles,
                                const std::vector<double>& rates) const {
  const Layout& at = system_.layout();
  State<double> x(at.size());
  for (int i = 1; i <= hinges(); ++i) {
    x[at.angle(i)] = angles[wing_.hinge_of[i]];
    x[at.rate(i)] = rates[wing_.hinge_of[i]];
  }
  return x;
}

State<double> LinearWing::rest() const {
  const Layout& at = system_.layout();
  State<double> x(at.size(), 0);
  for (int i = 1; i <= hinges(); ++i) {
    const LinearLaw<double>& law = work_.laws[i];
    x[at.angle(i)] = law.latched + law.drive / law.stiffness;
  }
  return x;
}

std::vector<Eigenvalue> LinearWing::eigenvalues(const State<double>& x) {
  std::vector<int> held;
  for (int i = 1; i <= hinges(); ++i)
    if (work_.engaged[i]) held.push_back(i);
  const int m = static_cast<int>(held.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * m, 2 * m);
  A.topRightCorner(m, m).setIdentity();
  LinearSolve<double> linear;
  linear.factorize(system_, x, 0.0, [](int) { return 0.0; });
  std::vector<double> column(hinges());
  for (int c = 0; c < m; ++c) {
    linear.solve(
        system_, [&](int i) { return i == held[c] ? 1.0 : 0.0; }, column.data());
    const auto hinge = resistance(system_, x, 0.0, held[c]);
    for (int r = 0; r < m; ++r) {
      A(m + r, c) = -column[held[r] - 1] * hinge.stiffness;
      A(m + r, m + c) = -column[held[r] - 1] * hinge.damping;
    }
  }
  std::vector<Eigenvalue> found;
  for (const Eigenvalue& lambda : A.eigenvalues())
    if (lambda.imag() >= 0) found.push_back(lambda);
  std::ranges::sort(found, {}, [](const Eigenvalue& lambda) { return std::abs(lambda); });
  return found;
}

} // namespace wingspread::study
