#include "montecarlo/model/campaign/guarantees.hpp"
#include "montecarlo/results/results_folder/replay.hpp"
#include "montecarlo/results/results_folder/results_folder.hpp"
#include "montecarlo/results/results_folder/version.hpp"
#include "montecarlo/results/summary/summary_json.hpp"
#include "montecarlo/results/summary/warnings.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("a stored campaign reads back with its stamp") {
  const Folder folder;
  const Campaign campaign = campaign_of(quick_campaign(10));
  const std::optional<Shard> shard = GENERATE(std::optional<Shard>{}, std::optional(Shard{2, 3}));
  const Stamp stamp = stamp_of(campaign, shard);
  folder.write(campaign_file, campaign_text(campaign, stamp));
  const StoredCampaign stored = read_stored_campaign(folder.path());
  CHECK(stored.stamp == stamp);
  CHECK(stored.stamp.version == version());
  CHECK(stored.stamp.seed == 7);
  CHECK(stored.stamp.hash == campaign_hash(campaign.resolved));
  CHECK(stored.campaign.resolved == campaign.resolved);
  CHECK(campaign_text(stored.campaign, stored.stamp) == campaign_text(campaign, stamp));
  CHECK(stored.runs() == shard_runs(10, shard));
}

TEST_CASE("what is no results folder is refused, with the reason") {
  const Folder folder;
  const std::string path = folder.path().string();
  const auto read = [&] { return read_stored_campaign(folder.path()); };
  CHECK(message_of([&] { return read_stored_campaign(folder.path() / "no"); }) ==
        path + "/no: found no such folder, expected a results folder");
  CHECK(message_of(read) == path + ": found no campaign.json in it, expected a results folder: one "
                                   "that `wingspread run` or `merge` wrote");

  const Campaign campaign = campaign_of(quick_campaign(10));
  const Json good = parse_json(campaign_text(campaign, stamp_of(campaign, Shard{1, 2})));
  const std::string hash = campaign_hash(campaign.resolved);
  const auto [pointer, value, message] = GENERATE(values<Spoiled>(
      {{"/wingspread", "",
        "/wingspread: found nothing, expected what `wingspread run` wrote: version, seed and hash"},
       {"/wingspread", "3",
        "/wingspread: found 3, expected what `wingspread run` wrote: version, seed and hash"},
       {"/wingspread/version", "",
        "/wingspread/version: found nothing, expected a string, the program's version"},
       {"/wingspread/hash", "1",
        "/wingspread/hash: found 1, expected a string, the campaign's hash"},
       {"/wingspread/shard/index", "3", "/wingspread/shard: found 3 of 2, expected 1 ≤ index ≤ of"},
       {"/wingspread/shard/of", "",
        "/wingspread/shard/of: found nothing, expected an integer, ≥ index"}}));
  const auto file = folder.write(campaign_file, spoil(good, {pointer, value, message}).dump());
  CHECK(message_of(read) == file.string() + ": " + message);
}

TEST_CASE("a campaign that was changed after it was run is refused") {
  const Folder folder;
  const Campaign campaign = campaign_of(quick_campaign(10));
  const Json good = parse_json(campaign_text(campaign, stamp_of(campaign, {})));
  const auto change = GENERATE(values<Spoiled>({{"/sampling/seed", "8", ""},
                                                {"/wingspread/seed", "8", ""},
                                                {"/scene/bodies/0/mass", "11", ""}}));
  const auto file = folder.write(campaign_file, spoil(good, change).dump());
  const std::string message = message_of([&] { return read_stored_campaign(folder.path()); });
  CHECK(message.starts_with(file.string() + ": /wingspread/hash: found \""));
  CHECK(message.ends_with("expected a campaign that nobody changed after it was run"));
}

