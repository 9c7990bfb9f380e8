/// Columns of texts, one per row, that may exceed memory (spilled.hpp).
#pragma once

#include "montecarlo/foundation/platform/spilled.hpp"

#include <cstdint>
#include <string_view>
#include <vector>

namespace wingspread {

/// Texts stored end to end. Views are valid until the next text is added.
class TextColumn {
public:
  void push_back(std::string_view text);
  [[nodiscard]] std::string_view operator[](std::size_t row) const;
  [[nodiscard]] std::size_t size() const { return ends_.size(); }
  /// As Spilled::release().
  void release() const;

private:
  Spilled<char> text_;
  Spilled<std::uint64_t> ends_; ///< end of each row's text
};

/// Dictionary encoding: each different text is stored once. Takes some 16 bytes of memory per different text.
class DictionaryColumn {
public:
  void push_back(std::string_view text);
  [[nodiscard]] std::string_view operator[](std::size_t row) const { return texts_[codes_[row]]; }
  [[nodiscard]] std::size_t size() const { return codes_.size(); }
  /// The different texts, in order of first appearance.
  [[nodiscard]] const TextColumn& texts() const { return texts_; }
  /// Index into texts() of each row.
  [[nodiscard]] const Spilled<std::uint32_t>& codes() const { return codes_; }
  void release() const;

private:
  /// A slot of an open-addressing hash table with linear probing.
  struct Slot {
    std::uint32_t hash = 0;
    std::uint32_t code = vacant;
  };
  static constexpr std::uint32_t vacant = UINT32_MAX;

  /// The slot of the text, or the vacant slot where the text belongs.
  [[nodiscard]] Slot& find(std::uint32_t hash, std::string_view text);
  void widen();

  TextColumn texts_;
  Spilled<std::uint32_t> codes_;
  std::vector<Slot> slots_; ///< a power of two of slots, at most half of them taken
};

} // namespace wingspread
