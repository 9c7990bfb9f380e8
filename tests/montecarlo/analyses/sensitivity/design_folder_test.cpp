#include "montecarlo/analyses/sensitivity/design_folder.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace wingspread;
using namespace wingspread::test;

namespace {

constexpr long design_rows = 6;

SaltelliDesign design_of(const Json& json) { return {campaign_of(json), design_rows, {}}; }

/// Makes what is left of a design in a folder, and stops after about that many runs.
void make(const std::filesystem::path& path, const SaltelliDesign& design, bool resume,
          long stop_after = 1'000'000) {
  const RunPlan plan = saltelli_plan(design.campaign, design.rows);
  DesignFolderWriter folder(path, design, plan, resume);
  std::atomic<bool> stop = false;
  const long first = std::ssize(folder.results().runs),
             last = saltelli_runs(design.rows, design.campaign.dispersions.size());
  const auto keep = [&](const Batch& batch) {
    folder.add(batch);
    stop = std::ssize(folder.results().runs) >= stop_after;
  };
  (void)ThreadEvaluator({.threads = 2}, stop).make(plan, {first, last}, {keep, true});
}

} // namespace

TEST_CASE("a design that was broken off goes on to the same bytes", "[parallel]") {
  const Folder folder;
  const SaltelliDesign design = design_of(quick_campaign(10));
  make(folder.path() / "whole", design, false);
  make(folder.path() / "parts", design, false, 7);
  std::ofstream(folder.path() / "parts" / design_runs_file, std::ios::app) << "9,deploy";
  make(folder.path() / "parts", design, true);
  CHECK(contents(folder.path() / "parts") == contents(folder.path() / "whole"));

  const SaltelliDesign read = read_design(folder.path() / "whole");
  CHECK(read.rows == design_rows);
  CHECK(stamp_of(read) == stamp_of(design));
  CHECK(is_design_folder(folder.path() / "whole"));
  CHECK(!is_design_folder(folder.path()));
  const RunPlan plan = saltelli_plan(read.campaign, read.rows);
  CHECK(read_design_runs(folder.path() / "whole", plan).results.size() == design_rows * 6);
}

TEST_CASE("a folder of another design, or of anything else, is left alone") {
  const Folder folder;
  const auto path = folder.path() / "design";
  make(path, design_of(quick_campaign(10)), false, 3);
  const auto before = contents(path);
  CHECK_THROWS_WITH(make(path, design_of(quick_campaign(10)), false),
                    Catch::Contains("expected a new or an empty folder (--resume"));
  Json other = quick_campaign(10);
  other["sampling"]["seed"] = 8;
  CHECK_THROWS_WITH(make(path, design_of(other), true),
                    Catch::Contains("design.json: found another design or version"));
  CHECK_THROWS_WITH(make(path, {campaign_of(quick_campaign(10)), design_rows + 1, {}}, true),
                    Catch::Contains("found another design"));
  CHECK(contents(path) == before);
}

TEST_CASE("a design that somebody changed is refused") {
  const Folder folder;
  const auto path = folder.path() / "design";
  make(path, design_of(quick_campaign(10)), false, 1);
  std::string text = *read_text(path / design_file);
  text.replace(text.find("\"samples\": 6"), 12, "\"samples\": 7");
  std::ofstream(path / design_file) << text;
  CHECK_THROWS_WITH(read_design(path), Catch::Contains("/wingspread/hash"));
  std::ofstream(path / design_file) << R"({ "samples": 6 })";
  CHECK_THROWS_WITH(read_design(path), Catch::Contains("campaign"));
}

TEST_CASE("no object of a design has a key that is not read") {
  const Folder folder;
  SaltelliDesign design = design_of(quick_campaign(10));
  design.shard = Shard{2, 3};
  const auto message_for = [&](const Json& json) {
    const auto file = folder.write("design.json", json.dump());
    return message_of([&] { return read_design_file(file); });
  };
  const Json json = parse_json(design_text(design));
  CHECK(message_for(json).empty());
  CHECK(objects_with_unread_keys(json, message_for) == std::vector<std::string>{});
}

TEST_CASE("rows of a design with a gap between them are refused") {
  const Folder folder;
  const auto path = folder.path() / "design";
  const SaltelliDesign design = design_of(quick_campaign(10));
  make(path, design, false);
  const RunPlan plan = saltelli_plan(design.campaign, design.rows);
  std::string text = *read_text(path / design_runs_file);
  const std::size_t fifth = text.find("\n4,") + 1; // after the header: run 4
  text.erase(fifth, text.find('\n', fifth) + 1 - fifth);
  std::ofstream(path / design_runs_file) << text;
  CHECK_THROWS_WITH(read_design_runs(path, plan),
                    Catch::Contains("found run 5, expected run 4, the next one"));
}

TEST_CASE("rows of a design are handed on if they are the folder's own, and others are refused") {
  const Folder folder;
  const auto path = folder.path() / "design";
  const SaltelliDesign design = design_of(quick_campaign(10));
  make(path, design, false);
  const RunPlan plan = saltelli_plan(design.campaign, design.rows);
  const long all = runs_of(design).last;
  for (const long first : {0L, 1L})
    for (const long last : {3L, all - 1, all, all + 1}) {
      CAPTURE(first, last);
      long taken = 0;
      const std::string told = message_of([&] {
        for_each_design_row(path, plan, {first, last}, [&](const ResultRow&) { ++taken; });
      });
      if (first == 0 && last >= all) {
        CHECK((told.empty() && taken == all));
        continue;
      }
      const long outside = first > 0 ? 0 : last;
      CHECK_THAT(told, Catch::EndsWith(fmt::format("found run {}, expected runs from {} up to {}",
                                                   outside, first, last - 1)));
      CHECK(taken == (first > 0 ? 0 : last));
    }
}
