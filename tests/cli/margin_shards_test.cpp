// Margin studies that make the runs at their first scales in shards.
#include "montecarlo/analyses/margin/margin_report.hpp"
#include "montecarlo/results/checkpoint/shard_checkpoints.hpp"
#include "montecarlo/results/checkpoint/study_folder.hpp"
#include "tests/cli/program.hpp"
#include "tests/montecarlo/margin_support.hpp"

#include <catch2/catch.hpp>

#include <csignal>
#include <thread>

using namespace wingspread;
using namespace wingspread::test;

namespace {

struct Shards {
  Folder folder{};
  std::string campaign = folder.write("c.json", one_panel_margin(200).dump());

  [[nodiscard]] std::string at(const std::string& name) const {
    return (folder.path() / name).string();
  }
  [[nodiscard]] Finished margin(const std::string& out,
                                const std::vector<std::string>& more) const {
    std::vector<std::string> words{"margin", campaign, "--out", at(out), "--threads", "1"};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(folder, words);
  }
  [[nodiscard]] Finished shard(int i, int of, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"--shard", std::to_string(i) + "/" + std::to_string(of)};
    words.insert(words.end(), more.begin(), more.end());
    return margin("part" + std::to_string(i), words);
  }
};

} // namespace

TEST_CASE("margin goes on from shards of its first looks to the bytes of one process",
          "[parallel]") {
  const Shards shards;
  const Finished whole = shards.margin("whole", {});
  CHECK(whole.code == 0);
  long runs = 0;
  for (const int i : {2, 1, 3}) {
    const Finished made = shards.shard(i, 3);
    CHECK(made.code == 0);
    CHECK(made.out == shards.at("part" + std::to_string(i)) + "/shard.json\n");
    CHECK_THAT(made.error, HasFacts({"note: shard " + std::to_string(i) + "/3", "--from"}));
    runs +=
        parse_json_file(shards.at("part" + std::to_string(i)) + "/shard.json")["runs"].get<long>();
  }
  CHECK(runs == 13 * 200);
  const std::vector<std::string> from{"--from", shards.at("part3"), shards.at("part1"),
                                      shards.at("part2")};
  const Finished merged = shards.margin("out", from);
  CHECK(merged.code == whole.code);
  CHECK(merged.out == whole.out);
  CHECK(merged.error == whole.error);
  CHECK(contents(shards.at("out")) == contents(shards.at("whole")));
  // the shard once more changes nothing
  const auto before = contents(shards.at("part2"));
  CHECK(shards.shard(2, 3).code == 2);
  CHECK(shards.shard(2, 3, {"--resume"}).code == 0);
  CHECK(contents(shards.at("part2")) == before);

  // rows of a shard that were changed
  const auto log = shards.folder.path() / "part2" / checkpoint_file;
  std::fstream bytes(log, std::ios::in | std::ios::out | std::ios::binary);
  bytes.seekp(3000);
  bytes.put('\x7F').put('\x01');
  bytes.close();
  const Finished damaged = shards.margin("out2", from);
  CHECK(damaged.code == 2);
  CHECK_THAT(damaged.error,
             Catch::Contains(log.string() + ": found missing or damaged rows, expected all "
                                            "rows of a finished shard"));
}

// What was read is not made now: the rate that the line shows would be that of the disk.
TEST_CASE("the line on a terminal counts the runs of shards, and has no rate of them") {
  const Shards shards;
  std::vector<std::string> from{"margin", shards.campaign, "--out", shards.at("out"), "--threads",
                                "1",      "--from"};
  for (const int i : {1, 2}) {
    CHECK(shards.shard(i, 2).code == 0);
    from.push_back(shards.at("part" + std::to_string(i)));
  }
  const std::string shown = shown_on_terminal(from);
  const std::string first = shown.substr(0, shown.find("\x1b[K"));
  CAPTURE(first);
  CHECK_THAT(first, Catch::Contains(" analysis 1 of at most ") && Catch::Contains(" runs") &&
                        !Catch::Contains(" 0 of at most ") && !Catch::Contains("runs/s"));
}

