#include "montecarlo/report/text/trajectory.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <sstream>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("a trajectory has a row for every sample, with all digits") {
  const Folder folder;
  const auto path = folder.path() / "trajectory.csv";
  const Scene scene = read_scene_file(three_panel_file());
  Integration integration;
  integration.t_end = 5;
  std::vector<Sample> samples;
  {
    TrajectoryWriter writer(path, scene);
    const Observer write = writer.observer();
    (void)Deployment().run(scene, integration, {}, [&](const Sample& sample) {
      samples.push_back(sample);
      write(sample);
    });
    writer.finish();
  }
  std::ifstream in(path);
  CsvReader reader(in, "trajectory.csv");
  REQUIRE(reader.next());
  CHECK(reader.cells() == std::vector<std::string>{"t", "root.angle", "root.rate", "root.moment",
                                                   "mid.angle", "mid.rate", "mid.moment",
                                                   "tip.angle", "tip.rate", "tip.moment", "kinetic",
                                                   "potential", "total"});
  for (const Sample& sample : samples) {
    REQUIRE(reader.next());
    const auto& cells = reader.cells();
    REQUIRE(cells.size() == 13);
    CHECK(std::stod(cells[0]) == sample.t);
    CHECK(std::stod(cells[4]) == sample.angles[1]);
    CHECK(std::stod(cells[8]) == sample.rates[2]);
    CHECK(std::stod(cells[3]) == sample.moments[0]);
    CHECK(std::stod(cells[12]) == sample.kinetic + sample.potential);
  }
  CHECK_FALSE(reader.next());
  CHECK(samples.back().t == 5);
}

TEST_CASE("a trajectory that cannot be written is refused before the run") {
  const Folder folder;
  const auto path = folder.path() / "no" / "trajectory.csv";
  CHECK(message_of([&] {
          TrajectoryWriter writer(path, {});
          return 0;
        }) ==
        path.string() + ": found No such file or directory, expected a file that can be written");
}

TEST_CASE("a trajectory of any length has each row once, in order") {
  const Folder folder;
  const auto path = folder.path() / "trajectory.csv";
  const Scene scene = read_scene_file(three_panel_file());
  Sample sample{};
  (void)Deployment().run(scene, {}, {}, [&](const Sample& each) { sample = each; });
  constexpr int rows = 5000; // several blocks of output
  {
    TrajectoryWriter writer(path, scene);
    const Observer write = writer.observer();
    for (int k = 0; k < rows; ++k) {
      sample.t = k / 3.0;
      write(sample);
    }
    writer.finish();
  }
  std::ifstream in(path);
  CsvReader reader(in, "trajectory.csv");
  REQUIRE(reader.next());
  for (int k = 0; k < rows; ++k) {
    REQUIRE(reader.next());
    REQUIRE(std::stod(reader.cells()[0]) == k / 3.0);
  }
  CHECK_FALSE(reader.next());
}
