#include "montecarlo/formats/files.hpp"

#include <cerrno>
#include <fstream>
#include <iterator>
#include <system_error>

namespace wingspread {
namespace {

SpecError unwritable(const std::filesystem::path& path, const std::error_code& why,
                     const char* expected) {
  return SpecError({{path.string(), "", why.message(), expected}});
}

} // namespace

std::optional<std::string> read_text(const std::filesystem::path& path) {
  std::error_code unknown; // a path that cannot be asked about cannot be opened either
  std::ifstream in;
  if (!std::filesystem::is_directory(path, unknown)) in.open(path, std::ios::binary);
  if (!in.is_open()) return std::nullopt;
  return std::string{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

SpecError unwritable(const std::filesystem::path& path) {
  return unwritable(path, std::error_code(errno, std::generic_category()),
                    "a file that can be written");
}

void write_file(const std::filesystem::path& path, std::string_view text) {
  write_file(path, [text](std::ostream& out) { out << text; });
}

void write_file(const std::filesystem::path& path,
                const std::function<void(std::ostream&)>& write) {
  std::filesystem::path part = path;
  part += part_suffix;
  std::ofstream out(part, std::ios::binary | std::ios::trunc);
  write(out);
  out.flush();
  if (!out) throw unwritable(part);
  out.close();
  std::error_code why;
  std::filesystem::rename(part, path, why);
  if (why) throw unwritable(path, why, "a file that can be written");
}

void make_folder(const std::filesystem::path& path) {
  std::error_code why;
  std::filesystem::create_directories(path, why);
  if (why) throw unwritable(path, why, "a folder that can be made");
}

} // namespace wingspread
