/// One line over all cases of a campaign.
#pragma once

#include "montecarlo/foundation/platform/progress.hpp"

namespace wingspread {

/// The line over all cases.
class OverallProgress {
public:
  /// @param runs of all that is to be made
  explicit OverallProgress(long runs) : earlier_{.total = runs} {}

  /// @param own of the case that is under way
  void show(const Tally& own) {
    Tally all = earlier_;
    add(own, all);
    all.picture = own.picture;
    progress_.show(all);
  }
  /// A case has come to its end: it may have stopped before all of its runs.
  void close(const Tally& own) {
    add(own, earlier_);
    earlier_.total -= own.total - own.done;
  }
  /// So that something else can be printed.
  void pause() { progress_.pause(); }

private:
  static void add(const Tally& own, Tally& all) {
    all.done += own.done;
    all.before += own.before;
    all.invalid += own.invalid;
    all.failed += own.failed;
    all.stalled += own.stalled;
    all.timed_out += own.timed_out;
  }

  Progress progress_{stderr};
  Tally earlier_; ///< of the cases that are done, less its total: that is of all
};

} // namespace wingspread
