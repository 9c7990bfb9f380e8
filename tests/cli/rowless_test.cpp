// run --no-rows, as a user has it.
#include "montecarlo/results/streaming/streaming_folder.hpp"
#include "tests/cli/program.hpp"

#include <catch2/catch.hpp>

#include <chrono>
#include <csignal>
#include <thread>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// Some runs are invalid, some time out, some break the requirement.
Json rowless_campaign(int runs) {
  Json json = quick_campaign(runs);
  json["integration"]["t_end"] = 6.75;
  json["requirements"] = parse_json(
      R"([{ "output": "root.latch_time", "max": 5, "probability": 0.5, "confidence": 0.9 }])");
  return json;
}

struct Rowless {
  Folder folder{};
  std::string campaign, rows = folder.path() / "rows", none = folder.path() / "none";

  explicit Rowless(int runs) : campaign(folder.write("c.json", rowless_campaign(runs).dump())) {}

  [[nodiscard]] Finished program(const std::vector<std::string>& arguments) const {
    return run_program(folder, arguments);
  }
  [[nodiscard]] Finished run(const std::string& out, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"run", campaign, "--out", out, "--no-rows"});
    return program(more);
  }
};

} // namespace

TEST_CASE("run --no-rows says what run says, and keeps the rows of broken runs alone",
          "[parallel]") {
  const Rowless made(10'000);
  const auto rows = made.program({"run", made.campaign, "--out", made.rows});
  const auto none = made.run(made.none);
  CHECK(none.code == rows.code);
  CHECK(none.error == rows.error);
  const std::filesystem::path folder = made.none;
  CHECK_FALSE(std::filesystem::exists(folder / runs_file));
  const Json timing = parse_json_file(folder / timing_file);
  CHECK((timing["runs"] == 10'000 && timing["runs_before"] == 0)); // the pilot's are this session's
  const Json full = parse_json_file(std::filesystem::path(made.rows) / summary_file),
             found = parse_json_file(folder / summary_file);
  for (const char* key : {"runs", "status", "reasons", "latch_order", "nominal"})
    CHECK(found[key] == full[key]);
  CHECK(found["requirements"][0]["failures"] == full["requirements"][0]["failures"]);
  CHECK(found["requirements"][0]["broken"] == full["requirements"][0]["broken"]);
  for (const auto& [name, output] : full["outputs"].items()) {
    CAPTURE(name);
    const Json& mine = found["outputs"][name];
    for (const char* key : {"unit", "count", "missing", "min", "max"})
      CHECK(mine[key] == output[key]);
    CHECK(mine["mean"].get<double>() == Approx(output["mean"].get<double>()).epsilon(1e-13));
    for (std::size_t q = 0; q < output["quantiles"].size(); ++q) {
      const Json &a = mine["quantiles"][q], &b = output["quantiles"][q];
      CHECK(a["value"].is_null() == b["value"].is_null());
      if (b["value"].is_null()) continue;
      CHECK(a["within"][0] <= b["value"]);
      CHECK(b["value"] <= a["within"][1]);
      CHECK(a["lower"] <= b["lower"]);
      CHECK(b["upper"] <= a["upper"]);
    }
  }
  // The rows that are kept are those of runs.csv, and each run that is missing there did deploy and kept to it.
  const StoredCampaign stored = read_stored_campaign(made.rows);
  std::string expected;
  append_header(expected, RunPlan(stored.campaign).names());
  (void)for_each_stored_row(stored, [&](const ResultRow& row) {
    if (row.status != Status::deployed || !(row.outputs[0] <= 5)) append_row(expected, row);
  });
  CHECK(read_text(folder / broken_runs_file) == expected);
  CHECK(lines_of(expected).size() > 100);
}

TEST_CASE(
    "run --no-rows gives the same bytes on any threads, resumed after any end, and from shards",
    "[parallel][long]") {
  const Rowless made(9'000);
  REQUIRE(made.run(made.none, {"--threads", "1"}).code <= 1);
  const auto whole = contents(made.none);
  REQUIRE(made.run(made.rows, {"--threads", "2", "--lanes", "1"}).code <= 1);
  CHECK(contents(made.rows) == whole);

  // Interrupted, and killed: what is behind the last state of the statistics is made again.
  const std::string cut = made.folder.path() / "cut";
  {
    const Program program(made.folder, {"run", made.campaign, "--out", cut, "--no-rows"});
    const auto state = std::filesystem::path(cut) / broken_runs_file;
    for (int i = 0; i < 2000 && !std::filesystem::exists(state); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    program.send(SIGINT);
    const int code = program.finish().code;
    CHECK((code == 130 || code <= 1)); // it may have been faster
  }
  std::ofstream(std::filesystem::path(cut) / broken_runs_file, std::ios::app)
      << "8999,stalled,cut o";
  REQUIRE(made.run(cut, {"--resume"}).code <= 1);
  CHECK(contents(cut) == whole);

  const std::string a = made.folder.path() / "a", b = made.folder.path() / "shard_2_of_3",
                    c = made.folder.path() / "c", out = made.folder.path() / "out";
  REQUIRE(made.run(a, {"--shard", "1/3"}).code == 0);
  REQUIRE(made.run(c, {"--shard", "3/3"}).code == 0);
  const Finished missing = made.program({"merge", a, c, "--out", out});
  CHECK(missing.code == 2);
  CHECK_THAT(missing.error, HasFacts({"no folder with runs 3000 to 5999", "1 command"}));
  CHECK_THAT(missing.error, !Catch::Contains("--preview")); // which needs rows
  CHECK(run_named(made.folder, missing.error) == std::vector{0});
  CHECK(made.program({"merge", c, a, b, "--out", out}).code <= 1);
  CHECK(contents(out) == whole);
  const Finished again = made.program({"merge", a, b, c, "--out", out}); // writes over nothing
  CHECK(again.code == 2);
  CHECK_THAT(again.error, HasFacts({out, "a new or an empty folder"}));
  CHECK(contents(out) == whole);
}

TEST_CASE("an unfinished folder without rows says so, and nobody is told to extend one") {
  const Rowless made(6'000);
  REQUIRE(made.run(made.none).code <= 1);
  const Finished whole = made.program({"analyze", made.none});
  CHECK_THAT(whole.error, !Catch::Contains("incomplete"));
  const std::string begun = made.folder.path() / "begun";
  {
    const StoredCampaign stored = read_stored_campaign(made.none);
    const RunPlan plan(stored.campaign);
    StreamingFolder folder(begun, plan, std::nullopt, false);
    ThreadEvaluator evaluator({.threads = 1}, never);
    REQUIRE(folder.begin(evaluator));
    folder.finish();
  }
  const Finished part = made.program({"analyze", begun});
  CHECK(part.code == 1);
  CHECK_THAT(part.error, HasFacts({"warning: incomplete: 4096 of 6000 runs"}));

  Json open = quick_campaign(8);
  open["requirements"] =
      parse_json(R"([{ "output": "deployed", "probability": 0.99, "confidence": 0.9 }])");
  const std::string file = made.folder.write("open.json", open.dump());
  for (const bool with_rows : {true, false}) {
    std::vector<std::string> words{"run", file, "--out", made.folder.path() / "open"};
    words.back() += with_rows ? "_rows" : "";
    if (!with_rows) words.emplace_back("--no-rows");
    const Finished undecided = made.program(words);
    CHECK(undecided.code == 1);
    CHECK_THAT(undecided.error, HasFacts({"note: each further test"}));
    CHECK((undecided.error.find("--resume --runs") != std::string::npos) == with_rows);
  }
}

TEST_CASE("a shard without rows that was killed early is named by merge with its command") {
  const Rowless made(40);
  const std::string a = made.folder.path() / "part1", b = made.folder.path() / "part2",
                    out = made.folder.path() / "out";
  REQUIRE(made.run(a, {"--shard", "1/2"}).code == 0);
  REQUIRE(made.run(b, {"--shard", "2/2"}).code == 0);
  for (const auto& entry : std::filesystem::directory_iterator(a))
    if (entry.path().filename() != campaign_file) std::filesystem::remove(entry.path());
  const Finished missing = made.program({"merge", a, b, "--out", out});
  CHECK(missing.code == 2);
  CHECK_THAT(missing.error, HasFacts({a, "no runs 0 to 19", "--no-rows --resume\n"}));
  CHECK_THAT(missing.error, !Catch::Contains("--preview"));
  CHECK(run_named(made.folder, missing.error) == std::vector{0});
  CHECK(made.program({"merge", a, b, "--out", out}).code <= 1);
}

TEST_CASE("what takes every row refuses a folder without rows; the rest works on it") {
  const Rowless made(300);
  REQUIRE(made.run(made.none).code <= 1);
  const auto before = contents(made.none);
  CHECK(made.program({"analyze", made.none}).code <= 1);
  CHECK(contents(made.none) == before);
  CHECK(made.program({"analyze", made.none, "--quantiles", "0.25"}).code <= 1);
  CHECK(parse_json_file(std::filesystem::path(made.none) /
                        summary_file)["outputs"]["root.latch_time"]["quantiles"][0]["p"] == 0.25);
  const std::string broken = read_text(std::filesystem::path(made.none) / broken_runs_file).value();
  const auto has = [&](int run) {
    return broken.find("\n" + std::to_string(run) + ",") != std::string::npos;
  };
  const auto replayed = [&](int run) {
    return made.program({"replay", made.none, "--run", std::to_string(run)}).out;
  };
  int kept = 0, other = 0;
  while (!has(kept)) ++kept;
  while (has(other)) ++other;
  CHECK_THAT(replayed(kept),
             HasFacts({"\nRun " + std::to_string(kept), "broken_runs.csv, bit for bit"}));
  CHECK_THAT(replayed(other),
             HasFacts({"\nRun " + std::to_string(other) + " is not in broken_runs.csv"}));
  const HasFacts refusal{"error: " + made.none + ": found a campaign", "--no-rows", "runs.csv"};
  const std::string late = made.folder.write(
      "late.json",
      R"([{ "output": "deployment_time", "max": 2, "probability": 0.8, "confidence": 0.9 }])");
  for (const std::vector<std::string>& words : {std::vector<std::string>{"sensitivity", made.none},
                                                {"analyze", made.none, "--requirements", late}}) {
    const auto [code, out, error] = made.program(words);
    CHECK(code == 2);
    CHECK_THAT(error, refusal);
  }
}

TEST_CASE(
    "the page of a folder without rows has what the page of the rows has, but for what takes rows",
    "[parallel][page]") {
  const Rowless made(6'000);
  REQUIRE(made.program({"run", made.campaign, "--out", made.rows}).code <= 1);
  REQUIRE(made.run(made.none).code <= 1);
  const auto data_of = [&](const std::string& folder) {
    REQUIRE(made.program({"report", folder}).code == 0);
    const std::string page = read_text(std::filesystem::path(folder) / "report.html").value();
    const std::string begin = "id=\"data\">";
    const std::size_t from = page.find(begin) + begin.size();
    return parse_json(page.substr(from, page.find("</script>", from) - from))["sets"][0];
  };
  Json full = data_of(made.rows);
  const Json found = data_of(made.none);
  for (Json& order : full["orders"])
    order["gaps"] = Json::array(); // times between latches take rows
  CHECK((full["rows"] == true && found["rows"] == false));
  CHECK(found["made_by"].get<std::string>().ends_with(" --no-rows --out again"));
  for (const char* key : {"runs", "planned", "statuses", "reasons", "orders", "order_kinds",
                          "without_latch", "wing", "inputs"})
    CHECK(found[key] == full[key]);
  for (const char* key : {"verdict", "broken", "not_deployed", "without_value", "cut", "beyond",
                          "worst", "beyond_runs", "not_deployed_runs", "guaranteed"})
    CHECK(found["requirements"][0][key] == full["requirements"][0][key]);
  CHECK(found["requirements"][0]["beyond"] > 0);
  REQUIRE(found["outputs"].size() == full["outputs"].size());
  for (std::size_t i = 0; i < full["outputs"].size(); ++i) {
    const Json &mine = found["outputs"][i], &output = full["outputs"][i];
    CAPTURE(output["name"]);
    for (const char* key : {"name", "unit", "count", "missing", "nominal", "min", "max", "limits"})
      CHECK(mine[key] == output[key]);
    CHECK(mine["convergence"].is_null());
    CHECK(mine["histogram"]["by_order"].empty());
    long sum = 0;
    for (const Json& count : mine["histogram"]["counts"]) sum += count.get<long>();
    CHECK(sum == output["count"].get<long>());
    // The curve at each knot of the rows' curve, by interpolation: within a bin and a rank of it.
    const auto numbers = [](const Json& json, const char* key) {
      return json["curve"][key].get<std::vector<double>>();
    };
    const auto x = numbers(output, "x"), p = numbers(output, "p"), mine_x = numbers(mine, "x"),
               mine_p = numbers(mine, "p");
    CHECK(mine_p.back() == 1);
    for (std::size_t k = 0, j = 0; k < x.size(); ++k) {
      while (j < mine_x.size() && mine_x[j] < x[k]) ++j;
      if (j == 0 || j == mine_x.size()) continue;
      CHECK(p[k] >= mine_p[j - 1] - 0.001);
      CHECK(p[k] <= mine_p[j] + 0.001);
    }
  }
  CHECK((found["sensitivity"].is_null() && found["scatters"].empty()));
  CHECK(found["correlations"]["pearson"] == full["correlations"]["pearson"]);
  CHECK(found["envelopes"]["runs"] == full["envelopes"]["runs"]);
  const auto worst = [](const Json& set) {
    for (const Json& motion : set["motions"])
      if (motion["label"].get<std::string>().starts_with("worst")) return motion;
    return Json();
  };
  CHECK(worst(found)["run"] == worst(full)["run"]);
  CHECK(worst(found)["moments"] == worst(full)["moments"]);

  // Beside a folder with rows: not paired, and the means' difference is 0.
  const std::string both = made.folder.path() / "both.html";
  REQUIRE(made.program({"report", made.rows, made.none, "--out", both}).code == 0);
  CHECK(read_text(both)->find("not paired, because rows were not kept: 6000 and 6000 runs") !=
        std::string::npos);
}

TEST_CASE("the page of a folder without rows leaves out rows beyond its saved statistics") {
  const Rowless made(300);
  REQUIRE(made.run(made.none).code <= 1);
  const StoredCampaign stored = read_stored_campaign(made.none);
  const StoredStatistics read = read_streaming_statistics(stored);
  const std::size_t rows = read_broken_runs(stored, read.broken_bytes).size();
  CHECK(rows > 1);
  CHECK(read_broken_runs(stored, read.broken_bytes - 1).size() == rows - 1);
}

TEST_CASE("run --no-rows refuses what takes rows, and folders that have them") {
  const Folder folder;
  const auto refusal = [&](const Json& json, std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"run", folder.write("c.json", json.dump()), "--out",
                               folder.path() / "r", "--no-rows"});
    const auto [code, out, error] = run_program(folder, more);
    CHECK(code == 2);
    return error;
  };
  Json json = quick_campaign(64);
  json["sampling"]["design"] = "sobol";
  CHECK_THAT(refusal(json), HasFacts({"error: --no-rows: found dependent draws", "\"random\""}));
  CHECK_THAT(refusal(quick_campaign(64), {"--until", "deployed 0.1"}),
             HasFacts({"error: --no-rows: found stopping goals"}));
  json = quick_campaign(64);
  json["cases"] = parse_json(R"([{ "name": "hot" }])");
  CHECK_THAT(refusal(json), HasFacts({"error: --no-rows: found a campaign with cases"}));
  CHECK_FALSE(std::filesystem::exists(folder.path() / "r"));

  const std::string campaign = folder.write("c.json", quick_campaign(64).dump()),
                    rows = folder.path() / "rows", none = folder.path() / "none";
  REQUIRE(run_program(folder, {"run", campaign, "--out", rows}).code == 0);
  REQUIRE(run_program(folder, {"run", campaign, "--out", none, "--no-rows"}).code == 0);
  CHECK_THAT(run_program(folder, {"run", campaign, "--out", rows, "--no-rows", "--resume"}).error,
             HasFacts({"error: " + rows + ": found", "rows", "--no-rows (without it --resume"}));
  CHECK_THAT(run_program(folder, {"run", campaign, "--out", none, "--resume"}).error,
             HasFacts({"error: " + none + ": found a folder that was begun with --no-rows",
                       "expected --no-rows beside --resume"}));
  CHECK_THAT(
      run_program(folder, {"run", campaign, "--out", none, "--no-rows", "--resume", "--runs", "99"})
          .error,
      HasFacts({"error: " + none + "/campaign.json: /sampling/runs: found 64, expected 99"}));
  std::string state = read_text(std::filesystem::path(none) / statistics_file).value();
  state[state.size() / 2] = static_cast<char>(state[state.size() / 2] ^ 4);
  std::ofstream(std::filesystem::path(none) / statistics_file, std::ios::binary) << state;
  CHECK_THAT(run_program(folder, {"analyze", none}).error,
             HasFacts({"error: " + none + "/statistics.bin: found a damaged file"}));
}
