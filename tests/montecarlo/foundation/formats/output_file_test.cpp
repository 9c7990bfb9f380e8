#include "montecarlo/foundation/formats/machine_error.hpp"
#include "montecarlo/foundation/formats/output_file.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("a file is begun anew, or gone on with at its end") {
  const Folder folder;
  const auto path = folder.write("a", "old");
  {
    OutputFile file(path, OutputFile::From::end);
    file.write(" and new");
    file.sync();
    file.close();
  }
  CHECK(read_text(path) == "old and new");
  OutputFile file(path, OutputFile::From::beginning);
  file.write("x");
  file.close();
  CHECK(read_text(path) == "x");
}

TEST_CASE("a full device is the machine's refusal, a missing folder the path's") {
  CHECK_THROWS_AS(OutputFile("/dev/full", OutputFile::From::end).write("x"), MachineError);
  CHECK(message_of([] {
          OutputFile("/dev/full", OutputFile::From::end).write("x");
          return 0;
        }) == "/dev/full: found No space left on device, expected a file that can be written");
  const Folder folder;
  CHECK_THROWS_AS(OutputFile(folder.path() / "no" / "a", OutputFile::From::beginning), SpecError);
}
