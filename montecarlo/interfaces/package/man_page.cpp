#include "montecarlo/interfaces/package/man_page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <span>
#include <sstream>

namespace wingspread {
namespace {

/// Text that means nothing to roff: hyphens that can be copied, no escapes, and no macro at a line's beginning.
std::string roff(std::string_view text) {
  std::string safe;
  for (const char letter : text) {
    if (letter == '-')
      safe += "\\-";
    else if (letter == '\\')
      safe += "\\e";
    else if ((letter == '.' || letter == '\'') && (safe.empty() || safe.back() == '\n'))
      safe += fmt::format("\\&{}", letter);
    else
      safe += letter;
  }
  return safe;
}

std::string upper(std::string_view text) {
  std::string all(text);
  std::ranges::transform(all, all.begin(), [](unsigned char letter) {
    return static_cast<char>(std::toupper(letter));
  });
  return all;
}

std::string option_text(const ArgumentEntry& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.names) names.push_back("\\fB" + roff(name) + "\\fR");
  const std::string value =
      option.words.empty() ? option.value : fmt::format("{}", fmt::join(option.words, "|"));
  return fmt::format(".TP\n{}{}\n{}{}\n", fmt::join(names, ", "),
                     value.empty() ? "" : " \\fI" + roff(value) + "\\fR", roff(option.description),
                     option.is_required ? " (required)" : "");
}

std::string synopsis(const CommandEntry& command, bool is_program) {
  if (is_program) return "\\fBwingspread\\fR \\fICOMMAND\\fR [\\fIOPTIONS\\fR]\n";
  std::string line = "\\fBwingspread " + roff(command.name) + "\\fR";
  for (const ArgumentEntry& positional : command.positionals) {
    const std::string name = fmt::format("\\fI{}\\fR{}", roff(positional.names[0]),
                                         positional.is_repeated ? " ..." : "");
    line += positional.is_required ? ' ' + name : " [" + name + ']';
  }
  for (const ArgumentEntry& option : command.options)
    if (option.is_required)
      line += fmt::format(" \\fB{}\\fR \\fI{}\\fR", roff(option.names.back()), roff(option.value));
  return line + " [\\fIOPTIONS\\fR]\n";
}

/// --help's footer: paragraphs as they are, what is indented line by line, and what follows "Example:" in a section
/// of its own.
std::string footer_text(const std::string& footer) {
  std::string page;
  bool verbatim = false, begun = false;
  const auto set_verbatim = [&](bool now) {
    if (now != verbatim) page += now ? ".PP\n.nf\n" : ".fi\n";
    verbatim = now;
  };
  std::istringstream lines(footer);
  for (std::string line; std::getline(lines, line);) {
    set_verbatim(line.starts_with("  ") || (verbatim && line.empty()));
    if (line == "Example:" || line.starts_with("Exit codes:")) {
      page += line == "Example:" ? ".SH EXAMPLE\n" : ".SH EXIT STATUS\n";
      line = line == "Example:" ? "" : line.substr(line.find(' ', line.find(' ') + 1) + 1);
      begun = true;
      if (line.empty()) continue;
    } else if (!begun) {
      page += ".SH DESCRIPTION\n";
      begun = true;
    }
    page += line.empty() ? (verbatim ? "\n" : ".PP\n") : roff(line) + '\n';
  }
  set_verbatim(false);
  return page;
}

std::string list_of(std::span<const ArgumentEntry> arguments, const char* title) {
  std::string page = arguments.empty() ? "" : fmt::format(".SH {}\n", title);
  for (const ArgumentEntry& argument : arguments) page += option_text(argument);
  return page;
}

std::string commands_text(std::span<const CommandEntry> commands) {
  std::string page = ".SH COMMANDS\n";
  for (const CommandEntry& command : commands)
    page += fmt::format(".TP\n\\fBwingspread\\-{}\\fR(1)\n{}\n", command.name,
                        roff(command.description));
  return page;
}

} // namespace

std::string man_page(const std::vector<CommandEntry>& table, const CommandEntry& command,
                     std::string_view version) {
  const bool is_program = &command == &table.front();
  const std::string name = is_program ? command.name : "wingspread-" + command.name;
  std::string what = command.description.substr(0, command.description.find('\n'));
  if (what.ends_with('.')) what.pop_back();
  // a name line says what it is, and does not say the name again
  const std::string brief = what.starts_with("Wingspread: ") ? what.substr(12) : what;
  std::string page =
      fmt::format(".TH {} 1 \"\" \"wingspread {}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n",
                  roff(upper(name)), roff(version), roff(name), roff(brief));
  page += ".SH SYNOPSIS\n" + synopsis(command, is_program);
  if (is_program) page += commands_text(std::span(table).subspan(1));
  page += list_of(command.positionals, "ARGUMENTS") + list_of(command.options, "OPTIONS");
  page += footer_text(command.footer);
  return page + (is_program ? "" : ".SH SEE ALSO\n\\fBwingspread\\fR(1)\n");
}

} // namespace wingspread
