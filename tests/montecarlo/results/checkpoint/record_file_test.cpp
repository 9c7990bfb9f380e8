#include "montecarlo/results/checkpoint/record_file.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>

#include <fstream>

using namespace wingspread;
using namespace wingspread::test;

namespace {

const std::vector<std::string> written{"first", "", std::string(300, 'x'), "last\n\0\xFF"};

void put_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

void write_all(const std::filesystem::path& path) {
  RecordWriter out(path, written.front());
  for (std::size_t i = 1; i < written.size(); ++i) out.add(written[i]);
}

struct Read {
  std::vector<std::string> records;
  RecordsEnd end;
  RecordsTail tail;
};

Read read_all(const std::filesystem::path& path) {
  RecordReader in(path);
  Read read{};
  while (in.next()) read.records.push_back(in.record());
  read.end = in.end();
  read.tail = in.tail();
  return read;
}

/// Whether they are the first ones of those that were written.
bool is_beginning(const std::vector<std::string>& records) {
  return records.size() <= written.size() &&
         std::equal(records.begin(), records.end(), written.begin());
}

} // namespace

TEST_CASE("records are read as they were written, and more can be put behind them") {
  const Folder folder;
  const auto path = folder.path() / "log";
  write_all(path);
  const Read read = read_all(path);
  CHECK(read.records == written);
  CHECK(read.tail == RecordsTail::clean);
  CHECK(read.end.bytes == std::filesystem::file_size(path));
  RecordWriter(path, read.end).add("more");
  auto with_more = written;
  with_more.push_back("more");
  CHECK(read_all(path).records == with_more);
}

TEST_CASE("a file that is cut off at any byte has its first records, and goes on behind them") {
  const Folder folder;
  const auto path = folder.path() / "log", whole = folder.path() / "whole";
  write_all(whole);
  const std::string all = bytes_of(whole);
  std::size_t before = 0;
  for (std::size_t size = 21; size < all.size(); ++size) { // behind the line of text
    put_bytes(path, all.substr(0, size));
    const Read read = read_all(path);
    CAPTURE(size);
    REQUIRE(is_beginning(read.records));
    REQUIRE(read.records.size() >= before);
    REQUIRE((read.tail == RecordsTail::clean) == (read.end.bytes == size));
    before = read.records.size();
    if (read.records.empty()) continue;
    {
      RecordWriter out(path, read.end);
      for (std::size_t i = before; i < written.size(); ++i) out.add(written[i]);
    }
    REQUIRE(bytes_of(path) == all);
  }
  CHECK(before == written.size() - 1);
}

TEST_CASE("no record is believed from a byte on that was changed") {
  const Folder folder;
  const auto path = folder.path() / "log";
  write_all(path);
  const std::string all = bytes_of(path);
  std::size_t next = 21, record = 0; // where the next record begins
  for (std::size_t at = 21; at < all.size(); ++at) {
    while (at >= next) next += 12 + written[record++].size();
    for (const int bit : {0, 3, 7}) {
      std::string changed = all;
      changed[at] = static_cast<char>(changed[at] ^ (1 << bit));
      put_bytes(path, changed);
      const Read read = read_all(path);
      CAPTURE(at, bit);
      REQUIRE(is_beginning(read.records));
      REQUIRE(read.records.size() == record - 1); // all before, and none from there on
      REQUIRE(read.tail != RecordsTail::clean);
    }
  }
}

TEST_CASE("a record that was lost, doubled or exchanged ends what is believed") {
  const Folder folder;
  const auto path = folder.path() / "log";
  {
    RecordWriter out(path, "a");
    for (const char* record : {"b", "c", "d"}) out.add(record);
  }
  const std::string all = bytes_of(path), head = all.substr(0, 34); // with the first record
  const auto at = [&](std::size_t i) { return all.substr(21 + 13 * i, 13); };
  for (const std::string& changed :
       {head + at(2) + at(3), head + at(1) + at(1) + at(2), head + at(2) + at(1) + at(3)}) {
    put_bytes(path, changed);
    const Read read = read_all(path);
    CHECK(read.records.size() <= 2);
    CHECK(read.records.size() == (changed.starts_with(head + at(1)) ? 2 : 1));
    CHECK(read.tail == RecordsTail::damaged);
  }
}

TEST_CASE("another kind of file is refused") {
  const Folder folder;
  const std::string path = folder.write("log", "run,status\n");
  CHECK_THROWS_WITH(RecordReader(path), Catch::StartsWith(path) && Catch::Contains("another kind"));
  CHECK_THROWS_WITH(RecordReader(folder.write("empty", "")), Catch::Contains("another kind"));
}
