/// The bytes of a state that is kept in a file: plain numbers one behind the other, least byte first.
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
  /// With a sum behind them by which a damaged file is told.
  [[nodiscard]] std::string finish() &&;

private:
  std::string bytes_;
};

class StateReader {
public:
  /// @param file name for the messages
  /// @throws SpecError when the sum is not that of the bytes
  StateReader(std::string bytes, std::string file);

  template <class Number> [[nodiscard]] Number get() {
    static_assert(std::is_arithmetic_v<Number>);
    Number value;
    std::memcpy(&value, take(sizeof value), sizeof value);
    return value;
  }
  [[nodiscard]] std::string get_text();
  /// How many of something there are, each of which takes `bytes` at least.
  [[nodiscard]] std::size_t get_count(std::size_t bytes);
  [[nodiscard]] bool at_end() const { return at_ == bytes_.size(); }
  [[nodiscard]] SpecError broken(std::string_view what) const;

private:
  [[nodiscard]] const char* take(std::size_t count);

  std::string bytes_, file_;
  std::size_t at_ = 0;
};

} // namespace wingspread
