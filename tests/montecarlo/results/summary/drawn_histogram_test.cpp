// Histograms drawn as text.
#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/results/summary/table.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <sstream>
#include <string>
#include <vector>

using namespace wingspread;

namespace {

std::vector<std::string> drawn_rows(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> rows;
  for (std::string row; std::getline(in, row);) rows.push_back(row);
  return rows;
}

} // namespace

TEST_CASE("a drawn histogram has as many digits as tell its edges apart") {
  for (const auto& [least, width] : std::vector<std::array<double, 2>>{
           {1e15, 0.5}, {1, 1e-8}, {-1, 1e-8}, {1, 4e-16}, {-1e-300, 1e-309}, {0, 1}}) {
    Histogram histogram{{least}, {}};
    for (int i = 1; i <= 4; ++i)
      histogram.edges.push_back(least + i * width), histogram.counts.push_back(i);
    const std::vector<std::string> rows = drawn_rows(draw_histogram("x", "", histogram, 100));
    REQUIRE(rows.size() == 6);
    CAPTURE(least, width);
    for (std::size_t row = 1; row < rows.size(); ++row) {
      CHECK(std::stold(rows[row]) == Approx(histogram.edges[row - 1]).epsilon(1e-5));
      if (row > 1) CHECK(std::stold(rows[row]) > std::stold(rows[row - 1]));
      if (row < 5) CHECK(count_characters(rows[row]) == 100);
    }
  }
}

TEST_CASE("a drawn histogram: one line per bin, its count, and a bar as long as its density") {
  const std::string drawn =
      draw_histogram("root.latch_time", "s", {{0, 1, 2, 4}, {10, 20, 20}}, 64);
  const std::vector<std::string> rows = drawn_rows(drawn);
  REQUIRE(rows.size() == 5);
  CHECK(rows[0] == "root.latch_time, s");
  const auto full = [&](std::size_t row) {
    long count = 0;
    for (std::size_t at = rows[row].find("█"); at != std::string::npos;
         at = rows[row].find("█", at + 1))
      ++count;
    return count;
  };
  CHECK((full(1) == 20 && full(2) == 40 && full(3) == 20));
  for (std::size_t row = 1; row <= 3; ++row) CHECK(count_characters(rows[row]) == 64);
  CHECK(rows[2].ends_with("       20"));
}

TEST_CASE("a drawn histogram puts bins together and loses no count") {
  Histogram histogram{{0}, {}};
  for (int i = 0; i < 50; ++i) {
    histogram.edges.push_back(i + 1);
    histogram.counts.push_back(i);
  }
  const std::vector<std::string> rows = drawn_rows(draw_histogram("x", "", histogram, 80));
  REQUIRE(rows.size() == 1 + 17 + 1); // groups of three
  CHECK(rows[0] == "x");
  long sum = 0;
  for (std::size_t row = 1; row <= 17; ++row)
    sum += std::stol(rows[row].substr(rows[row].rfind(' ') + 1));
  CHECK(sum == histogram.total());
  for (std::size_t row = 1; row <= 17; ++row)
    CHECK(std::stod(rows[row]) == 3 * static_cast<double>(row - 1)); // its lower edge
  CHECK(std::stod(rows[18]) == 50);
  CHECK(draw_histogram("x", "N", {}, 80) == "x, N\n  no values\n");
}
