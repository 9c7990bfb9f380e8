#include "montecarlo/results/results_folder/cases_folder.hpp"
#include "tests/cli/program.hpp"

#include <catch2/catch.hpp>
#include <linux/capability.h>
#include <sys/prctl.h>

#include <cmath>
#include <fstream>
#include <thread>
#include <unistd.h>

using namespace wingspread;
using namespace wingspread::test;

namespace {

struct Done {
  Folder folder{};
  std::filesystem::path path = folder.path() / "r", page = path / "report.html";
  explicit Done(const Json& json, const Session& session = {}) {
    (void)run_into(path, campaign_of(json), session);
  }

  [[nodiscard]] Finished program(const std::vector<std::string>& arguments) const {
    return run_program(folder, arguments);
  }
};

/// As somebody for whom what may only be read is so; root is asked no questions, and gives that up for it.
Finished run_as_reader(const Folder& folder, const std::vector<std::string>& arguments) {
  Finished done{};
  std::thread([&] { // the bounding set is a thread's own, and that of the processes that it starts
    prctl(PR_CAPBSET_DROP, CAP_DAC_OVERRIDE);
    prctl(PR_CAPBSET_DROP, CAP_DAC_READ_SEARCH);
    done = run_program(folder, arguments);
  })
      .join();
  return done;
}

/// A folder with all below it that may only be read, while this lives.
class ReadOnly {
public:
  explicit ReadOnly(std::filesystem::path folder) : folder_(std::move(folder)) { set(false); }
  ~ReadOnly() { set(true); }
  ReadOnly(const ReadOnly&) = delete;
  ReadOnly& operator=(const ReadOnly&) = delete;

private:
  void set(bool writable) const {
    const auto change = [&](const std::filesystem::path& path) {
      using std::filesystem::perms;
      using std::filesystem::perm_options;
      std::filesystem::permissions(path, perms::owner_write | perms::group_write,
                                   writable ? perm_options::add : perm_options::remove);
    };
    change(folder_);
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_)) change(entry);
  }
  std::filesystem::path folder_;
};

} // namespace

TEST_CASE("report and analyze read a folder that may only be read, and write elsewhere",
          "[report][cases]") {
  const Folder folder;
  const bool cases = GENERATE(false, true);
  Json json = quick_campaign(10);
  if (cases)
    json["cases"] = parse_json(
        R"([ { "name": "as_it_is" }, { "name": "weak", "scale": { "hinges.*.spring.scale": 0.9 } } ])");
  const std::string file = folder.write("c.json", json.dump()), path = folder.path() / "r",
                    page = folder.path() / "page.html", again = folder.path() / "again";
  REQUIRE(run_program(folder, {"run", file, "--out", path}).code == 0);
  const auto before = contents(path);
  {
    const ReadOnly read_only(path);
    const Finished refused = run_as_reader(folder, {"analyze", path});
    if (refused.code == 0 && geteuid() == 0) {
      WARN("root here cannot give up its rights");
      return;
    }
    CHECK(refused.code == 4);
    CHECK_THAT(refused.error, Catch::Contains("expected a folder that can be written; --out DIR "));
    const Finished unreported = run_as_reader(folder, {"report", path});
    CHECK(unreported.code == 4);
    CHECK_THAT(unreported.error,
               Catch::Contains("expected a folder that can be written; --out FILE "));
    const std::string one = cases ? path + "/weak" : path, tables = folder.path() / "tables";
    const Finished unranked = run_as_reader(folder, {"sensitivity", one});
    CHECK(unranked.code == 4);
    CHECK_THAT(unranked.error,
               Catch::Contains("expected a folder that can be written; --out DIR "));
    const Finished ranked = run_as_reader(folder, {"sensitivity", one, "--out", tables});
    CHECK(ranked.code == 0);
    CHECK(std::filesystem::exists(tables + "/sensitivity.json"));
    const Finished reported = run_as_reader(folder, {"report", path, "--out", page});
    CHECK(reported.error.empty());
    CHECK(reported.code == 0);
    CHECK(run_as_reader(folder, {"report", path, path, "--out", page}).code == 2);
    const Finished analyzed = run_as_reader(folder, {"analyze", path, "--out", again});
    CHECK(analyzed.error.empty());
    CHECK(analyzed.code == 0);
    CHECK(std::filesystem::exists(again + (cases ? "/weak/summary.json" : "/summary.json")));
  }
  CHECK(contents(path) == before);

  const FolderLock held(path);
  const ReadOnly read_only(path);
  const Finished second = run_as_reader(folder, {"report", path, "--out", page});
  CHECK(second.code == 4);
  CHECK_THAT(second.error, Catch::Contains(": found process " + std::to_string(getpid()) + " on "));
}

