#include "montecarlo/foundation/formats/input_file.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>
#include <sys/stat.h>

using namespace wingspread;
using namespace wingspread::test;

namespace {

std::string refusal(const std::filesystem::path& path) {
  return message_of([&] { return InputFile(path).size(); });
}

} // namespace

TEST_CASE("a file is read to its end, and from any byte on") {
  const Folder folder;
  std::string text;
  for (int line = 0; line < 40'000; ++line)
    text += std::to_string(line) + "\n"; // more than a block
  InputFile in(folder.write("lines", text));
  CHECK(in.size() == text.size());
  std::string line;
  long sum = 0;
  while (std::getline(in, line)) sum += std::stol(line);
  CHECK(sum == 40'000L * 39'999 / 2);
  in.seek(text.find("31415\n"));
  std::getline(in, line);
  CHECK(line == "31415");
}

TEST_CASE("what has no end is refused, and not waited for") {
  const Folder folder;
  const auto pipe = folder.path() / "pipe";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  CHECK(refusal(pipe) == pipe.string() + ": found a pipe, expected a regular file");
  CHECK(refusal("/dev/zero") == "/dev/zero: found a device, expected a regular file");
  CHECK(refusal(folder.path()) ==
        folder.path().string() + ": found a folder, expected a regular file");
  CHECK(refusal(folder.path() / "no") ==
        (folder.path() / "no").string() +
            ": found No such file or directory, expected a file that can be read");
}
