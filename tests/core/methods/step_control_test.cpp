#include "core/methods/dop853.hpp"
#include "core/methods/step_control.hpp"
#include "core/methods/steppers.hpp"
#include "tests/support/random_scenes.hpp"

#include <Eigen/Core>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace wingspread;

namespace {

/// ẋ = A x.
struct LinearSystem {
  Eigen::MatrixXd A;
  void operator()(const State<double>& x, State<double>& dxdt, double /*t*/) const {
    dxdt.resize(x.size());
    Eigen::Map<Eigen::VectorXd>(dxdt.data(), A.rows()) = A * vector_of(x);
  }
  static Eigen::Map<const Eigen::VectorXd> vector_of(const State<double>& x) {
    return {x.data(), static_cast<Eigen::Index>(x.size())};
  }
};

} // namespace

TEST_CASE("step control: the first step is that of the source, with the exact second derivative") {
  int bent = 0, sloped = 0, cut = 0, grown = 0;
  for (int trial = 0; trial < 400; ++trial) {
    oracle::Draws draws(900 + trial);
    const int n = 1 + trial % 4, order = 3 + trial % 6;
    LinearSystem system{Eigen::MatrixXd(n, n)};
    for (double& a : system.A.reshaped())
      a = draws.uniform(0, 1) < 0.3 ? 0 : draws.uniform(-1, 1) * draws.log_uniform(1e-2, 1e3);
    State<double> x(n), dxdt, scratch(n), dscratch(n);
    for (double& v : x) v = draws.uniform(0, 1) < 0.2 ? 0 : draws.uniform(-2, 2);
    system(x, dxdt, 0);
    const double rtol = draws.log_uniform(1e-12, 1e-2), atol = draws.log_uniform(1e-14, 1e-4);
    const double longest = draws.log_uniform(1e-6, 10);
    const auto size_of = [&](const Eigen::VectorXd& v) {
      const auto scale = atol + rtol * LinearSystem::vector_of(x).array().abs();
      return (v.array().abs() / scale).maxCoeff();
    };
    const Eigen::VectorXd first = system.A * LinearSystem::vector_of(x), second = system.A * first;
    const double d0 = size_of(LinearSystem::vector_of(x)), d1 = size_of(first);
    const double d2 = size_of(second),
                 h0 = std::min(d0 < 1e-5 || d1 < 1e-5 ? 1e-6 : 0.01 * d0 / d1, longest);
    const double largest = std::max(d1, d2);
    const double h1 =
        largest > 1e-15 ? std::pow(0.01 / largest, 1.0 / (order + 1)) : std::max(1e-6, 1e-3 * h0);
    const double h =
        first_step(system, x, dxdt, 0.0, order, rtol, atol, longest, scratch, dscratch);
    CAPTURE(trial, h0, h1, longest);
    CHECK(h == Approx(std::min({100 * h0, h1, longest})).epsilon(1e-3));
    const bool by_size = h1 < std::min(100 * h0, longest) && largest > 1e-15;
    bent += by_size && d2 > 2 * d1, sloped += by_size && d1 > 2 * d2;
    cut += longest < std::min(100 * h0, h1), grown += 100 * h0 < std::min(h1, longest);
  }
  CHECK(std::min({bent, sloped, cut, grown}) >= 10);
}

TEST_CASE("step control: a scalar and a lane of a pack get the same factor") {
  using P = Pack<4>;
  oracle::Draws draws(4);
  for (int trial = 0; trial < 2000; ++trial) {
    StepMemory<P> memories;
    P errors(0.0), sizes(0.0);
    StepMemory<double> memory[4];
    for (int lane = 0; lane < 4; ++lane) {
      const double before = draws.log_uniform(1e-12, 1);
      if (draws.uniform(0, 1) < 0.5) memory[lane].foresee();
      memory[lane].accepted(before, draws.log_uniform(0.1, 10));
      if (draws.uniform(0, 1) < 0.2) memory[lane].rejected();
      memories.log_error.v[lane] = memory[lane].log_error;
      memories.most.v[lane] = memory[lane].most, memories.h.v[lane] = memory[lane].h;
      sizes.v[lane] = draws.log_uniform(0.1, 10);
      const double odd[] = {0,
                            1,
                            std::nextafter(1.0, 2.0),
                            1e99,
                            1e101,
                            std::numeric_limits<double>::infinity(),
                            std::numeric_limits<double>::quiet_NaN()};
      errors.v[lane] = trial < 7 ? odd[trial] : draws.log_uniform(1e-14, 1e4);
    }
    for (const int order : {4, 7}) {
      const P factors = step_factor(order, errors, sizes, memories);
      for (int lane = 0; lane < 4; ++lane)
        CHECK(factors.v[lane] ==
              step_factor(order, double(errors.v[lane]), double(sizes.v[lane]), memory[lane]));
    }
  }
}

