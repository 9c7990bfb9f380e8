// Full disks, missing permissions, damaged files: errors without loss of data.
#include "montecarlo/foundation/platform/folder_lock.hpp"
#include "montecarlo/results/export/hdf5_export.hpp"
#include "montecarlo/results/summary/summary_json.hpp"
#include "tests/cli/program.hpp"
#include "tests/montecarlo/analyses/fit/fit_support.hpp"
#include "tests/montecarlo/margin_support.hpp"

#include <catch2/catch.hpp>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <fstream>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// TMPDIR for the programs that are started while this lives.
class TemporaryFolder {
public:
  explicit TemporaryFolder(const std::string& path) { setenv("TMPDIR", path.c_str(), 1); }
  ~TemporaryFolder() { unsetenv("TMPDIR"); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
};

/// A campaign's folder with so many rows, of which the last is a true one and the others have the first one's values.
void write_rows(const std::filesystem::path& path, const Campaign& campaign, long count) {
  const RunPlan plan(campaign);
  Runner runner(plan);
  std::string csv;
  append_header(csv, plan.names());
  ResultRow row = runner.run(0);
  for (row.run = 0; row.run + 1 < count; ++row.run) append_row(csv, row);
  append_row(csv, runner.run(count - 1));
  std::filesystem::create_directory(path);
  write_file(path / campaign_file, campaign_text(campaign, stamp_of(campaign, {})));
  write_file(path / runs_file, csv);
}

long lines_in(const std::filesystem::path& file) {
  return std::ranges::count(read_text(file).value(), '\n');
}

} // namespace

TEST_CASE("what is printed to a full device is not taken for done") {
  const Folder folder;
  const std::string campaign = folder.write("c.json", quick_campaign(100).dump());
  const std::string scene = three_panel_file();
  const std::vector<std::vector<std::string>> commands{
      {"sample", campaign}, {"simulate", scene, "--t-end", "1"},
      {"check", campaign},  {"methods"},
      {"version"},          {"size", "--probability", "0.9", "--confidence", "0.9"},
      {"--help"},           {"run", "--help"}};
  for (const auto& command : commands) {
    CAPTURE(command);
    const auto [code, out, error] = run_program(folder, command, "/dev/full");
    CHECK(code == 4);
    CHECK_THAT(error, HasFacts({"error: standard output: found No space left on device"}));
  }
}

// Messages are lost there; the command, its files and its exit status stay.
TEST_CASE("a full or closed standard error ends no command, and no message gets into a file") {
  const Folder folder;
  Json json = quick_campaign(60);
  json["requirements"] = parse_json(
      R"([{ "output": "deployment_time", "max": 1, "probability": 0.9, "confidence": 0.9 }])");
  json["scene"]["bodies"][0]["mass"] = 40'000; // a warning, before any run
  const std::string campaign = folder.write("c.json", json.dump());
  const std::string whole = folder.path() / "whole";
  const auto usual = run_program(folder, {"run", campaign, "--out", whole, "--table"});
  CHECK_THAT(usual.error, HasFacts({"warning: ", "not met: "}));
  const auto with = [&](const std::string& arguments, const std::string& redirected) {
    const std::string command =
        '"' + std::string(program_path) + "\" " + arguments + ' ' + redirected;
    const int status = std::system(command.c_str()); // NOLINT(cert-env33-c): a shell closes files
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  };
  int made = 0;
  for (const auto& [redirected, code] : {std::pair(">/dev/null 2>/dev/full", usual.code),
                                         {">/dev/null 2>&-", usual.code},
                                         {">&- 2>&-", 4},
                                         {"<&- >&- 2>&-", 4}}) { // 4: the table is lost
    CAPTURE(redirected);
    const std::string out = folder.path() / ("out_" + std::to_string(++made));
    CHECK(with("run \"" + campaign + "\" --out \"" + out + "\" --table", redirected) == code);
    for (const auto& entry : std::filesystem::directory_iterator(whole)) {
      const std::filesystem::path name = entry.path().filename();
      CAPTURE(name);
      const auto text = read_text(std::filesystem::path(out) / name);
      REQUIRE(text.has_value());
      if (name == timing_file) continue;
      CHECK(*text == read_text(entry.path()).value());
    }
    CHECK(with("run \"" + campaign + "\" --runs 0 --out \"" + out + "x\"", redirected) == 2);
  }
}

