#include "core/peaks/peak.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

using namespace wingspread;

TEST_CASE("a peak keeps the first time of its largest finite value") {
  PeakOf<double> peak;
  peak.raise(2, 0.5), peak.raise(3, 1), peak.raise(3, 2), peak.raise(1, 3);
  peak.raise(std::numeric_limits<double>::infinity(), 4);
  peak.raise(std::numeric_limits<double>::quiet_NaN(), 5);
  CHECK(peak.value == 3);
  CHECK(peak.time == 1);
}

TEST_CASE("nine samples bound a swing of up to 14.5 rad wherever its crest lies") {
  oracle::Draws draws(7);
  int at_start = 0, at_end = 0, inside = 0;
  double widest = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const double turned = draws.uniform(0.01, 14.5), phase = draws.uniform(-3.2, 3.2);
    const double shift = draws.uniform(-2, 2);
    const auto swing = [&](double s) { return std::sin(turned * s + phase) + shift; };
    std::array<double, 9> samples;
    for (int k = 0; k <= 8; ++k) samples.at(k) = swing(k / 8.0);
    double most = swing(0), where = 0;
    for (int n = 0; n <= 2000; ++n)
      if (swing(n / 2000.0) > most) most = swing(n / 2000.0), where = n / 2000.0;
    const double bound = most_by_samples(samples);
    CAPTURE(trial, turned, phase, where);
    CHECK(bound >= most - 1e-12);
    CHECK(bound >= *std::ranges::max_element(samples));
    if (turned < 2.6) widest = std::max(widest, bound - most);
    ++(where == 0 ? at_start : where == 1 ? at_end : inside);
  }
  CHECK(std::min({at_start, at_end, inside}) > 100);
  CHECK(widest < 0.03); // of a swing as long as roughness allows
}
