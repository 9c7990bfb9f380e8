#include "montecarlo/interfaces/commands/cli.hpp"
#include "montecarlo/interfaces/package/completion.hpp"
#include "montecarlo/interfaces/package/man_page.hpp"

#include <CLI/CLI.hpp>
#include <catch2/catch.hpp>

using namespace wingspread;

namespace {

/// A made-up command line with everything that shells and roff could take for something else.
std::vector<CommandEntry> made_up_table() {
  ArgumentEntry out{
      {"-o", "--out"}, "FILE", {}, true, "A file: [it's] \"new\" - or not", true, false};
  ArgumentEntry shape{{"--shape"}, "TEXT", {"round", "flat"}, false, "'one' of two", false, false};
  ArgumentEntry thing{{"thing"}, "TEXT", {}, true, "What is meant", true, true};
  return {{"wingspread", "It spreads.", "", {}, {}},
          {"go",
           "Goes",
           ".Not a macro\n\n'nor\\this\n\nExample:\n  wingspread go -o x",
           {thing},
           {out, shape}}};
}

} // namespace

TEST_CASE("the command line as data has every command and option that is listed, and no other") {
  CLI::App app("It", "wingspread");
  Action action;
  for (const Command& command : all_commands()) command.add(app, action);
  const std::vector<CommandEntry> table = command_table(app);
  CHECK(table[0].name == "wingspread");
  const auto find = [&](const std::string& name) {
    return std::ranges::find(table, name, &CommandEntry::name);
  };
  CHECK(find("man") == table.end()); // it is not listed
  const auto simulate = find("simulate");
  REQUIRE(simulate != table.end());
  REQUIRE(simulate->positionals.size() == 1);
  CHECK(simulate->positionals[0].takes_file);
  CHECK(simulate->positionals[0].is_required);
  const auto option = [&](const char* name) {
    return *std::ranges::find_if(simulate->options, [&](const ArgumentEntry& each) {
      return std::ranges::find(each.names, name) != each.names.end();
    });
  };
  CHECK(option("--help").names == std::vector<std::string>{"-h", "--help"});
  CHECK(option("--json").value.empty());
  CHECK(option("--latch").words == std::vector<std::string>{"event"});
  CHECK_FALSE(option("--dt").takes_file);
  CHECK(option("--set").is_repeated);
}

TEST_CASE("words that shells and roff could take for something else are theirs no more") {
  const auto table = made_up_table();
  const auto has = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
  };
  const std::string bash = completion_script(table, Shell::bash);
  CHECK(has(bash, "      -o|--out) reply -f; return;;\n"));
  CHECK(has(bash, "      --shape) reply -W \"round flat\"; return;;\n"));
  const std::string zsh = completion_script(table, Shell::zsh);
  CHECK(has(zsh, "'--out[A file\\: \\[it'\\''s\\] \"new\" - or not]:FILE:_files'"));
  CHECK(has(zsh, "'--shape['\\''one'\\'' of two]:TEXT:(round flat)'"));
  CHECK(has(zsh, "'*:thing:_files'"));
  const std::string fish = completion_script(table, Shell::fish);
  CHECK(has(fish, " -s o -l out -r -F -d 'A file: [it'\\''s] \"new\" - or not'\n"));
  CHECK(has(fish, " -l shape -x -a 'round flat' -d"));
  const std::string page = man_page(table, table[1], "1-2");
  CHECK(has(page, ".TH WINGSPREAD\\-GO 1 \"\" \"wingspread 1\\-2\" \"User Commands\"\n"));
  CHECK(has(page, "\\fBwingspread go\\fR \\fIthing\\fR ... \\fB\\-\\-out\\fR \\fIFILE\\fR "
                  "[\\fIOPTIONS\\fR]\n"));
  CHECK(has(page, ".TP\n\\fB\\-o\\fR, \\fB\\-\\-out\\fR \\fIFILE\\fR\n"));
  CHECK(has(page, "\n\\&.Not a macro\n.PP\n\\&'nor\\ethis\n.PP\n.SH EXAMPLE\n.PP\n.nf\n  "
                  "wingspread go \\-o x\n.fi\n"));
}
