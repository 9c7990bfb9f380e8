#include "montecarlo/foundation/platform/spilled.hpp"

#include "montecarlo/foundation/formats/machine_error.hpp"

#include <sys/mman.h>
#include <sys/resource.h>

#include <cerrno>
#include <cstdlib>
#include <fcntl.h>
#include <string>
#include <system_error>
#include <unistd.h>

namespace wingspread {
namespace {

std::string temporary_folder() {
  const char* named = std::getenv("TMPDIR");
  return named && *named ? named : "/var/tmp"; // /tmp may itself be memory
}

MachineError no_temporary_file(int error) {
  return MachineError({temporary_folder(), "", std::generic_category().message(error),
                       "room for temporary data (TMPDIR names another folder)"});
}

/// Raises the limit of open files to its maximum: a table may have hundreds of columns, each with a file or two.
/// @return whether the limit was raised
bool ask_for_files() {
  rlimit files{};
  if (getrlimit(RLIMIT_NOFILE, &files) != 0 || files.rlim_cur == files.rlim_max) return false;
  files.rlim_cur = files.rlim_max;
  return setrlimit(RLIMIT_NOFILE, &files) == 0;
}

int open_unnamed() {
  std::string path = temporary_folder() + "/wingspread-XXXXXX";
  const int file = mkostemp(path.data(), O_CLOEXEC);
  if (file < 0 && errno == EMFILE && ask_for_files()) return open_unnamed();
  if (file < 0) throw no_temporary_file(errno);
  unlink(path.c_str());
  return file;
}

} // namespace

TemporaryFile::~TemporaryFile() {
  if (data_) munmap(data_, size_);
  if (file_ >= 0) close(file_);
}

void TemporaryFile::swap(TemporaryFile& other) noexcept {
  std::swap(file_, other.file_);
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
}

void TemporaryFile::grow(std::size_t bytes) {
  if (file_ < 0) file_ = open_unnamed();
  // Allocates disk blocks now: a full disk is an error here, and not a SIGBUS at a later write.
  int error = EINTR;
  while (error == EINTR)
    error = posix_fallocate(file_, static_cast<off_t>(size_), static_cast<off_t>(bytes - size_));
  if (error != 0) throw no_temporary_file(error);
  void* const mapped = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file_, 0);
  if (mapped == MAP_FAILED) throw no_temporary_file(errno);
  if (data_) munmap(data_, size_);
  data_ = static_cast<std::byte*>(mapped);
  size_ = bytes;
}

void TemporaryFile::release(std::size_t first, std::size_t last) const {
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  first -= first % page;
  if (first < last) madvise(data_ + first, last - first, MADV_DONTNEED);
}

} // namespace wingspread
