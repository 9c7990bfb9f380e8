/// Parses a command line, one argument per line. It is accepted, or ends with exit code 0 (--help) or 2. Commands
/// without files are also executed; they end with a documented exit code.
#include "montecarlo/interfaces/commands/cli.hpp"
#include "tests/fuzz/fuzz.hpp"

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

using namespace wingspread;

namespace {

std::vector<std::string> arguments_in(std::string_view text) {
  std::vector<std::string> arguments{"wingspread"};
  std::istringstream in{std::string(text)};
  for (std::string line; std::getline(in, line) && arguments.size() < 64;)
    arguments.push_back(line);
  return arguments;
}

/// Adds the commands that the arguments name; all commands for one input in 16. Adding all takes ten times as long, and
/// commands are independent of each other.
std::vector<Command> commands_for(const std::vector<std::string>& arguments, std::size_t size) {
  std::vector<Command> commands;
  for (const Command& command : all_commands())
    if (size % 16 == 0 || std::ranges::find(arguments, command.name) != arguments.end())
      commands.push_back(command);
  return commands;
}

/// Commands that neither read nor write files.
bool is_harmless(const std::vector<std::string>& arguments) {
  return arguments.size() > 1 &&
         (arguments[1] == "size" || arguments[1] == "methods" || arguments[1] == "version");
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::vector<std::string> arguments = arguments_in(test::text_of(data, size));
  std::vector<const char*> argv;
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  const int argc = static_cast<int>(argv.size());
  const ParsedArguments parsed = parse_arguments(argc, argv.data(), commands_for(arguments, size));
  test::demand(parsed.action || parsed.code == exit_code::done ||
                   parsed.code == exit_code::bad_input,
               "a command line is done with by --help, or bad input");
  if (!parsed.action || !is_harmless(arguments)) return 0;
  const int code = run_action(parsed.action);
  test::demand(code == exit_code::done || code == exit_code::bad_input,
               "a question is answered, or refused");
  return 0;
}
