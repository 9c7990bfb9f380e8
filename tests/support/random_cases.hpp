/// How many cases a test draws at random.
#pragma once

#include <cstdlib>

namespace wingspread {

/// `nightly` where tests/nightly runs the test (WINGSPREAD_NIGHTLY is set), else `quick`: few enough for every change.
inline int random_cases(int nightly, int quick) {
  return std::getenv("WINGSPREAD_NIGHTLY") != nullptr ? nightly : quick;
}

} // namespace wingspread