TEST_CASE("a file on a full device is the machine's refusal") {
  const Folder folder;
  const std::string campaign = folder.write("c.json", quick_campaign(10).dump());
  for (const char* command : {"sample", "simulate"}) {
    const auto [code, out, error] = run_program(folder, {command, campaign, "--out", "/dev/full"});
    CHECK(code == 4);
    CHECK_THAT(error, HasFacts({"error: /dev/full: found No space left on device"}));
  }
}

namespace {

/// The largest size of a file for the programs that are started while this lives.
struct FileSizeLimit {
  explicit FileSizeLimit(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before);
    const rlimit lower{bytes, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &lower);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
  ~FileSizeLimit() { setrlimit(RLIMIT_FSIZE, &before); }
  rlimit before{};
};

} // namespace

TEST_CASE("a file that may grow no more is the machine's refusal, and what is done is kept") {
  const Folder folder;
  const std::string campaign = folder.write("c.json", quick_campaign(100).dump());
  const auto whole = folder.path() / "whole", cut = folder.path() / "cut";
  REQUIRE(run_program(folder, {"run", campaign, "--out", whole}).code == 0);
  {
    const FileSizeLimit limit(6000);
    const auto [code, out, error] = run_program(folder, {"run", campaign, "--out", cut});
    CHECK(code == 4);
    CHECK_THAT(error, Catch::Contains("File too large"));
    CHECK_THAT(error, Catch::Contains(cut.string()));
    if (has_hdf5()) {
      const auto exported = run_program(folder, {"export", whole, "--out", folder.path() / "t.h5"});
      CHECK(exported.code == 4);
      CHECK_THAT(exported.error, Catch::Contains("File too large"));
      CHECK_FALSE(std::filesystem::exists(folder.path() / "t.h5"));
    }
  }
  if (has_hdf5()) { // below the limit nothing changes
    const FileSizeLimit limit(10'000'000);
    CHECK(run_program(folder, {"export", whole, "--out", folder.path() / "limited.h5"}).code == 0);
  }
  if (has_hdf5()) {
    CHECK(run_program(folder, {"export", whole, "--out", folder.path() / "t.h5"}).code == 0);
    CHECK(read_text(folder.path() / "t.h5") == read_text(folder.path() / "limited.h5"));
  }
  const bool has_campaign = std::filesystem::exists(cut / campaign_file);
  std::vector<std::string> again{"run", campaign, "--out", cut};
  if (has_campaign) again.emplace_back("--resume");
  CHECK(run_program(folder, again).code == 0);
  CHECK(read_text(cut / runs_file) == read_text(whole / runs_file));
}

