#include "distributions/design.hpp"
#include "montecarlo/analyses/sensitivity/sobol_indices.hpp"
#include "montecarlo/foundation/statistics/jackknife.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

using namespace wingspread;

namespace {

using Function = std::function<double(std::span<const double>)>; ///< of the unit cube

/// f at the points of a Saltelli design, as the runs of a campaign would stand.
std::vector<double> outputs(const Function& f, std::size_t d, long rows, DesignKind kind,
                            std::uint64_t seed, std::uint64_t replicates = 1) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < 2 * d; ++i) names.push_back(std::string(1, char('a' + i)));
  const PreparedDesign design({kind, seed, static_cast<std::uint64_t>(rows), replicates}, names);
  std::vector<double> values, x(d);
  for (long run = 0; run < rows * static_cast<long>(d + 2); ++run) {
    const auto [row, place] = saltelli_point(run, d);
    for (std::size_t i = 0; i < d; ++i) {
      const bool from_b = place == 1 || place == static_cast<long>(i) + 2;
      x[i] = design.uniform(static_cast<std::uint64_t>(row), from_b ? d + i : i);
    }
    values.push_back(f(x));
  }
  return values;
}

/// T. Ishigami, T. Homma (1990), a = 7, b = 0.1, on [−π, π]³.
double ishigami(std::span<const double> u) {
  const auto x = [&](std::size_t i) { return std::numbers::pi * (2 * u[i] - 1); };
  return std::sin(x(0)) + 7 * std::pow(std::sin(x(1)), 2) +
         0.1 * std::pow(x(2), 4) * std::sin(x(0));
}
/// V = a²/8 + bπ⁴/5 + b²π⁸/18 + ½, V_1 = ½(1 + bπ⁴/5)², V_2 = a²/8, V_13 = 8b²π⁸/225.
constexpr std::array first{0.313905, 0.442411, 0.0}, total{0.557589, 0.442411, 0.243684};

bool holds(const SobolIndex& index, double value) {
  return *index.bounds.lower <= value && value <= *index.bounds.upper;
}

} // namespace

TEST_CASE("Ishigami's indices are inside their bounds, by every design") {
  for (const DesignKind kind :
       {DesignKind::random, DesignKind::latin_hypercube, DesignKind::sobol}) {
    const int replicates = kind == DesignKind::random ? 0 : 16;
    const auto found =
        sobol_indices(outputs(ishigami, 3, 4096, kind, 2, 16), 3,
                      {.confidence = 0.99, .replicates = replicates, .resamples = 500, .seed = 2});
    CHECK(found.rows == 4096);
    CHECK(found.mean == Approx(3.5).margin(0.2));
    CHECK(found.variance == Approx(13.8446).epsilon(0.05));
    for (std::size_t i = 0; i < 3; ++i) {
      INFO("design " << static_cast<int>(kind) << ", dispersion " << i);
      CHECK(holds(found.effects[i].first, first[i]));
      CHECK(holds(found.effects[i].total, total[i]));
      CHECK(*found.effects[i].first.bounds.upper - *found.effects[i].first.bounds.lower < 0.25);
      CHECK(!found.effects[i].inert);
    }
  }
}

// Rows of Sobol' points depend on each other: taken for independent ones, as the bootstrap does, they
// seem less certain than they are.
TEST_CASE("bounds from a design's replicates cover, and see what the design gains") {
  constexpr int designs = 200, replicates = 8;
  std::array<int, 6> hits{};
  double width = 0, bootstrap_width = 0;
  for (int k = 0; k < designs; ++k) {
    const auto seed = static_cast<std::uint64_t>(k);
    const auto values = outputs(ishigami, 3, 512, DesignKind::sobol, seed, replicates);
    const auto found = sobol_indices(values, 3, {.confidence = 0.9, .replicates = replicates});
    const auto loose =
        sobol_indices(values, 3, {.confidence = 0.9, .resamples = 100, .seed = seed});
    for (std::size_t i = 0; i < 3; ++i) {
      hits[i] += holds(found.effects[i].first, first[i]);
      hits[3 + i] += holds(found.effects[i].total, total[i]);
    }
    width += *found.effects[1].total.bounds.upper - *found.effects[1].total.bounds.lower;
    bootstrap_width += *loose.effects[1].total.bounds.upper - *loose.effects[1].total.bounds.lower;
  }
  // the binomial's standard deviation is 0.021; the jackknife's pseudo-values are not quite normal
  for (const int count : hits) {
    CHECK(count >= 0.82 * designs);
    CHECK(count <= 0.97 * designs);
  }
  CHECK(width < 0.8 * bootstrap_width); // 0.69, with Student's factor of seven degrees
}

TEST_CASE("bounds from replicates are the jackknife's of the indices without each, by themselves") {
  const auto values = outputs(ishigami, 3, 32, DesignKind::sobol, 5, 4);
  const auto found = sobol_indices(values, 3, {.confidence = 0.9, .replicates = 4});
  std::vector<double> first_without, total_without;
  for (std::size_t left_out = 0; left_out < 4; ++left_out) {
    std::vector<double> rest;
    for (std::size_t at = 0; at < values.size(); ++at)
      if (at / 5 % 4 != left_out) rest.push_back(values[at]); // five points a row
    const SobolEffect effect = sobol_indices(rest, 3, {.replicates = 1}).effects[0];
    first_without.push_back(effect.first.value);
    total_without.push_back(effect.total.value);
  }
  const SobolEffect& effect = found.effects[0];
  const Bounds first_bounds = jackknife_bounds(effect.first.value, first_without, 0.9),
               total_bounds = jackknife_bounds(effect.total.value, total_without, 0.9);
  CHECK(*effect.first.bounds.lower == Approx(*first_bounds.lower).epsilon(1e-12));
  CHECK(*effect.first.bounds.upper == Approx(*first_bounds.upper).epsilon(1e-12));
  CHECK(*effect.total.bounds.lower == Approx(*total_bounds.lower).epsilon(1e-12));
  CHECK(*effect.total.bounds.upper == Approx(*total_bounds.upper).epsilon(1e-12));
}

