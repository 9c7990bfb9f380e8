#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/results/results_folder/row_writer.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

namespace {

const ResultNames names{{"mass"}, {"root.latch_time"}};

Batch batch_of(long first, long count) {
  Batch batch;
  for (long run = first; run < first + count; ++run) {
    ResultRow row;
    row.run = run, row.status = Status::deployed;
    row.draws = {1 + 0.125 * static_cast<double>(run)};
    row.outputs = {4.5};
    row.latch_order = "root";
    append_row(batch.csv, row);
    batch.rows.push_back(row);
  }
  return batch;
}

} // namespace

TEST_CASE("rows are kept and appended to their file, which has its header once") {
  const Folder folder;
  const auto file = folder.path() / "runs.csv";
  {
    RowWriter rows(file, names);
    rows.open();
    rows.add(batch_of(0, 2));
    rows.add(batch_of(2, 1));
    CHECK(rows.results().size() == 3);
  }
  std::ofstream(file, std::ios::binary | std::ios::app) << "3,deplo"; // a crash
  std::ifstream in(file, std::ios::binary);
  RowWriter rows(file, names);
  rows.continue_after(read_results(in, file.string(), names, UnterminatedRow::drop), 0);
  rows.open();
  rows.add(batch_of(3, 1));
  CHECK(rows.results().runs[3] == 3);
  std::string expected;
  append_header(expected, names);
  CHECK(read_text(file).value() == expected + batch_of(0, 4).csv);
}

TEST_CASE("rows with a gap are not gone on with, and the file is left as it is") {
  const Folder folder;
  const auto file = folder.path() / "runs.csv";
  std::string text;
  append_header(text, names);
  text += batch_of(0, 1).csv + batch_of(2, 1).csv + "5";
  std::ofstream(file, std::ios::binary) << text;
  std::ifstream in(file, std::ios::binary);
  ResultsFile read = read_results(in, file.string(), names, UnterminatedRow::drop);
  RowWriter rows(file, names);
  const std::string message = message_of([&] { rows.continue_after(std::move(read), 0); });
  CHECK_THAT(message, Catch::Contains("found run 2") && Catch::Contains("run 1, the next one"));
  CHECK(read_text(file).value() == text);
}

TEST_CASE("rows are appended only below a header of the same columns in the same order") {
  const Folder folder;
  const auto file = folder.path() / "runs.csv";
  const auto refusal = [&](const char* header, const char* row) {
    const std::string text = header + std::string("\n") + row + "\n4,deplo";
    std::ofstream(file, std::ios::binary) << text;
    std::ifstream in(file, std::ios::binary);
    ResultsFile read = read_results(in, file.string(), names, UnterminatedRow::drop);
    CHECK(read.results.size() == 1); // readers accept it
    RowWriter rows(file, names);
    const std::string message = message_of([&] { rows.continue_after(std::move(read), 3); });
    CHECK((message.empty() || read_text(file) == text));
    return message;
  };
  CHECK(refusal("run,status,mass,root.latch_time,latch_order,reason", "3,deployed,1,4.5,root,")
            .empty());
  CHECK_THAT(
      refusal("run,status,root.latch_time,mass,latch_order,reason", "3,deployed,4.5,1,root,"),
      Catch::Contains("found \"root.latch_time\" as column 3") &&
          Catch::Contains("expected \"mass\""));
  CHECK_THAT(refusal("run,status,mass,root.latch_time,latch_order", "3,deployed,1,4.5,root"),
             Catch::Contains("nothing as column 6") && Catch::Contains("expected \"reason\""));
}

TEST_CASE("rows that cannot be written say which file") {
  const Folder folder;
  RowWriter rows(folder.path() / "nowhere" / "runs.csv", names);
  CHECK_THAT(message_of([&] { rows.open(); }), Catch::Contains("runs.csv"));
}
