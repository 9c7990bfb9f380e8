#include "montecarlo/results/streaming/state_file.hpp"

#include "distributions/random_stream.hpp"

#include <utility>

namespace wingspread {
std::string StateWriter::finish() && {
  put(stream_name(bytes_).hash);
  return std::move(bytes_);
}

StateReader::StateReader(std::string bytes, std::string file)
    : bytes_(std::move(bytes)), file_(std::move(file)) {
  std::uint64_t sum = 0;
  if (bytes_.size() < sizeof sum) throw broken("at least a checksum");
  std::memcpy(&sum, bytes_.data() + bytes_.size() - sizeof sum, sizeof sum);
  bytes_.resize(bytes_.size() - sizeof sum);
  if (stream_name(bytes_).hash != sum) throw broken("the checksum matches");
}

std::string StateReader::get_text() {
  const std::size_t size = get_count(1);
  return {take(size), size};
}

std::size_t StateReader::get_count(std::size_t bytes) {
  const auto count = get<std::uint64_t>();
  if (count > (bytes_.size() - at_) / bytes) throw broken("as many items as announced");
  return static_cast<std::size_t>(count);
}

SpecError StateReader::broken(std::string_view what) const {
  return SpecError({{file_, "", "a damaged file",
                     "statistics that `run --no-rows` wrote: " + std::string(what)}});
}

const char* StateReader::take(std::size_t count) {
  if (count > bytes_.size() - at_) throw broken("more bytes");
  const char* there = bytes_.data() + at_;
  at_ += count;
  return there;
}

} // namespace wingspread