TEST_CASE("one replicate has no bounds, nor have more replicates than rows") {
  const auto values = outputs(ishigami, 3, 64, DesignKind::sobol, 1);
  for (const int replicates : {1, 65}) {
    const auto found = sobol_indices(values, 3, {.replicates = replicates});
    CHECK(!found.effects[0].first.bounds.lower);
    CHECK(!std::isnan(found.effects[0].first.value));
  }
  CHECK(sobol_indices(values, 3, {.replicates = 64}).effects[0].first.bounds.lower);
}

TEST_CASE("Sobol' points come nearer to the indices than random ones do") {
  const auto error = [](DesignKind kind) {
    double sum = 0;
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
      const auto found = sobol_indices(outputs(ishigami, 3, 1024, kind, seed), 3, {.resamples = 1});
      for (std::size_t i = 0; i < 3; ++i)
        sum += std::pow(found.effects[i].first.value - first[i], 2) +
               std::pow(found.effects[i].total.value - total[i], 2);
    }
    return std::sqrt(sum / 48);
  };
  const double random = error(DesignKind::random);
  CHECK(random < 0.06);
  CHECK(error(DesignKind::sobol) < 0.5 * random);
}

TEST_CASE("the intervals hold Ishigami's indices as often as they say") {
  constexpr int designs = 200;
  std::array<int, 6> hits{};
  for (int k = 0; k < designs; ++k) {
    const auto seed = static_cast<std::uint64_t>(k);
    const auto found = sobol_indices(outputs(ishigami, 3, 256, DesignKind::random, seed), 3,
                                     {.confidence = 0.9, .resamples = 200, .seed = seed});
    for (std::size_t i = 0; i < 3; ++i) {
      hits[i] += holds(found.effects[i].first, first[i]);
      hits[3 + i] += holds(found.effects[i].total, total[i]);
    }
  }
  // the binomial's standard deviation is 0.021; percentile intervals cover somewhat less
  for (const int count : hits) {
    CHECK(count >= 0.82 * designs);
    CHECK(count <= 0.97 * designs);
  }
}

TEST_CASE("shares of a sum are the squares of its weights; the estimates do not see a shift") {
  const auto sum = [](std::span<const double> u) { return 1e6 + 3 * u[0] + 2 * u[1] + u[2]; };
  const auto found =
      sobol_indices(outputs(sum, 3, 2048, DesignKind::sobol, 1), 3, {.resamples = 50});
  for (const auto& [i, share] : {std::pair(0u, 9.0 / 14), {1u, 4.0 / 14}, {2u, 1.0 / 14}}) {
    CHECK(found.effects[i].first.value == Approx(share).margin(0.005));
    CHECK(found.effects[i].total.value == Approx(share).margin(0.005));
  }
}

TEST_CASE("a dispersion that does nothing has indices of exactly 0") {
  const auto found = sobol_indices(
      outputs([](std::span<const double> u) { return u[1]; }, 2, 64, DesignKind::random, 1), 2,
      {.resamples = 50});
  CHECK(found.effects[0].inert);
  CHECK(found.effects[0].first.value == 0);
  CHECK(found.effects[0].total.value == 0);
  CHECK(*found.effects[0].first.bounds.upper == 0);
  CHECK(!found.effects[1].inert);
}

TEST_CASE("an output that did not happen at some point has no indices, and its rows are counted") {
  std::vector<double> values = outputs(ishigami, 3, 64, DesignKind::random, 1);
  const double mean = sobol_indices(values, 3, {.resamples = 20}).mean;
  values[3] = values[14] = values[13] = std::nan(""); // two rows, no A or B
  values.push_back(1);                                // the beginning of a row
  const auto found = sobol_indices(values, 3, {.resamples = 20});
  CHECK(found.rows == 64);
  CHECK(found.incomplete == 2);
  CHECK(found.mean == mean);
  for (const SobolEffect& effect : found.effects) {
    CHECK((std::isnan(effect.first.value) && std::isnan(effect.total.value)));
    CHECK((!effect.first.bounds.lower && !effect.total.bounds.upper));
    CHECK(!effect.inert);
  }
}

TEST_CASE("outputs that do not vary, or are not there, have no indices") {
  const auto constant = sobol_indices(std::vector<double>(40, 2.5), 2, {.resamples = 20});
  CHECK(constant.rows == 10);
  CHECK(constant.variance == 0);
  CHECK(std::isnan(constant.effects[0].first.value));
  CHECK(constant.effects[0].inert);
  const auto missing = sobol_indices(std::vector<double>(40, std::nan("")), 2, {.resamples = 20});
  CHECK(missing.rows == 10);
  CHECK(missing.incomplete == 10);
  CHECK(std::isnan(missing.effects[1].total.value));
  CHECK(missing.effects[1].inert); // it is missing whatever the dispersion
}

TEST_CASE("the same seed gives the same intervals, another one others") {
  const std::vector<double> values = outputs(ishigami, 3, 128, DesignKind::random, 1);
  const auto lower = [&](std::uint64_t seed) {
    return sobol_indices(values, 3, {.resamples = 100, .seed = seed}).effects[0].first.bounds.lower;
  };
  CHECK(lower(1) == lower(1));
  CHECK(lower(1) != lower(2));
}
