/// --help as a man page.
#pragma once

#include "montecarlo/interfaces/package/command_table.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// The page of a command, in the man macros, section 1.
/// @param table   as of command_table
/// @param command one of the table's; the first: the program's own page
/// @param version for the page's foot
[[nodiscard]] std::string man_page(const std::vector<CommandEntry>& table,
                                   const CommandEntry& command, std::string_view version);

} // namespace wingspread
