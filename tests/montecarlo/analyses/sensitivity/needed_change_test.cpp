#include "distributions/continuous_law.hpp"
#include "montecarlo/analyses/sensitivity/needed_change.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <catch2/catch.hpp>

#include <random>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// Runs with draws "a", "b" about 1, and the output y(a, b).
struct InventedRuns {
  std::vector<double> a, b, y;
  std::vector<Status> status;

  template <class Output> InventedRuns(int n, std::uint64_t seed, Output output) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    for (int i = 0; i < n; ++i) {
      a.push_back(1 + 0.1 * normal(random));
      b.push_back(1 + 0.2 * normal(random));
      y.push_back(output(a.back(), b.back(), normal(random)));
    }
    status.assign(a.size(), Status::deployed);
  }
  [[nodiscard]] Results results() const {
    Results rows(ResultNames{{"a", "b"}, {"y"}});
    for (std::size_t i = 0; i < y.size(); ++i)
      rows.append({static_cast<long>(i), status[i], {a[i], b[i]}, {y[i]}, "root", ""});
    return rows;
  }
};

Requirement limited(double max, double probability = 0.99) {
  Requirement requirement;
  requirement.output = "y", requirement.max = max;
  requirement.probability = probability, requirement.confidence = 0.9;
  return requirement;
}

Requirement deploying(double probability) {
  Requirement requirement;
  requirement.output = deployed_output;
  requirement.probability = probability, requirement.confidence = 0.9;
  return requirement;
}

std::vector<std::optional<NeededChange>> needed_of(NeededFor what, const Requirement& requirement,
                                                   const Results& results,
                                                   const std::vector<MovedDraws>& moved) {
  const auto found = needed_changes(what, judge(requirement, results), results, {}, moved, 0.95);
  REQUIRE(found);
  return found->changes;
}

double normal_quantile(double p) { return inverse(Normal{}, {p, 1 - p}); }

const MovedDraws a_shifted{{0}, false}, a_scaled{{0}, true}, both_scaled{{0, 1}, true};

} // namespace

TEST_CASE("of a linear output the change is the one at which the requirement just passes",
          "[needed]") {
  const bool upwards = GENERATE(true, false);
  const double sign = upwards ? 1 : -1;
  const auto output = [sign](double a, double b, double) { return sign * (3 * a - 0.5 * b); };
  const InventedRuns sample(4000, 1, output);
  Requirement requirement = limited(3);
  if (!upwards) requirement.max.reset(), requirement.min = -3;
  REQUIRE(judge(requirement, sample.results()).decision == Decision::fail);
  for (const MovedDraws& moved : {a_shifted, a_scaled, both_scaled}) {
    const auto change =
        needed_of(NeededFor::limit, requirement, sample.results(), {moved}).front().value();
    for (const auto& [beyond, decision] :
         {std::pair(1 + 1e-9, Decision::pass), std::pair(1 - 1e-6, Decision::fail)}) {
      const double base = moved.scaled ? 1 : 0, made = base + beyond * (change.change - base);
      const auto moved_to = [&](double x) { return moved.scaled ? x * made : x + made; };
      InventedRuns after = sample;
      for (std::size_t i = 0; i < after.y.size(); ++i)
        after.y[i] = output(moved_to(sample.a[i]),
                            moved.columns.size() > 1 ? moved_to(sample.b[i]) : sample.b[i], 0);
      CHECK(judge(requirement, after.results()).decision == decision);
    }
  }
}

TEST_CASE("the change of a linear output with noise is that of its normal law", "[needed]") {
  // y = 3 a − 2 b + 0.3 z: 99 % stay below 1 + 2.326 √(0.3² + 0.4² + 0.3²) = 2.356, so a must fall by (2.356 − 2)/3
  const int n = 200'000;
  const InventedRuns sample(n, 2,
                            [](double a, double b, double z) { return 3 * a - 2 * b + 0.3 * z; });
  const double spread = std::sqrt(0.34), z = normal_quantile(0.99);
  // the order statistic lies within the binomial band of 1 % and the verdict's own confidence
  const double density = std::exp(-z * z / 2) / std::sqrt(2 * 3.14159265358979),
               band_of_t = 7 * spread * std::sqrt(0.01 * 0.99 / n) / density / 3;
  const auto found =
      needed_of(NeededFor::limit, limited(2), sample.results(), {a_shifted, a_scaled}).front();
  REQUIRE(found);
  const double expected = (2 - (1 + z * spread)) / 3;
  CHECK(found->change == Approx(expected).margin(band_of_t));
  CHECK(*found->bounds.lower < found->change);
  CHECK(*found->bounds.upper > found->change);
  CHECK(*found->bounds.upper - *found->bounds.lower < 0.05 * std::abs(expected));
  CHECK(found->now == Approx(1).margin(1e-3));
  CHECK(!found->is_beyond());
  CHECK(found->of_broken > found->of_others); // runs beyond the limit have a larger a
}