TEST_CASE(
    "statistics that the machine refused to write elsewhere are written by the same command") {
  const Folder folder;
  Json json = quick_campaign(100);
  json["cases"] = {{{"name", "hot"}}, {{"name", "cold"}}};
  const std::string with_cases = folder.write("cases.json", json.dump()),
                    campaign = folder.write("c.json", quick_campaign(100).dump());
  const auto rows = folder.path() / "rows", none = folder.path() / "none",
             cases = folder.path() / "cases";
  REQUIRE(run_program(folder, {"run", campaign, "--out", rows}).code == 0);
  REQUIRE(run_program(folder, {"run", campaign, "--out", none, "--no-rows"}).code == 0);
  REQUIRE(run_program(folder, {"run", with_cases, "--out", cases}).code == 0);
  for (const auto& [from, command] :
       {std::pair(rows, "analyze"), {none, "analyze"}, {cases, "analyze"}, {rows, "sensitivity"}}) {
    const std::filesystem::path out = from.string() + "_" + command;
    CAPTURE(out.string());
    const std::vector<std::string> words{command, from, "--out", out};
    const auto whole = [&, from = from] { // the sizes of the files, without words of the command
      const std::filesystem::path other = out.string() + "_whole";
      if (!exists(other)) REQUIRE(run_program(folder, {words[0], from, "--out", other}).code == 0);
      return contents(other);
    }();
    std::vector<std::uintmax_t> sizes;
    for (const auto& [name, text] : whole) sizes.push_back(text.size());
    std::ranges::sort(sizes);
    for (const std::uintmax_t size : {sizes.back() - 1, sizes[sizes.size() / 2] - 1}) {
      {
        const FileSizeLimit limit(size);
        const auto refused = run_program(folder, words);
        CHECK(refused.code == 4);
        CHECK_THAT(refused.error, HasFacts({out, "File too large"}));
      }
      CHECK(run_program(folder, words).code == 0);
      CHECK(contents(out) == whole);
      std::filesystem::remove_all(out);
    }
  }
}

TEST_CASE("statistics are written only beside the rows that they are of") {
  const Folder folder;
  const std::string campaign = folder.write("c.json", quick_campaign(20).dump()),
                    from = folder.path() / "from", out = folder.path() / "out";
  REQUIRE(run_program(folder, {"run", campaign, "--out", from}).code == 0);
  REQUIRE(run_program(folder, {"analyze", from, "--out", out}).code == 0);
  const auto refused = [&] {
    const auto before = contents(out);
    const auto [code, text, error] = run_program(folder, {"analyze", from, "--out", out});
    CHECK_THAT(error, HasFacts({out, "a new or an empty folder"}));
    CHECK(contents(out) == before);
    return code == 2;
  };
  CHECK(refused()); // it is finished
  std::filesystem::remove(out + "/histograms.csv");
  const std::string rows = read_text(out + "/runs.csv").value();
  write_file(out + "/runs.csv", rows.substr(0, rows.size() / 2)); // other rows
  CHECK(refused());
  write_file(out + "/runs.csv", rows);
  std::filesystem::remove(from + "/histograms.csv");
  CHECK(run_program(folder, {"analyze", from, "--out", from}).code != 0);
  CHECK(run_program(folder, {"analyze", from, "--out", out}).code == 0);
  REQUIRE(run_program(folder, {"sensitivity", from, "--out", out + "s"}).code == 0);
  std::filesystem::remove(out + "s/sensitivity.csv");
  write_file(out + "s/sensitivity.json", "{}"); // of another study
  CHECK(run_program(folder, {"sensitivity", from, "--out", out + "s"}).code == 2);
  CHECK(read_text(out + "s/sensitivity.json") == "{}");
}

TEST_CASE("an edited row that contradicts itself is refused in a folder of the program's own") {
  const Folder folder;
  const std::string campaign = folder.write("c.json", quick_campaign(5).dump());
  const std::filesystem::path out = folder.path() / "r";
  REQUIRE(run_program(folder, {"run", campaign, "--out", out}).code == 0);
  std::string csv = read_text(out / runs_file).value();
  const std::size_t header = csv.find('\n'), line = csv.find('\n', header + 1) + 1; // of run 1
  const std::string names = csv.substr(0, header);
  const auto cell = [&](const std::string& name) { // its first character in the line
    std::size_t at = line;
    for (std::size_t k = std::ranges::count(names.substr(0, names.find(name)), ','); k > 0; --k)
      at = csv.find(',', at) + 1;
    return at;
  };
  csv.insert(cell("root.latch_time"), "-");
  std::ofstream(out / runs_file) << csv;
  const auto [code, text, error] = run_program(folder, {"analyze", out});
  CHECK(code == 2);
  CHECK_THAT(error, HasFacts({"line 3", "'root.latch_time'", "a time ≥ 0"}));
}

