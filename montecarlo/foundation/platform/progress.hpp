/// A progress line on a terminal.
#pragma once

#include <chrono>
#include <cstdio>
#include <string>

namespace wingspread {

/// Numbers that the progress line shows.
struct RunCounts {
  long done = 0, total = 0;
  long before = 0;  ///< runs of `done` that an earlier session made
  long invalid = 0; ///< runs with an unphysical draw
  long failed = 0;  ///< runs whose integration failed
  long stalled = 0, timed_out = 0;
  long analysis = 0, analyses = 0; ///< analysis under way, and how many there will be
  bool at_most = false;            ///< `analyses` and `total` are upper bounds, which may shrink
};

/// Progress of a study that chooses its next runs by earlier results.
struct StudyProgress {
  long analysis = 0,
       most_analyses = 0;       ///< analysis under way, from 1; upper bound of their number
  long runs = 0, most_runs = 0; ///< runs made; upper bound of their number
};

/// @param before runs that an earlier session made
[[nodiscard]] RunCounts counts_of(const StudyProgress& progress, long before);

/// One line: a bar, done of total, runs per second, time left, and counts of runs that did not deploy. The time left
/// is omitted if the total is an upper bound.
/// @param seconds since this session began
[[nodiscard]] std::string progress_line(const RunCounts& counts, double seconds);

/// Shows the line on a terminal. Writes nothing to other streams.
class Progress {
public:
  explicit Progress(std::FILE* stream);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Rewrites the line at most ten times a second, and always when all runs are done. Does nothing if the share done is
  /// smaller than one shown before, so that the bar never runs backwards.
  void show(const RunCounts& counts);

  /// Ends the line, so that other text can be printed; the next line is shown below that text.
  void pause();

  [[nodiscard]] double seconds() const;

private:
  using Clock = std::chrono::steady_clock;

  std::FILE* stream_; ///< null: not a terminal
  Clock::time_point start_ = Clock::now(), last_{};
  double share_ = 0; ///< largest share shown
  bool shown_ = false;
};

/// Whether a stream is a terminal.
[[nodiscard]] bool is_terminal(std::FILE* stream);

} // namespace wingspread
