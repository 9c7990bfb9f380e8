/// What the machine refused: no room, no permission, no memory, a device that fails. Not the input's fault, and
/// not that of what was done before.
#pragma once

#include "montecarlo/foundation/formats/spec_error.hpp"

#include <exception>
#include <filesystem>
#include <string>

namespace wingspread {

/// Thrown where the program cannot go on for the machine's sake; it ends with an exit code of its own.
class MachineError : public std::exception {
public:
  explicit MachineError(const Problem& problem);
  /// @param message one line for each thing that there is to say
  explicit MachineError(std::string message);

  [[nodiscard]] const char* what() const noexcept override { return message_.c_str(); }

private:
  std::string message_;
};

/// Throws what the system's error for a path comes to: a MachineError, or a SpecError where it is the path that is
/// wrong (no such folder, a folder where a file should be, a name too long).
/// @param error    errno
/// @param expected what should be there, e.g. "a file that can be written"
[[noreturn]] void refuse_path(const std::filesystem::path& path, int error, const char* expected);

} // namespace wingspread