TEST_CASE("a folder in which a process is at work is refused by all that write to it") {
  const Folder folder;
  const std::string campaign = folder.write("c.json", quick_campaign(10).dump());
  const std::string path = folder.path() / "r", design = folder.path() / "s",
                    fresh = folder.path() / "fresh";
  Json sized = quick_campaign(10);
  sized["requirements"] =
      parse_json(R"([{ "output": "deployed", "probability": 0.5, "confidence": 0.5 }])");
  sized["margin"] =
      parse_json(R"({ "scale": ["hinges.*.spring.torque_stowed"], "range": [0.9, 1.1] })");
  const std::string margin = folder.write("m.json", sized.dump());
  const std::vector<std::string> sobol{"sensitivity", campaign, "--samples", "4", "--out", design};
  REQUIRE(run_program(folder, {"run", campaign, "--out", path}).code == 0);
  REQUIRE(run_program(folder, sobol).code == 0);
  const auto before = contents(path), design_before = contents(design);
  const FolderLock held(path), held_design(design), held_fresh(fresh);
  const std::vector<std::vector<std::string>> commands{
      {"run", campaign, "--out", path, "--resume"},
      {"run", campaign, "--out", fresh},
      {"analyze", path},
      {"sensitivity", path},
      {"sensitivity", design},
      {"sensitivity", campaign, "--samples", "4", "--out", design, "--resume"},
      {"margin", margin, "--out", fresh},
      {"merge", path, "--out", fresh}};
  for (const auto& command : commands) {
    CAPTURE(command);
    const auto [code, out, error] = run_program(folder, command);
    CHECK(code == 4);
    CHECK(out.empty());
    CHECK_THAT(error, Catch::StartsWith("error: " + folder.path().string()) &&
                          Catch::Contains(": found process " + std::to_string(getpid()) + " on ") &&
                          Catch::Contains("no other process"));
  }
  auto after = contents(path), design_after = contents(design);
  CHECK(after.erase(lock_file) == 1);
  CHECK(design_after.erase(lock_file) == 1);
  CHECK(after == before);
  CHECK(design_after == design_before);
}

TEST_CASE("a stray quote costs no row") {
  const Folder folder;
  const std::string campaign = folder.write("c.json", quick_campaign(60).dump());
  const std::string path = folder.path() / "r";
  REQUIRE(run_program(folder, {"run", campaign, "--out", path}).code == 0);
  const auto file = std::filesystem::path(path) / runs_file;
  std::string text = read_text(file).value();
  text.insert(text.find("\n4,deployed,") + 12, "\"");
  std::ofstream(file, std::ios::binary) << text;
  const auto [code, out, error] = run_program(folder, {"run", campaign, "--out", path, "--resume"});
  CHECK(code == 2);
  CHECK(error == "error: " + file.string() +
                     ": line 6: found a quote that is never closed, expected a closing quote\n");
  CHECK(read_text(file) == text);
}

TEST_CASE("rows that this program does not make are not gone on with") {
  const Folder folder;
  const std::string campaign = folder.write("c.json", quick_campaign(20).dump());
  const std::string path = folder.path() / "r";
  REQUIRE(run_program(folder, {"run", campaign, "--out", path}).code == 0);
  const auto file = std::filesystem::path(path) / runs_file;
  std::string text = read_text(file).value();
  const std::size_t row = text.find("\n9,"), end = text.find('\n', row + 1) + 1;
  const std::size_t digit =
      text.find(',', text.find("deployed,", row) + 9) - 4; // of the first draw
  text.resize(end);
  text[digit] = text[digit] == '1' ? '2' : '1';
  std::ofstream(file, std::ios::binary) << text;
  const auto [code, out, error] = run_program(folder, {"run", campaign, "--out", path, "--resume"});
  CHECK(code == 2);
  CHECK_THAT(error,
             Catch::StartsWith("error: " + file.string() +
                               ": found run 9, column root_spring: recorded as ") &&
                 Catch::EndsWith(
                     ", expected the same: all rows made by one program on one kind of machine\n"));
  CHECK(lines_of(error).size() == 1);
  CHECK(read_text(file) == text);
}

