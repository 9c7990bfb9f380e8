/// Shared by the fuzz targets.
#pragma once

#include "montecarlo/foundation/formats/spec_error.hpp"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

/// Called by libFuzzer and replay.cpp with each input; returns 0.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace wingspread::test {

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Ends the program if a condition is false; an assertion that stays in release builds.
inline void demand(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

/// Calls a reader. Wrong input may only throw a SpecError with a message; any other exception ends the program. Returns
/// whether the input was accepted.
template <class Read> bool takes(const Read& read) {
  try {
    read();
    return true;
  } catch (const SpecError& error) {
    demand(!error.problems().empty(), "a refusal has a reason");
    return false;
  }
}

} // namespace wingspread::test
