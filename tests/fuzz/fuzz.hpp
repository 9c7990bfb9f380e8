/// For the fuzz targets: what they share.
#pragma once

#include "montecarlo/foundation/formats/spec_error.hpp"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

/// What libFuzzer and replay.cpp call with each input; 0.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace wingspread::test {

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Ends the program where something does not hold; an assertion that stays in release builds.
inline void demand(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

/// Calls it. Bad input may be refused, and in no other way than by a SpecError with something to say; whatever
/// else is thrown ends the program. @return whether it was taken
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