TEST_CASE("a run that is not the folder's is refused") {
  const Folder folder;
  const Campaign campaign = campaign_of(quick_campaign(10));
  (void)run_into(folder.path() / "all", campaign);
  (void)run_into(folder.path() / "part", campaign, {.shard = Shard{2, 2}});
  const auto file = folder.path() / "part" / runs_file;
  std::filesystem::copy_file(folder.path() / "all" / runs_file, file,
                             std::filesystem::copy_options::overwrite_existing);
  CHECK(message_of([&] {
          return read_stored_results(read_stored_campaign(folder.path() / "part"));
        }) == file.string() + ": found run 0, expected runs from 5 up to 9, those of shard 2/2");
}

TEST_CASE("the statistics of the stored rows are those of the rows in memory, byte for byte") {
  const Folder folder;
  const auto path = folder.path() / "r";
  (void)run_into(path, campaign_of(full_campaign(40)));
  const auto before = contents(path);
  CHECK(before.size() == 5);
  const StoredCampaign stored = read_stored_campaign(path);
  for (const char* file : {summary_file, histograms_json_file, histograms_csv_file})
    std::filesystem::remove(path / file);
  const Summary summary = write_statistics(stored, read_stored_results(stored).results);
  CHECK(contents(path) == before);
  long sum = 0;
  for (const StatusShare& share : summary.statuses) sum += share.count;
  CHECK(sum == 40);
}

TEST_CASE("results that lack runs say so in their summary") {
  const Folder folder;
  const auto path = folder.path() / "r";
  const long made = run_into(path, campaign_of(quick_campaign(200)), {.stop_after = 20});
  const Json about = parse_json_file(path / summary_file)["wingspread"];
  CHECK(about["partial"] == Json{{"done", made}, {"of", 200}});
  (void)run_into(path, campaign_of(quick_campaign(200)), {.resume = true});
  CHECK_FALSE(parse_json_file(path / summary_file)["wingspread"].contains("partial"));
}

TEST_CASE("requirements are judged from the folder, and those of a file in their place") {
  const Folder folder;
  const auto path = folder.path() / "r";
  Json json = quick_campaign(300);
  json["requirements"] = parse_json(R"([
    { "output": "root.latch_time", "max": 20, "probability": 0.99, "confidence": 0.9 } ])");
  (void)run_into(path, campaign_of(json));
  const Json judged = parse_json_file(path / summary_file)["requirements"];
  REQUIRE(judged.size() == 1);
  CHECK(judged[0]["verdict"] == "pass");
  StoredCampaign stored = read_stored_campaign(path);
  CHECK(write_requirements(stored.campaign.requirements) == json["requirements"]);
  const auto file = folder.write("q.json", R"([
    { "output": "deployed", "probability": 0.999, "confidence": 0.9 } ])");
  stored.campaign.requirements = read_requirements_file(file, stored.campaign);
  const Summary summary = write_statistics(stored, read_stored_results(stored).results);
  CHECK(summary.requirements.at(0).decision == Decision::undecided);
  folder.write("q.json", R"([ { "output": "root.x", "probability": 0.9, "confidence": 0.9 } ])");
  CHECK(message_of([&] { return read_requirements_file(file, stored.campaign); }) ==
        file.string() +
            ": /0/output: found string \"root.x\", expected an output of the campaign, "
            "or \"deployed\"\n" +
            file.string() +
            ": /0: found neither max nor min, expected one of them (write two requirements for "
            "both)");
}

