/// The end of a computation that was told to stop.
#pragma once

#include <exception>

namespace wingspread {

/// Thrown by a study or by a function of the library whose caller's stop flag was set before the result was complete.
struct Stopped : std::exception {
  [[nodiscard]] const char* what() const noexcept override {
    return "stopped before the result was complete";
  }
};

} // namespace wingspread
