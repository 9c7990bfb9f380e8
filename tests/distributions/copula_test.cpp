#include "distributions/continuous_law.hpp"
#include "distributions/copula.hpp"
#include "distributions/design.hpp"
#include "distributions/prepared_distribution.hpp"
#include "tests/support/decompositions.hpp"

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

using namespace wingspread;

namespace {

const std::vector<std::string> names{"d", "c", "b", "a"};
const std::vector<RankCorrelation> correlations{{0, 1, 0.6}, {1, 2, -0.8}, {0, 2, -0.3}};
constexpr std::size_t runs = 100000;

/// The columns of u' below one half and above it, over `runs` runs of the four.
std::vector<std::vector<Tails>> coupled_columns() {
  const PreparedDesign design({DesignKind::random, 3, runs}, names);
  const GaussianCopula copula(order_by_name(names), correlations);
  std::vector<std::vector<Tails>> columns(names.size(), std::vector<Tails>(runs));
  std::vector<Tails> u(names.size()), row(names.size());
  for (std::size_t k = 0; k < runs; ++k) {
    for (std::size_t i = 0; i < u.size(); ++i) u[i] = tails_of_uniform(design.uniform(k, i));
    copula.couple(u, row);
    for (std::size_t i = 0; i < u.size(); ++i) columns[i][k] = row[i];
  }
  return columns;
}

/// Of values that do not repeat.
std::vector<double> ranks(const std::vector<Tails>& column) {
  std::vector<std::size_t> order(column.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t k) { return column[k].below; });
  std::vector<double> rank(column.size());
  for (std::size_t place = 0; place < order.size(); ++place)
    rank[order[place]] = static_cast<double>(place);
  return rank;
}

double spearman(const std::vector<Tails>& a, const std::vector<Tails>& b) {
  const std::vector<double> x = ranks(a), y = ranks(b);
  const double n = static_cast<double>(x.size());
  double squares = 0;
  for (std::size_t k = 0; k < x.size(); ++k) squares += (x[k] - y[k]) * (x[k] - y[k]);
  return 1 - 6 * squares / (n * (n * n - 1));
}

double kolmogorov_statistic(const std::vector<Tails>& column) {
  std::vector<double> u;
  for (const Tails& tails : column) u.push_back(tails.below);
  std::ranges::sort(u);
  const double n = static_cast<double>(u.size());
  double distance = 0;
  for (std::size_t k = 0; k < u.size(); ++k)
    distance = std::max(
        {distance, u[k] - static_cast<double>(k) / n, (static_cast<double>(k) + 1) / n - u[k]});
  return distance * std::sqrt(n);
}

Eigen::Matrix3d triple(double ab, double ac, double bc) {
  Eigen::Matrix3d matrix;
  matrix << 1, ab, ac, ab, 1, bc, ac, bc, 1;
  return matrix;
}

double smallest_eigenvalue(const Eigen::MatrixXd& matrix) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues()(0);
}

} // namespace

TEST_CASE("Spearman's coefficient and the normal correlation are each other's inverse") {
  CHECK(normal_correlation(0) == 0);
  CHECK(normal_correlation(1) == Approx(1).epsilon(1e-15));
  CHECK(normal_correlation(0.5) == Approx(0.5176380902050415).epsilon(1e-15)); // 2 sin 15°
  for (const double rho : {-0.99, -0.3, 0.1, 0.75})
    CHECK(spearman_correlation(normal_correlation(rho)) == Approx(rho).epsilon(1e-14));
}

TEST_CASE("coupled coordinates have the rank correlations asked for, and stay uniform") {
  const auto columns = coupled_columns();
  // Its standard error, by D. G. Bonett, T. A. Wright, Psychometrika 65 (2000) 23–28.
  const auto check = [&](std::size_t i, std::size_t j, double rho) {
    const double sigma =
        (1 - rho * rho) * std::sqrt((1 + rho * rho / 2) / (static_cast<double>(runs) - 3));
    CHECK(spearman(columns[i], columns[j]) == Approx(rho).margin(5 * sigma));
  };
  check(0, 1, 0.6), check(1, 2, -0.8), check(0, 2, -0.3);
  for (std::size_t i = 0; i < 3; ++i) check(i, 3, 0);
  for (const auto& column : columns) CHECK(kolmogorov_statistic(column) < 2.23); // one in 10⁴
}