TEST_CASE("a campaign without a stamp is another tool's, and read in full") {
  const Folder folder;
  Json json = quick_campaign(3);
  json.erase("outputs");
  json["dispersions"][0]["name"] = "overtravel_or_peaks_final"; // a draw is no output
  folder.write(campaign_file, json.dump());
  std::string csv = "status,run,latch_order";
  Campaign campaign = campaign_of(json);
  campaign.outputs.erase(OutputFamily::peaks_final);
  if (GENERATE(true, false)) campaign.outputs.erase(OutputFamily::overtravel); // may be missing
  const ResultNames names = RunPlan(campaign).names();
  for (const auto* list : {&names.outputs, &names.draws})
    for (const std::string& name : *list) csv += "," + name;
  for (const char* run : {"0", "1", "2"}) { // the last line without an end
    csv += std::string("\r\ndeployed,") + run + ",root>mid>tip";
    for (std::size_t i = 0; i < names.outputs.size() + names.draws.size(); ++i) csv += ",1.5";
  }
  folder.write(runs_file, csv);
  CHECK(message_of([&] { return read_stored_campaign(folder.path()); }).find("/wingspread") !=
        std::string::npos);
  const StoredCampaign stored = read_any_campaign(folder.path());
  CHECK(stored.foreign);
  CHECK(stored.campaign.outputs.contains(OutputFamily::overtravel) ==
        campaign.outputs.contains(OutputFamily::overtravel)); // by the header
  const Results results = read_stored_results(stored).results;
  CHECK(results.size() == 3);
  (void)write_statistics(stored, results);
  const Json summary = parse_json_file(folder.path() / summary_file);
  CHECK(summary["wingspread"]["foreign"] == true);
  CHECK_FALSE(summary["wingspread"].contains("partial"));
  CHECK(summary["outputs"]["root.latch_time"]["mean"] == 1.5);
}

TEST_CASE("draws of another tool that the laws do not give are warned of") {
  Campaign campaign = campaign_of(quick_campaign(4));
  REQUIRE(campaign.dispersions.size() >= 1);
  campaign.dispersions.resize(1);
  campaign.dispersions[0].name = "u";
  campaign.dispersions[0].distribution = {Uniform{0.9, 1.1}, {}};
  Results results(ResultNames{{"u"}, {"root.latch_time"}});
  for (const double draw : {0.9, 5.95, 1.1, 0.2})
    results.append({std::ssize(results.runs), Status::deployed, {draw}, {1.0}, "", ""});
  const std::vector<StrangeDraws> found = strange_draws(campaign, results);
  REQUIRE(found.size() == 1);
  CHECK((found[0].runs == 2 && found[0].run == 1 && found[0].value == 5.95));
  Summary summary;
  summary.runs = 4, summary.strange_draws = found;
  CHECK(warnings(summary) ==
        std::vector<std::string>{
            "in 2 of 4 runs the draw u is outside its law (least 0.9, largest 1.1): 5.95 "
            "in run 1. The campaign is perhaps not that of these runs"});
  campaign.dispersions[0].distribution = {Normal{1, 0.5}, {}};
  CHECK(strange_draws(campaign, results).at(0).runs == 1); // 9.9 σ
  campaign.dispersions[0].distribution = {Normal{1, 1}, {}};
  CHECK(strange_draws(campaign, results).empty());
}

TEST_CASE("tolerance limits are of the runs in the folder") {
  const Folder folder;
  const auto path = folder.path() / "r";
  Json json = quick_campaign(100);
  json["statistics"] = {
      {"tolerance", {{{"probability", 0.95}, {"confidence", 0.95}, {"side", "both"}}}}};
  (void)run_into(path, campaign_of(json));
  const Json output = parse_json_file(path / summary_file)["outputs"]["root.latch_time"];
  CHECK(output["tolerance"][0]["lower"] == output["min"]); // order 1 of 100 runs
  CHECK(output["tolerance"][0]["upper"] == output["max"]);
}

