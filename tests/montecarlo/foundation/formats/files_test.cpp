#include "montecarlo/foundation/formats/files.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("a file is written whole, in place of the old one, and leaves nothing else") {
  const Folder folder;
  const auto path = folder.write("a.json", "old");
  write_file(path, "new");
  CHECK(read_text(path) == "new");
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 1);
}

TEST_CASE("what cannot be written is named, with the system's reason") {
  const Folder folder;
  const auto file = folder.write("file", "");
  CHECK(message_of([&] {
          write_file(folder.path() / "no" / "a.json", "x");
          return 0;
        }) == (folder.path() / "no" / "a.json").string() +
                  ": found No such file or directory, expected a file that can be written");
  CHECK(message_of([&] {
          make_folder(file / "below");
          return 0;
        }) ==
        (file / "below").string() + ": found Not a directory, expected a folder that can be made");
}