TEST_CASE("laws of every kind keep their shape when coupled") {
  const auto columns = coupled_columns();
  const PreparedDistribution dice({Discrete{{1, 2, 3}, {0.5, 0.2, 0.3}}, {}});
  const PreparedDistribution cut({Normal{0, 1}, Truncation{1, 1.5}});
  std::array<double, 3> counts{};
  double below_median = 0;
  const double median = cut.quantile(0.5);
  for (std::size_t k = 0; k < runs; ++k) {
    ++counts.at(static_cast<std::size_t>(dice.quantile(columns[0][k])) - 1);
    const double value = cut.quantile(columns[1][k]);
    CHECK((value >= 1 && value <= 1.5));
    below_median += value < median ? 1 : 0;
  }
  const double n = static_cast<double>(runs), five_sigmas = 5 * std::sqrt(n) / 2;
  CHECK(std::abs(counts[0] - 0.5 * n) < five_sigmas);
  CHECK(std::abs(counts[1] - 0.2 * n) < five_sigmas);
  CHECK(std::abs(below_median - 0.5 * n) < five_sigmas);
}

TEST_CASE("what is first by name, or is correlated with nothing, keeps its coordinate") {
  const GaussianCopula copula(order_by_name(names), correlations);
  const std::vector<Tails> u{tails_of_uniform(0.1), tails_of_uniform(0.9),
                             tails_of_uniform(1 - 0x1p-53), tails_of_uniform(0x1p-53)};
  std::vector<Tails> coupled(4);
  copula.couple(u, coupled);
  CHECK((coupled[2].below == 1 - 0x1p-53 && coupled[2].above == 0x1p-53)); // "b", first of three
  CHECK((coupled[3].below == 0x1p-53 && coupled[3].above == 1 - 0x1p-53)); // "a"
  CHECK(coupled[1].below != 0.9);
  CHECK_FALSE(copula.is_independent());
  CHECK(GaussianCopula({0, 1}, {}).is_independent());
}

TEST_CASE("both tails of a coupled coordinate are accurate") {
  // With z = Φ⁻¹(u) the same for both, z' = (r + √(1 − r²)) z. From u = 2⁻⁴⁰ and
  // ρ = 0.5, mpmath 1.2.1 with 40 digits: z' = ∓9.678….
  const GaussianCopula copula({0, 1}, std::vector<RankCorrelation>{{0, 1, 0.5}});
  std::vector<Tails> low(2), high(2);
  copula.couple(std::vector<Tails>(2, tails_of_uniform(0x1p-40)), low);
  copula.couple(std::vector<Tails>(2, tails_of_uniform(1 - 0x1p-40)), high);
  CHECK(low[1].below == Approx(1.866726213638958e-22).epsilon(1e-12));
  CHECK(high[1].above == low[1].below); // not 1 − (1 − …), which is 0
  CHECK(high[1].below == 1);
  const PreparedDistribution normal({Normal{0, 1}, {}});
  CHECK(normal.quantile(high[1]) == Approx(9.678168165571679).epsilon(1e-13));
  CHECK(normal.quantile(low[1]) == Approx(-9.678168165571679).epsilon(1e-13));
}

// Of u = 1 − 1e-30 alone, which is 1, nothing would be left. Φ⁻¹(1e-30): mpmath, 40 digits.
TEST_CASE("a coordinate next to 1 is coupled by its complement") {
  const GaussianCopula copula({0, 1}, std::vector<RankCorrelation>{{0, 1, 0.5}});
  std::vector<Tails> low(2), high(2);
  copula.couple(std::vector<Tails>(2, Tails{1e-30, 1}), low);
  copula.couple(std::vector<Tails>(2, Tails{1, 1e-30}), high);
  CHECK(high[1].above == low[1].below);
  const double z = inverse(Normal{}, {1e-30, 1});
  CHECK(z == Approx(-11.464024688443616).epsilon(1e-14));
  const double r = 2 * std::sin(0.5 * 3.14159265358979324 / 6);
  CHECK(inverse(Normal{}, high[1]) == Approx(-z * (r + std::sqrt(1 - r * r))).epsilon(1e-13));
  CHECK((high[0].below == 1 && high[0].above == 1e-30));
}

