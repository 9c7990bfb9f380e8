/// The command line as data: what completions and man pages are made of.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace wingspread {

/// An option, or what stands at its place on the command line.
struct ArgumentEntry {
  std::vector<std::string> names; ///< "--out", the short ones first; of a positional its name alone
  std::string value;              ///< what it takes, for people: "N"; empty of a flag
  std::vector<std::string> words; ///< all that it takes, where that is a list
  bool takes_file = false;        ///< or a folder, or any text
  std::string description;
  bool is_required = false, is_repeated = false;
};

struct CommandEntry {
  std::string name; ///< "run"; of the program itself "wingspread"
  std::string description, footer;
  std::vector<ArgumentEntry> positionals, options;
};

/// The program itself and its commands as --help lists them; not those that it does not list.
[[nodiscard]] std::vector<CommandEntry> command_table(const CLI::App& app);

} // namespace wingspread
