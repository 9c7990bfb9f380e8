#include "montecarlo/foundation/platform/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unistd.h>

namespace wingspread {
namespace {

/// "7 s", "3 min 20 s", "2 h 5 min".
std::string duration(double seconds) {
  const auto whole = static_cast<long>(std::ceil(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

std::string bar(double share) {
  constexpr int width = 24;
  std::string text;
  for (int i = 0; i < width; ++i) text += i < std::floor(share * width) ? "█" : "░";
  return text;
}

} // namespace

namespace {

/// From 0 to 1.
double share_of(const RunCounts& counts) {
  if (counts.total == 0) return 1;
  return std::min(1.0, static_cast<double>(counts.done) / static_cast<double>(counts.total));
}

} // namespace

bool is_terminal(std::FILE* stream) { return isatty(fileno(stream)) == 1; }

RunCounts counts_of(const StudyProgress& progress, long before) {
  RunCounts counts{.done = progress.runs, .total = progress.most_runs, .before = before};
  counts.analysis = progress.analysis;
  counts.analyses = progress.most_analyses;
  counts.at_most = true;
  return counts;
}

std::string progress_line(const RunCounts& counts, double seconds) {
  std::string text = bar(share_of(counts));
  if (counts.analyses > 0)
    text += fmt::format(" analysis {} of at most {} ·", counts.analysis, counts.analyses);
  text += counts.at_most ? fmt::format(" {} of at most {} runs", counts.done, counts.total)
                         : fmt::format(" {}/{} runs", counts.done, counts.total);
  const double rate = static_cast<double>(counts.done - counts.before) / seconds;
  if (rate > 0 && std::isfinite(rate)) {
    text += fmt::format(" · {:.0f} runs/s", rate);
    if (counts.done < counts.total && !counts.at_most)
      text += " · " + duration(static_cast<double>(counts.total - counts.done) / rate) + " left";
  }
  if (counts.stalled > 0) text += fmt::format(" · {} stalled", counts.stalled);
  if (counts.timed_out > 0) text += fmt::format(" · {} timed out", counts.timed_out);
  if (counts.invalid > 0) text += fmt::format(" · {} invalid", counts.invalid);
  if (counts.failed > 0) text += fmt::format(" · {} failed", counts.failed);
  return text;
}

Progress::Progress(std::FILE* stream) : stream_(is_terminal(stream) ? stream : nullptr) {}

Progress::~Progress() { pause(); }

void Progress::pause() {
  if (shown_) fmt::print(stream_, "\n");
  shown_ = false;
}

double Progress::seconds() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

void Progress::show(const RunCounts& counts) {
  if (!stream_) return;
  const auto now = Clock::now();
  if (shown_ && counts.done < counts.total && now - last_ < std::chrono::milliseconds(100)) return;
  if (share_of(counts) < share_) return;
  share_ = share_of(counts);
  last_ = now;
  shown_ = true;
  // "\x1b[K" clears the rest of the line, which may show the end of a longer one.
  fmt::print(stream_, "\r{}\x1b[K", progress_line(counts, seconds()));
  std::fflush(stream_);
}

} // namespace wingspread
