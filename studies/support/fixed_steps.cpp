#include "studies/support/fixed_steps.hpp"

#include "core/methods/steppers.hpp"

#include <Eigen/Eigenvalues>
#include <boost/numeric/odeint/stepper/modified_midpoint.hpp>

#include <memory>
#include <numbers>

namespace wingspread::study {
namespace {

namespace odeint = boost::numeric::odeint;
using AnySystem = LinearWing::AnySystem;

// ---- steps

Step classical_step() {
  using Stepper = odeint::runge_kutta4<State<double>, double, State<double>, double, StateAlgebra>;
  return [stepper = Stepper()](AnySystem& system, State<double>& x, double h) mutable {
    stepper.do_step(std::ref(system), x, 0.0, h);
  };
}

/// A formula of core/ that estimates its error.
template <class Formula> Step formula_step() {
  const auto formula = std::make_shared<Formula>();
  return [formula, x1 = State<double>(), dxdt = State<double>(), dxdt1 = State<double>(),
          error = State<double>()](AnySystem& system, State<double>& x, double h) mutable {
    for (State<double>* v : {&x1, &dxdt, &dxdt1, &error}) v->resize(x.size());
    const double t = 0;
    system(x, dxdt, t);
    formula->estimate(system, Start<double>{t, x, dxdt}, h, x1, dxdt1, error);
    std::swap(x, x1);
  };
}

/// Extrapolates results with n_0 < n_1 < … substeps to the limit of infinitely many, by Aitken and Neville, in powers of
/// hᵖ. The result is the last element.
void extrapolate(std::vector<State<double>>& results, const std::vector<int>& n, int p) {
  for (int k = 1; k < std::ssize(results); ++k)
    for (int j = static_cast<int>(std::ssize(results)) - 1; j >= k; --j) {
      const double ratio = std::pow(static_cast<double>(n[j]) / n[j - k], p);
      for (std::size_t c = 0; c < results[j].size(); ++c)
        results[j][c] += (results[j][c] - results[j - 1][c]) / (ratio - 1);
    }
}

/// A step of bulirsch_stoer: the modified midpoint rule with 2, 4, … substeps, extrapolated in h².
Step midpoint_step(int rows) {
  odeint::modified_midpoint<State<double>, double, State<double>, double, StateAlgebra> rule;
  return [rule, rows](AnySystem& system, State<double>& x, double h) mutable {
    std::vector<State<double>> results;
    std::vector<int> n;
    for (int row = 0; row < rows; ++row) {
      n.push_back(2 * (row + 1));
      rule.set_steps(static_cast<unsigned short>(n.back()));
      State<double> result(x.size());
      rule.do_step(std::ref(system), x, 0.0, result, h);
      results.push_back(result);
    }
    extrapolate(results, n, 2);
    x = results.back();
  };
}

/// A step of seulex: the linearly implicit Euler rule with 2, 3, … substeps, extrapolated in h.
Step implicit_euler_step(int rows) {
  const auto implicit = std::make_shared<LinearlyImplicit<double>>();
  return [implicit, rows](AnySystem& system, State<double>& x, double h) {
    std::vector<State<double>> results;
    std::vector<int> n;
    const double t = 0;
    State<double> change(x.size()), dxdt(x.size());
    for (int row = 0; row < rows; ++row) {
      n.push_back(row + 2);
      const double part = h / n.back();
      implicit->factorize(system, Start<double>{t, x, dxdt}, part);
      State<double> result = x;
      for (int k = 0; k < n.back(); ++k) {
        system(result, dxdt, t);
        for (std::size_t c = 0; c < x.size(); ++c) change[c] = part * dxdt[c];
        implicit->solve(system, change, part);
        for (std::size_t c = 0; c < x.size(); ++c) result[c] += change[c];
      }
      results.push_back(result);
    }
    extrapolate(results, n, 1);
    x = results.back();
  };
}

/// A step of adams_bashforth_moulton at a constant order, after the first steps that raise the order to it.
template <int Order> Step adams_step() {
  using Stepper = odeint::adaptive_adams_bashforth_moulton<Order, State<double>, double,
                                                           State<double>, double, StateAlgebra>;
  return [stepper = std::make_shared<Stepper>(), t = 0.0](AnySystem& system, State<double>& x,
                                                          double h) mutable {
    stepper->do_step(std::ref(system), x, t, h);
    t += h;
  };
}

// ---- growth

/// |R(z)| of a one-step method, from a step of h = 1 of a panel whose latch has the eigenvalues z and z̄. The step is a
/// matrix with the eigenvalues R(z) and its conjugate, so its determinant is |R(z)|².
double one_step_growth(const std::function<Step()>& start, std::complex<double> z) {
  Scene scene;
  scene.bodies = {{"panel", 1, 1}};
  Hinge hinge;
  hinge.name = "hinge", hinge.stowed = -1;
  hinge.latch = Latch{std::norm(z), -2 * z.real()};
  scene.hinges = {hinge};
  LinearWing oscillator(scene);
  oscillator.engage_all();
  const Step step = start();
  State<double> first{1, 0}, second{0, 1};
  step(oscillator.system(), first, 1), step(oscillator.system(), second, 1);
  return std::sqrt(std::abs(first[0] * second[1] - first[1] * second[0]));
}

/// γ_i of Adams and Bashforth: γ_i = 1 − Σ_{j<i} γ_j/(i + 1 − j)
/// [Hairer, Nørsett & Wanner I, III.1].
std::vector<double> adams_coefficients(int count) {
  std::vector<double> gamma;
  for (int i = 0; i < count; ++i) {
    double sum = 1;
    for (int j = 0; j < i; ++j) sum -= gamma[j] / (i + 1 - j);
    gamma.push_back(sum);
  }
  return gamma;
}

/// The growth of a step that predicts with order k, evaluates, corrects with the next difference and evaluates again. For
/// f = λ y with differences ∇ʲ f over y_n … y_{n−k+1}, the step is a linear map of these values. The growth is the map's
/// spectral radius.
double adams_growth(int k, std::complex<double> z) {
  const std::vector<double> gamma = adams_coefficients(k + 1);
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(k), last = Eigen::VectorXd::Zero(k);
  Eigen::VectorXd difference = Eigen::VectorXd::Unit(k, 0); // ∇ʲ as weights of the f's
  for (int j = 0; j < k; ++j) {
    weights += gamma[j] * difference;
    last += difference;
    Eigen::VectorXd next = difference;
    next.tail(k - 1) -= difference.head(k - 1);
    difference = next;
  }
  // p = y + z Σ weights y;   y₊ = p + z γ_k (p − Σ last y)
  Eigen::VectorXcd p = z * weights;
  p(0) += 1;
  Eigen::MatrixXcd map = Eigen::MatrixXcd::Zero(k, k);
  map.row(0) = (p + z * gamma[k] * (p - last)).transpose();
  for (int j = 1; j < k; ++j) map(j, j - 1) = 1;
  return map.eigenvalues().cwiseAbs().maxCoeff();
}

FixedStepMethod one_step(const std::string& name, int order, double evaluations,
                         const std::function<Step()>& start) {
  return {name, order, evaluations, start,
          [start](std::complex<double> z) { return one_step_growth(start, z); }};
}

/// @param order order of the prediction; that of the correction is one higher
FixedStepMethod adams(int order, const std::function<Step()>& start) {
  return {"adams_bashforth_moulton", order, 2, start,
          [order](std::complex<double> z) { return adams_growth(order, z); }};
}

/// Evaluations of the modified midpoint rule in a step. A row with n substeps takes n + 1, the last for the smoothing. All
/// rows share the first evaluation.
double midpoint_evaluations(int rows) { return rows * (rows + 1) + 1; }
/// Evaluations of the implicit Euler rule in a step: one that all rows share, and n − 1 for a row with n substeps.
double implicit_evaluations(int rows) { return 1 + rows * (rows + 1) / 2.0; }

} // namespace

std::vector<FixedStepMethod> fixed_step_methods() {
  std::vector<FixedStepMethod> all{
      one_step("runge_kutta4", 4, 4, classical_step),
      one_step("cash_karp54", 5, 6, formula_step<CashKarp54<double>>),
      one_step("dopri5", 5, 6, formula_step<DormandPrince5<double>>),
      one_step("fehlberg78", 8, 13, formula_step<Fehlberg78<double>>),
      one_step("dop853", 8, 12, formula_step<DormandPrince853<double>>)};
  for (const int rows : {2, 4, 8})
    all.push_back(one_step("bulirsch_stoer", 2 * rows, midpoint_evaluations(rows),
                           [rows] { return midpoint_step(rows); }));
  all.push_back(adams(1, adams_step<1>));
  all.push_back(adams(2, adams_step<2>));
  all.push_back(adams(4, adams_step<4>));
  all.push_back(adams(8, adams_step<8>));
  all.push_back(one_step("rosenbrock_w", 3, 4, formula_step<RosenbrockW<double>>));
  for (const int rows : {3, 6, 12})
    all.push_back(one_step("seulex", rows, implicit_evaluations(rows),
                           [rows] { return implicit_euler_step(rows); }));
  return all;
}

} // namespace wingspread::study
