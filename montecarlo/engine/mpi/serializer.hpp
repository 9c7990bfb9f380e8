/// Values as bytes and back. Numbers are copied bit by bit: all ranks must run on machines of one kind.
#pragma once

#include "montecarlo/engine/runs/evaluator.hpp"

#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace wingspread {

/// Appends values to a byte string.
class Serializer {
public:
  template <class T>
  requires(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>) void put(const T& value) {
    put_bytes({reinterpret_cast<const char*>(&value), sizeof value});
  }
  void put(std::string_view text) {
    put(text.size());
    put_bytes(text);
  }
  void put(const std::string& text) { put(std::string_view(text)); }
  void put(const std::vector<double>& values) {
    put(values.size());
    put_bytes({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)});
  }
  void put(const Batch& batch);

  [[nodiscard]] std::string take() { return std::move(bytes_); }

private:
  void put_bytes(std::string_view bytes) { bytes_.append(bytes); }

  std::string bytes_;
};

/// Reads values back. @pre the reads have the types and the order of the writes
class Deserializer {
public:
  /// @pre the bytes outlive this object
  explicit Deserializer(std::string_view bytes) : bytes_(bytes) {}

  template <class T>
  requires std::is_trivially_copyable_v<T>
  [[nodiscard]] T take() {
    T value;
    std::memcpy(&value, take_bytes(sizeof value).data(), sizeof value);
    return value;
  }
  [[nodiscard]] std::string take_text() { return std::string(take_bytes(take<std::size_t>())); }
  [[nodiscard]] std::vector<double> take_numbers();
  /// @param first run number of the first row
  [[nodiscard]] Batch take_batch(long first);
  [[nodiscard]] bool is_empty() const { return bytes_.empty(); }

private:
  [[nodiscard]] std::string_view take_bytes(std::size_t count);
  [[nodiscard]] ResultRow take_row(long run);

  std::string_view bytes_;
};

} // namespace wingspread
