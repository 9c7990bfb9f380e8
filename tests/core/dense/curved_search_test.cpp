#include "core/dense/curved_search.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

using namespace wingspread;

namespace {

/// size·sin(turns·s + phase) + shift, whose second derivative is size·turns² at most.
struct Wave {
  double size, turns, phase, shift;
  double operator()(double s) const { return size * std::sin(turns * s + phase) + shift; }
  [[nodiscard]] double slope(double s) const { return size * turns * std::cos(turns * s + phase); }
  [[nodiscard]] double rise() const { return size * turns * turns / 8; }
};

} // namespace

TEST_CASE("the first point where a function is positive is found, however narrow the crest") {
  int found = 0;
  for (int k = 0; k < 400; ++k) {
    const double margin = std::pow(10, -8 + 7.0 * (k % 20) / 20); // of the crest over zero
    const Wave wave{1, 3 + 0.05 * k, 4.7 + 0.37 * k, margin - 1};
    const double left = std::numbers::pi / 2 - std::acos(1 - margin); // where it crosses
    const double turn = 2 * std::numbers::pi;
    const double cycles = std::ceil((wave.phase - left) / turn);
    const double expected = (left + cycles * turn - wave.phase) / wave.turns;
    Sampled<double> crest{0, -1e9};
    if (wave(0) > 0) continue;
    const auto root = first_positive(wave, wave(0), wave(1), Bulge<double>{wave.rise()}, 1e-12,
                                     1.0 / (1 << 17), crest);
    CAPTURE(k, margin, expected);
    REQUIRE(root.has_value() == (expected <= 1));
    if (!root) continue;
    ++found;
    CHECK(std::abs(wave(root->s)) < 1e-9);
    CHECK(root->s == Approx(expected).margin(1e-8 + 1e-12 / std::sqrt(margin)));
    CHECK(root->slope == Approx(wave.slope(root->s)).epsilon(0.1));
  }
  CHECK(found > 100);
}

TEST_CASE("the largest value is found, at an end or inside, and none below the floor is sought") {
  int inside = 0;
  for (int k = 0; k < 400; ++k) {
    const Wave wave{2, 0.5 + 0.04 * k, 0.61 * k, 5};
    int calls = 0;
    const auto counted = [&](double s) { return ++calls, wave(s); };
    const Sampled<double> best = largest_of(counted, wave(0), wave(1), Bulge<double>{wave.rise()},
                                            0.0, 1e-12, 1.0 / (1 << 17));
    double expected = std::max(wave(0), wave(1));
    for (int n = 1; n < 2000; ++n) expected = std::max(expected, wave(n / 2000.0));
    CAPTURE(k);
    CHECK(best.value > expected - 1e-10 * wave.rise());
    CHECK(best.value < expected + 2 * std::pow(wave.turns / 4000, 2));
    CHECK(calls < 200); // two crests or three of the same height
    inside += best.s > 0 && best.s < 1;
    calls = 0;
    (void)largest_of(counted, wave(0), wave(1), Bulge<double>{wave.rise()}, 7 + wave.rise() + 1,
                     1e-12, 1.0 / (1 << 17));
    CHECK(calls == 0);
  }
  CHECK(inside > 100);
}

TEST_CASE("samples exclude no crest between them, and exclude those that their parts' bound does") {
  int missed_by_samples = 0, excluded = 0, kept = 0;
  for (int k = 0; k < 4000; ++k) {
    const Wave wave{1, 0.5 + 0.007 * (k % 1000), 0.61 * k, 2};
    std::array<Sampled<double>, 5> samples;
    std::ranges::transform(std::array{0., 0.2, 0.5, 0.7, 1.}, samples.begin(), [&](double s) {
      return Sampled<double>{s, wave(s)};
    });
    double most = 0, sampled = 0;
    for (int n = 0; n <= 1000; ++n) most = std::max(most, wave(n / 1000.0));
    for (const auto& [s, value] : samples) sampled = std::max(sampled, value);
    const double ends = std::max(wave(0), wave(1));
    const double floor = k % 3 == 0 ? 0 : sampled + (k % 3 == 1 ? 0.5 : 1.5) * (most - sampled);
    const bool may = may_crest_between(samples, Bulge<double>{wave.rise()}, floor, 1e-9);
    CAPTURE(k, floor, most, sampled);
    if (most > std::max(ends, floor) + 1e-9) CHECK(may);
    missed_by_samples += may && most > floor && sampled <= std::max(ends, floor);
    // a part of 0.3 rises by at most 0.09 of the rise over the whole
    const bool surely_not = sampled + 0.09 * wave.rise() <= floor;
    if (surely_not) CHECK_FALSE(may);
    excluded += surely_not, kept += may;
  }
  CHECK(std::min({missed_by_samples, excluded, kept}) > 50);
}

TEST_CASE("a search ends, whatever its bound says") {
  const Wave wave{1, 3, 0.4, -2}; // ≤ −1
  for (const Bulge<double>& bulge : {Bulge<double>{1e14}, {0, 1e14}, {0, 0, 3}, {1e300, 1, 2}}) {
    long calls = 0;
    const auto counted = [&](double s) { return ++calls, wave(s); };
    Sampled<double> crest{0, -2};
    CHECK_FALSE(first_positive(counted, wave(0), wave(1), bulge, 1e-12, 1.0 / (1 << 17), crest));
    CHECK(crest.value == Approx(-1).epsilon(1e-9)); // on the way it has seen all there is
    CHECK(largest_of(counted, wave(0), wave(1), bulge, -1e9, 1e-12, 1.0 / (1 << 17)).value ==
          Approx(-1).epsilon(1e-9));
    CHECK(calls < 2 << detail::most_halvings);
  }
}

TEST_CASE("a sample above the floor and both ends is a crest, however close the bound is") {
  oracle::Draws draws(31);
  int crests = 0;
  for (int k = 0; k < 200; ++k) {
    std::array<Sampled<double>, 5> samples{};
    for (int n = 0; n < 5; ++n) samples[n] = {0.25 * n, draws.uniform(0, 1)};
    const double floor = draws.uniform(0, 1.2);
    const double least = std::max({samples.front().value, samples.back().value, floor});
    const bool crest = std::ranges::any_of(
        samples, [&](const Sampled<double>& sample) { return sample.value > least; });
    crests += crest;
    CHECK(may_crest_between(samples, Bulge<double>{0}, floor, 0.0) == crest);
    CHECK(may_crest_between(samples, Bulge<double>{1e-3}, floor, 1e-2) == crest);
  }
  CHECK(crests >= 30);
}
