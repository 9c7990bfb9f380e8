#include "montecarlo/interfaces/package/command_table.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>

namespace wingspread {
namespace {

/// The words of "TEXT:{bash,zsh,fish}", and those of "event|smoothed:EPS" that stand for themselves.
std::vector<std::string> words_of(const std::string& type) {
  const std::size_t open = type.find('{'), close = type.find('}', open);
  if (close != std::string::npos)
    return CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
  if (type.find('|') == std::string::npos) return {};
  std::vector<std::string> words = CLI::detail::split(type, '|');
  std::erase_if(words, [](const std::string& word) {
    return std::ranges::any_of(word, [](char letter) { return letter >= 'A' && letter <= 'Z'; });
  });
  return words;
}

ArgumentEntry entry_of(const CLI::Option& option) {
  ArgumentEntry entry;
  for (const std::string& name : option.get_snames()) entry.names.push_back('-' + name);
  for (const std::string& name : option.get_lnames()) entry.names.push_back("--" + name);
  if (entry.names.empty()) entry.names.push_back(option.get_name());
  if (option.get_items_expected_max() > 0) {
    const std::string type = option.get_type_name();
    entry.words = words_of(type);
    entry.value = type.substr(0, type.find(":{"));
    entry.takes_file = entry.words.empty() && (type == "TEXT" || type == "FILE");
  }
  entry.description = option.get_description();
  entry.is_required = option.get_required();
  entry.is_repeated = option.get_items_expected_max() > 1;
  return entry;
}

CommandEntry entry_of(const CLI::App& app) {
  CommandEntry entry{app.get_name(), app.get_description(), app.get_footer(), {}, {}};
  for (const CLI::Option* option : app.get_options())
    (option->nonpositional() ? entry.options : entry.positionals).push_back(entry_of(*option));
  return entry;
}

} // namespace

std::vector<CommandEntry> command_table(const CLI::App& app) {
  std::vector<CommandEntry> table{entry_of(app)};
  for (const CLI::App* command :
       app.get_subcommands([](const CLI::App* each) { return !each->get_group().empty(); }))
    table.push_back(entry_of(*command));
  return table;
}

} // namespace wingspread
