// The modes of linear models: held against the model, and against a library's QR algorithm.
#include "core/proofs/modes.hpp"
#include "tests/support/decompositions.hpp"
#include "tests/support/random_scenes.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

using namespace wingspread;
using Eigen::MatrixXd;

namespace {

/// A chain of panels like those of a wing, each 10 % lighter or heavier; springs and dampers of the hinges.
/// @param damping of a panel alone on its hinge, as a share of the critical one, about
RestModel chain(oracle::Draws& draws, int n, double damping) {
  RestModel model;
  model.parents.assign(n, 0);
  model.mass.setZero(n, n), model.stiffness.setZero(n, n), model.damping.setZero(n, n);
  for (int panel = 0; panel < n; ++panel) { // turned by the hinges inward of it
    Eigen::VectorXd ways = Eigen::VectorXd::Zero(n);
    for (int i = 0; i <= panel; ++i) ways(i) = panel - i + 0.5;
    const double mass = draws.uniform(0.9, 1.1);
    model.mass += mass * ways * ways.transpose();
    model.mass.topLeftCorner(panel + 1, panel + 1).array() += mass / 12;
  }
  for (int i = 0; i < n; ++i) {
    const double k = draws.uniform(500, 2000);
    model.stiffness(i, i) = k;
    model.damping(i, i) = damping * 2 * std::sqrt(k / 3) * draws.uniform(0.5, 2); // one panel on it
  }
  return model;
}

MatrixXd first_order(const RestModel& model) {
  const int n = model.size();
  MatrixXd L = MatrixXd::Zero(2L * n, 2L * n);
  L.topRightCorner(n, n).setIdentity();
  L.bottomLeftCorner(n, n) = -model.mass.inverse() * model.stiffness;
  L.bottomRightCorner(n, n) = -model.mass.inverse() * model.damping;
  return L;
}

/// |V⁻¹ L V − Λ| beside |L|.
double residual(const Modes& modes, const MatrixXd& L) {
  const auto& V = modes.columns();
  return (V.inverse() * L * V - modes.blocks()).cwiseAbs().maxCoeff() / L.norm();
}

std::vector<std::complex<double>> in_order(std::vector<std::complex<double>> values) {
  std::ranges::sort(values, {}, [](const std::complex<double>& value) {
    return std::pair(std::round(1e6 * std::abs(value)), value.imag());
  });
  return values;
}

/// Whether they are found one by one: then they are those of a library, and fulfil the model to round-off.
bool are_those_of_a_library(const RestModel& model, const MatrixXd& L) {
  Modes modes;
  if (!modes.find_one_by_one(model)) return false;
  CHECK(residual(modes, L) < 1e-12); // rounding: some 1e-15 times the columns' condition
  const Eigen::VectorXcd exact = L.eigenvalues();
  const auto expected = in_order({exact.begin(), exact.end()});
  const auto values = in_order(modes.values());
  for (std::size_t j = 0; j < values.size(); ++j)
    CHECK(std::abs(values[j] - expected[j]) < 1e-9 * std::abs(expected[j]));
  return true;
}

} // namespace

TEST_CASE("modes found one by one are those of a library, and fulfil the model to round-off") {
  oracle::Draws draws(5);
  int found = 0, asked = 0;
  for (const int n : {1, 2, 3, 4, 5, 8, 20})
    for (const double damping : {0.0, 1e-3, 0.02, 0.1, 0.5, 1.0})
      for (int trial = 0; trial < 10; ++trial, ++asked) {
        const RestModel model = chain(draws, n, damping);
        const MatrixXd L = first_order(model);
        CAPTURE(n, damping, trial);
        found += are_those_of_a_library(model, L);
      }
  CHECK(found > 0.8 * asked);
}

TEST_CASE(
    "modes that creep are found, one by one or all at once, and those that are the same twice") {
  oracle::Draws draws(6);
  for (const double damping : {0.5, 4.0})
    for (int trial = 0; trial < 20; ++trial) {
      const RestModel model = chain(draws, 3, damping);
      const MatrixXd L = first_order(model);
      Modes modes;
      REQUIRE(modes.find(model, model.mass.inverse()));
      CHECK(residual(modes, L) < 1e-9);
    }
  RestModel twins; // two wings that are alike
  twins.parents = {0, 0};
  twins.mass = MatrixXd::Identity(2, 2), twins.stiffness = 100 * MatrixXd::Identity(2, 2);
  twins.damping = 0.3 * MatrixXd::Identity(2, 2);
  Modes modes;
  CHECK_FALSE(modes.find_one_by_one(twins));
  REQUIRE(modes.find(twins, twins.mass.inverse()));
  CHECK(residual(modes, first_order(twins)) < 1e-14);
}

TEST_CASE("a wing without mass, or that nothing holds, has no modes of its own that swing") {
  oracle::Draws draws(7);
  RestModel model = chain(draws, 3, 0.02);
  RestModel loose = model, massless = model;
  loose.stiffness(1, 1) = 0;
  CHECK_FALSE(Modes().find_one_by_one(loose));
  massless.mass.setZero();
  CHECK_FALSE(Modes().find_one_by_one(massless));
}

// Rounding is all that it bounds in a run, so no run shows it. The oracle turns the phase of the other mode.
TEST_CASE("what one mode leaves in another is largest at one phase, of real modes and of pairs") {
  oracle::Draws draws(23);
  for (int trial = 0; trial < 40; ++trial) {
    Eigen::MatrixXd e(5, 5);
    for (int i = 0; i < 25; ++i) e(i / 5, i % 5) = draws.uniform(-1, 1);
    const ModeColumns all[] = {{0, false}, {1, true}, {3, true}};
    for (const ModeColumns& of : all)
      for (const ModeColumns& by : all) {
        double most = 0;
        for (int k = 0; k < 2000; ++k) {
          const std::complex<double> w = std::polar(1.0, 2 * std::numbers::pi * k / 2000);
          Eigen::VectorXd coordinates = Eigen::VectorXd::Zero(5);
          if (by.is_pair)
            coordinates(by.column) = 2 * w.real(), coordinates(by.column + 1) = -2 * w.imag();
          else
            coordinates(by.column) = 1;
          const Eigen::VectorXd left = e * coordinates;
          most = std::max(most, of.is_pair ? 0.5 * std::hypot(left(of.column), left(of.column + 1))
                                           : std::abs(left(of.column)));
        }
        const double bound = size_of_residual(e, of, by);
        CAPTURE(trial, of.column, by.column);
        CHECK(most <= bound * (1 + 1e-12));
        CHECK(most >= bound * (1 - 1e-5));
      }
  }
}
