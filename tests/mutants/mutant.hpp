/// For mutants.py: whether the fault of this number is switched on. Put before all else into the copies of the
/// files that it changes.
#pragma once

#include <cstdlib>
#include <type_traits>

/// The one that the environment names; 0: none. A copy for each translation unit: an instruction set's object
/// shares nothing with the others.
[[maybe_unused]] static const int wingspread_mutant_asked = [] {
  const char* number = std::getenv("WINGSPREAD_MUTANT");
  return number ? std::atoi(number) : 0;
}();

[[gnu::always_inline]] inline int wingspread_mutant_number() { return wingspread_mutant_asked; }

/// Never while the compiler computes: then there is nothing to switch.
[[gnu::always_inline]] inline constexpr bool wingspread_mutant(int number) {
  if (std::is_constant_evaluated()) return false;
  return wingspread_mutant_number() == number;
}