TEST_CASE("report writes one page, the same bytes on any number of threads", "[report][parallel]") {
  const Done done(full_campaign(40));
  const auto before = contents(done.path);
  const auto [code, out, error] = done.program({"report", done.path, "--threads", "1"});
  CHECK(code == 0);
  CHECK(error.empty());
  CHECK(out == done.page.string() + "\n");
  const std::string bytes = read_text(done.page).value();
  CHECK(done.program({"report", done.path, "--threads", "2"}).code == 0);
  CHECK(read_text(done.page).value() == bytes);
  std::filesystem::remove(done.page);
  CHECK(contents(done.path) == before); // and nothing else was touched
  const auto elsewhere = done.folder.path() / "page.html";
  CHECK(done.program({"report", done.path, "--out", elsewhere}).out == elsewhere.string() + "\n");
  CHECK(read_text(elsewhere).value() == bytes);
  CHECK(!std::filesystem::exists(done.page));
  const Json data = page_data(elsewhere);
  CHECK(data["format"] == 1);
  CHECK(data["command"] == "wingspread report " + done.path.string());
  REQUIRE(data["sets"].size() == 1);
  CHECK(data["sets"][0]["label"] == "r");
  CHECK(data["sets"][0]["seed"] == "7");
  CHECK(data["sets"][0]["runs"] == 40);
  CHECK(data["comparisons"].empty());
}

TEST_CASE("a folder given twice is refused as such, under any of its names", "[report]") {
  const Done done(quick_campaign(3), {.shard = Shard{1, 2}});
  const std::string path = done.path, link = done.folder.path() / "link",
                    whole = done.folder.path() / "whole";
  std::filesystem::create_directory_symlink(path, link);
  const auto before = contents(path);
  for (const std::string& other : {path, link, path + "/."})
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"report", path, other},
          {"report", path, other, "--out", done.folder.path() / "page.html"},
          {"merge", path, other, "--out", whole}}) {
      const Finished refused = done.program(command);
      CAPTURE(command[0], other);
      CHECK((refused.code == 2 && refused.out.empty()));
      CHECK_THAT(refused.error, HasFacts({"error: " + other + ": ", "the same folder", "once"}));
      CHECK(lines_of(refused.error).size() == 1);
    }
  CHECK(contents(path) == before);
  CHECK_FALSE(std::filesystem::exists(whole));
}

TEST_CASE("report says that a finished shard is no whole campaign", "[report]") {
  const Done done(quick_campaign(4), {.shard = Shard{1, 2}});
  const Finished made = done.program({"report", done.path});
  CHECK((made.code == 0 && lines_of(made.error).size() == 1));
  CHECK_THAT(made.error, HasFacts({"warning: " + done.path.string(), "shard 1/2", "merge"}));
}

