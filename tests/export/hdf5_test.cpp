// What `wingspread export` writes, read back by HDF5 itself and held against runs.csv.
#include "montecarlo/results/export/hdf5_export.hpp"
#include "tests/cli/program.hpp"

#include <catch2/catch.hpp>

#include <H5Cpp.h>
#include <atomic>
#include <bit>
#include <chrono>
#include <cstdint>
#include <map>
#include <thread>

using namespace wingspread;
using namespace wingspread::test;

namespace {

template <class Number>
std::vector<Number> numbers(const H5::Group& group, const std::string& name,
                            const H5::PredType& type) {
  const H5::DataSet set = group.openDataSet(name);
  std::vector<Number> values(static_cast<std::size_t>(set.getSpace().getSimpleExtentNpoints()));
  if (!values.empty()) set.read(values.data(), type);
  return values;
}

std::vector<double> doubles(const H5::Group& group, const std::string& name) {
  return numbers<double>(group, name, H5::PredType::NATIVE_DOUBLE);
}

std::vector<std::string> texts(const H5::Group& group, const std::string& name) {
  const H5::DataSet set = group.openDataSet(name);
  const std::size_t width = set.getDataType().getSize();
  std::string bytes(width * set.getSpace().getSimpleExtentNpoints(), '?');
  if (!bytes.empty()) set.read(bytes.data(), set.getDataType());
  std::vector<std::string> values;
  for (std::size_t at = 0; at < bytes.size(); at += width)
    values.emplace_back(bytes.substr(at, width).c_str());
  return values;
}

std::string attribute(const H5::H5Object& object, const std::string& name) {
  std::string text;
  const H5::Attribute found = object.openAttribute(name);
  found.read(found.getDataType(), text);
  return text;
}

/// In the order in which they were made.
std::vector<std::string> links(const H5::Group& group) {
  std::vector<std::string> names;
  const auto take = [](hid_t, const char* name, const H5L_info_t*, void* to) -> herr_t {
    static_cast<std::vector<std::string>*>(to)->emplace_back(name);
    return 0;
  };
  H5Literate(group.getId(), H5_INDEX_CRT_ORDER, H5_ITER_INC, nullptr, take, &names);
  return names;
}

bool same_bits(const std::vector<double>& found, const Spilled<double>& expected) {
  if (found.size() != expected.size()) return false;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (std::isnan(found[i]) && std::isnan(expected[i])) continue;
    if (std::bit_cast<std::uint64_t>(found[i]) != std::bit_cast<std::uint64_t>(expected[i]))
      return false;
  }
  return true;
}

/// Every column of the group against the folder's rows.
void check_rows(const H5::Group& group, const std::filesystem::path& folder) {
  const StoredCampaign stored = read_stored_campaign(folder);
  const Results rows = read_stored_results(stored).results;
  REQUIRE(links(group) == header_cells(RunPlan(stored.campaign).names()));
  for (const auto* columns : {&rows.draws, &rows.outputs})
    for (const Column& column : *columns) {
      CAPTURE(column.name);
      CHECK(same_bits(doubles(group, column.name), column.values));
    }
  const auto runs = numbers<std::int64_t>(group, "run", H5::PredType::NATIVE_INT64);
  const auto status = texts(group, "status"), order = texts(group, "latch_order"),
             reason = texts(group, "reason");
  REQUIRE(runs.size() == rows.size());
  for (const char* name : {"status", "latch_order", "reason"})
    CHECK(group.openDataSet(name).getStrType().getCset() ==
          H5T_CSET_ASCII); // Octave reads no other
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const ResultRow row = rows.row(i);
    CHECK(runs[i] == row.run);
    CHECK(status[i] == to_string(row.status));
    CHECK(order[i] == row.latch_order);
    CHECK(reason[i] == row.reason);
  }
  if (!rows.has_peaks_final) return;
  const auto final = numbers<signed char>(group, "peaks_final", H5::PredType::NATIVE_SCHAR);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const int code = rows.peaks_final[i] == PeaksFinal::yes       ? 1
                     : rows.peaks_final[i] == PeaksFinal::no      ? 0
                     : rows.peaks_final[i] == PeaksFinal::moments ? 2
                     : rows.peaks_final[i] == PeaksFinal::forces  ? 3
                                                                  : -1;
    CHECK(final[i] == code);
  }
}

} // namespace

