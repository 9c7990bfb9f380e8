#include "montecarlo/foundation/formats/printable.hpp"
#include "tests/cli/program.hpp"

#include <catch2/catch.hpp>
#include <sys/wait.h>

#include <fstream>
#include <pty.h>
#include <sstream>
#include <unistd.h>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("from nothing to a report: new, check, run, report") {
  const Folder folder;
  const std::string wing = folder.path() / "wing", campaign = wing + "/campaign.json";
  const auto made = run_program(
      folder, {"new", "--panels", "2", "--yoke", "--panel-mass", "9 kg", "--out", wing});
  CHECK(made.code == 0);
  CHECK(made.error.empty());
  CHECK_THAT(made.out, HasFacts({wing + "/scene.json\n", campaign, wing + "/README.md", "next:",
                                 "wingspread check " + campaign, "wingspread run " + campaign,
                                 "wingspread report " + wing + "/results"}));
  const std::string picture = folder.path() / "wing.svg";
  const auto checked = run_program(folder, {"check", campaign, "--strict", "--draw", picture});
  CHECK(checked.code == 0);
  CHECK(checked.error.empty());
  CHECK_THAT(checked.out, HasFacts({"mass of 3 bodies: 21.5 kg", "cost: the nominal run takes ",
                                    " evaluations, ", "3000 runs in 3 cases: about "}));
  CHECK(read_text(picture).value().starts_with("<svg "));
  const std::string results = wing + "/results";
  const auto run = run_program(folder, {"run", campaign, "--out", results, "--runs", "60"});
  CHECK(run.code == 1); // 60 runs cannot show 99.73 %
  CHECK(run.error.find("warning") == std::string::npos);
  for (const char* name : {"cold", "ambient", "hot"}) {
    const Json summary = parse_json_file(results + "/" + name + "/summary.json");
    CHECK(summary["status"]["deployed"]["count"] == 60);
    CHECK(summary["nominal"]["status"] == "deployed");
  }
  const auto report = run_program(folder, {"report", results});
  CHECK(report.code == 0);
  CHECK(report.error.empty());
}

TEST_CASE("new keeps files that it did not make, and makes the same ones again") {
  const Folder folder;
  const std::string wing = folder.path() / "wing", scene = wing + "/scene.json";
  const std::vector<std::string> words{"new", "--panels", "1", "--out", wing};
  REQUIRE(run_program(folder, words).code == 0);
  const auto before = contents(wing);
  CHECK(run_program(folder, words).code == 0);
  CHECK(contents(wing) == before);
  const auto other = run_program(folder, {"new", "--panels", "2", "--out", wing});
  CHECK(other.code == 2);
  CHECK(other.error.starts_with("error: --out: found \"" + scene + "\", an existing file"));
  CHECK(lines_of(other.error).size() == 3);
  CHECK(contents(wing) == before);
}

TEST_CASE("numbers of a yoke need a yoke") {
  const Folder folder;
  for (const char* option : {"--yoke-mass", "--yoke-length"}) {
    const std::string out = folder.path() / option;
    const auto refused = run_program(folder, {"new", "--out", out, "--panels", "2", option, "2"});
    CHECK(refused.code == 2);
    CHECK_THAT(refused.error, HasFacts({option, "requires --yoke"}));
    CHECK(run_program(folder, {"new", "--out", out, "--yoke", option, "2"}).code == 0);
  }
}

TEST_CASE("a wing with its root hinge only has no spring of other hinges") {
  const Folder folder;
  const std::string out = folder.path() / "w";
  const Finished refused =
      run_program(folder, {"new", "--out", out, "--panels", "1", "--spring", "77"});
  CHECK(refused.code == 2);
  CHECK_THAT(refused.error, HasFacts({"--spring", "77", "--root-spring"}));
  CHECK_FALSE(std::filesystem::exists(out));
  CHECK(run_program(folder, {"new", "--out", out, "--panels", "1", "--root-spring", "0.4",
                             "--harness", "0.02"})
            .code == 0);
  CHECK(parse_json_file(out + "/scene.json")["hinges"][0]["latch"]["stiffness"] == 5000 * 0.4);
}

TEST_CASE("new refuses a wing that cannot be, and says if one does not deploy") {
  const Folder folder;
  const std::string out = folder.path() / "w";
  const auto refused = [&](const std::vector<std::string>& options) {
    std::vector<std::string> words{"new", "--out", out};
    words.insert(words.end(), options.begin(), options.end());
    const auto done = run_program(folder, words);
    CHECK(done.code == 2);
    return done.error;
  };
  CHECK_THAT(refused({"--panel-mass", "9 m"}),
             HasFacts({"--panel-mass", "found 9 m, expected a number, kg, > 0"}));
  CHECK_THAT(refused({"--wings", "3"}), HasFacts({"--wings"}));
  CHECK_THAT(refused({"--name", "a/b"}), HasFacts({"--name: found \"a/b\""}));
  CHECK_THAT(refused({"--example", "yoke", "--panels", "3"}), HasFacts({"--example"}));
  CHECK_FALSE(std::filesystem::exists(out));
  const auto stalls = run_program(folder, {"new", "--harness", "5", "--out", out});
  CHECK(stalls.code == 0);
  CHECK_THAT(stalls.error, HasFacts({"warning: the nominal wing does not deploy"}));
  const std::string page = read_text(out + "/README.md").value();
  for (const char* claim : {"twice the", "three times"}) CHECK_THAT(page, !Catch::Contains(claim));
  CHECK_THAT(page, HasFacts({"a placeholder", "a placeholder", "placeholders"}));
}

