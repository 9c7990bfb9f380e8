/// Columns that may be longer than memory should hold.
///
/// A short column is ordinary memory. A longer one lies in a temporary file of its own, mapped into
/// memory: in the folder that TMPDIR names, else in /var/tmp. The file has no name, so that nothing
/// is left of it however the program ends. What is resident of it is given back as it grows, and
/// wherever release() says that it has been read; it comes back when it is touched.
#pragma once

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace wingspread {

/// Longer columns than this go to a file, and as much of a growing one is resident.
inline constexpr std::size_t spill_bytes = std::size_t{1} << 18;

/// A temporary file without a name, mapped as a whole.
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
  /// Null as long as it is empty.
  [[nodiscard]] std::byte* data() const { return data_; }
  [[nodiscard]] std::size_t size() const { return size_; }
  /// Makes it longer, by zeros; what is mapped may move.
  /// @param bytes more than its size
  /// @throws MachineError that names the folder, when it has no room or cannot be written
  void grow(std::size_t bytes);
  /// Lets go of the memory that the bytes [first, last) take up; their values stay.
  void release(std::size_t first, std::size_t last) const;

private:
  int file_ = -1;
  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
};

/// A vector of plain values that spills into a file. Pointers and spans hold until it grows.
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

  /// @throws MachineError when there is no room for it on disk
  void push_back(const T& value) {
    const T copy = value; // it may be one of these
    if (size_ == room_) make_room();
    data_[size_++] = copy;
  }
  void append(std::span<const T> values) {
    for (const T& value : values) push_back(value);
  }

  /// Lets go of the memory of all values, or of those in [first, last), that lie in a file. For
  /// whoever has read them and is not to hold them; they stay what they are.
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

  std::vector<T> memory_; ///< while it is short
  TemporaryFile file_;
  T* data_ = nullptr;
  std::size_t size_ = 0;
  std::size_t room_ = 0; ///< the size at which there is something to be done first
};

} // namespace wingspread
