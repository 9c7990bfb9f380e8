#include "distributions/random_stream.hpp"

#include <Random123/philox.h>

namespace wingspread {

PhiloxBlock philox(const PhiloxKey& key, const PhiloxBlock& counter) {
  const r123::Philox4x64::ctr_type block =
      r123::Philox4x64{}({{counter[0], counter[1], counter[2], counter[3]}}, {{key[0], key[1]}});
  return {block[0], block[1], block[2], block[3]};
}

std::uint64_t choice_rank(std::uint64_t seed, std::uint64_t run) {
  return philox({seed, static_cast<std::uint64_t>(StreamUse::choice)}, {0, run, 0, 0})[0];
}

double uniform(std::uint64_t seed, std::uint64_t run, StreamName name) {
  return open_uniform(philox({seed, 0}, {0, run, name.hash, 0})[0]);
}

RandomStream::result_type RandomStream::operator()() {
  if (used_ == block_.size()) {
    block_ = philox(key_, counter_);
    ++counter_[0];
    used_ = 0;
  }
  return block_[used_++];
}

} // namespace wingspread
