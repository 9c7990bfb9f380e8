#include "montecarlo/foundation/platform/spilled.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>
#include <sys/resource.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <numeric>
#include <unistd.h>

using namespace wingspread;
using namespace wingspread::test;

namespace {

constexpr std::size_t window = spill_bytes / sizeof(long);

/// 0, 1, … count − 1.
Spilled<long> counting(std::size_t count) {
  Spilled<long> values;
  while (values.size() < count) values.push_back(static_cast<long>(values.size()));
  return values;
}

bool counts(const Spilled<long>& values) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (values[i] != static_cast<long>(i)) return false;
  return true;
}

/// What this process holds, in MiB.
double resident() {
  std::ifstream statm("/proc/self/statm");
  double total = 0, pages = 0;
  statm >> total >> pages;
  return pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

/// TMPDIR, as long as this lives.
class TemporaryFolder {
public:
  explicit TemporaryFolder(const char* path) {
    if (const char* before = std::getenv("TMPDIR")) before_ = before;
    setenv("TMPDIR", path, 1);
  }
  ~TemporaryFolder() {
    before_.empty() ? unsetenv("TMPDIR") : setenv("TMPDIR", before_.c_str(), 1);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

private:
  std::string before_;
};

/// Whether a long column holds its numbers in a process that may open no further file.
/// @param may_raise whether the process may raise that limit by itself
/// @return 0: it does; 1: it says that too many files are open; else something else happened
int fill_without_files(bool may_raise) {
  const pid_t process = fork();
  if (process == 0) {
    rlimit files{};
    const int next = dup(0);
    close(next);
    getrlimit(RLIMIT_NOFILE, &files);
    files.rlim_cur = static_cast<rlim_t>(next);
    if (!may_raise) files.rlim_max = files.rlim_cur;
    if (setrlimit(RLIMIT_NOFILE, &files) != 0) _exit(3);
    const std::string message = message_of([&] { return counts(counting(2 * window)); });
    if (message.empty()) _exit(0);
    _exit(message.find("Too many open files") != std::string::npos ? 1 : 2);
  }
  int status = 0;
  waitpid(process, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

} // namespace

TEST_CASE("a column has its values whether it lies in memory or in a file") {
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, window - 1, window, window + 1,
                                 3 * window, 40 * window + 7}) {
    const Spilled<long> values = counting(size);
    REQUIRE(values.size() == size);
    REQUIRE(values.empty() == (size == 0));
    REQUIRE(counts(values));
    values.release();
    REQUIRE(counts(values));
  }
}

TEST_CASE("a column is filled, read and written as a vector is") {
  Spilled<long> values{3, 1, 2};
  CHECK(values == std::vector<long>{3, 1, 2});
  CHECK(std::accumulate(values.begin(), values.end(), 0L) == 6);
  std::ranges::sort(values);
  CHECK((values.front() == 1 && values.back() == 3));
  values[1] = 7;
  CHECK(values == Spilled<long>{1, 7, 3});
  CHECK(Spilled<long>(window + 2, 5L)[window + 1] == 5);
  while (values.size() < 2 * window) values.push_back(values.front()); // one of its own
  CHECK(values.back() == 1);
}

TEST_CASE("columns are copied, moved and swapped, in memory and in files") {
  for (const std::size_t size : {std::size_t{5}, 3 * window}) {
    Spilled<long> values = counting(size);
    Spilled<long> copy = values;
    copy[2] = -1;
    REQUIRE((counts(values) && values.size() == size && copy.size() == size));
    Spilled<long> moved = std::move(copy);
    REQUIRE((moved[2] == -1 && moved.size() == size));
    moved = values;
    REQUIRE(counts(moved));
    moved.push_back(static_cast<long>(size));
    REQUIRE((counts(moved) && moved.size() == size + 1 && values.size() == size));
    values = {};
    REQUIRE(values.empty());
    values.push_back(0);
    REQUIRE(counts(values));
  }
}

TEST_CASE("of a long column little is resident while it grows, and after it is released") {
  constexpr std::size_t size = (std::size_t{64} << 20) / sizeof(long);
  const double before = resident();
  const Spilled<long> values = counting(size);
  CHECK(resident() - before < 8);
  CHECK(counts(values));
  CHECK(resident() - before > 48);
  values.release();
  CHECK(resident() - before < 8);
  for (std::size_t first = 0; first < size; first += window) {
    CHECK(std::accumulate(&values[first], &values[first] + window, 0L) > 0);
    values.release(first, first + window);
  }
  CHECK(resident() - before < 8);
}

TEST_CASE("a long column leaves nothing in the folder that TMPDIR names") {
  const Folder folder;
  const TemporaryFolder named(folder.path().c_str());
  const Spilled<long> values = counting(2 * window);
  CHECK(counts(values));
  CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("where there is no room for a long column, the folder is named, and how to choose one") {
  const Folder folder;
  const std::string missing = (folder.path() / "missing").string();
  const TemporaryFolder named(missing.c_str());
  CHECK(counting(window).size() == window); // short ones need none
  CHECK(message_of([] { return counting(window + 1).size(); }) ==
        missing + ": found No such file or directory, expected room for temporary data (TMPDIR "
                  "names another folder)");
}

TEST_CASE(
    "where no more files may be open, a column raises that limit, or says that it could not") {
  CHECK(fill_without_files(true) == 0);
  CHECK(fill_without_files(false) == 1);
}
