/// Ctrl-C, SIGTERM and the end of a terminal (SIGHUP) as a flag, so that finished work is kept.
#pragma once

#include "montecarlo/foundation/platform/stopped.hpp"

#include <atomic>
#include <signal.h>

namespace wingspread {

/// The exit status of a program ended by a signal.
inline constexpr int interrupted_status = 130;

/// While an Interrupt exists, the first SIGINT, SIGTERM or SIGHUP sets a flag, and the second ends the program.
/// A SIGHUP that the program was started to ignore (nohup) stays ignored.
/// @pre no other Interrupt exists
class Interrupt {
public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// True after the first signal.
  [[nodiscard]] const std::atomic<bool>& flag() const;

  /// Whether the signal was SIGTERM, which a batch scheduler sends some seconds before it kills the program, or SIGHUP.
  [[nodiscard]] bool is_urgent() const;

  /// From now on a signal prints `words` to standard error and ends the program. For work that can simply be repeated.
  /// @param words outlive this object
  void end_at_once(const char* words);

private:
  struct sigaction before_int_ {
  }, before_term_{}, before_hang_up_{};
};

} // namespace wingspread
