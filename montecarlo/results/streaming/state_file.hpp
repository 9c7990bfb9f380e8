/// Serializes statistics: numbers and texts one after the other, little-endian, with a checksum at the end.
#pragma once

#include "montecarlo/foundation/formats/spec_error.hpp"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace wingspread {

static_assert(std::endian::native == std::endian::little, "as they are in memory");

class StateWriter {
public:
  template <class Number> void put(Number value) {
    static_assert(std::is_arithmetic_v<Number>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void put(std::string_view text) {
    put(std::uint64_t{text.size()});
    bytes_.append(text);
  }
  /// Appends the checksum (FNV-1a).
  [[nodiscard]] std::string finish() &&;

private:
  std::string bytes_;
};

class StateReader {
public:
  /// @param file name for messages
  /// @throws SpecError if the checksum does not match
  StateReader(std::string bytes, std::string file);

  template <class Number> [[nodiscard]] Number get() {
    static_assert(std::is_arithmetic_v<Number>);
    Number value;
    std::memcpy(&value, take(sizeof value), sizeof value);
    return value;
  }
  [[nodiscard]] std::string get_text();
  /// Reads a number of items that take at least `bytes` each. @throws SpecError if the file is too short for them
  [[nodiscard]] std::size_t get_count(std::size_t bytes);
  [[nodiscard]] bool at_end() const { return at_ == bytes_.size(); }
  [[nodiscard]] SpecError broken(std::string_view what) const;

private:
  [[nodiscard]] const char* take(std::size_t count);

  std::string bytes_, file_;
  std::size_t at_ = 0;
};

} // namespace wingspread
