/// What makes a shell complete the program's commands, options and files.
#pragma once

#include "montecarlo/interfaces/package/command_table.hpp"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

enum class Shell { bash, zsh, fish };
inline constexpr std::array<std::string_view, 3> shell_names{"bash", "zsh", "fish"};

/// The shell's script. @param table as of command_table
[[nodiscard]] std::string completion_script(const std::vector<CommandEntry>& table, Shell shell);

} // namespace wingspread
