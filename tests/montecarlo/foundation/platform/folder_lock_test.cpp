#include "montecarlo/foundation/platform/folder_lock.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>
#include <sys/wait.h>

#include <signal.h>

using namespace wingspread;
using namespace wingspread::test;

namespace {

std::string refusal(const std::filesystem::path& folder) {
  return message_of([&] {
    const FolderLock lock(folder);
    return 0;
  });
}

/// A process of its own that holds the folder until it is killed.
class Holder {
public:
  explicit Holder(const std::filesystem::path& folder) {
    int ready[2];
    REQUIRE(pipe(ready) == 0);
    process_ = fork();
    if (process_ == 0) {
      const FolderLock lock(folder);
      (void)!write(ready[1], "x", 1);
      for (;;) pause();
    }
    char byte = 0;
    REQUIRE(read(ready[0], &byte, 1) == 1);
    close(ready[0]);
    close(ready[1]);
  }
  ~Holder() { end(); }
  Holder(const Holder&) = delete;
  Holder& operator=(const Holder&) = delete;

  [[nodiscard]] pid_t process() const { return process_; }
  void end() {
    if (process_ <= 0) return;
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
    process_ = 0;
  }

private:
  pid_t process_ = 0;
};

} // namespace

TEST_CASE("a folder has one writer, and the second is told who it is") {
  const Folder folder;
  const auto path = folder.path() / "r";
  {
    const FolderLock lock(path);
    char host[256] = {};
    gethostname(host, sizeof host - 1);
    CHECK(refusal(path) == path.string() + ": found process " + std::to_string(getpid()) + " on " +
                               host +
                               " at work in it, expected a folder that no other process writes to");
  }
  CHECK(refusal(path).empty());
}

TEST_CASE("the lock leaves nothing, nor a folder that it made and nobody used") {
  const Folder folder;
  const auto fresh = folder.path() / "fresh", used = folder.path() / "used";
  { const FolderLock lock(fresh); }
  CHECK_FALSE(std::filesystem::exists(fresh));
  {
    const FolderLock lock(used);
    std::ofstream(used / "runs.csv") << "run\n";
  }
  CHECK(std::filesystem::exists(used / "runs.csv"));
  CHECK_FALSE(std::filesystem::exists(used / lock_file));
}

TEST_CASE("a dead holder's lock does not hold") {
  const Folder folder;
  const auto path = folder.path() / "r";
  Holder holder(path);
  CHECK_THAT(refusal(path),
             Catch::Contains("found process " + std::to_string(holder.process()) + " on "));
  holder.end();
  CHECK(std::filesystem::exists(path / lock_file)); // what a crash leaves
  CHECK(refusal(path).empty());
  CHECK_FALSE(std::filesystem::exists(path / lock_file));
}

TEST_CASE("who writes to a folder clears away what a killed program had begun in it, and no more") {
  const Folder folder;
  const char* begun = ".summary.json.part";
  folder.write(begun, "{");
  folder.write("summary.json", "{}");
  folder.write("thesis.part", "chapter 1"); // the user's
  { const FolderLock lock(folder.path(), FolderLock::For::reading); }
  CHECK(read_text(folder.path() / begun) == "{");
  { const FolderLock lock(folder.path()); }
  CHECK_FALSE(std::filesystem::exists(folder.path() / begun));
  CHECK(read_text(folder.path() / "summary.json") == "{}");
  CHECK(read_text(folder.path() / "thesis.part") == "chapter 1");
}
