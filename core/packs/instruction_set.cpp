#include "core/packs/instruction_set.hpp"

namespace wingspread {

bool has_avx2() {
#ifdef __x86_64__
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return false;
#endif
}

bool has_neon() {
#ifdef __aarch64__
  return true;
#else
  return false;
#endif
}

bool has_avx512() {
#ifdef __x86_64__
  return has_avx2() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512cd");
#else
  return false;
#endif
}

const char* to_string(InstructionSet set) {
  switch (set) {
  case InstructionSet::scalar:
    return "scalar";
  case InstructionSet::neon:
    return "neon";
  case InstructionSet::avx2:
    return "avx2";
  case InstructionSet::avx512:
    return "avx512";
  }
  return "unknown";
}

const std::vector<InstructionSet>& instruction_sets() {
  static const std::vector<InstructionSet> available = [] {
    std::vector<InstructionSet> sets{InstructionSet::scalar};
    if (has_neon()) sets.push_back(InstructionSet::neon);
    if (has_avx2()) sets.push_back(InstructionSet::avx2);
    if (has_avx512()) sets.push_back(InstructionSet::avx512);
    return sets;
  }();
  return available;
}

int lanes_of(InstructionSet set) {
  switch (set) {
  case InstructionSet::scalar:
    return 1;
  case InstructionSet::neon:
    return 2;
  case InstructionSet::avx2:
    return 4;
  case InstructionSet::avx512:
    return 8;
  }
  return 1;
}

Occupancy& Occupancy::operator+=(const Occupancy& other) {
  trial_steps += other.trial_steps, busy += other.busy, scalar += other.scalar,
      returns += other.returns;
  in_lanes += other.in_lanes;
  for (std::size_t k = 0; k < outside.size(); ++k) outside[k] += other.outside[k];
  return *this;
}

} // namespace wingspread
