#include "core/peaks/maximum.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

using namespace wingspread;

namespace {

using Function = std::function<double(double)>;

struct Found {
  Sampled<double> best;
  double vertex;
  int calls;
};

Found search(const Function& f) {
  std::array<double, 5> samples{};
  std::size_t best = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    samples[k] = f(static_cast<double>(k) / 4);
    if (samples[k] > samples[best]) best = k;
  }
  Found found{{}, 0, 0};
  std::tie(found.best, found.vertex) = maximum_near(samples, best, [&](const double& s) {
    ++found.calls;
    return f(s);
  });
  return found;
}

} // namespace

TEST_CASE("a maximum inside a step is found from few more points than its samples") {
  oracle::Draws draws(7);
  double worst = 0;
  int calls = 0;
  constexpr int trials = 2000;
  for (int trial = 0; trial < trials; ++trial) {
    const double where = draws.uniform(0.02, 0.98), quick = draws.uniform(0.3, 2.5),
                 skew = draws.uniform(-0.5, 0.5);
    const Function f = [&](double s) { // its one maximum in the step is at `where`
      const double z = s - where;
      return 10 + std::cos(quick * z) * std::exp(-skew * skew * z * z) + 0.1 * skew * z * z * z;
    };
    const Found found = search(f);
    CAPTURE(where, quick, skew);
    CHECK(std::abs(found.vertex - where) < 1e-6);
    worst = std::max(worst, f(where) - f(found.vertex));
    calls += found.calls;
  }
  CHECK(worst < 1e-12);
  CAPTURE(calls);
  CHECK(calls < 6 * trials);
}

TEST_CASE("a maximum at an end of a step stays there") {
  for (const double way : {-1.0, 1.0}) {
    const Found found = search([&](double s) { return std::exp(way * s); });
    CHECK(found.vertex == (way > 0 ? 1 : 0));
    CHECK(found.best.value == (way > 0 ? std::exp(1.0) : 1));
  }
  // beside an end, where the end's sample is the largest
  const Found beside = search([](double s) { return -std::pow(s - 0.03, 2); });
  CHECK(beside.vertex == Approx(0.03).margin(1e-5));
}

TEST_CASE("a kink, a plateau and a number that is none end the search for a maximum") {
  const Found kink = search([](double s) { return -std::abs(s - 0.6); });
  CHECK(kink.best.s == Approx(0.6).margin(1e-4));
  const Found plateau = search([](double) { return 3.0; });
  CHECK(plateau.best.value == 3);
  const Found valley = search([](double s) { return std::pow(s - 0.5, 2); });
  CHECK(valley.best.value == 0.25);
  const Found nothing = search([](double s) { return s > 0.3 ? std::nan("") : s; });
  CHECK(nothing.calls < 50);
}

TEST_CASE(
    "where nine samples say that a function rises to the step's end, the search finds the end") {
  oracle::Draws draws(8);
  int risen = 0;
  constexpr int trials = 4000;
  for (int trial = 0; trial < trials; ++trial) {
    const double where = draws.uniform(0.5, 1.5), quick = draws.uniform(0.3, 12);
    const double ripple = draws.chance(0.5) ? draws.log_uniform(1e-9, 1e-1) : 0;
    const Function f = [&](double s) {
      const double z = s - where;
      return 10 + std::cos(quick * z) + ripple * std::sin(40 * s);
    };
    std::array<double, 9> samples{};
    std::size_t best = 0;
    for (std::size_t k = 0; k < samples.size(); ++k) {
      samples[k] = f(static_cast<double>(k) / 8);
      if (samples[k] > samples[best]) best = k;
    }
    const Sampled<double> found = maximum_near(samples, best, f).first;
    const bool at_end = found.s == 1 && found.value == samples.back();
    CAPTURE(where, quick, ripple, found.s);
    CHECK(rises_to_end(samples, f) == at_end);
    risen += at_end ? 1 : 0;
  }
  CHECK(risen > trials / 8);
  CHECK(risen < trials / 2);
}

// Between the last two samples a function may rise, fall and rise again. Then its end lies above all samples, and the
// search may find more inside.
TEST_CASE("where a function is said to rise to the step's end, the search finds no more inside, "
          "though it wiggles between the samples") {
  oracle::Draws draws(9);
  int risen = 0, hidden = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const double slope = draws.uniform(0.1, 2), bend = draws.uniform(-2, 1);
    const double ripple = draws.log_uniform(1e-3, 1e-1), quick = draws.uniform(30, 250),
                 phase = draws.uniform(0, 6.3);
    const Function f = [&](double s) {
      return 10 + s * (slope + bend * s) + ripple * std::sin(quick * s + phase);
    };
    std::array<double, 9> samples{};
    for (std::size_t k = 0; k < samples.size(); ++k) samples[k] = f(static_cast<double>(k) / 8);
    const bool rises = rises_to_end(samples, f);
    if (*std::max_element(samples.begin(), samples.end()) > samples.back()) continue;
    const Sampled<double> found = maximum_near(samples, samples.size() - 1, f).first;
    CAPTURE(slope, bend, ripple, quick, phase, found.s);
    if (rises) CHECK(found.value == samples.back());
    risen += rises, hidden += found.value > samples.back();
  }
  CHECK(risen > 1000);
  CHECK(hidden > 1000);
}
