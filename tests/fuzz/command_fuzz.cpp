/// The command line, one argument a line. It is understood, or refused with exit code 0 (--help) or 2. What reads
/// and writes no file is also done: the codes that FORMATS has.
#include "montecarlo/commands/cli.hpp"
#include "tests/fuzz/fuzz.hpp"

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

/// What reads no file and writes none.
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
  const Understood understood = understand(argc, argv.data());
  test::demand(understood.action || understood.code == exit_code::done ||
                   understood.code == exit_code::bad_input,
               "a command line is done with by --help, or bad input");
  if (!understood.action || !is_harmless(arguments)) return 0;
  const int code = carry_out(understood.action);
  test::demand(code == exit_code::done || code == exit_code::bad_input,
               "a question is answered, or refused");
  return 0;
}