TEST_CASE("exported rows are those of runs.csv, bit for bit") {
  const Folder folder;
  const auto path = folder.path() / "r", file = folder.path() / "r.h5";
  // Some draws are invalid, with reasons; some runs time out, with peaks that are cut and columns that are empty.
  (void)run_into(path, campaign_of(full_campaign(200)));
  const auto [code, out, error] = run_program(folder, {"export", path, "--out", file.string()});
  CHECK(code == 0);
  CHECK(error.empty());
  CHECK(out == file.string() + "\n");
  const H5::H5File in(file.string(), H5F_ACC_RDONLY);
  check_rows(in, path);
  const auto final = numbers<signed char>(in, "peaks_final", H5::PredType::NATIVE_SCHAR);
  for (const int code_seen : {-1, 0, 1}) CHECK(std::ranges::count(final, code_seen) > 0);
}

TEST_CASE("exported columns say what they are, and the file where they are from") {
  const Folder folder;
  const auto path = folder.path() / "r", file = folder.path() / "r.h5";
  (void)run_into(path, campaign_of(quick_campaign(10)));
  export_hdf5(path, file);
  const H5::H5File in(file.string(), H5F_ACC_RDONLY);
  const StoredCampaign stored = read_stored_campaign(path);
  CHECK(attribute(in, "version") == stored.stamp.version);
  CHECK(attribute(in, "hash") == stored.stamp.hash);
  CHECK(parse_json(attribute(in, "campaign")) == stored.campaign.resolved);
  std::uint64_t seed = 0;
  in.openAttribute("seed").read(H5::PredType::NATIVE_UINT64, &seed);
  CHECK(seed == 7);
  const H5::DataSet time = in.openDataSet("root.latch_time"), mass = in.openDataSet("mass.panel_1"),
                    spring = in.openDataSet("root_spring");
  CHECK(attribute(time, "name") == "root.latch_time");
  CHECK(attribute(time, "unit") == "s");
  CHECK(attribute(time, "description") ==
        "when root reaches its latched angle for the first time; of a latch that may miss or let "
        "go, when it engaged for good");
  CHECK(attribute(mass, "unit") == "kg");
  CHECK(attribute(mass, "description") ==
        "drawn: uniform (lower 9, upper 11); set bodies.panel_1.mass");
  CHECK(attribute(spring, "unit").empty()); // a factor
  CHECK(attribute(in.openDataSet("mid.rate_at.tip"), "description") ==
        "relative rate of mid when tip latches, signed");
}

TEST_CASE("an exported shard has its own number of runs, and says which shard it is") {
  const Folder folder;
  long all = 0;
  for (const long index : {1L, 2L, 3L}) {
    const std::string name = "r" + std::to_string(index);
    const auto path = folder.path() / name, file = folder.path() / (name + ".h5");
    const Shard shard{index, 3};
    (void)run_into(path, campaign_of(quick_campaign(20)), {.shard = shard});
    export_hdf5(path, file);
    const H5::H5File in(file.string(), H5F_ACC_RDONLY);
    check_rows(in, path);
    std::int64_t runs = 0;
    in.openAttribute("runs").read(H5::PredType::NATIVE_INT64, &runs);
    CHECK(runs == shard_runs(20, shard).size());
    CHECK(attribute(in, "shard") == describe(std::optional(shard)));
    all += runs;
  }
  CHECK(all == 20);
  const std::string part = folder.path() / "part", file = folder.path() / "part.h5";
  (void)run_program(
      folder, {"merge", folder.path() / "r1", folder.path() / "r3", "--preview", "--out", part});
  export_hdf5(part, file);
  const H5::H5File in(file, H5F_ACC_RDONLY);
  CHECK(attribute(in, "preview") == "a preview of 13 of 20 runs");
}

