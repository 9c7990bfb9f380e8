/// Ctrl-C, asked for politely: what is done is kept.
#pragma once

#include <atomic>
#include <signal.h>

namespace wingspread {

/// Thrown where what was begun cannot be finished: it was asked to stop.
struct Stopped {};

/// The exit status of a program that a signal ended.
inline constexpr int interrupted_status = 130;

/// While one exists, SIGINT and SIGTERM raise a flag and do not end the program; a second one does.
/// One at a time.
class Interrupt {
public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// True from the first signal on.
  [[nodiscard]] const std::atomic<bool>& flag() const;

  /// Whether it was SIGTERM: who sends it, a scheduler, kills what has not ended some seconds later.
  [[nodiscard]] bool is_urgent() const;

  /// From now on a signal ends the program there and then, for what is under way can be made again.
  /// @param words its last, to standard error; they outlive this
  void end_at_once(const char* words);

private:
  struct sigaction before_int_ {
  }, before_term_{};
};

} // namespace wingspread