TEST_CASE("without room for statistics a campaign goes on, and says so") {
  const Folder folder;
  const Json json =
      quick_campaign(33'000); // columns of more than 32,768 numbers go to temporary files
  const std::string file = folder.write("c.json", json.dump()), path = folder.path() / "r";
  write_rows(path, campaign_of(json), 32'700);
  const std::string missing = folder.path() / "missing";
  const TemporaryFolder temporary(missing);
  const auto [code, out, error] = run_program(folder, {"run", file, "--out", path, "--resume"});
  CHECK(code == 4);
  CHECK(out.empty());
  CHECK_THAT(error, HasFacts({"error: " + missing + ": found No such file or directory", "TMPDIR",
                              "\nerror: 33000 of 33000 runs are kept",
                              "`wingspread analyze " + path + "`"}));
  CHECK(lines_in(std::filesystem::path(path) / runs_file) == 33'001);
  CHECK_FALSE(std::filesystem::exists(std::filesystem::path(path) / summary_file));
  setenv("TMPDIR", folder.path().c_str(), 1);
  CHECK(run_program(folder, {"analyze", path}).code == 0);
  CHECK(parse_json_file(std::filesystem::path(path) / summary_file)["runs"] == 33'000);
}

TEST_CASE("a scene without an end is refused") {
  const Folder folder;
  const std::string pipe = folder.path() / "pipe";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  CHECK(run_program(folder, {"check", "/dev/zero"}).error ==
        "error: /dev/zero: found a device, expected a regular file\n");
  const auto [code, out, error] = run_program(folder, {"check", pipe});
  CHECK(code == 2);
  CHECK(error == "error: " + pipe + ": found a pipe, expected a regular file\n");
}

TEST_CASE("what a file says does not reach the terminal as it is") {
  const Folder folder;
  const auto [code, out, error] = run_program(folder, {"check", folder.path() / "a\x1b[31mb"});
  CHECK(code == 2);
  CHECK_THAT(error, Catch::Contains(R"(a\x1b[31mb: found no file that can be read)"));
}

TEST_CASE("on a terminal each command that makes many runs shows how far it is") {
  const Folder folder;
  const std::string campaign = folder.write("c.json", quick_campaign(12).dump());
  const std::string margin = folder.write("m.json", one_panel_margin(90).dump());
  const std::string panel = folder.write("p.json", panel_campaign(0.01).dump());
  const std::string tests =
      folder.write("tests.json", R"({ "tests": [ { "name": "timer", "values": [
      { "output": "root.latch_time", "value": 2.3, "std": "10 ms" } ] } ],
    "fit": { "parameters": ["spring"], "starts": 2, "samples": 200 } })");
  const auto out = [&](const char* name) { return (folder.path() / name).string(); };
  const auto shows = [](const std::vector<std::string>& arguments,
                        std::initializer_list<std::string> facts) {
    CHECK_THAT(shown_on_terminal(arguments), HasFacts(facts));
  };
  shows({"run", campaign, "--out", out("run")}, {"12/12 runs"});
  shows({"sensitivity", campaign, "--samples", "4", "--out", out("design")}, {"24/24 runs"});
  shows({"margin", margin, "--out", out("margin")}, {"analysis 1 of at most", " runs"});
  shows({"rare", margin, "--output", "root.latch_rate", "--below=-0.9", "--samples", "100",
         "--repeats", "2"},
        {" of at most 2000 runs"});
  shows({"fit", panel, tests, "--out", out("fit")},
        {"sampling: ", " runs, effective sample size ", " of 200, split R-hat "});
}