TEST_CASE("report refuses what is no results folder, with its place", "[report]") {
  const Done done(quick_campaign(3));
  const std::string nowhere = done.folder.path() / "nowhere", f = done.folder.path();
  const auto expect = [&](const std::vector<std::string>& arguments, int code,
                          const std::string& message) {
    const Finished refused = done.program(arguments);
    CHECK(refused.code == code);
    CHECK(refused.out.empty());
    CHECK(refused.error == message);
  };
  expect({"report"}, 2, "error: folders is required\nerror: see wingspread report --help\n");
  expect({"report", nowhere}, 2,
         "error: " + nowhere + ": found no such folder, expected a results folder\n");
  expect({"report", f}, 2,
         "error: " + f +
             ": found no campaign.json in it, expected a results folder: one that "
             "`wingspread run` or `merge` wrote\n");
  CHECK(!std::filesystem::exists(nowhere));
  const std::string into = done.folder.path() / "no/such/page.html";
  const Finished unwritable = done.program({"report", done.path, "--out", into});
  CHECK(unwritable.code != 0);
  CHECK(unwritable.error.find(into) != std::string::npos);
  std::vector<std::string> many{"report"};
  for (int k = 0; k < 13; ++k) many.push_back(done.path);
  CHECK(done.program(many).code != 0);
}

TEST_CASE("a damaged summary is refused with the command that writes it again", "[report]") {
  const Folder folder;
  const std::string file = folder.write("c.json", quick_campaign(10).dump()),
                    out = folder.path() / "r";
  REQUIRE(run_program(folder, {"run", file, "--out", out}).code == 0);
  std::filesystem::resize_file(out + "/summary.json", 100);
  const auto refused = run_program(folder, {"report", out, "--out", folder.path() / "page.html"});
  CHECK(refused.code == 2);
  CHECK_THAT(refused.error, HasFacts({out + "/summary.json", "wingspread analyze " + out}));
  CHECK(run_program(folder, {"analyze", out}).code == 0);
  CHECK(run_program(folder, {"report", out, "--out", folder.path() / "page.html"}).code == 0);
}

TEST_CASE("report shows a single run", "[report]") {
  const Done single(full_campaign(1));
  CHECK(single.program({"report", single.path}).code == 0);
  const Json one = page_data(single.page)["sets"][0];
  CHECK(one["runs"] == 1);
  CHECK(one["correlations"].is_null());
  CHECK(one["sensitivity"].is_null());
}

TEST_CASE("report shows a campaign without a run that deployed", "[report]") {
  Json json = full_campaign(5);
  json["dispersions"][1]["distribution"] = {{"type", "constant"}, {"value", -1}};
  const Done invalid(json);
  CHECK(invalid.program({"report", invalid.path}).code == 0);
  const Json none = page_data(invalid.page)["sets"][0];
  CHECK(none["statuses"][3]["count"] == 5);
  CHECK(none["envelopes"].is_null());
  CHECK(none["motions"].empty()); // the nominal wing, at the medians, is unphysical too
  CHECK(none["outputs"][0]["count"] == 0);
}

TEST_CASE("report says when runs are missing", "[report]") {
  const Done done(quick_campaign(10));
  const auto lines = lines_of(read_text(done.path / runs_file).value());
  std::string part;
  for (std::size_t k = 0; k < 5; ++k) part += lines[k] + '\n';
  std::ofstream(done.path / runs_file, std::ios::binary) << part;
  CHECK(done.program({"report", done.path}).code == 0);
  const Json set = page_data(done.page)["sets"][0];
  CHECK(set["partial"] == true);
  CHECK(set["runs"] == 4);
  CHECK(set["planned"] == 10);
}

