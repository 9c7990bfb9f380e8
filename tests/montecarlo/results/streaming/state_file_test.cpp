// Files whose checksum is right and whose content no program of this version wrote.
#include "montecarlo/results/streaming/exact_sum.hpp"
#include "montecarlo/results/streaming/state_file.hpp"
#include "montecarlo/results/streaming/value_counts.hpp"

#include <catch2/catch.hpp>

#include <functional>

using namespace wingspread;

namespace {

StateReader reader_of(const std::function<void(StateWriter&)>& write) {
  StateWriter to;
  write(to);
  return {std::move(to).finish(), "file"};
}

/// Digits first … last − 1 of a sum.
StateReader sum_of_digits(std::uint8_t first, std::uint8_t last) {
  return reader_of([&](StateWriter& to) {
    to.put(false);
    to.put(first);
    to.put(last);
    for (int i = 0; i < 300; ++i) to.put(std::int64_t{1});
  });
}

/// Counts with these pages, each of 256 ones, where so many are announced.
StateReader counts_of_pages(const std::vector<std::uint32_t>& pages, std::uint64_t announced) {
  return reader_of([&](StateWriter& to) {
    to.put(std::int32_t{-10});
    to.put(0.0);
    to.put(std::int64_t{2}); // zeros
    to.put(announced);
    for (const std::uint32_t page : pages) {
      to.put(page);
      for (int i = 0; i < 256; ++i) to.put(std::int64_t{1});
    }
  });
}

} // namespace

TEST_CASE("a sum with digits beyond its own is damaged") {
  for (const auto& [first, last] : {std::pair(0, 0), {0, 67}, {66, 67}, {67, 67}, {3, 5}}) {
    StateReader from =
        sum_of_digits(static_cast<std::uint8_t>(first), static_cast<std::uint8_t>(last));
    ExactSum sum;
    CHECK_NOTHROW(sum.read(from));
  }
  for (const auto& [first, last] : {std::pair(0, 68), {0, 255}, {67, 68}, {1, 0}, {67, 66}}) {
    CAPTURE(first, last);
    StateReader from =
        sum_of_digits(static_cast<std::uint8_t>(first), static_cast<std::uint8_t>(last));
    ExactSum sum;
    CHECK_THROWS_WITH(sum.read(from), Catch::StartsWith("file: ") && Catch::Contains("damaged") &&
                                          Catch::Contains("a sum"));
  }
}

TEST_CASE("counts with a page twice, too many or beyond the last one are damaged") {
  const auto read = [](StateReader from) {
    ValueCounts counts{Grid{}};
    counts.read(from);
    CHECK(from.at_end());
    long total = 0;
    for (const auto& bin : counts.bins()) total += bin.count;
    return total;
  };
  CHECK(read(counts_of_pages({}, 0)) == 2);
  CHECK(read(counts_of_pages({0, 4}, 2)) == 2 + 2 * 256);
  CHECK_THROWS_WITH(read(counts_of_pages({4, 4}, 2)), Catch::Contains("pages of counts"));
  CHECK_THROWS_WITH(read(counts_of_pages({1u << 31}, 1)), Catch::Contains("pages of counts"));
  CHECK_THROWS_WITH(read(counts_of_pages({0, 4}, 3)), Catch::Contains("as many items"));
  CHECK_THROWS_WITH(read(counts_of_pages({0, 4}, ~std::uint64_t{0})),
                    Catch::Contains("as many items"));
}

TEST_CASE("a file that ends too early is damaged, and one that ends in time is not") {
  const auto four = [](StateWriter& to) {
    to.put(std::uint64_t{3});
    for (const char c : {'a', 'b', 'c'}) to.put(c);
  };
  CHECK(reader_of(four).get_text() == "abc");
  CHECK(reader_of(four).get_count(1) == 3);
  CHECK_THROWS_WITH(reader_of(four).get_count(2), Catch::Contains("as many items"));
  StateReader from = reader_of(four);
  CHECK(from.get<std::uint64_t>() == 3);
  CHECK_THROWS_WITH(from.get<float>(), Catch::Contains("more bytes"));
  CHECK_FALSE(from.at_end());
  for (const char c : {'a', 'b', 'c'}) CHECK(from.get<char>() == c);
  CHECK(from.at_end());
  CHECK_THROWS_WITH(from.get<char>(), Catch::Contains("more bytes"));
  CHECK_THROWS_WITH(StateReader("1234567", "file"), Catch::Contains("checksum"));
  CHECK(reader_of([](StateWriter&) {}).at_end());
}
