#include "distributions/continuous_law.hpp"
#include "montecarlo/analyses/sensitivity/needed_change.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/normal.hpp>
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

TEST_CASE("of a linear output the edge is where the requirement just passes", "[needed]") {
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
         {std::pair(1 + 1e-6, Decision::pass), std::pair(1 - 1e-6, Decision::fail)}) {
      const double base = moved.scaled ? 1 : 0, made = base + beyond * (change.edge - base);
      const auto moved_to = [&](double x) { return moved.scaled ? x * made : x + made; };
      InventedRuns after = sample;
      for (std::size_t i = 0; i < after.y.size(); ++i)
        after.y[i] = output(moved_to(sample.a[i]),
                            moved.columns.size() > 1 ? moved_to(sample.b[i]) : sample.b[i], 0);
      CHECK(judge(requirement, after.results()).decision == decision);
    }
  }
}

namespace {

/// Outputs whose slope with a falls off, stays and grows towards smaller a, and whose spread depends on a.
double curved(int kind, double a, double b, double z) {
  const double x = a - 1;
  switch (kind) {
  case 0:
    return 3 * x + 8 * x * x - 0.5 * b + 0.05 * z; // flat at a = 0.81
  case 1:
    return 3 * x - 0.5 * b + 0.05 * z;
  case 2:
    return 3 * x - 6 * x * x - 0.5 * b + 0.05 * z;
  default:
    return (1 + 2 * x) * (2 - b) + 0.02 * z;
  }
}

} // namespace

TEST_CASE("a change that is called known passes in new runs, for quadratic outputs", "[needed]") {
  const int kind = GENERATE(0, 1, 2, 3);
  constexpr int samples = 40;
  int known = 0, passed = 0;
  for (int s = 0; s < samples; ++s) {
    const auto seed = static_cast<std::uint64_t>(1000 * kind + 2 * s);
    const auto output = [&](double a, double b, double z) { return curved(kind, a, b, z); };
    const InventedRuns sample(2000, seed, output);
    std::vector<double> sorted = sample.y;
    std::ranges::sort(sorted);
    const Requirement requirement = limited(sorted[1930]); // 69 runs break it
    const auto found =
        needed_of(NeededFor::limit, requirement, sample.results(), {a_scaled}).front();
    if (!found || !found->known) continue;
    ++known;
    CHECK(*found->bounds.lower == found->change); // downwards
    CHECK(*found->bounds.upper >= found->edge);
    CHECK(found->edge >= found->change);
    const InventedRuns after(2000, seed + 1, [&](double a, double b, double z) {
      return curved(kind, found->change * a, b, z);
    });
    passed += judge(requirement, after.results()).decision == Decision::pass ? 1 : 0;
  }
  INFO("of kind " << kind << ": " << passed << " of " << known);
  if (kind > 0) CHECK(known > samples / 2);
  CHECK(passed >= 0.975 * known - 4 * std::sqrt(0.025 * 0.975 * known));
}

TEST_CASE("the bounds hold the edge, and a draw without effect has no change", "[needed]") {
  int covered = 0, seen = 0, found_edges = 0;
  constexpr int samples = 200;
  for (int s = 0; s < samples; ++s) {
    const InventedRuns sample(600, static_cast<std::uint64_t>(100 + s),
                              [](double a, double, double z) { return a + 0.1 * z; });
    const auto found = needed_of(NeededFor::limit, limited(1.15, 0.95), sample.results(),
                                 {a_shifted, MovedDraws{{1}, false}});
    seen += found[1] ? 1 : 0;
    if (!found[0] || !found[0]->known) continue;
    ++found_edges;
    // a + t + 0.1 z ≤ 1.15 in the share m/n of new runs
    const double share =
                     static_cast<double>(*judge(limited(1.15, 0.95), sample.results()).allowed) /
                     600,
                 exact = 0.15 - std::sqrt(0.02) * normal_quantile(1 - share);
    covered += *found[0]->bounds.lower <= exact && exact <= *found[0]->bounds.upper ? 1 : 0;
  }
  CHECK(found_edges > samples / 2);
  CHECK(covered >= 0.95 * found_edges);
  CHECK(seen <= samples * (0.025 + band(0.025, samples))); // two of them share 5 %
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
    CHECK(found[place]->edge == Approx(expected).epsilon(0.1));
    CHECK(std::abs(found[place]->change) >= std::abs(found[place]->edge));
  }
  // A factor of a multiplies its spread too: 0.4 + 2 t = 2.05 … 2.09 √(0.2² (1 + t)² + 0.2² + 0.1²).
  const double t = found[2]->edge - 1, sigma = std::hypot(0.2 * (1 + t), 0.2, 0.1);
  CHECK((0.4 + 2 * t) / sigma ==
        Approx((0.4 + 2 * found[0]->edge) / 0.3).epsilon(0.005)); // as the shift
  CHECK(t > 1.1 * found[0]->edge);
  CHECK(found[0]->of_broken < found[0]->of_others);
  CHECK(found[1]->of_broken > found[1]->of_others);
}