TEST_CASE("Cholesky's factor gives the matrix back, and impossible matrices have none") {
  const Eigen::MatrixXd matrix = normal_correlations(4, correlations);
  const auto factor = cholesky(matrix);
  REQUIRE(factor);
  CHECK((*factor * factor->transpose() - matrix).norm() < 1e-15);
  CHECK(factor->isLowerTriangular());
  CHECK_FALSE(cholesky(triple(0.9, 0.9, -0.9)));
  CHECK_FALSE(cholesky(triple(1, 0, 0)));
  CHECK(cholesky(triple(0.999999, 0, 0)));
  CHECK_FALSE(cholesky(triple(std::nextafter(1, 0), 0, 0))); // what is left is above 0 by rounding
}

TEST_CASE("the nearest correlation matrix: published values") {
  // N. J. Higham, IMA J. Numer. Anal. 22 (2002), section 4: 0.7607 and 0.1573.
  const Eigen::MatrixXd nearest = nearest_correlations(triple(1, 0, 1), 1e-12);
  CHECK(nearest(0, 1) == Approx(0.76068985).margin(1e-7)); // numpy 1.24, 20,000 projections
  CHECK(nearest(1, 2) == Approx(0.76068985).margin(1e-7));
  CHECK(nearest(0, 2) == Approx(0.15729811).margin(1e-7));
}

TEST_CASE("the nearest correlation matrix is one, and nothing close by is nearer") {
  const Eigen::MatrixXd impossible = triple(0.9, 0.7, -0.6);
  constexpr double smallest = 1e-3;
  const Eigen::MatrixXd nearest = nearest_correlations(impossible, smallest);
  CHECK(smallest_eigenvalue(nearest) == Approx(smallest).epsilon(1e-4));
  CHECK((nearest.diagonal() - Eigen::Vector3d::Ones()).norm() == 0);
  CHECK(cholesky(nearest));
  const double distance = (nearest - impossible).norm();
  RandomStream random(1, 0, stream_name("nearby"));
  int possible = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const auto off = [&] { return 0.02 * (open_uniform(random()) - 0.5); };
    const Eigen::MatrixXd other =
        nearest + triple(off(), off(), off()) - Eigen::Matrix3d::Identity();
    if (smallest_eigenvalue(other) < smallest) continue;
    ++possible;
    CHECK((other - impossible).norm() >= distance - 1e-8);
  }
  CHECK(possible > 500);
  const Eigen::MatrixXd sound = triple(0.5, 0.2, 0.1);
  CHECK((nearest_correlations(sound, smallest) - sound).norm() < 1e-14);
}

// The bits are those of the normal law as all draws have it, evaluated in double: in long double they
// would be the processor's.
TEST_CASE("coupled draws are evaluated as the normal law's own are") {
  const std::vector<RankCorrelation> pair{{0, 1, 0.6}};
  const GaussianCopula copula(order_by_name({"a", "b"}), pair);
  const double r = normal_correlation(0.6), rest = std::sqrt(1 - r * r);
  const PreparedDesign design({DesignKind::random, 5, 1000}, {"a", "b"});
  const auto score = [](double u) { return inverse(Normal{}, {u, 1 - u}); };
  std::array<Tails, 2> coupled{};
  for (std::size_t k = 0; k < 1000; ++k) {
    const std::array<double, 2> u{design.uniform(k, 0), design.uniform(k, 1)};
    copula.couple(std::array{tails_of_uniform(u[0]), tails_of_uniform(u[1])}, coupled);
    const Tails expected = tails(Normal{}, rest * score(u[1]) + r * score(u[0]));
    CHECK((coupled[1].below == expected.below && coupled[1].above == expected.above));
    CHECK((coupled[0].below == u[0] && coupled[0].above == 1 - u[0]));
  }
}
