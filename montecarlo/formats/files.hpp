/// Files: read whole, and written whole or not at all.
#pragma once

#include "montecarlo/formats/spec_error.hpp"

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>

namespace wingspread {

/// The bytes of a file; nothing when it cannot be read.
[[nodiscard]] std::optional<std::string> read_text(const std::filesystem::path& path);

/// The end of the name under which a file is written before it gets its own.
inline constexpr std::string_view part_suffix = ".part";

/// Writes a file beside its place and moves it there: readers see the old one or the new one.
/// @throws SpecError when that cannot be done
void write_file(const std::filesystem::path& path, std::string_view text);

/// The same for what need not be in memory all at once.
void write_file(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);

/// An error to throw about a file that could not be written, with the system's reason (errno).
[[nodiscard]] SpecError unwritable(const std::filesystem::path& path);

/// Makes the folder and those it lies in. @throws SpecError when that cannot be done
void make_folder(const std::filesystem::path& path);

} // namespace wingspread
