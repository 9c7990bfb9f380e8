/// Columns of texts, one a row, that may be longer than memory should hold (spilled.hpp).
#pragma once

#include "montecarlo/foundation/platform/spilled.hpp"

#include <cstdint>
#include <string_view>
#include <vector>

namespace wingspread {

/// Texts end to end. Views of them hold until the next one is added.
class TextColumn {
public:
  void push_back(std::string_view text);
  [[nodiscard]] std::string_view operator[](std::size_t row) const;
  [[nodiscard]] std::size_t size() const { return ends_.size(); }
  /// As of Spilled.
  void release() const;

private:
  Spilled<char> text_;
  Spilled<std::uint64_t> ends_; ///< of each row's text
};

/// Texts that come again and again, each kept once: dictionary encoding. In memory are some 16
/// bytes for each different one.
class DictionaryColumn {
public:
  void push_back(std::string_view text);
  [[nodiscard]] std::string_view operator[](std::size_t row) const { return texts_[codes_[row]]; }
  [[nodiscard]] std::size_t size() const { return codes_.size(); }
  /// The different texts, in the order in which they first came.
  [[nodiscard]] const TextColumn& texts() const { return texts_; }
  /// Which of them each row has.
  [[nodiscard]] const Spilled<std::uint32_t>& codes() const { return codes_; }
  void release() const;

private:
  /// Of an open-addressed hash table with linear probing.
  struct Slot {
    std::uint32_t hash = 0;
    std::uint32_t code = vacant;
  };
  static constexpr std::uint32_t vacant = UINT32_MAX;

  /// The text's slot, or the vacant one where it belongs.
  [[nodiscard]] Slot& find(std::uint32_t hash, std::string_view text);
  void widen();

  TextColumn texts_;
  Spilled<std::uint32_t> codes_;
  std::vector<Slot> slots_; ///< a power of two, at most half of them taken
};

} // namespace wingspread
