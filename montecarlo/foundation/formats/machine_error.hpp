/// Failures of the machine: no space, no permission, no memory, a failing device.
#pragma once

#include "montecarlo/foundation/formats/spec_error.hpp"

#include <exception>
#include <filesystem>
#include <string>

namespace wingspread {

/// A failure of the machine; the program ends with its own exit code for these.
class MachineError : public std::exception {
public:
  explicit MachineError(const Problem& problem);
  /// @param message one or more lines
  explicit MachineError(std::string message);

  [[nodiscard]] const char* what() const noexcept override { return message_.c_str(); }

private:
  std::string message_;
};

/// Throws the system's error for a path: a SpecError if the path is wrong (no such folder, a folder instead of a file,
/// a name too long), else a MachineError.
/// @param error    errno
/// @param expected what should be there, e.g. "a file that can be written"
[[noreturn]] void refuse_path(const std::filesystem::path& path, int error, const char* expected);

} // namespace wingspread
