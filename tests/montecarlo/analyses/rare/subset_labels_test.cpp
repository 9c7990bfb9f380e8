#include "montecarlo/analyses/rare/strata.hpp"
#include "tests/montecarlo/analyses/rare/lid_support.hpp"
#include "tests/montecarlo/analyses/rare/limit_states.hpp"
#include "tests/support/random_cases.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

using namespace wingspread;
using namespace wingspread::oracle;
using namespace wingspread::test;

namespace {

/// A table of `rows` rows and a quantity Y ~ N(0, 1): the event is Y > beta in the middle row and Y > far in the others.
struct DecisiveRow {
  int rows;
  double beta, far;

  [[nodiscard]] double probability() const {
    return (normal_tail(beta) + (rows - 1) * normal_tail(far)) / rows;
  }
  [[nodiscard]] double g(const NormalPoint& z) const {
    const int row = std::min(rows - 1, static_cast<int>(normal_tail(-z[0]) * rows));
    return (row == rows / 2 ? beta : far) - (z[1] + z[2]) / std::sqrt(2);
  }
};

RareEstimate estimated(const PointFunction& g, std::size_t dimensions,
                       const std::vector<std::size_t>& labels, std::uint64_t seed) {
  std::vector<SubsetEstimate> repeats;
  for (std::uint64_t k = 0; k < 5; ++k)
    repeats.push_back(
        subset_simulation(limit_state(g), dimensions,
                          {.samples = 1000, .seed = seed, .repetition = k, .labels = labels}));
  return combined(repeats, 0.9);
}

/// 90 % bounds of P among so many seeds. `test_montecarlo "[rare]" -s` prints them; tests/nightly takes the seeds of README.md.
struct Misses {
  int seeds = random_cases(300, 60);
  int above = 0, below = 0; ///< lower bounds above P, upper bounds below it
  double bias = 0;          ///< relative, of the mean estimate

  Misses(const PointFunction& g, std::size_t dimensions, const std::vector<std::size_t>& labels,
         double exact) {
    for (int seed = 1; seed <= seeds; ++seed) {
      const RareEstimate found = estimated(g, dimensions, labels, static_cast<std::uint64_t>(seed));
      above += found.interval.lower > exact, below += found.interval.upper < exact;
      bias += (found.probability / exact - 1) / seeds;
    }
  }
  [[nodiscard]] int all() const { return above + below; }
  /// A tenth, and three standard errors.
  [[nodiscard]] double most() const { return 0.1 * seeds + 3 * std::sqrt(0.09 * seeds); }
};

} // namespace

TEST_CASE("an event by way of one row among many: bounds hold as often as they say",
          "[rare][long]") {
  const DecisiveRow table = GENERATE(DecisiveRow{37, 3.9, 8}, DecisiveRow{300, 3.9, 8},
                                     DecisiveRow{5, 4, 7}, DecisiveRow{2, 3.5, 5});
  const auto g = [&](const NormalPoint& z) { return table.g(z); };
  const Misses found(g, 3, {0}, table.probability());
  CAPTURE(table.rows, table.probability(), found.above, found.below, found.bias);
  CHECK(found.all() <= found.most());
}

TEST_CASE("without labels, bounds miss an event by way of one row among many", "[rare][long]") {
  const DecisiveRow table = GENERATE(DecisiveRow{37, 3.9, 8}, DecisiveRow{300, 3.9, 8});
  const auto g = [&](const NormalPoint& z) { return table.g(z); };
  const Misses found(g, 3, {}, table.probability());
  CAPTURE(table.rows, table.probability(), found.above, found.below, found.bias);
  CHECK(found.below > found.seeds / 2);
}

TEST_CASE("an event by two values of ten: bounds hold as often as they say", "[rare][long]") {
  const auto value = [](double z) { return std::min(9, static_cast<int>(normal_tail(-z) * 10)); };
  const auto g = [&](const NormalPoint& z) {
    return 6.0 - (value(z[0]) == 4) - (value(z[3]) == 7) - (z[1] + z[2]) / std::sqrt(2);
  };
  const double exact = 0.01 * normal_tail(4) + 0.18 * normal_tail(5) + 0.81 * normal_tail(6);
  const Misses found(g, 4, {0, 3}, exact);
  CAPTURE(exact, found.above, found.below, found.bias);
  CHECK(found.all() <= found.most());
}

