#include "montecarlo/foundation/statistics/statistics.hpp"
#include "montecarlo/results/streaming/population.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

using namespace wingspread;

namespace {

using Law = std::function<double(std::mt19937_64&)>;

struct DrawnSample {
  std::vector<double> values, sorted;
  Population population;
};

DrawnSample sample_of(const Law& law, long count) {
  std::mt19937_64 random(11);
  std::vector<double> values;
  for (long i = 0; i < count; ++i) values.push_back(law(random));
  Population population(grid_of({values.begin(), values.begin() + std::min(4096L, count)}));
  for (long i = 0; i < count; ++i) population.add(values[static_cast<std::size_t>(i)], i);
  std::vector<double> sorted = values;
  std::ranges::sort(sorted);
  return {values, sorted, std::move(population)};
}

/// Laws that are hard on bins: heavy tails, atoms, two narrow peaks far apart, values of both signs about 0.
const std::vector<std::pair<const char*, Law>> laws{
    {"normal", [](auto& r) { return std::normal_distribution<double>(5, 0.05)(r); }},
    {"Cauchy", [](auto& r) { return std::cauchy_distribution<double>(0, 1)(r); }},
    {"lognormal", [](auto& r) { return std::lognormal_distribution<double>(0, 3)(r); }},
    {"atoms", [](auto& r) { return std::floor(std::uniform_real_distribution<double>(0, 4)(r)); }},
    {"two peaks",
     [](auto& r) { return std::normal_distribution<double>(r() % 3 == 0 ? 5 : 700, 1e-3)(r); }},
    {"mostly 0",
     [](auto& r) { return r() % 10 == 0 ? std::exponential_distribution<double>(1)(r) : 0.0; }},
    {"about 0", [](auto& r) { return std::normal_distribution<double>(0, 1e-9)(r); }},
    {"constant", [](auto&) { return -0.125; }}};

std::string bytes_of(const Population& population) {
  StateWriter to;
  population.write(to);
  return std::move(to).finish();
}

} // namespace

TEST_CASE("population: every order statistic lies where it is said to, with the rank error that is "
          "said") {
  constexpr long count = 100'000;
  for (const auto& [name, law] : laws) {
    CAPTURE(name);
    const DrawnSample sample = sample_of(law, count);
    const RankedPopulation ranked(sample.population);
    CHECK(ranked.min() == sample.sorted.front());
    CHECK(ranked.max() == sample.sorted.back());
    for (long rank = 1; rank <= count; rank += rank < 5000 || rank > 95'000 ? 97 : 331) {
      const double truth = sample.sorted[static_cast<std::size_t>(rank - 1)];
      const OrderStatistic found = ranked.at(rank);
      const bool within = found.lower <= truth && truth <= found.upper &&
                          found.lower <= found.value && found.value <= found.upper;
      // The ranks that the value itself could have among the sorted ones.
      const long first =
          std::ranges::lower_bound(sample.sorted, found.value) - sample.sorted.begin();
      const long last =
          std::ranges::upper_bound(sample.sorted, found.value) - sample.sorted.begin();
      const bool near = first - found.rank_error <= rank && rank <= last + found.rank_error;
      const bool exact = rank > long{kept_extremes} && count - rank >= long{kept_extremes}
                             ? true
                             : found.value == truth && found.rank_error == 0;
      if (!within || !near || !exact)
        FAIL_CHECK("rank " << rank << ": " << truth << " for " << found.value << " in ["
                           << found.lower << ", " << found.upper << "] ± " << found.rank_error);
    }
  }
}

TEST_CASE("population: bins are narrow where values are dense") {
  const DrawnSample sample = sample_of(laws[0].second, 100'000); // normal, standard deviation 0.05
  const RankedPopulation ranked(sample.population);
  for (const long rank : {10'000L, 50'000L, 90'000L}) {
    const OrderStatistic found = ranked.at(rank);
    CHECK(found.upper - found.lower <=
          0.05 / 4000);            // 2^-13 of the pilot's estimate, within a power of two
    CHECK(found.rank_error <= 60); // 100,000 · 0.4/4096 = 10, and what chance adds
  }
}

TEST_CASE(
    "population: an order statistic is as often above the truth as below, in shares of its bin") {
  const DrawnSample sample = sample_of(laws[0].second, 100'000);
  const RankedPopulation ranked(sample.population);
  double sum = 0;
  long bins = 0; // ranks in bins
  for (long rank = 5'000; rank <= 95'000; ++rank) {
    const OrderStatistic found = ranked.at(rank);
    sum += (found.value - sample.sorted[static_cast<std::size_t>(rank - 1)]) /
           (found.upper - found.lower);
    ++bins;
  }
  CHECK(std::abs(sum / static_cast<double>(bins)) < 0.01);
}

TEST_CASE("population: zeros are counted apart, so that a quantile among them is one") {
  const DrawnSample sample = sample_of(laws[5].second, 100'000); // nine of ten are 0
  const OrderStatistic found = RankedPopulation(sample.population).at(50'000);
  CHECK(found.value == 0);
  CHECK(found.rank_error == 0);
}

TEST_CASE("population: the same in any order and however it is shared out") {
  for (const auto& [name, law] : laws) {
    CAPTURE(name);
    const DrawnSample sample = sample_of(law, 20'000);
    const Grid grid = sample.population.counts().grid();
    std::vector<std::size_t> order(sample.values.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::shuffle(order.begin(), order.end(), std::mt19937(5));
    Population first(grid), second(grid);
    for (std::size_t i = 0; i < order.size(); ++i)
      (i < 7001 ? first : second).add(sample.values[order[i]], static_cast<long>(order[i]));
    second.add(first);
    CHECK(bytes_of(second) == bytes_of(sample.population));
    StateReader from(bytes_of(second), "a population");
    Population read{Grid{}};
    read.read(from);
    CHECK(bytes_of(read) == bytes_of(second));
  }
}

TEST_CASE("value counts: a value on an edge counts above it, over all magnitudes") {
  ValueCounts counts(Grid{-3, 5}); // width 1/8 from 5/8 on
  std::vector<double> values{0.625, 0.75, std::nextafter(0.75, 0.0), -1e300, 1e300, -7.5, 1e6};
  for (const double value : values) counts.add(value);
  long seen = 0;
  for (const auto& [lower, upper, below, count] : counts.bins()) {
    CHECK(below == seen);
    CHECK(std::ranges::count_if(values, [&](double v) { return lower <= v && v < upper; }) ==
          count);
    seen += count;
  }
  CHECK(seen == std::ssize(values));
}

TEST_CASE("extremes: of equal values those of the lowest runs") {
  Extremes highest(Extremes::End::highest, 3);
  for (const long run : {5, 9, 1, 7, 3}) highest.add(2, run);
  highest.add(1, 0);
  highest.add(3, 8);
  CHECK(highest.sorted() == std::vector<RunValue>{{3, 8}, {2, 1}, {2, 3}});
}

TEST_CASE("state file: damage is told") {
  StateWriter to;
  to.put(1.5);
  to.put(std::string_view("text"));
  std::string bytes = std::move(to).finish();
  StateReader from(bytes, "file");
  CHECK(from.get<double>() == 1.5);
  CHECK(from.get_text() == "text");
  CHECK(from.at_end());
  bytes[3] = static_cast<char>(bytes[3] ^ 1);
  CHECK_THROWS_WITH(StateReader(bytes, "file"), Catch::StartsWith("file: ") &&
                                                    Catch::Contains("damaged") &&
                                                    Catch::Contains("checksum"));
}
