/// Columns that may exceed memory.
///
/// A short column is ordinary memory. A longer one is an unnamed temporary file, mapped into memory, in the folder
/// that TMPDIR names, else in /var/tmp. The file has no name, so nothing is left however the program ends. Resident
/// memory is returned to the system as a column grows and by release(); a later access reads the file again.
#pragma once

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace wingspread {

/// Largest column kept in ordinary memory; also the part of a growing file that stays resident. Heuristic: 256 KiB
/// times some hundred columns is tens of MB; a smaller value means more system calls, a larger one more memory.
inline constexpr std::size_t spill_bytes = std::size_t{1} << 18;

/// An unnamed temporary file, mapped as a whole.
class TemporaryFile {
public:
  TemporaryFile() = default;
  TemporaryFile(TemporaryFile&& other) noexcept { swap(other); }
  TemporaryFile& operator=(TemporaryFile&& other) noexcept {
    TemporaryFile(std::move(other)).swap(*this);
    return *this;
  }
  ~TemporaryFile();

  void swap(TemporaryFile& other) noexcept;
  /// Null if the file is empty.
  [[nodiscard]] std::byte* data() const { return data_; }
  [[nodiscard]] std::size_t size() const { return size_; }
  /// Extends the file by zeros. The mapping may move.
  /// @param bytes more than size()
  /// @throws MachineError that names the folder, if it has no room or cannot be written
  void grow(std::size_t bytes);
  /// Returns the memory of the bytes [first, last) to the system. Their values stay.
  void release(std::size_t first, std::size_t last) const;

private:
  int file_ = -1;
  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
};

/// A vector of plain values that spills into a file. Pointers and spans are valid until the vector grows.
template <class T> class Spilled {
  static_assert(std::is_trivially_copyable_v<T>);

public:
  using value_type = T;
  using iterator = T*;
  using const_iterator = const T*;

  Spilled() = default;
  Spilled(std::size_t count, const T& value) {
    while (size_ < count) push_back(value);
  }
  Spilled(std::initializer_list<T> values) { append(values); }
  Spilled(const std::vector<T>& values) { append(values); }
  Spilled(const Spilled& other) { append(other); }
  Spilled(Spilled&& other) noexcept { swap(other); }
  Spilled& operator=(Spilled other) noexcept {
    swap(other);
    return *this;
  }
  ~Spilled() = default;

  void swap(Spilled& other) noexcept {
    memory_.swap(other.memory_);
    file_.swap(other.file_);
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(room_, other.room_);
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] T* data() { return data_; }
  [[nodiscard]] const T* data() const { return data_; }
  [[nodiscard]] T* begin() { return data_; }
  [[nodiscard]] T* end() { return data_ + size_; }
  [[nodiscard]] const T* begin() const { return data_; }
  [[nodiscard]] const T* end() const { return data_ + size_; }
  [[nodiscard]] T& operator[](std::size_t index) { return data_[index]; }
  [[nodiscard]] const T& operator[](std::size_t index) const { return data_[index]; }
  [[nodiscard]] const T& front() const { return data_[0]; }
  [[nodiscard]] const T& back() const { return data_[size_ - 1]; }

  /// @throws MachineError if the disk has no room
  void push_back(const T& value) {
    const T copy = value; // `value` may refer to an element, which make_room() moves
    if (size_ == room_) make_room();
    data_[size_++] = copy;
  }
  void append(std::span<const T> values) {
    for (const T& value : values) push_back(value);
  }

  /// Returns the memory of values in a file, all or [first, last), to the system. The values stay. Call after reading
  /// a long column.
  void release() const { release(0, size_); }
  void release(std::size_t first, std::size_t last) const {
    if (file_.data()) file_.release(first * sizeof(T), last * sizeof(T));
  }

  friend bool operator==(const Spilled& a, const Spilled& b) { return std::ranges::equal(a, b); }

private:
  static constexpr std::size_t window = spill_bytes / sizeof(T); ///< values that stay resident

  void make_room() {
    if (size_ < window)
      grow_memory();
    else if ((size_ + 1) * sizeof(T) > file_.size())
      grow_file();
    else
      release(size_ - window, size_);
    if (file_.data()) room_ = std::min(size_ + window, file_.size() / sizeof(T));
  }

  void grow_memory() {
    memory_.resize(std::clamp<std::size_t>(2 * size_, 16, window));
    data_ = memory_.data();
    room_ = memory_.size();
  }

  void grow_file() {
    constexpr std::size_t step = 4 * spill_bytes;
    const std::size_t bytes = size_ * sizeof(T);
    file_.grow((bytes + bytes / 4) / step * step + step);
    T* const mapped = reinterpret_cast<T*>(file_.data());
    if (!memory_.empty()) std::copy_n(data_, size_, mapped);
    data_ = mapped;
    memory_ = {};
  }

  std::vector<T> memory_; ///< used while the column is short
  TemporaryFile file_;
  T* data_ = nullptr;
  std::size_t size_ = 0;
  std::size_t room_ = 0; ///< size at which make_room() must run
};

} // namespace wingspread