TEST_CASE("shards that are missing, unfinished, of another study or no shards are refused") {
  const Shards shards;
  CHECK(shards.shard(1, 3).code == 0);
  CHECK(shards.shard(3, 3).code == 0);
  const Finished missing = shards.margin("out", {"--from", shards.at("part1"), shards.at("part3")});
  CHECK(missing.code == 2);
  const std::string command =
      "wingspread margin " + shards.campaign + " --out " + shards.at("part2") + " --shard 2/3";
  CHECK_THAT(missing.error,
             HasFacts({"runs 66 to 132", "200 runs", "1 command", "\n  " + command + "\n"}));
  CHECK_FALSE(std::filesystem::exists(shards.at("out")));
  CHECK(shards.shard(2, 3).code == 0);
  std::filesystem::remove(shards.at("part2") + "/shard.json"); // as if it had been cut off
  const Finished unfinished =
      shards.margin("out", {"--from", shards.at("part1"), shards.at("part2"), shards.at("part3")});
  CHECK_THAT(unfinished.error, HasFacts({"part2: found no runs 66 to 132", "shard 2/3"}) &&
                                   Catch::EndsWith("  " + command + " --resume\n"));
  const Finished other = shards.margin("out", {"--seed", "99", "--from", shards.at("part1")});
  CHECK_THAT(other.error,
             Catch::Contains("part1/looks.log: /wingspread/seed: found 3, expected 99"));
  CHECK_THAT(shards.margin("out", {"--from", shards.at("none")}).error,
             HasFacts({"looks.log", "a shard of a study"}));
  CHECK_THAT(
      run_program(shards.folder, {"merge", shards.at("part1"), "--out", shards.at("out")}).error,
      HasFacts({"a shard of a margin study", "--from DIR"}));
  CHECK(shards.shard(2, 3, {"--from", shards.at("part1")}).code == 2);
}

TEST_CASE("a study from shards goes on after a kill with the same shards", "[parallel]") {
  const Shards shards;
  const Finished whole = shards.margin("whole", {});
  std::vector<std::string> from{"--from"};
  for (const int i : {1, 2}) {
    CHECK(shards.shard(i, 2).code == 0);
    from.push_back(shards.at("part" + std::to_string(i)));
  }
  std::vector<std::string> words{"margin",         shards.campaign, "--out",
                                 shards.at("cut"), "--threads",     "1"};
  words.insert(words.end(), from.begin(), from.end());
  const auto log = shards.folder.path() / "cut" / checkpoint_file;
  const Program program(shards.folder, words);
  for (int i = 0; i < 20'000; ++i) {
    std::error_code not_yet;
    if (std::filesystem::file_size(log, not_yet) > 8000 && !not_yet) break;
    if (std::filesystem::exists(shards.at("cut") + "/margin.json")) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  program.send(SIGKILL);
  REQUIRE(program.finish().code == 128 + SIGKILL);
  const Finished without = shards.margin("cut", {"--resume"});
  CHECK(without.code == 2);
  CHECK_THAT(without.error, HasFacts({" 1: campaign ", "--from"}));
  from.push_back("--resume");
  CHECK(shards.margin("cut", from).out == whole.out);
  CHECK(contents(shards.at("cut")) == contents(shards.at("whole")));
}

TEST_CASE("the commands for missing shards have all options of the study, and their shards fit") {
  const Shards shards;
  const std::vector<std::string> options{
      "--seed", "77", "--runs", "80", "--range", "0.7", "1.4", "--scale", "hinges.*.spring.scale"};
  CHECK(shards.shard(1, 3, options).code == 0);
  const auto continued = [&] {
    std::vector<std::string> words = options;
    words.emplace_back("--from");
    for (const int i : {1, 2, 3})
      if (std::filesystem::exists(shards.at("part" + std::to_string(i))))
        words.push_back(shards.at("part" + std::to_string(i)));
    return shards.margin("out", words);
  };
  const Finished missing = continued();
  CHECK(missing.code == 2);
  CHECK(run_named(shards.folder, missing.error) == std::vector<int>{0, 0});
  const Finished merged = continued(), whole = shards.margin("whole", options);
  CHECK(merged.code == whole.code);
  CHECK(merged.out == whole.out);
}
