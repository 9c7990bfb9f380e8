/// Ctrl-C, asked for politely: what is done is kept.
#pragma once

#include <atomic>
#include <signal.h>

namespace wingspread {

/// Thrown where what was begun cannot be finished: it was asked to stop.
struct Stopped {};

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

private:
  struct sigaction before_int_ {
  }, before_term_{};
};

} // namespace wingspread
