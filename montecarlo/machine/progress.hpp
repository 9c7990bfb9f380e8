/// How far a campaign has come, on a terminal.
#pragma once

#include <chrono>
#include <cstdio>
#include <string>

namespace wingspread {

/// What there is to tell.
struct Tally {
  long done = 0, total = 0;
  long before = 0;  ///< of those done, how many an earlier session had made
  long invalid = 0; ///< runs with an unphysical draw
  long failed = 0;  ///< runs whose integration could not go on
  long stalled = 0, timed_out = 0;
  std::string picture{}; ///< a line below it; may be empty
};

/// One line: a bar, done of total, runs a second, the time left, what else became of runs so far.
/// @param seconds since this session began
[[nodiscard]] std::string progress_line(const Tally& tally, double seconds);

/// Keeps that line and the picture up to date. Writes nothing at all when the stream is not a terminal.
class Progress {
public:
  explicit Progress(std::FILE* stream);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Rewrites the line, ten times a second at most and when all is done.
  void show(const Tally& tally);

  [[nodiscard]] double seconds() const;

private:
  using Clock = std::chrono::steady_clock;

  std::FILE* stream_; ///< null when there is no one to look
  Clock::time_point start_ = Clock::now(), last_{};
  bool shown_ = false, pictured_ = false;
};

/// Whether a stream is a terminal.
[[nodiscard]] bool is_terminal(std::FILE* stream);

} // namespace wingspread