TEST_CASE("the bounds of a slope cover it, and a draw without effect has no change", "[needed]") {
  int covered = 0, seen = 0;
  constexpr int samples = 200;
  for (int s = 0; s < samples; ++s) {
    const InventedRuns sample(300, static_cast<std::uint64_t>(100 + s),
                              [](double a, double, double z) { return a + 0.1 * z; });
    const auto found = needed_of(NeededFor::limit, limited(1.2), sample.results(),
                                 {a_shifted, MovedDraws{{1}, false}});
    REQUIRE(found[0]);
    // with slope 1 the change is the limit less the order statistic, which the estimate scales by 1/b
    std::vector<double> y = sample.y;
    std::ranges::sort(y, std::ranges::greater{});
    const long may = judge(limited(1.2), sample.results()).allowed.value();
    const double exact = 1.2 - y[static_cast<std::size_t>(may)];
    covered += *found[0]->bounds.lower <= exact && exact <= *found[0]->bounds.upper ? 1 : 0;
    seen += found[1] ? 1 : 0;
  }
  CHECK(covered / static_cast<double>(samples) == Approx(0.95).margin(band(0.95, samples)));
  CHECK(seen / static_cast<double>(samples) ==
        Approx(0.025).margin(band(0.025, samples))); // two of them
}

TEST_CASE("a wing that deploys above a threshold needs the shift of its normal law", "[needed]") {
  // stalls where 2 a − b + 0.1 z < 0.6: Φ((0.6 − 1)/σ), σ = √(0.2² + 0.2² + 0.1²) = 0.3
  InventedRuns sample(40'000, 3, [](double a, double b, double z) { return 2 * a - b + 0.1 * z; });
  for (std::size_t i = 0; i < sample.y.size(); ++i)
    if (sample.y[i] < 0.6) sample.status[i] = Status::stalled;
  const auto stalled = static_cast<double>(std::ranges::count(sample.status, Status::stalled));
  CHECK(stalled / 40'000 == Approx(0.0912).margin(0.006));
  const auto found = needed_of(NeededFor::deployment, deploying(0.98), sample.results(),
                               {a_shifted, MovedDraws{{1}, false}, a_scaled});
  // to 2 % less the margin of the verdict: 0.4 + 2 t = 0.3 · 2.05…2.09
  for (const auto& [place, slope] : {std::pair(0, 2.0), std::pair(1, -1.0)}) {
    REQUIRE(found[place]);
    const double expected = (0.3 * normal_quantile(0.98) - 0.4) / slope;
    CHECK(found[place]->change == Approx(expected).epsilon(0.1));
    CHECK(found[place]->bounds.lower < found[place]->bounds.upper);
  }
  CHECK(found[2]->change - 1 == Approx(found[0]->change).epsilon(0.01)); // the mean of a is 1
  CHECK(found[0]->of_broken < found[0]->of_others);
  CHECK(found[1]->of_broken > found[1]->of_others);
}

TEST_CASE("a change beyond the values drawn says so", "[needed]") {
  const InventedRuns sample(2000, 4, [](double a, double b, double) { return 3 * a - 2 * b; });
  const auto near = needed_of(NeededFor::limit, limited(1.7), sample.results(), {a_scaled}).front(),
             far = needed_of(NeededFor::limit, limited(-1), sample.results(), {a_scaled}).front();
  const auto [low, high] = std::ranges::minmax(sample.a);
  double mean = 0;
  for (const double a : sample.a) mean += a / 2000;
  CHECK(near->least == Approx(low / mean));
  CHECK(near->most == Approx(high / mean));
  CHECK(!near->is_beyond());
  CHECK(far->is_beyond());
}

TEST_CASE("there is no estimate of too few runs, of entangled draws, or where every run stalls",
          "[needed]") {
  const auto output = [](double a, double b, double) { return 3 * a - 2 * b; };
  const auto estimate = [](NeededFor what, const Requirement& requirement,
                           const InventedRuns& sample) {
    const Results results = sample.results();
    const std::vector<MovedDraws> moved{a_scaled};
    return needed_changes(what, judge(requirement, results), results, {}, moved, 0.95);
  };
  CHECK(!estimate(NeededFor::limit, limited(1), InventedRuns(12, 5, output))); // 13 needed
  CHECK(estimate(NeededFor::limit, limited(1), InventedRuns(13, 5, output)));
  InventedRuns entangled(500, 6, output);
  for (std::size_t i = 0; i < entangled.b.size(); ++i) entangled.b[i] = 2 * entangled.a[i];
  CHECK(!estimate(NeededFor::limit, limited(1), entangled));
  InventedRuns stalled(500, 7, output);
  stalled.status.assign(500, Status::stalled);
  CHECK(!estimate(NeededFor::limit, limited(1), stalled));
  CHECK(!estimate(NeededFor::deployment, deploying(0.99), stalled));
}