TEST_CASE("report says which cases of an interrupted campaign lack runs", "[report][cases]") {
  const Folder folder;
  Json json = quick_campaign(40);
  json["cases"] = parse_json(
      R"([ { "name": "as_it_is" }, { "name": "weak", "scale": { "hinges.*.spring.scale": 0.9 } } ])");
  json["requirements"] =
      parse_json(R"([{ "output": "deployed", "probability": 0.5, "confidence": 0.9 }])");
  const std::string file = folder.write("c.json", json.dump()), path = folder.path() / "r";
  const auto page = [&] { return page_data(path + "/report.html"); };
  REQUIRE(run_program(folder, {"run", file, "--out", path}).code == 0);
  CHECK(run_program(folder, {"report", path}).error.empty());
  CHECK(page()["unmade"].empty());
  std::filesystem::remove_all(path + "/weak"); // it was not begun
  std::filesystem::remove(path + "/cases.json");
  const Finished none = run_program(folder, {"report", path});
  CHECK(none.code == 0);
  CHECK_THAT(none.error, HasFacts({"warning: ", "no run of case weak"}));
  CHECK(
      page()["unmade"] ==
      parse_json(R"([{ "label": "weak", "case": "weak", "planned": 40, "campaign_folder": 0 }])"));
  std::filesystem::resize_file(path + "/as_it_is/runs.csv", 3000); // as a crash leaves it
  const Finished some = run_program(folder, {"report", path});
  const long runs = page()["sets"][0]["runs"];
  CHECK((runs > 0 && runs < 40));
  CHECK_THAT(some.error, HasFacts({"warning: ", std::to_string(runs) + " of 40 runs",
                                   "as_it_is, none of weak"}));
}

TEST_CASE("report makes no run again of another tool's rows", "[report]") {
  const Done done(full_campaign(10));
  Json campaign = parse_json_file(done.path / campaign_file);
  campaign.erase(stamp_key);
  std::ofstream(done.path / campaign_file, std::ios::binary) << campaign.dump();
  CHECK(done.program({"report", done.path}).code == 0);
  const Json set = page_data(done.page)["sets"][0];
  CHECK(set["foreign"] == true);
  CHECK(set["motions"].empty());
  CHECK(set["envelopes"].is_null());
  CHECK(set["made_by"] == "");
  CHECK(set["outputs"][0]["count"].get<long>() > 0);
}

TEST_CASE("report has a set for each case, and compares them run by run", "[report][cases]") {
  const Folder folder;
  Json json = quick_campaign(20);
  json["cases"] = parse_json(
      R"([ { "name": "as_it_is" }, { "name": "weak", "scale": { "hinges.*.spring.torque_stowed": 0.8, "hinges.*.spring.torque_latched": 0.8 } } ])");
  const std::string file = folder.write("c.json", json.dump()), out = folder.path() / "r";
  REQUIRE(run_program(folder, {"run", file, "--out", out}).code == 0);
  REQUIRE(run_program(folder, {"report", out}).code == 0);
  const Json data = page_data(folder.path() / "r/report.html");
  REQUIRE(data["sets"].size() == 2);
  CHECK(data["sets"][0]["label"] == "as_it_is");
  CHECK(data["sets"][1]["case"] == "weak");
  REQUIRE(data["comparisons"].size() == 1);
  CHECK(data["comparisons"][0]["paired"] == true);
  CHECK(data["comparisons"][0]["text"] ==
        "weak − as_it_is, run by run over the 20 runs with the same random numbers");
  CHECK(data["comparisons"][0]["outputs"].back()["lower"].get<double>() >
        0); // the weaker, the slower
}