TEST_CASE("the commands on a new wing's page deploy it, however slow it is") {
  const Folder folder;
  const std::string out = folder.path() / "slow";
  REQUIRE(
      run_program(folder, {"new", "--panels", "2", "--panel-mass", "5000", "--out", out}).code ==
      0);
  CHECK(parse_json_file(out + "/campaign.json")["integration"]["t_end"] > 60);
  long commands = 0;
  for (const std::string& line : lines_of(read_text(out + "/README.md").value())) {
    if (!line.starts_with("    wingspread simulate ")) continue;
    std::istringstream in(line);
    std::string program, command, file;
    in >> program >> command >> file;
    const Finished done = run_program(folder, {command, out + '/' + file, "--json"});
    CHECK(parse_json(done.out)["status"] == "deployed");
    ++commands;
  }
  CHECK(commands == 1);
}

TEST_CASE("an example is copied by its name, and runs from its copy") {
  const Folder folder;
  const std::string out = folder.path() / "yoke";
  REQUIRE(run_program(folder, {"new", "--example", "yoke", "--out", out}).code == 0);
  CHECK(run_program(folder, {"check", out + "/campaign.json", "--strict"}).code == 0);
  const auto unknown = run_program(folder, {"new", "--example", "nothing", "--out", out + "2"});
  CHECK(unknown.code == 2);
  CHECK_THAT(unknown.error, HasFacts({"--example", "one of bending_wings, correlated, long_chain, ",
                                      "yoke_wing"}));
}

namespace {

/// Collects the commands in a page's data.
void find_commands(const Json& part, std::vector<std::string>& commands) {
  if (part.is_string() && part.get_ref<const std::string&>().starts_with("wingspread "))
    commands.push_back(part.get<std::string>());
  if (part.is_structured())
    for (const Json& each : part) find_commands(each, commands);
}

} // namespace

TEST_CASE("printed commands quote their paths for a shell") {
  const Folder folder;
  const std::string wing = folder.path() / "it's a&b", quoted = shell_word(wing + "/campaign.json");
  REQUIRE(quoted.ends_with(R"(/it'\''s a&b/campaign.json')"));
  const auto made = run_program(folder, {"new", "--panels", "1", "--name", "w", "--out", wing});
  REQUIRE(made.code == 0);
  CHECK_THAT(made.out,
             HasFacts({"  wingspread check " + quoted + " --draw ",
                       "  wingspread run " + quoted + " --out ", "  wingspread report "}));
  CHECK_THAT(
      read_text(wing + "/README.md").value(),
      Catch::Contains("    wingspread new --name w --panels 1 --out " + shell_word(wing) + "\n"));
  const std::string results = wing + "/r 1", campaign = wing + "/campaign.json";
  const Finished done =
      run_program(folder, {"run", campaign, "--out", results, "--runs", "20", "--table"});
  REQUIRE(done.code <= 1);
  REQUIRE(run_program(folder, {"report", results}).code == 0);
  std::vector<std::string> commands;
  find_commands(page_data(results + "/report.html"), commands);
  REQUIRE(commands.size() >= 3); // how the page, the runs and a motion are made
  for (const std::string& command : commands) {
    CAPTURE(command);
    const std::size_t at = command.find(folder.path().string());
    CHECK((at == std::string::npos || command[at - 1] == '\''));
  }
  const auto replayed = run_program(
      folder, {"replay", results, "--case", "cold", "--run", "0", "--scene", wing + "/s 1.json"});
  CHECK_THAT(replayed.out,
             Catch::Contains("\n  wingspread simulate " + shell_word(wing + "/s 1.json") + " "));
}

TEST_CASE("the end of the input at a question writes no wing") {
  const Folder folder;
  int terminal = -1;
  const pid_t child = forkpty(&terminal, nullptr, nullptr, nullptr);
  if (child == 0) {
    if (chdir(folder.path().c_str()) == 0) execl(program_path, "wingspread", "new", nullptr);
    _exit(127);
  }
  CHECK(write(terminal, "sat\n\x04", 5) == 5); // a name, then Ctrl-D
  std::string said;
  char part[4096];
  for (ssize_t got = 0; (got = read(terminal, part, sizeof part)) > 0;) said.append(part, got);
  int status = 0;
  CHECK(waitpid(child, &status, 0) == child);
  close(terminal);
  CHECK(WEXITSTATUS(status) == 2);
  CHECK_THAT(said, HasFacts({"the end of the input", "nothing is written"}));
  CHECK(std::filesystem::is_empty(folder.path()));
}
