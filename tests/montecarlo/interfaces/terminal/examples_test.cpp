#include "montecarlo/interfaces/terminal/examples.hpp"
#include "montecarlo/model/starter/starter.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("every campaign of the studies is an example that can be read on its own") {
  const std::filesystem::path studies = std::filesystem::path(source_folder) / "studies";
  long read = 0;
  for (const auto& entry : std::filesystem::directory_iterator(studies / "campaigns")) {
    const std::string name = entry.path().stem();
    CAPTURE(name);
    const Folder folder;
    const Example example = read_example(name, studies);
    CHECK(example.name == name);
    for (const auto& [file, text] : example.files) (void)folder.write(file.c_str(), text);
    const Campaign alone = read_campaign_file(folder.path() / starter_campaign_file);
    CHECK(alone.resolved == read_campaign_file(entry.path()).resolved);
    ++read;
  }
  CHECK(read >= 12);
}

TEST_CASE("an example is found by the beginning of its name, if that is the only one") {
  const std::filesystem::path studies = std::filesystem::path(source_folder) / "studies";
  CHECK(read_example("yoke", studies).name == "yoke_wing");
  CHECK(read_example("work_precision", studies).name == "work_precision");
  for (const char* name : {"work", "no", ""})
    CHECK_THROWS_WITH(read_example(name, studies),
                      Catch::Contains("one of bending_wings, correlated, ") &&
                          Catch::Contains(", yoke_wing"));
}

TEST_CASE("examples are found beside an installed program and beside a built one") {
  const Folder folder;
  const auto make = [&](const char* path) {
    std::filesystem::create_directories(folder.path() / path);
  };
  CHECK_FALSE(examples_folder(folder.path() / "bin/wingspread"));
  for (const char* path : {"bin", "share/wingspread/examples/scenes"}) make(path);
  CHECK_FALSE(examples_folder(folder.path() / "bin/wingspread"));
  make("share/wingspread/examples/campaigns");
  CHECK(examples_folder(folder.path() / "bin/wingspread").value().filename() == "examples");
  for (const char* path : {"build/release", "studies/scenes", "studies/campaigns"}) make(path);
  CHECK(examples_folder(folder.path() / "build/release/wingspread").value().filename() ==
        "studies");
}
