/// The numbers of a new wing: as text from an option or an answer, as questions on a terminal, and as options again.
#pragma once

#include "montecarlo/model/starter/wing_design.hpp"

#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>

namespace wingspread {

/// Reads "1.8", "1.8 m" or "70 in" into the design. @return the message if the text is no such number; else nothing
[[nodiscard]] std::optional<std::string>
read_design_number(std::string_view text, const DesignNumber& number, WingDesign& design);
/// Reads the damper of the root hinge into the design. @return as read_design_number
[[nodiscard]] std::optional<std::string> read_damper(std::string_view text, WingDesign& design);

/// Asks for each part of the design in turn. An empty line keeps the value in brackets. A question is repeated until
/// its answer can be read. @return nothing if the input ends before the last answer
[[nodiscard]] std::optional<WingDesign> ask_design(std::istream& in, std::ostream& out);

/// "wingspread new --panels 4 --yoke --out wing": the options that differ from the defaults, ready for a shell.
/// @param out the folder of --out; empty: not given
[[nodiscard]] std::string command_of(const WingDesign& design, const std::string& out = "");

} // namespace wingspread
