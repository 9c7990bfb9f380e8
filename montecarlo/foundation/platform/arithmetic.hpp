/// The processor's arithmetic in which runs are defined.
#pragma once

#include <cfenv>

namespace wingspread {

/// While it lives, its thread rounds to nearest, and no operation traps, whatever the calling program has set for
/// itself. Threads inherit the arithmetic of the one that starts them.
class DefaultArithmetic {
public:
  DefaultArithmetic() {
    std::fegetenv(&callers_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~DefaultArithmetic() { std::fesetenv(&callers_); }
  DefaultArithmetic(const DefaultArithmetic&) = delete;
  DefaultArithmetic& operator=(const DefaultArithmetic&) = delete;

private:
  std::fenv_t callers_{};
};

} // namespace wingspread
