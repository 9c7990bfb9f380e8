#include "montecarlo/foundation/formats/files.hpp"

#include "montecarlo/foundation/formats/input_file.hpp"

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <iterator>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace wingspread {
namespace {

// Globals, because a signal handler reaches nothing else.
std::array<char, PATH_MAX> part_path; // of the unfinished WholeFile
std::atomic<bool> part_begun = false;
static_assert(std::atomic<bool>::is_always_lock_free);

bool is_special(const std::filesystem::path& path) {
  std::error_code unknown;
  const auto found = std::filesystem::status(path, unknown);
  return std::filesystem::exists(found) && !std::filesystem::is_regular_file(found);
}

/// Returns the part's path and records it for the signal handler.
std::filesystem::path begin_part(const std::filesystem::path& path) {
  if (is_special(path)) return path;
  const std::string name = '.' + path.filename().string() + std::string(part_suffix);
  const std::string part = path.parent_path() / name;
  if (part.size() >= part_path.size()) refuse_path(path, ENAMETOOLONG, "a shorter name");
  part_path[part.copy(part_path.data(), part.size())] = '\0';
  part_begun = true;
  return part;
}

} // namespace

void drop_part() noexcept {
  if (part_begun.exchange(false)) unlink(part_path.data());
}

WholeFile::WholeFile(std::filesystem::path path)
    : path_(std::move(path)), part_(begin_part(path_), OutputFile::From::beginning, path_) {}

WholeFile::~WholeFile() { drop_part(); }

void WholeFile::finish() {
  part_.sync();
  part_.close();
  if (part_.path() == path_) return;
  if (std::rename(part_.path().c_str(), path_.c_str()) != 0)
    refuse_path(path_, errno, "a file that can be written");
  part_begun = false;
  sync_folder(path_.parent_path());
}

void write_file(const std::filesystem::path& path, std::string_view text) {
  WholeFile file(path);
  file.write(text);
  file.finish();
}

void remove_parts(const std::filesystem::path& folder) {
  std::error_code unreadable; // then the loop is empty
  for (const auto& entry : std::filesystem::directory_iterator(folder, unreadable))
    if (const std::string name = entry.path().filename();
        name.starts_with('.') && name.ends_with(part_suffix))
      unlink(entry.path().c_str());
}

void make_folder(const std::filesystem::path& path, const char* expected) {
  std::error_code why;
  std::filesystem::create_directories(path, why);
  if (why) refuse_path(path, why.value(), expected);
}

std::optional<std::string> read_text(const std::filesystem::path& path) {
  std::error_code unknown; // a path that cannot be asked about cannot be opened either
  if (!std::filesystem::exists(path, unknown) || std::filesystem::is_directory(path, unknown))
    return std::nullopt;
  InputFile in(path);
  if (in.size() > most_text_bytes)
    throw SpecError({{path.string(), "", fmt::format("{} bytes", in.size()),
                      fmt::format("at most {}", most_text_bytes)}});
  return std::string{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

} // namespace wingspread