TEST_CASE("step control: a step of NaN is cut to a tenth, one with too large an error according to "
          "the error") {
  const StepMemory<double> fresh;
  CHECK(step_factor(7, std::numeric_limits<double>::quiet_NaN(), 1.0, fresh) == 0.1);
  CHECK(step_factor(7, std::numeric_limits<double>::infinity(), 1.0, fresh) == 0.1);
  CHECK(step_factor(7, 1e30, 1.0, fresh) == 0.2);
  CHECK(step_factor(7, 2.0, 1.0, fresh) < 0.9);
  CHECK(step_factor(7, 0.0, 1.0, fresh) > 5);
  StepMemory<double> rejected = fresh;
  rejected.rejected();
  CHECK(step_factor(7, 0.0, 1.0, rejected) == 1);
}

TEST_CASE("after foresee() step control expects steps to become shorter still") {
  // an error that would grow by 2⁸ at equal steps halves a step of order 8
  StepMemory<double> plain, foreseeing;
  foreseeing.foresee();
  for (StepMemory<double>* memory : {&plain, &foreseeing}) memory->accepted(0.5, 1);
  const double h = 0.5,
               error = 0.5; // the step before was twice as long: another step of 0.5 would miss
  CHECK(step_factor(7, error, h, plain) > 0.9);
  CHECK(step_factor(7, error, h, foreseeing) == Approx(0.5 * 0.9 * std::pow(0.5, -1.0 / 8)));
  CHECK(step_factor(7, error, 1.5, foreseeing) == step_factor(7, error, 1.5, plain)); // they grow
  CHECK(step_factor(7, 2.0, h, foreseeing) == step_factor(7, 2.0, h, plain));         // a rejection
}

// ẋ = t⁶ from 0 to 1: both estimates are sums over the stages. With the coefficients of E. Hairer's dop853.f they are 1.400e-3
// and 6.479e-2, so that his ε5²/√(ε5² + 0.01 ε3²) is 2.95878531e-4 (computed apart, in Python).
TEST_CASE("the error of dop853 weighs its two estimates as Hairer's code does") {
  const auto system = [](const State<double>& /*x*/, State<double>& dxdt, double t) {
    dxdt.assign(1, std::pow(t, 6));
  };
  DormandPrince853<double> formula;
  const double t = 0, h = 1;
  const State<double> x(1, 0.0), dxdt(1, 0.0);
  State<double> x1(1), dxdt1(1), error(1);
  formula.estimate(system, {t, x, dxdt}, h, x1, dxdt1, error);
  CHECK(x1[0] == Approx(1.0 / 7).epsilon(1e-13));
  CHECK(formula.scaled_error(x, x1, dxdt1, error, 0, 1) == Approx(2.9587853e-4).epsilon(1e-7));
  CHECK(formula.scaled_error(x, x1, dxdt1, error, 0, 1e-3) == Approx(0.29587853).epsilon(1e-7));
  // relative to the larger of |x| and |x1| = 1/7; the rate there, 1, only must be finite
  CHECK(scaled_error_of(formula, x, x1, dxdt1, error, 1.0, 0.0) ==
        Approx(7 * 2.9587853e-4).epsilon(1e-7));
}

TEST_CASE("an error counts relative to the state's larger end, whatever the rates") {
  const State<double> x{-4, 1, 0}, x1{2, -8, 0}, error{4e-3, 4e-3, 5e-6};
  for (const double rate : {0.0, 1e3}) {
    const State<double> dxdt1(3, rate);
    const DormandPrince5<double> formula; // has no rule of its own
    CHECK(scaled_error_of(formula, x, x1, dxdt1, error, 1e-3, 0.0) > 1e300); // the third: no scale
    CHECK(scaled_error_of(formula, x, x1, dxdt1, error, 1e-3, 1e-5) ==
          Approx(4 / 4.01).epsilon(1e-12));
    CHECK(scaled_error_of(formula, x, x1, dxdt1, error, 1e-4, 1e-6) == Approx(4e-3 / 4.01e-4));
  }
}

// A formula that fits its steps to the tolerance needs no control: only a step that went wrong counts.
TEST_CASE("a formula that fits its steps gets half after a rejection, a tenth after numbers that "
          "are none") {
  using Series = TaylorSeries<double>;
  static_assert(FitsSteps<Series>);
  const StepMemory<double> fresh;
  const auto factor = [&](double error) { return factor_of<Series>(error, 0.1, fresh); };
  CHECK(factor(0) == Series::longest_growth);
  CHECK(factor(1) == Series::longest_growth);
  CHECK(factor(1.01) == 0.5);
  CHECK(factor(1e99) == 0.5);
  CHECK(factor(std::numeric_limits<double>::infinity()) == 0.1);
  CHECK(factor(std::numeric_limits<double>::quiet_NaN()) == 0.1);
}
