// Studies that were cut off at any moment go on to the same bytes.
#include "montecarlo/analyses/margin/margin_report.hpp"
#include "montecarlo/analyses/rare/rare_report.hpp"
#include "montecarlo/analyses/sensitivity/design_folder.hpp"
#include "montecarlo/results/checkpoint/study_folder.hpp"
#include "tests/cli/program.hpp"
#include "tests/montecarlo/margin_support.hpp"

#include <catch2/catch.hpp>

#include <csignal>
#include <thread>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// A command that writes as it goes.
struct Resumable {
  std::vector<std::string> command; ///< less --out
  const char* growing;              ///< the file that it grows
  const char* last;                 ///< and the one that it writes last
};

struct ResumedPlace {
  Folder folder{};

  [[nodiscard]] Finished run(const Resumable& study, const std::string& out,
                             const std::vector<std::string>& more = {}) const {
    return run_program(folder, words(study, out, more));
  }
  [[nodiscard]] std::vector<std::string> words(const Resumable& study, const std::string& out,
                                               const std::vector<std::string>& more) const {
    std::vector<std::string> words = study.command;
    words.insert(words.end(), {"--out", (folder.path() / out).string()});
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  /// Starts it and sends the signal when its file is that long. @return whether it was not too late
  bool cut(const Resumable& study, const std::string& out, std::uintmax_t bytes, int signal,
           const std::vector<std::string>& more, Finished& finished) const {
    const auto growing = folder.path() / out / study.growing,
               last = folder.path() / out / study.last;
    const Program program(folder, words(study, out, more));
    const auto is_there = [&] {
      std::error_code not_yet;
      const auto size = std::filesystem::file_size(growing, not_yet);
      return (!not_yet && size >= bytes) || std::filesystem::exists(last);
    };
    for (int i = 0; i < 20'000 && !is_there(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    program.send(signal);
    finished = program.finish();
    return finished.code == 128 + SIGKILL || finished.code == 130;
  }
};

Resumable margin_of(const Folder& folder) {
  Json json = one_panel_margin(600);
  json["requirements"].push_back(
      {{"output", "root.peak_moment"}, {"max", 400}, {"probability", 0.9}, {"confidence", 0.9}});
  return {{"margin", folder.write("margin.json", json.dump()), "--threads", "2"},
          checkpoint_file,
          margin_json_file};
}

Resumable rare_of(const Folder& folder) {
  return {{"rare", folder.write("rare.json", quick_campaign(10).dump()), "--output",
           "root.latch_time", "--above", "6", "--samples", "400", "--repeats", "3", "--threads",
           "2"},
          checkpoint_file,
          rare_json_file};
}

Resumable sobol_of(const Folder& folder) {
  return {{"sensitivity", folder.write("sobol.json", quick_campaign(10).dump()), "--samples", "500",
           "--resamples", "20", "--threads", "2"},
          design_runs_file,
          sensitivity_csv_file};
}

} // namespace

TEST_CASE("margin, rare and sensitivity go on after kill -9 at several moments to the same bytes",
          "[parallel]") {
  const ResumedPlace place;
  for (const Resumable& study :
       {margin_of(place.folder), rare_of(place.folder), sobol_of(place.folder)}) {
    CAPTURE(study.command.front());
    const Finished whole = place.run(study, study.command.front());
    REQUIRE(whole.code <= 1);
    long kills = 0;
    const std::string out = study.command.front() + "_cut";
    Finished finished;
    const auto is_over = [&] {
      return std::filesystem::exists(place.folder.path() / out / study.last);
    };
    for (const std::uintmax_t bytes : {1U, 3000U, 20'000U, 60'000U, 61'000U, 150'000U}) {
      const bool was_over = is_over();
      const bool killed = place.cut(study, out, bytes, SIGKILL, {"--resume"}, finished);
      kills += killed;
      if (!killed && !was_over) CHECK(finished.out == whole.out); // faster than the signal
    }
    CHECK(kills >= 3);
    const bool was_over = is_over(); // a finished study names its file alone
    const Finished resumed = place.run(study, out, {"--resume"});
    CHECK(resumed.code == whole.code);
    if (!was_over) CHECK(resumed.out == whole.out);
    CHECK(contents(place.folder.path() / out) ==
          contents(place.folder.path() / study.command.front()));
  }
}

TEST_CASE("margin and rare interrupted say so, are refused without --resume, and go on with it",
          "[parallel]") {
  const ResumedPlace place;
  const int signal = GENERATE(SIGINT, SIGTERM);
  for (const Resumable& study : {margin_of(place.folder), rare_of(place.folder)}) {
    const Finished whole = place.run(study, "whole_" + study.command.front());
    const std::string out = study.command.front();
    const std::string folder = (place.folder.path() / out).string();
    Finished finished;
    REQUIRE(place.cut(study, out, 10'000, signal, {}, finished));
    CHECK(finished.out.empty());
    CHECK_THAT(lines_of(finished.error).back(),
               Catch::Matches("interrupted: [0-9]+ runs are kept; .*--resume.*"));
    const auto before = contents(folder);
    CHECK_FALSE(before.contains(study.last));
    const Finished refused = place.run(study, out);
    CHECK(refused.code == 2);
    CHECK_THAT(refused.error,
               HasFacts({"error: " + folder + ": found", "interrupted", "--resume"}));
    const Finished other = place.run(study, out, {"--resume", "--seed", "99"});
    CHECK(other.code == 2);
    CHECK_THAT(other.error, Catch::Contains("looks.log: /wingspread/seed: found ") &&
                                Catch::Contains(", expected 99, to continue what is there\n") &&
                                Catch::Contains("/wingspread/hash: found "));
    CHECK(contents(folder) == before);
    const Finished resumed = place.run(study, out, {"--resume"});
    CHECK(resumed.error == whole.error);
    CHECK(resumed.out == whole.out);
    CHECK(contents(folder) == contents(place.folder.path() / ("whole_" + out)));
    const Finished again = place.run(study, out, {"--resume"});
    CHECK(again.code == whole.code);
    CHECK(again.out == folder + "/" + study.last + "\n");
    CHECK_THAT(again.error, HasFacts({"note: this study was finished already\n"}));
    CHECK(contents(folder) == contents(place.folder.path() / ("whole_" + out)));
    CHECK(place.run(study, out, {"--resume", "--seed", "99"}).code == 2);
  }
}

TEST_CASE("a byte of a study's log that was changed is seen, said, and costs runs and no result",
          "[parallel]") {
  const ResumedPlace place;
  const Resumable study = rare_of(place.folder);
  const Finished whole = place.run(study, "whole");
  Finished finished;
  REQUIRE(place.cut(study, "cut", 20'000, SIGKILL, {}, finished));
  const auto log = place.folder.path() / "cut" / checkpoint_file;
  std::fstream bytes(log, std::ios::in | std::ios::out | std::ios::binary);
  bytes.seekp(9000);
  bytes.put('\x7F').put('\x01');
  bytes.close();
  const Finished resumed = place.run(study, "cut", {"--resume"});
  CHECK(resumed.code == whole.code);
  CHECK_THAT(resumed.error,
             Catch::Matches("warning: .*looks.log.* damaged .*run [0-9]+ .*\n(.|\n)*"));
  CHECK(contents(place.folder.path() / "cut") == contents(place.folder.path() / "whole"));
}

TEST_CASE("rare without a folder keeps nothing, and has nothing to go on with") {
  const ResumedPlace place;
  std::vector<std::string> command = rare_of(place.folder).command;
  command.push_back("--resume");
  const Finished refused = run_program(place.folder, command);
  CHECK(refused.code == 2);
  CHECK_THAT(refused.error, HasFacts({"error: --resume: found --resume without --out"}));
}

TEST_CASE("a finished study with failed runs has the same exit code when it is shown again",
          "[parallel]") {
  const ResumedPlace place;
  for (Resumable study : {margin_of(place.folder), rare_of(place.folder)}) {
    CAPTURE(study.command.front());
    Json json = parse_json_file(study.command[1]);
    json["integration"]["max_steps"] = 10; // all runs fail
    json["sampling"]["runs"] = 100;
    study.command[1] = place.folder.write("failing.json", json.dump());
    const Finished first = place.run(study, "failing_" + study.command.front());
    const Finished again = place.run(study, "failing_" + study.command.front(), {"--resume"});
    CHECK(first.code == 3);
    CHECK(again.code == 3);
    CHECK_THAT(again.error, HasFacts({"runs failed numerically"}));
    CHECK_THAT(again.error, Catch::Contains("finished already"));
  }
}