TEST_CASE("a folder from before peaks were told to be final opens as it is") {
  const Folder folder;
  const auto path = folder.path() / "r";
  Json json = quick_campaign(20);
  json["outputs"] = {"peak_moment"};
  json["integration"]["t_end"] = 7; // some still ring then: their peaks are not proven
  json["requirements"] = parse_json(R"([
    { "output": "root.peak_moment", "max": 1e6, "probability": 0.8, "confidence": 0.9 } ])");
  Campaign campaign = campaign_of(json);
  (void)run_into(path, campaign);
  const Json now = parse_json_file(path / summary_file);
  long cut = 0, open = 0, all_cut = 0;
  const Results rows = read_stored_results(read_stored_campaign(path)).results;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool deployed = rows.status[i] == Status::deployed;
    all_cut += rows.peaks_final[i] == PeaksFinal::no ? 1 : 0;
    cut += deployed && rows.peaks_final[i] == PeaksFinal::no ? 1 : 0;
    open += deployed ? 0 : 1;
  }
  REQUIRE(cut > 0);
  CHECK(now["peaks_final"]["false"] == all_cut);
  Json failures{
      {"seen", cut + open}, {"allowed", 1}, {"peaks_cut", cut}, {"peaks_cut_within_limit", cut}};
  if (open > 0) failures["without_value"] = open;
  CHECK(now["requirements"][0]["failures"] == failures);
  campaign.outputs.erase(OutputFamily::peaks_final); // as they were
  campaign.resolved["outputs"] = write_outputs(campaign.outputs);
  const auto old = folder.path() / "old";
  (void)run_into(old, campaign);
  const std::string header = read_text(old / runs_file).value().substr(0, 200);
  CHECK(header.find("peaks_final") == std::string::npos);
  const StoredCampaign stored = read_stored_campaign(old);
  CHECK_FALSE(stored.campaign.outputs.contains(OutputFamily::peaks_final));
  const Summary summary = write_statistics(stored, read_stored_results(stored).results);
  CHECK_FALSE(summary.peaks);
  CHECK(std::ssize(summary.requirements[0].broken) == open);
  CHECK(ReplayRequest(stored, 3).replay({}).differences.empty());
  CHECK(ReplayRequest(read_stored_campaign(path), 3).replay({}).differences.empty());
}

TEST_CASE("a run that is missing before a later one is a gap, in a shard as in the whole") {
  const Campaign campaign = campaign_of(quick_campaign(31));
  for (const std::optional<Shard>& shard :
       {std::optional<Shard>(), std::optional(Shard{1, 3}), std::optional(Shard{3, 3})}) {
    const StoredCampaign stored{"r", campaign, stamp_of(campaign, shard)};
    const auto [first, last] = stored.runs();
    for (long missing = first; missing < last; ++missing)
      for (const long end : {missing, missing + 1, missing + 2, last}) {
        if (end > last) continue;
        Results results(ResultNames{{}, {}});
        for (long run = first; run < end; ++run)
          if (run != missing) results.append({run, Status::deployed, {}, {}, "", "", {}});
        CAPTURE(first, last, missing, end);
        const bool is_gap = missing + 1 < end;
        CHECK(gaps_text(stored, results, false).has_value() == is_gap);
        CHECK_FALSE(gaps_text(stored, results, true)); // stopped by its rule
      }
  }
}

TEST_CASE("a campaign stopped at its own confidence, and is as complete when analyzed at another") {
  const Folder folder;
  Json json = quick_campaign(2000);
  json["until"] =
      parse_json(R"([{ "output": "root.latch_time", "quantile": 0.5, "relative_width": 0.006 },
                                 { "output": "deployed", "width": 0.01 }])");
  const Campaign campaign = campaign_of(json);
  REQUIRE(run_into(folder.path() / "r", campaign, {.threads = 2}) == 1000);
  StoredCampaign stored = read_stored_campaign(folder.path() / "r");
  const Results results = read_stored_results(stored).results;
  const auto widths = [&] {
    const Summary summary = stored_summary(stored, results, 1);
    CHECK(summary.stopped);
    std::vector<std::optional<double>> found;
    for (const GoalState& each : summary.until) found.push_back(each.width);
    return found;
  };
  const std::vector<std::optional<double>> own = widths();
  for (const double confidence : {0.5, 0.8, 0.99, 0.9999999}) {
    stored.campaign.statistics.confidence = confidence;
    CHECK(widths() == own);
    CHECK(is_complete(stored, results));
  }
}
