#include "montecarlo/results/checkpoint/record_file.hpp"

#include "montecarlo/foundation/formats/files.hpp"

#include <array>
#include <bit>
#include <cstring>

namespace wingspread {
namespace {

static_assert(std::endian::native == std::endian::little, "records are read as they lie in memory");

constexpr std::string_view magic = "wingspread records 1\n";
constexpr std::uint64_t first_sum = 0xcbf29ce484222325u;
constexpr std::size_t head_bytes = sizeof(std::uint32_t) + sizeof(std::uint64_t);

std::uint64_t sum_of(std::uint64_t sum, std::string_view bytes) {
  for (const char c : bytes) sum = (sum ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return sum;
}

/// The checksum of a record and all before it.
std::uint64_t sum_of(std::uint64_t before, std::uint32_t size, std::string_view record) {
  std::array<char, sizeof size> bytes;
  std::memcpy(bytes.data(), &size, sizeof size);
  return sum_of(sum_of(before, {bytes.data(), bytes.size()}), record);
}

/// Appends the record with its head. @return its checksum
std::uint64_t append_framed(std::string& buffer, std::uint64_t before, std::string_view record) {
  const auto size = static_cast<std::uint32_t>(record.size());
  const std::uint64_t sum = sum_of(before, size, record);
  buffer.append(reinterpret_cast<const char*>(&size), sizeof size); // NOLINT: bytes of a number
  buffer.append(reinterpret_cast<const char*>(&sum), sizeof sum);   // NOLINT: bytes of a number
  buffer += record;
  return sum;
}

} // namespace

RecordReader::RecordReader(const std::filesystem::path& path) : in_(path) {
  std::array<char, magic.size()> there{};
  in_.read(there.data(), there.size());
  if (std::string_view(there.data(), static_cast<std::size_t>(in_.gcount())) != magic)
    throw SpecError({{path.string(), "", "another kind of file", "a checkpoint of this program"}});
  end_ = {magic.size(), first_sum};
}

bool RecordReader::next() {
  std::array<char, head_bytes> head{};
  in_.read(head.data(), head.size());
  const auto got = static_cast<std::size_t>(in_.gcount());
  tail_ = got == 0 ? RecordsTail::clean : RecordsTail::cut_off;
  if (got < head.size()) return false;
  std::uint32_t size = 0;
  std::uint64_t sum = 0;
  std::memcpy(&size, head.data(), sizeof size);
  std::memcpy(&sum, head.data() + sizeof size, sizeof sum);
  const std::size_t left = in_.size() - std::min(in_.size(), end_.bytes + head_bytes);
  const bool is_long = size > most_record_bytes;
  if (is_long) tail_ = RecordsTail::damaged;
  if (is_long || size > left) return false;
  record_.resize(size);
  in_.read(record_.data(), size);
  if (static_cast<std::size_t>(in_.gcount()) < size) return false;
  tail_ = RecordsTail::damaged;
  if (sum_of(end_.sum, size, record_) != sum) return false;
  end_ = {end_.bytes + head_bytes + size, sum};
  return true;
}

RecordWriter::RecordWriter(const std::filesystem::path& path, std::string_view first) {
  std::string text(magic);
  sum_ = append_framed(text, first_sum, first);
  write_file(path, text);
  out_.emplace(path, OutputFile::From::end);
}

RecordWriter::RecordWriter(const std::filesystem::path& path, RecordsEnd end) : sum_(end.sum) {
  std::error_code why;
  if (std::filesystem::file_size(path, why) > end.bytes && !why)
    std::filesystem::resize_file(path, end.bytes, why);
  if (why) refuse_path(path, why.value(), "a file that can be written");
  out_.emplace(path, OutputFile::From::end);
}

void RecordWriter::add(std::string_view record) {
  framed_.clear();
  sum_ = append_framed(framed_, sum_, record);
  out_->write(framed_);
}

} // namespace wingspread
