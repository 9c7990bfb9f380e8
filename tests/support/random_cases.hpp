/// How many cases a test draws at random.
#pragma once

#include <cstdlib>

namespace wingspread {

/// `nightly` if tests/nightly runs the test (WINGSPREAD_NIGHTLY is set); else `quick`, which is small enough to run after
/// every change.
inline int random_cases(int nightly, int quick) {
  return std::getenv("WINGSPREAD_NIGHTLY") != nullptr ? nightly : quick;
}

} // namespace wingspread
