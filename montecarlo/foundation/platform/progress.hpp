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
  long look = 0, looks = 0; ///< of a study: the one that is under way, and how many there will be
  bool at_most = false;     ///< that and the total are known by an upper bound, which falls
};

/// How far a study has come, whose looks depend on what earlier ones came to.
struct StudyProgress {
  long look = 0, most_looks = 0; ///< the one that is under way, from 1, and no more than so many
  long runs = 0, most_runs = 0;  ///< made, and no more than so many
};

/// As a tally. @param before runs that an earlier session had made
[[nodiscard]] Tally tally_of(const StudyProgress& progress, long before);

/// One line: a bar, done of total, runs a second, the time left, what else became of runs so far. Where the total is a
/// bound nothing is said of the time.
/// @param seconds since this session began
[[nodiscard]] std::string progress_line(const Tally& tally, double seconds);

/// Keeps that line up to date. Writes nothing at all when the stream is not a terminal.
class Progress {
public:
  explicit Progress(std::FILE* stream);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Rewrites the line, ten times a second at most and when all is done. It does not run backwards: a tally of a
  /// smaller share than one that was shown is not shown.
  void show(const Tally& tally);

  /// Ends the line, so that something else can be printed; the next one is shown below that.
  void pause();

  [[nodiscard]] double seconds() const;

private:
  using Clock = std::chrono::steady_clock;

  std::FILE* stream_; ///< null when there is no one to look
  Clock::time_point start_ = Clock::now(), last_{};
  double share_ = 0; ///< that was shown
  bool shown_ = false;
};

/// Whether a stream is a terminal.
[[nodiscard]] bool is_terminal(std::FILE* stream);

} // namespace wingspread