TEST_CASE("an event by many weak parts at once: bounds hold as often as they say", "[rare][long]") {
  constexpr std::size_t parts = 24;
  constexpr double weak = 1.6448536269514722; // one in 20
  const auto g = [&](const NormalPoint& z) {
    return 6.5 - static_cast<double>(std::ranges::count_if(z, [&](double x) { return x > weak; }));
  };
  double exact = 0, term = std::pow(0.95, 24); // of k weak parts
  for (int k = 0; k <= 24; ++k) {
    if (k >= 7) exact += term;
    term *= (24.0 - k) / (k + 1) * 0.05 / 0.95;
  }
  std::vector<std::size_t> labels(parts);
  std::iota(labels.begin(), labels.end(), 0U);
  const Misses found(g, parts, labels, exact);
  CAPTURE(exact, found.above, found.below, found.bias);
  CHECK(found.all() <= found.most());
}

TEST_CASE("labels are drawn anew, the others move by a scale, and one of the two at a time",
          "[rare]") {
  std::vector<NormalPoint> points;
  const LimitStateFunction g = [&](std::span<const NormalPoint> now) {
    points.assign(now.begin(), now.end());
    return std::vector<double>(now.size(), 1.0); // every move is taken, and no level is the last
  };
  std::vector<std::vector<NormalPoint>> steps;
  const LimitStateFunction kept = [&](std::span<const NormalPoint> now) {
    std::vector<double> values = g(now);
    if (steps.empty())
      for (std::size_t k = 0; k < values.size(); ++k) values[k] = static_cast<double>(k);
    steps.push_back(points);
    return values;
  };
  (void)subset_simulation(kept, 4,
                          {.samples = 1000, .smallest = 0.05, .seed = 5, .labels = {1, 3}});
  REQUIRE(steps.size() >= 10);
  long labels_alone = 0, others_alone = 0;
  for (std::size_t step = 2; step < 10; ++step)
    for (std::size_t chain = 0; chain < 100; ++chain) {
      const NormalPoint &from = steps[step - 1][chain], &to = steps[step][chain];
      const bool labels = from[1] != to[1] || from[3] != to[3];
      const bool others = from[0] != to[0] && from[2] != to[2];
      CHECK(labels != others);
      labels_alone += labels, others_alone += others;
    }
  CHECK(labels_alone + others_alone == 800);
  CHECK(std::abs(static_cast<double>(labels_alone) - 800 / 3.0) < 4 * std::sqrt(800 * 2 / 9.0));
}

TEST_CASE("rows and laws with few values are labels, samples and fixed values are none", "[rare]") {
  const auto empirical = [](const char* name, int count) -> Json {
    std::vector<double> values;
    for (int k = 0; k < count; ++k) values.push_back(1 + 1e-3 * k);
    return {{"name", name},
            {"distribution", {{"type", "empirical"}, {"values", values}}},
            {"apply", "scale"},
            {"to", {"bodies.lid.inertia"}}};
  };
  const auto labels = [](const Json& dispersions) {
    Json json = lid();
    json["dispersions"] = dispersions;
    std::vector<std::vector<std::size_t>> all;
    for (const Stratum& stratum : strata_of(campaign_of(json), {.samples = 2000}).list)
      all.push_back(stratum.labels);
    return all;
  };
  using Labels = std::vector<std::vector<std::size_t>>;
  const Json normal = normal_law("D", 5, 0.4, "set", "hinges.h.release.delay");
  CHECK(labels(Json::array({normal})) == Labels{{}});
  CHECK(labels({normal, empirical("e", 20)}) == Labels{{1}});
  CHECK(labels({normal, empirical("e", 21)}) == Labels{{}});
  CHECK(labels({empirical("e", 1), normal}) == Labels{{}});
  // a rare value: neither stratum has a choice
  CHECK(labels({discrete_law("nofire", {0, 1}, {0.999, 0.001}, "set", "hinges.h.release.fails"),
                normal}) == Labels{{}, {}});
  // two common values and a rare one
  CHECK(
      labels({discrete_law("k", {1, 1.1, 1.2}, {0.5, 0.499, 0.001}, "scale", "bodies.lid.inertia"),
              normal}) == Labels{{0}, {}});
  std::vector<double> k, J;
  for (int row = 0; row < 40; ++row) k.push_back(1 + 1e-3 * row), J.push_back(1 - 1e-3 * row);
  const Json rows = {
      {"name", "measured"},
      {"rows",
       {{"values", {{"k", k}, {"J", J}}},
        {"apply", "scale"},
        {"columns", {{"k", "hinges.h.spring.scale"}, {"J", "bodies.lid.inertia"}}}}}};
  CHECK(labels({normal, rows}) == Labels{{1}});
}
