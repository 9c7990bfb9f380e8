#include "montecarlo/foundation/platform/text_column.hpp"

#include <functional>

namespace wingspread {

void TextColumn::push_back(std::string_view text) {
  text_.append(text);
  ends_.push_back(text_.size());
}

std::string_view TextColumn::operator[](std::size_t row) const {
  const std::size_t begin = row == 0 ? 0 : ends_[row - 1];
  return {text_.data() + begin, ends_[row] - begin};
}

void TextColumn::release() const {
  text_.release();
  ends_.release();
}

void DictionaryColumn::push_back(std::string_view text) {
  if (2 * texts_.size() >= slots_.size()) widen();
  const auto hash = static_cast<std::uint32_t>(std::hash<std::string_view>{}(text));
  Slot& slot = find(hash, text);
  if (slot.code == vacant) {
    slot = {hash, static_cast<std::uint32_t>(texts_.size())};
    texts_.push_back(text);
  }
  codes_.push_back(slot.code);
}

DictionaryColumn::Slot& DictionaryColumn::find(std::uint32_t hash, std::string_view text) {
  std::size_t at = hash;
  for (;; ++at) {
    Slot& slot = slots_[at % slots_.size()];
    if (slot.code == vacant || (slot.hash == hash && texts_[slot.code] == text)) return slot;
  }
}

void DictionaryColumn::widen() {
  std::vector<Slot> before(std::max<std::size_t>(16, 2 * slots_.size()));
  before.swap(slots_);
  for (const Slot& slot : before) {
    if (slot.code == vacant) continue;
    std::size_t at = slot.hash;
    while (slots_[at % slots_.size()].code != vacant) ++at;
    slots_[at % slots_.size()] = slot;
  }
}

void DictionaryColumn::release() const {
  texts_.release();
  codes_.release();
}

} // namespace wingspread
