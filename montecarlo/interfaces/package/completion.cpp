#include "montecarlo/interfaces/package/completion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <span>

namespace wingspread {
namespace {

/// In single quotes, as all three shells take it.
std::string single_quoted(std::string_view text) {
  std::string all = "'";
  for (const char letter : text) all += letter == '\'' ? "'\\''" : std::string(1, letter);
  return all + "'";
}

std::vector<std::string> option_names(const CommandEntry& command) {
  std::vector<std::string> names;
  for (const ArgumentEntry& option : command.options)
    names.insert(names.end(), option.names.begin(), option.names.end());
  return names;
}

std::vector<std::string> command_names(std::span<const CommandEntry> commands) {
  std::vector<std::string> names;
  for (const CommandEntry& command : commands) names.push_back(command.name);
  return names;
}

/// The words that a command takes at its place, if they are a list.
std::vector<std::string> positional_words(const CommandEntry& command) {
  return command.positionals.empty() ? std::vector<std::string>{} : command.positionals[0].words;
}

/// "    --out|-o) reply -f;;": what stands behind the options of a kind.
std::string bash_case(const std::vector<std::string>& names, const std::string& reply) {
  return names.empty()
             ? ""
             : fmt::format("      {}) reply {}; return;;\n", fmt::join(names, "|"), reply);
}

/// What stands behind options that take something: files, nothing that a shell knows, or a list of words.
std::string bash_values(const CommandEntry& command) {
  std::vector<std::string> files, others;
  std::string lists;
  for (const ArgumentEntry& option : command.options) {
    if (option.value.empty()) continue;
    if (!option.words.empty())
      lists += bash_case(option.names, fmt::format("-W \"{}\"", fmt::join(option.words, " ")));
    else
      (option.takes_file ? files : others)
          .insert((option.takes_file ? files : others).end(), option.names.begin(),
                  option.names.end());
  }
  return lists + bash_case(files, "-f") + bash_case(others, "-W \"\"");
}

std::string bash_script(const std::vector<CommandEntry>& table) {
  const std::span commands = std::span(table).subspan(1);
  std::string script =
      fmt::format(R"(# bash completion for wingspread
_wingspread() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD-1]}} options= words=
  reply() {{
    mapfile -t COMPREPLY < <(compgen "$@" -- "$current")
    [ "$1" != -f ] || compopt -o filenames 2>/dev/null
  }}
  if [ "$COMP_CWORD" -eq 1 ]; then
    reply -W "{} {}"
    return
  fi
  case ${{COMP_WORDS[1]}} in
)",
                  fmt::join(command_names(commands), " "), fmt::join(option_names(table[0]), " "));
  for (const CommandEntry& command : commands) {
    script += fmt::format("  {})\n    options=\"{}\" words=\"{}\"\n", command.name,
                          fmt::join(option_names(command), " "),
                          fmt::join(positional_words(command), " "));
    if (const std::string values = bash_values(command); !values.empty())
      script += "    case $previous in\n" + values + "    esac\n";
    script += "    ;;\n";
  }
  return script + R"(  esac
  if [[ $current == -* ]]; then
    reply -W "$options"
  elif [ -n "$words" ]; then
    reply -W "$words"
  else
    reply -f
  fi
}
complete -F _wingspread wingspread
)";
}

/// What stands in a specification of _arguments within brackets or between colons.
std::string zsh_text(std::string_view text) {
  std::string all;
  for (const char letter : text) {
    if (std::string_view("[]:\\").find(letter) != std::string_view::npos) all += '\\';
    all += letter;
  }
  return all;
}

std::string zsh_action(const ArgumentEntry& argument) {
  if (argument.takes_file) return "_files";
  return argument.words.empty() ? " " : fmt::format("({})", fmt::join(argument.words, " "));
}

std::string zsh_arguments(const CommandEntry& command) {
  std::string lines;
  for (const ArgumentEntry& option : command.options)
    for (const std::string& name : option.names) {
      const std::string takes =
          option.value.empty() ? ""
                               : fmt::format(":{}:{}", zsh_text(option.value), zsh_action(option));
      lines += fmt::format(" \\\n        {}",
                           single_quoted(fmt::format("{}{}[{}]{}", option.is_repeated ? "*" : "",
                                                     name, zsh_text(option.description), takes)));
    }
  for (const ArgumentEntry& positional : command.positionals)
    lines += fmt::format(
        " \\\n        {}",
        single_quoted(fmt::format("{}:{}:{}", positional.is_repeated ? "*" : "",
                                  zsh_text(positional.names[0]), zsh_action(positional))));
  return lines;
}

std::string zsh_script(const std::vector<CommandEntry>& table) {
  std::string script = "#compdef wingspread\n_wingspread() {\n  local -a commands\n  commands=(\n";
  const std::span commands = std::span(table).subspan(1);
  for (const CommandEntry& command : commands)
    script += fmt::format("    {}\n", single_quoted(fmt::format("{}:{}", command.name,
                                                                zsh_text(command.description))));
  script += "  )\n  if (( CURRENT == 2 )); then\n    _describe command commands\n";
  script += fmt::format("    [[ $PREFIX == -* ]] && compadd -- {}\n    return\n  fi\n",
                        fmt::join(option_names(table[0]), " "));
  script += "  local command=$words[2]\n  shift words\n  (( CURRENT-- ))\n  case $command in\n";
  for (const CommandEntry& command : commands)
    script += fmt::format("    {})\n      _arguments{}\n      ;;\n", command.name,
                          zsh_arguments(command));
  return script + "  esac\n}\n_wingspread \"$@\"\n";
}

std::string fish_argument(const ArgumentEntry& argument) {
  if (argument.value.empty()) return "";
  if (argument.takes_file) return " -r -F";
  return argument.words.empty()
             ? " -x"
             : fmt::format(" -x -a {}",
                           single_quoted(fmt::format("{}", fmt::join(argument.words, " "))));
}

std::string fish_option(const ArgumentEntry& option) {
  std::string names;
  for (const std::string& name : option.names)
    names += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  return names + fish_argument(option) + " -d " + single_quoted(option.description);
}

std::string fish_script(const std::vector<CommandEntry>& table) {
  std::string script = "# fish completion for wingspread\n";
  const std::span commands = std::span(table).subspan(1);
  for (const CommandEntry& command : commands)
    script += fmt::format("complete -c wingspread -n __fish_use_subcommand -f -a {} -d {}\n",
                          command.name, single_quoted(command.description));
  for (const ArgumentEntry& option : table[0].options)
    script +=
        fmt::format("complete -c wingspread -n __fish_use_subcommand{}\n", fish_option(option));
  for (const CommandEntry& command : commands) {
    const std::string within =
        fmt::format("complete -c wingspread -n '__fish_seen_subcommand_from {}'", command.name);
    for (const ArgumentEntry& option : command.options)
      script += within + fish_option(option) + '\n';
    if (const auto words = positional_words(command); !words.empty())
      script += fmt::format("{} -f -a {}\n", within,
                            single_quoted(fmt::format("{}", fmt::join(words, " "))));
  }
  return script;
}

} // namespace

std::string completion_script(const std::vector<CommandEntry>& table, Shell shell) {
  if (shell == Shell::bash) return bash_script(table);
  return shell == Shell::zsh ? zsh_script(table) : fish_script(table);
}

} // namespace wingspread
