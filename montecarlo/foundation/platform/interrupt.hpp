/// Ctrl-C and SIGTERM as a flag, so that finished work is kept.
#pragma once

#include "montecarlo/foundation/platform/stopped.hpp"

#include <atomic>
#include <signal.h>

namespace wingspread {

/// The exit status of a program ended by a signal.
inline constexpr int interrupted_status = 130;

/// While an Interrupt exists, the first SIGINT or SIGTERM sets a flag, and the second ends the program.
/// @pre no other Interrupt exists
class Interrupt {
public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// True after the first signal.
  [[nodiscard]] const std::atomic<bool>& flag() const;

  /// Whether the signal was SIGTERM: a batch scheduler sends it and kills the program some seconds later.
  [[nodiscard]] bool is_urgent() const;

  /// From now on a signal prints `words` to standard error and ends the program. For work that can simply be repeated.
  /// @param words outlive this object
  void end_at_once(const char* words);

private:
  struct sigaction before_int_ {
  }, before_term_{};
};

} // namespace wingspread