TEST_CASE("the same folder is exported to the same bytes, in place of what was there") {
  const Folder folder;
  const auto path = folder.path() / "r", a = folder.path() / "a.h5", b = folder.path() / "b.h5";
  (void)run_into(path, campaign_of(quick_campaign(10)));
  export_hdf5(path, a);
  std::ofstream(b) << "what was there";
  std::this_thread::sleep_for(std::chrono::milliseconds(1100)); // HDF5's times are whole seconds
  export_hdf5(path, b);
  CHECK(read_text(a) == read_text(b));
  CHECK_FALSE(std::filesystem::exists(folder.path() / ".b.h5.part"));
}

TEST_CASE("a folder to which rows are being added is exported as far as it was") {
  const Folder folder;
  const auto path = folder.path() / "r", file = folder.path() / "r.h5";
  (void)run_into(path, campaign_of(quick_campaign(3000)));
  const std::string all = read_text(path / runs_file).value();
  const std::vector<std::string> lines = lines_of(all);
  std::ofstream rows(path / runs_file, std::ios::trunc);
  const auto add = [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) rows << lines[k] << "\n";
    rows.flush();
  };
  add(0, 1001); // the header and 1000 rows
  std::atomic<bool> stop = false;
  std::thread writer([&] {
    for (std::size_t k = 1001; k < lines.size() && !stop; ++k) {
      add(k, k + 1);
      std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
  });
  std::size_t before = 1000;
  std::string failure;
  for (int trial = 0; trial < 5 && failure.empty(); ++trial) {
    failure = message_of([&] {
      export_hdf5(path, file);
      return 0;
    });
    if (!failure.empty()) break;
    const H5::H5File in(file.string(), H5F_ACC_RDONLY);
    const auto runs = numbers<std::int64_t>(in, "run", H5::PredType::NATIVE_INT64);
    CHECK(runs.size() >= before);
    for (std::size_t k = 0; k < runs.size(); ++k) REQUIRE(runs[k] == static_cast<std::int64_t>(k));
    before = runs.size();
  }
  stop = true;
  writer.join();
  CHECK(failure.empty());
  CHECK(before > 1000); // rows were added meanwhile
}

TEST_CASE("a campaign's cases are exported as groups") {
  const Folder folder;
  Json json = quick_campaign(20);
  json["cases"] = parse_json(R"([{ "name": "cold", "scale": { "bodies.*.inertia": 1.1 } },
                                 { "name": "hot" }])");
  const std::string campaign = folder.write("c.json", json.dump()), path = folder.path() / "r";
  REQUIRE(run_program(folder, {"run", campaign, "--out", path}).code == 0);
  const auto file = folder.path() / "r.h5";
  export_hdf5(path, file);
  const H5::H5File in(file.string(), H5F_ACC_RDONLY);
  CHECK(links(in) == std::vector<std::string>{"cold", "hot"});
  for (const char* name : {"cold", "hot"})
    check_rows(in.openGroup(name), std::filesystem::path(path) / name);
}

