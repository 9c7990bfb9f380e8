#include "montecarlo/foundation/formats/printable.hpp"
#include "montecarlo/model/campaign/cases.hpp"
#include "montecarlo/results/results_folder/cases_folder.hpp"
#include "montecarlo/results/results_folder/merge.hpp"
#include "montecarlo/results/results_folder/parts.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// Makes a shard of these cases of a campaign, as `run --shard --case` does.
void make(const std::filesystem::path& path, const Campaign& campaign, const Shard& shard,
          const std::vector<std::string>& names) {
  const CasesFolder folder(path, campaign, shard, false);
  for (const CaseSpec& spec : chosen_cases(campaign, names))
    (void)run_into(path / spec.name, campaign_of_case(campaign, spec), {.shard = shard});
}

} // namespace

TEST_CASE("the command for a missing shard makes the cases that the others have, and no more",
          "[cases]") {
  using Names = std::vector<std::string>;
  Json json = quick_campaign(6);
  json["cases"] = parse_json(R"([{ "name": "cold", "scale": { "hinges.*.spring.scale": 0.9 } },
                                 { "name": "hot", "scale": { "hinges.*.spring.scale": 1.1 } },
                                 { "name": "as_it_is" }])");
  const Campaign campaign = campaign_of(json);
  for (const Names& names :
       {Names{"cold"}, Names{"cold", "as_it_is"}, Names{"hot"}, Names{"cold", "hot", "as_it_is"}}) {
    const Folder folder;
    make(folder.path() / "a", campaign, {1, 2}, names);
    Names commands;
    try {
      (void)merge_cases({folder.path() / "a"}, folder.path() / "out");
    } catch (const MissingRuns& missing) {
      commands = missing.commands();
    }
    REQUIRE(commands.size() == 1);
    CAPTURE(commands[0]);
    for (const CaseSpec& spec : campaign.cases) {
      const bool made = std::ranges::find(names, spec.name) != names.end();
      const bool named = commands[0].find(" --case " + shell_word(spec.name)) != std::string::npos;
      CHECK(named == (made && names.size() < 3)); // all of them are what is made anyway
    }
  }
}