TEST_CASE("folders with cases are compared case by case, over the runs that both have",
          "[report][cases]") {
  const Folder folder;
  Json json = quick_campaign(20);
  json["cases"] = parse_json(R"([ { "name": "cold" }, { "name": "ambient" }, { "name": "hot" } ])");
  const std::string first = folder.write("c.json", json.dump());
  json["sampling"]["runs"] = 12;
  json["cases"] = parse_json(R"([ { "name": "hot" }, { "name": "space" }, { "name": "cold" } ])");
  const std::string second = folder.write("d.json", json.dump());
  const std::string plain = folder.write("e.json", quick_campaign(5).dump());
  const std::string a = folder.path() / "A", b = folder.path() / "B", c = folder.path() / "C";
  REQUIRE(run_program(folder, {"run", first, "--out", a, "--case", "cold", "--case", "hot"}).code ==
          0);
  REQUIRE(run_program(folder, {"run", second, "--out", b}).code == 0);
  REQUIRE(run_program(folder, {"run", plain, "--out", c}).code == 0);
  const auto compared = [&](std::vector<std::string> folders) {
    const std::string page = folder.path() / "page.html";
    folders.insert(folders.begin(), "report");
    folders.insert(folders.end(), {"--out", page});
    REQUIRE(run_program(folder, folders).code == 0);
    const Json data = page_data(page);
    std::vector<std::string> texts;
    for (const Json& each : data["comparisons"]) texts.push_back(each["text"]);
    for (const Json& each : data["unpaired"]) texts.push_back(each);
    return texts;
  };
  const std::string over = ", run by run over the 12 runs with the same random numbers",
                    of = over + " (of 12 and 20)";
  CHECK(compared({a, b}) ==
        std::vector<std::string>{
            "B · hot − A · hot" + of, "B · cold − A · cold" + of,
            "A · hot − A · cold, run by run over the 20 runs with the same random numbers",
            "B · space − B · hot" + over, "B · cold − B · hot" + over,
            "B · cold − B · space" + over,
            "B · space: none of A · cold, A · hot is the case space"});
  CHECK(compared({a + "/cold", b + "/hot"}) ==
        std::vector<std::string>{"hot − cold" + of}); // as asked
  CHECK(compared({c, b + "/cold"}).size() == 1);
  const auto apart = compared({b, c});
  REQUIRE(apart.size() == 3 + 4);
  CHECK(apart.back() == "C: none of B · hot, B · space, B · cold is without a case");
}

TEST_CASE("a page of many runs keeps to its size", "[report]") {
  Json json = quick_campaign(20'000);
  const Done done(quick_campaign(20));
  const Campaign campaign = campaign_of(json);
  const Results made = read_stored_results(read_stored_campaign(done.path)).results;
  std::string csv; // rows that no one ran: those of twenty, over and over and a little off
  append_header(csv, RunPlan(campaign).names());
  for (long run = 0; run < 20'000; ++run) {
    ResultRow row = made.row(static_cast<std::size_t>(run % 20));
    row.run = run;
    for (double& output : row.outputs) output *= 1 + 1e-3 * std::sin(static_cast<double>(run));
    append_row(csv, row);
  }
  const auto many = done.folder.path() / "many";
  std::filesystem::create_directories(many);
  std::ofstream(many / campaign_file, std::ios::binary)
      << campaign_text(campaign, stamp_of(campaign, {}));
  std::ofstream(many / runs_file, std::ios::binary) << csv;
  CHECK(done.program({"report", many}).code == 0);
  CHECK(std::filesystem::file_size(many / "report.html") < 4'000'000);
  CHECK(page_data(many / "report.html")["sets"][0]["runs"] == 20'000);
}

TEST_CASE("page and program say in the same words which runs are missing", "[report][cases]") {
  const Done part(full_campaign(40), {.stop_after = 12});
  const long made = parse_json_file(part.path / "summary.json")["runs"];
  REQUIRE(made < 40);
  const Finished reported = part.program({"report", part.path});
  const std::string missing = std::to_string(made) + " of 40 runs";
  CHECK(reported.error == "warning: incomplete: " + missing + "\n"); // it has no requirements
  CHECK(page_data(part.page)["incomplete"] == missing);

  Json json = quick_campaign(4500);
  json["outputs"] = {"latch_time"};
  json["requirements"] =
      parse_json(R"([ { "output": "deployed", "probability": 0.5, "confidence": 0.5 } ])");
  json["cases"] =
      parse_json(R"([ { "name": "as_it_is" }, { "name": "hot" }, { "name": "cold" } ])");
  const std::string file = part.folder.write("c.json", json.dump()),
                    path = part.folder.path() / "cases";
  REQUIRE(part.program({"run", file, "--out", path, "--case", "hot"}).code == 0);
  const Finished cases = part.program({"report", path});
  CHECK_THAT(cases.error,
             Catch::Contains("incomplete: no run of case as_it_is and cold; requirements of "
                             "as_it_is and cold are not judged\n"));
  CHECK(page_data(path + "/report.html")["incomplete"] == "no run of case as_it_is and cold");
}
