#include "montecarlo/analyses/sampler/polynomial_map.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace wingspread;

namespace {

/// ξ₁ = z₁ + bend z₂², ξ₂ = z₂ + cube z₁ z₂².
Eigen::VectorXd bent(const Eigen::VectorXd& z, double bend, double cube) {
  return Eigen::Vector2d{z[0] + bend * z[1] * z[1], z[1] + cube * z[0] * z[1] * z[1]};
}

PolynomialMap map_of(double bend, double cube, int degree) {
  std::vector<Eigen::VectorXd> z, xi;
  for (const double a : {-2.0, -1.0, 0.0, 1.0, 2.0})
    for (const double b : {-2.0, -1.0, 0.0, 1.0, 2.0}) {
      z.push_back(Eigen::Vector2d{a, b});
      xi.push_back(bent(z.back(), bend, cube));
    }
  return {z, xi, degree};
}

} // namespace

TEST_CASE("a polynomial map goes through the points of its degree, and back") {
  CHECK(PolynomialMap::terms(2, 2) == 6);
  CHECK(PolynomialMap::terms(8, 3) == 165);
  const Eigen::VectorXd z = Eigen::Vector2d{0.7, -1.3};
  for (const int degree : {2, 3}) {
    const double cube = degree == 3 ? 0.02 : 0;
    const PolynomialMap map = map_of(3, cube, degree);
    const Eigen::VectorXd xi = bent(z, 3, cube);
    CHECK((map(z) - xi).norm() < 1e-10);
    const auto back = map.inverse(xi);
    REQUIRE(back);
    CHECK((*back - z).norm() < 1e-9);
    const double determinant = 1 + 2 * cube * z[0] * z[1] - 6 * z[1] * cube * z[1] * z[1];
    CHECK(*map.log_determinant(z) == Approx(std::log(determinant)).margin(1e-10));
  }
}

TEST_CASE("beyond a fold of the map there is neither a density nor a draw") {
  std::vector<Eigen::VectorXd> z, xi; // ξ = z − z²/4: the largest is 1, at z = 2
  for (const double at : {-2.0, -1.0, 0.0, 1.0, 2.0}) {
    z.push_back(Eigen::VectorXd::Constant(1, at));
    xi.push_back(Eigen::VectorXd::Constant(1, at - at * at / 4));
  }
  const PolynomialMap map(z, xi, 2);
  const auto at = [](double x) { return Eigen::VectorXd(Eigen::VectorXd::Constant(1, x)); };
  CHECK(map.log_determinant(at(1)));
  CHECK_FALSE(map.log_determinant(at(3)));
  CHECK_FALSE(map.inverse(at(1.5)));
  CHECK((*map.inverse(at(0.75)))[0] == Approx(1));
}
