#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/report/data/page_detail.hpp"
#include "tests/support/source_folder.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace wingspread;

namespace {

/// The numbers of a part of the page, of all sets, and the room that the part has.
struct PartOfPage {
  double numbers, room;
  bool shortened; ///< some list is shorter than in full
  bool at_least;  ///< some list is as short as it gets
};

std::vector<PartOfPage> parts_of_page(const PageExtent& extent, const PageDetail& d) {
  const PageDetail full;
  const auto sets = static_cast<double>(extent.sets), hinges = static_cast<double>(extent.hinges),
             outputs = static_cast<double>(std::min(extent.outputs, d.outputs));
  const auto of = [](std::size_t count) { return static_cast<double>(count); };
  return {
      {sets * outputs * (9 * of(d.bins) + 4 * of(d.knots) + 7 * of(d.convergence_points)), 140'000,
       d.bins < full.bins, d.bins == 10 || d.knots == 17 || d.convergence_points == 6},
      {sets * 3 * hinges * of(d.motions) * of(d.motion_samples), 130'000,
       d.motion_samples < full.motion_samples, d.motions == 2},
      {sets * hinges * (14 * of(d.envelope_times) + of(d.latch_times)), 60'000,
       d.envelope_times < full.envelope_times, d.envelope_times == 12 || d.latch_times == 20},
      {sets * of(d.scatters) * (1024 + 66 + 4 * 400), 45'000, d.scatters < full.scatters,
       d.scatters == 1},
      {sets * outputs * of(d.correlated_draws), 30'000, d.correlated_draws < full.correlated_draws,
       d.correlated_draws == 1},
  };
}

} // namespace

TEST_CASE("a usual wing's page has its lists in full, as long as DATA.md says", "[page]") {
  PageDetail d = page_detail({1, 3, 13});
  CHECK((13 <= d.outputs && d.outputs < 400)); // so many would not leave the lists in full
  d.outputs = page_detail({1, 3, 1000}).outputs;
  const std::string page =
      read_text(std::filesystem::path(source_folder) / "montecarlo/report/page/DATA.md").value();
  const auto number = [](std::size_t count) { return std::to_string(count); };
  for (const std::string& limit :
       {"columns' order, ≤ " + number(d.outputs) + '\n', "B ≤ " + number(d.bins) + ';',
        "K ≤ " + number(d.knots) + ' ', "C ≤ " + number(d.convergence_points) + ',',
        "at most " + number(d.motions) + " per set", "T ≤ " + number(d.motion_samples) + ',',
        "[ ≤ " + number(d.latch_times) + " sorted times ]",
        "strongest pairs, ≤ " + number(d.scatters) + ';',
        "per output ≤ " + number(d.effects) + " draws",
        "≤ " + number(d.correlated_draws) + " × " + number(d.outputs) + ',',
        "≤ " + number(d.parameters) + ", without zeros"}) {
    CAPTURE(limit);
    CHECK(page.find(limit) != std::string::npos);
  }
  CHECK(d.envelope_times == 100);
  CHECK(d.envelope_runs == 200);
}

TEST_CASE("each part of the page fills its room, and no more, where its lists are shortened",
          "[page]") {
  std::size_t shortened = 0;
  for (const PageExtent& extent :
       {PageExtent{2, 6, 40}, PageExtent{3, 10, 66}, PageExtent{4, 13, 90}, PageExtent{6, 8, 60},
        PageExtent{12, 3, 13}, PageExtent{2, 30, 200}}) {
    CAPTURE(extent.sets, extent.hinges, extent.outputs);
    const PageDetail d = page_detail(extent);
    for (const PartOfPage& part : parts_of_page(extent, d)) {
      CAPTURE(part.room, part.numbers);
      if (!part.at_least) CHECK(part.numbers <= part.room);
      if (part.shortened && !part.at_least) CHECK(part.numbers > 0.7 * part.room);
      shortened += part.shortened;
    }
    CHECK(d.parameters == std::clamp<std::size_t>(4500 / extent.sets, 200, 1500));
  }
  CHECK(shortened > 12);
}

// Replaying takes a time that grows with the runs, the sets and the square of the hinges.
TEST_CASE("the more hinges and sets, the fewer runs are made again for the envelopes", "[page]") {
  CHECK(page_detail({1, 6, 1}).envelope_runs == 200);
  CHECK(page_detail({1, 8, 1}).envelope_runs == 125);
  CHECK(page_detail({2, 8, 1}).envelope_runs == 62);
  CHECK(page_detail({2, 40, 1}).envelope_runs == 24);
  CHECK(page_detail({1, 0, 0}).envelope_runs == 200);
}
