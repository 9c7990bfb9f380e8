/// Turns GCC's coverage (-fsanitize-coverage=trace-pc) into counters for libFuzzer, which reads all counters in a section
/// of this name. libFuzzer 14's own function of this name only reports that it is no longer supported.
#include <cstddef>
#include <cstdint>

namespace {

constexpr int bits = 16;
[[gnu::section("__libfuzzer_extra_counters")]] std::uint8_t counters[std::size_t{1} << bits];

} // namespace

/// Called by every basic block. Fibonacci hashing spreads the addresses over the counters.
extern "C" void __sanitizer_cov_trace_pc() {
  const auto block = reinterpret_cast<std::uintptr_t>(__builtin_return_address(0));
  ++counters[block * 0x9E3779B97F4A7C15U >> (64 - bits)];
}

/// GCC also reports floating-point comparisons. libFuzzer has no use for them: the input is text.
extern "C" void __sanitizer_cov_trace_cmpd(double, double) {}
extern "C" void __sanitizer_cov_trace_cmpf(float, float) {}
