/// For mutants.py: whether the fault of this number is switched on. Included by the copies of the files that have faults.
#pragma once

// a fault may look like one
#pragma GCC diagnostic ignored "-Wnarrowing"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wfloat-conversion"
#pragma GCC diagnostic ignored "-Wsign-compare"
#pragma GCC diagnostic ignored "-Wparentheses"
#pragma GCC diagnostic ignored "-Wunused-value"
#pragma GCC diagnostic ignored "-Wunused-variable"
#pragma GCC diagnostic ignored "-Wunused-but-set-variable"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC diagnostic ignored "-Wint-in-bool-context"
#pragma GCC diagnostic ignored "-Wbool-compare"
#pragma GCC diagnostic ignored "-Wbool-operation"
#pragma GCC diagnostic ignored "-Wlogical-op"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wtype-limits"
#pragma GCC diagnostic ignored "-Wdiv-by-zero"
#pragma GCC diagnostic ignored "-Wfloat-equal"
#pragma GCC diagnostic ignored "-Warray-bounds"
#pragma GCC diagnostic ignored "-Wnonnull"
#pragma GCC diagnostic ignored "-Wduplicated-branches"
#pragma GCC diagnostic ignored "-Wtautological-compare"
#pragma GCC diagnostic ignored "-Wdangling-else"
#pragma GCC diagnostic ignored "-Wempty-body"
#pragma GCC diagnostic ignored "-Wshadow"

#include <cstdio>
#include <cstdlib>
#include <type_traits>

/// The fault that the environment names; 0: none. A copy for each translation unit: an instruction set's object shares
/// nothing with the others.
[[maybe_unused]] static const int wingspread_mutant_asked = [] {
  const char* number = std::getenv("WINGSPREAD_MUTANT");
  return number ? std::atoi(number) : 0;
}();

/// Leaves a file: a test has executed the fault's place.
[[maybe_unused, gnu::cold, gnu::noinline]] static bool wingspread_mutant_reached() {
  static const bool left = [] {
    const char* name = std::getenv("WINGSPREAD_MUTANT_REACHED");
    if (std::FILE* file = name ? std::fopen(name, "w") : nullptr) std::fclose(file);
    return true;
  }();
  return left;
}

[[gnu::always_inline]] inline bool wingspread_mutant_is(int number) {
  return wingspread_mutant_asked == number && wingspread_mutant_reached();
}

/// Never while the compiler computes: then there is nothing to switch.
[[gnu::always_inline]] inline constexpr bool wingspread_mutant(int number) {
  if (std::is_constant_evaluated()) return false;
  return wingspread_mutant_is(number);
}

/// A condition as `bool`, so that both sides of a switch have one type: of an `optional` and a `bool` the common type is an
/// `optional`, which has a value where the `bool` is false. Lanes' truths stay as they are.
template <class C>
[[gnu::always_inline]] inline constexpr auto wingspread_mutant_condition(const C& condition) {
  if constexpr (std::is_constructible_v<bool, const C&>)
    return static_cast<bool>(condition);
  else
    return condition;
}
