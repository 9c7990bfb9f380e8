/// The end of a computation that was told to stop.
#pragma once

#include <exception>

namespace wingspread {

/// Thrown when a computation is stopped before its result is complete.
struct Stopped : std::exception {
  [[nodiscard]] const char* what() const noexcept override {
    return "stopped before the result was complete";
  }
};

} // namespace wingspread