// A factor multiplies the spread of a draw too: N(1, 0.1) times c falls below 0.9 with Φ((0.9/c − 1)/0.1).
TEST_CASE("a factor that is called enough lets new runs deploy, however many there are",
          "[needed]") {
  const auto [runs, sigma, probability] = GENERATE(table<int, double, double>(
      {{2000, 0.1, 0.95}, {5000, 0.1, 0.99}, {10'000, 0.1, 0.99}, {1000, 0.15, 0.9}}));
  constexpr int samples = 20;
  double passes = 0;
  int known = 0;
  for (std::uint64_t seed = 0; seed < samples; ++seed) {
    InventedRuns sample(runs, 50 + seed, [](double a, double, double) { return a; });
    for (std::size_t i = 0; i < sample.a.size(); ++i) {
      sample.a[i] = 1 + sigma / 0.1 * (sample.a[i] - 1);
      if (sample.a[i] < 0.9) sample.status[i] = Status::stalled;
    }
    const Verdict verdict = judge(deploying(probability), sample.results());
    const auto change =
        needed_of(NeededFor::deployment, deploying(probability), sample.results(), {a_scaled})[0];
    REQUIRE(change);
    if (!change->known) continue;
    ++known;
    const boost::math::normal law(1, sigma);
    const double fails = cdf(law, 0.9 / change->change);
    passes += cdf(boost::math::binomial(runs, fails), static_cast<double>(*verdict.allowed));
  }
  CAPTURE(runs, sigma, probability, known);
  CHECK(known >= samples / 2);
  CHECK(passes / known > 0.9);
}

TEST_CASE("a rare weak value among equal ones is no normal law: no change is promised",
          "[needed]") {
  for (const double weak : {0.3, 0.9}) {
    InventedRuns sample(2000, 5, [](double a, double, double) { return a; });
    for (std::size_t i = 0; i < sample.a.size(); ++i) {
      sample.a[i] = i % 33 == 0 ? weak : 1;
      if (i % 33 == 0) sample.status[i] = Status::stalled;
    }
    CHECK_FALSE(
        needed_of(NeededFor::deployment, deploying(0.985), sample.results(), {a_scaled})[0]);
    if (weak > 0.5) continue;
    // Springs of other strength beside them do not fill the gap.
    for (std::size_t i = 0; i < sample.a.size(); ++i)
      if (i % 33 != 0) sample.a[i] = 1 + 0.2 * (sample.b[i] - 1);
    CHECK_FALSE(
        needed_of(NeededFor::deployment, deploying(0.985), sample.results(), {a_scaled})[0]);
  }
}

TEST_CASE("beyond the values drawn, and where wings drawn there stall, no change is known",
          "[needed]") {
  const auto output = [](double a, double b, double) { return 3 * a - 2 * b; };
  InventedRuns sample(4000, 4, output);
  const auto change = [&](double max) {
    return needed_of(NeededFor::limit, limited(max), sample.results(), {a_scaled}).front();
  };
  const auto near = change(2);
  REQUIRE(near);
  CHECK(near->known);
  CHECK(near->beyond_runs >= 10);
  CHECK(near->beyond_undeployed == 0);
  const auto [low, high] = std::ranges::minmax(sample.a);
  CHECK(near->least == Approx(low / near->now));
  CHECK(near->most == Approx(high / near->now));
  CHECK(near->change > near->least);
  CHECK(!change(-1)); // every a that was drawn is too large
  for (std::size_t i = 0; i < sample.a.size(); ++i)
    if (sample.a[i] < 0.84) sample.status[i] = Status::stalled; // the limit counts 5 % more then
  const Results results = sample.results();
  // of 99 % that must deploy and keep to the limit some 80 % deploy beyond the change
  const auto stalling = needed_of(NeededFor::limit, limited(2), results, {a_scaled}).front();
  REQUIRE(stalling);
  CHECK(stalling->edge > 0.9);
  CHECK(static_cast<double>(stalling->beyond_undeployed) >
        0.1 * static_cast<double>(stalling->beyond_runs));
  CHECK_FALSE(stalling->known);
  CHECK_FALSE(stalling->bounds.lower);
  const auto far = needed_of(NeededFor::limit, limited(1.75, 0.9), results, {a_scaled}).front();
  REQUIRE(far);
  CHECK_FALSE(far->known);
  CHECK_FALSE(far->bounds.lower);
  CHECK(far->bounds.upper);
}

// Every tenth run with a below 0.9 stalls, and no other: of the runs with so small a b far fewer.
TEST_CASE("of draws that move together that one is counted beyond which most wings stall",
          "[needed]") {
  const auto output = [](double a, double b, double) { return 3 * a + 3 * b; };
  for (const bool is_first : {true, false}) { // of the two draws that which stalls
    InventedRuns sample(4000, 4, output);
    for (std::size_t i = 0; i < sample.a.size(); i += 10)
      if ((is_first ? sample.a : sample.b)[i] < 0.9) sample.status[i] = Status::stalled;
    const std::vector<double>& stalling = is_first ? sample.a : sample.b;
    for (const MovedDraws& moved : {both_scaled, MovedDraws{{1, 0}, true}}) {
      const auto found =
          needed_of(NeededFor::limit, limited(6.5, 0.9), sample.results(), {moved}).front();
      REQUIRE((found && found->known));
      double sum = 0, deployed = 0; // the mean is that of the wings that deploy
      for (std::size_t i = 0; i < stalling.size(); ++i)
        if (sample.status[i] == Status::deployed) sum += stalling[i], ++deployed;
      long runs = 0, stalled = 0;
      for (std::size_t i = 0; i < stalling.size(); ++i) {
        if (stalling[i] > found->change * sum / deployed) continue;
        ++runs, stalled += sample.status[i] == Status::stalled ? 1 : 0;
      }
      CHECK(stalled > 0);
      CHECK(found->beyond_runs == runs);
      CHECK(found->beyond_undeployed == stalled);
    }
  }
}

// Beyond the change lie more runs by b, which varies more: more of them stall, but a smaller share.
TEST_CASE("of draws that move together that one counts of which the larger share stalls",
          "[needed]") {
  const auto output = [](double a, double b, double) { return 3 * a + 3 * b; };
  InventedRuns sample(4000, 4, output);
  for (std::size_t i = 0; i < sample.a.size(); ++i)
    if ((i % 15 == 0 && sample.a[i] < 0.95) || (i % 40 == 7 && sample.b[i] < 0.95))
      sample.status[i] = Status::stalled;
  for (const MovedDraws& moved : {both_scaled, MovedDraws{{1, 0}, true}}) {
    const auto found =
        needed_of(NeededFor::limit, limited(6.5, 0.9), sample.results(), {moved}).front();
    REQUIRE((found && found->known));
    const auto beyond = [&](const std::vector<double>& draws) {
      double sum = 0, deployed = 0;
      for (std::size_t i = 0; i < draws.size(); ++i)
        if (sample.status[i] == Status::deployed) sum += draws[i], ++deployed;
      std::pair<long, long> counts{0, 0}; // runs, those that stalled
      for (std::size_t i = 0; i < draws.size(); ++i)
        if (draws[i] <= found->change * sum / deployed)
          ++counts.first, counts.second += sample.status[i] == Status::stalled ? 1 : 0;
      return counts;
    };
    const auto [runs, stalled] = beyond(sample.a);
    const auto [more_runs, more_stalled] = beyond(sample.b);
    REQUIRE(more_stalled > stalled);
    REQUIRE(stalled * more_runs > more_stalled * runs);
    CHECK(found->beyond_runs == runs);
    CHECK(found->beyond_undeployed == stalled);
  }
}

TEST_CASE("too few runs never promise a change", "[needed]") {
  // of 300 runs none may break 99 % at 90 %, so no number of seen ones is few enough
  const InventedRuns sample(300, 9, [](double a, double, double z) { return a + 0.1 * z; });
  const auto found =
      needed_of(NeededFor::limit, limited(1.3), sample.results(), {a_scaled}).front();
  CHECK_FALSE((found && found->known));
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