TEST_CASE("chunks hold whole numbers of rows, and a file without rows can be read") {
  const Folder folder;
  const auto path = folder.path() / "r", file = folder.path() / "r.h5";
  Json json = quick_campaign(40'000);       // two chunks and a part of one
  json["integration"]["t_end"] = 1'000'000; // the latch times below
  const Campaign campaign = campaign_of(json);
  const RunPlan plan(campaign);
  Runner runner(plan);
  std::string csv;
  append_header(csv, plan.names());
  ResultRow row = runner.run(0);
  std::filesystem::create_directory(path);
  write_file(path / campaign_file, campaign_text(campaign, stamp_of(campaign, {})));
  write_file(path / runs_file, csv);
  export_hdf5(path, file);
  CHECK(doubles(H5::H5File(file.string(), H5F_ACC_RDONLY), "root.latch_time").empty());
  row.latch_order.clear(); // the latch times below have none
  REQUIRE(plan.names().outputs.back() == "deployment_time");
  row.outputs.back() = 1e5; // after all of them
  for (row.run = 0; row.run < 40'000; ++row.run) {
    row.outputs[0] = static_cast<double>(row.run) + 0.1;
    append_row(csv, row);
  }
  write_file(path / runs_file, csv);
  export_hdf5(path, file);
  const H5::H5File in(file.string(), H5F_ACC_RDONLY);
  const auto values = doubles(in, plan.names().outputs[0]);
  REQUIRE(values.size() == 40'000);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (values[i] != static_cast<double>(i) + 0.1) FAIL_CHECK("row " << i << ": " << values[i]);
}

TEST_CASE("a name that HDF5 cannot have is another there, and stands in an attribute") {
  const Folder folder;
  const auto path = folder.path() / "r", file = folder.path() / "r.h5";
  Json json = quick_campaign(5);
  const std::vector<std::pair<std::string, std::string>> names{
      {"spring/root", "spring∕root"}, {"/of/many/parts/", "∕of∕many∕parts∕"}, {".", "_."}};
  const Json first = json["dispersions"][0];
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (k > 0) json["dispersions"].push_back(first);
    (k > 0 ? json["dispersions"].back() : json["dispersions"][0])["name"] = names[k].first;
    (k > 0 ? json["dispersions"].back() : json["dispersions"][0])["apply"] = "scale";
  }
  (void)run_into(path, campaign_of(json));
  export_hdf5(path, file);
  const H5::H5File in(file.string(), H5F_ACC_RDONLY);
  for (const auto& [name, link] : names) CHECK(attribute(in.openDataSet(link), "name") == name);
}

TEST_CASE("what cannot be exported is refused, and nothing is left of it") {
  const Folder folder;
  const std::string path = folder.path() / "r", file = folder.path() / "r.h5";
  (void)run_into(path, campaign_of(quick_campaign(5)));
  const auto refused = [&](const std::string& from, const std::string& to) {
    return run_program(folder, {"export", from, "--out", to});
  };
  const auto none = refused(folder.path() / "none", file);
  CHECK(none.code == 2);
  CHECK(none.error == "error: " + (folder.path() / "none").string() +
                          ": found no such folder, expected a results folder\n");
  CHECK(refused(path, path).code == 2); // it is read
  CHECK(refused(path, folder.path()).error ==
        "error: " + folder.path().string() +
            ": found a folder, expected a file: HDF5 goes back and forth in it\n");
  CHECK(refused(path, "/dev/full").code == 2);
  CHECK(refused(path, folder.path() / "nowhere/r.h5").code == 2);
  const std::string rowless = folder.path() / "rowless";
  REQUIRE(run_program(folder, {"run", std::filesystem::path(path) / "campaign.json", "--no-rows",
                               "--out", rowless})
              .code == 0);
  CHECK_THAT(refused(rowless, file).error,
             Catch::Contains(rowless) && Catch::Contains("--no-rows"));
  std::filesystem::remove(std::filesystem::path(path) / runs_file);
  const auto [code, out, error] = refused(path, file);
  CHECK(code == 2);
  CHECK(error ==
        "error: " + path +
            ": found no runs.csv in it, expected a results folder with the rows of its runs\n");
  CHECK_FALSE(std::filesystem::exists(file));
  CHECK_FALSE(std::filesystem::exists(folder.path() / ".r.h5.part"));
}

TEST_CASE("a device without room is the machine's refusal, and nothing is left of the file") {
  const Folder folder;
  const std::string path = folder.path() / "r", file = folder.path() / "r.h5";
  (void)run_into(path, campaign_of(full_campaign(2000)));
  write_file(file, "what was there");
  const std::map<std::string, std::string> faults{{"LD_PRELOAD", WINGSPREAD_FAULTS},
                                                  {"FAULTS_PATH", folder.path()},
                                                  {"FAULTS_CALLS", "write"},
                                                  {"FAULTS_AT", "12"},
                                                  {"FAULTS_LAST", "0"},
                                                  {"FAULTS_ERROR", "ENOSPC"}};
  for (const auto& [name, value] : faults) setenv(name.c_str(), value.c_str(), 1);
  const auto [code, out, error] = run_program(folder, {"export", path, "--out", file});
  for (const auto& [name, value] : faults) unsetenv(name.c_str());
  CHECK(code == 4);
  CHECK(error == "error: " + file +
                     ": found No space left on device, expected a file that can be written\n");
  CHECK(read_text(file) == "what was there");
  CHECK_FALSE(std::filesystem::exists(folder.path() / ".r.h5.part"));
}
