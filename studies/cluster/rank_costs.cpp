/// Measures the costs of a job of many ranks: the time of each run of a campaign, and the time that rank 0 spends on
/// a message and on each row in it. `simulate_ranks.py` reads the files.
///
///   rank_costs [--quick] [--out DIR]      of studies/campaigns/seed.json
///
///   run_times.csv   how long each run took by itself, s
///   costs.csv       name, value
#include "montecarlo/engine/mpi/messages.hpp"
#include "montecarlo/engine/runs/in_order.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/results/results_folder/row_writer.hpp"
#include "studies/support/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <utility>

using namespace wingspread;

namespace {

const std::atomic<bool> never = false;

/// The processor's time of this thread: other work on the machine is not in it.
double now() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

template <class Work> double seconds_of(const Work& work) {
  const double began = now();
  work();
  return now() - began;
}

/// The messages of a rank that makes `runs` runs in chunks of `in_chunk`.
std::vector<std::string> reports(const RunPlan& plan, long runs, long in_chunk) {
  std::vector<std::string> messages;
  for (long first = 0; first < runs; first += in_chunk) {
    Report report{.wanted = 1};
    FinishedChunk& chunk = report.finished.emplace_back();
    chunk.chunk = {first / in_chunk, {first, std::min(first + in_chunk, runs)}};
    const auto keep = [&](const Batch& batch) {
      chunk.batch.csv += batch.csv;
      std::ranges::copy(batch.rows, std::back_inserter(chunk.batch.rows));
    };
    (void)ThreadEvaluator({.threads = 1}, never).make(plan, chunk.chunk.runs, {keep, true});
    messages.push_back(report_message(report));
  }
  return messages;
}

/// Rank 0 unpacks the messages, puts their rows in order and writes them. @return s, the least of nine passes
double take_in(const RunPlan& plan, const std::vector<std::string>& messages,
               const std::filesystem::path& file) {
  double least = 1e9;
  for (int repeat = 0; repeat < 9; ++repeat) {
    std::filesystem::remove(file);
    RowWriter writer(file, plan.names());
    writer.open();
    const BatchSink sink{[&](const Batch& batch) { writer.add(batch); }, true};
    InOrder in_order(sink, 1024);
    least = std::min(least, seconds_of([&] {
                       for (const std::string& message : messages) {
                         Deserializer bytes(message);
                         (void)kind_of(bytes);
                         for (FinishedChunk& each : read_report(bytes).finished)
                           in_order.finish(each.chunk.number, std::move(each.batch), true);
                       }
                     }));
    writer.finish();
  }
  return least;
}

void study_costs(const study::StudyOptions& options) {
  const Campaign campaign = read_campaign_file("studies/campaigns/seed.json");
  const RunPlan plan(campaign);
  const long timed = options.quick ? 200 : 10000, kept = options.quick ? 256 : 8192;
  study::Table times{"seconds"}, costs{"name", "value"};
  Runner runner(plan);
  double alone = 0;
  for (long run = 0; run < timed; ++run) {
    const double seconds = seconds_of([&] { (void)runner.run(run); });
    alone += seconds;
    times.add({seconds});
  }
  times.write(options.folder / "run_times.csv");
  const double in_lanes = seconds_of([&] {
    (void)ThreadEvaluator({.threads = 1}, never)
        .make(plan, {0, timed}, {[](const Batch&) {}, true});
  });
  const auto few = reports(plan, kept, 1), many = reports(plan, kept, 64);
  std::size_t bytes = 0;
  for (const std::string& message : many) bytes += message.size();
  const std::filesystem::path file = options.folder / "rank_costs_rows.csv";
  const double of_few = take_in(plan, few, file), of_many = take_in(plan, many, file);
  std::filesystem::remove(file);
  // of_few = kept (a + c), of_many = kept (a/64 + c)
  const auto runs = static_cast<double>(kept);
  const double message = std::max(0.0, (of_few - of_many) / runs * 64 / 63);
  const double row = of_many / runs - message / 64;
  costs.add({std::string("run_s"), in_lanes / static_cast<double>(timed)});
  costs.add({std::string("lanes_speedup"), alone / in_lanes});
  costs.add({std::string("message_s"), message});
  costs.add({std::string("row_s"), row});
  costs.add({std::string("row_bytes"), static_cast<double>(bytes) / runs});
  costs.write(options.folder / "costs.csv");
  fmt::print("a run: {:.1f} us in lanes, {:.2f} times that alone\n"
             "rank 0: {:.2f} us a message and {:.2f} us a row of {:.0f} bytes\n",
             1e6 * in_lanes / static_cast<double>(timed), alone / in_lanes, 1e6 * message,
             1e6 * row, static_cast<double>(bytes) / runs);
}

} // namespace

int main(int count, char** arguments) {
  return study::run_study(count, arguments, "rank_costs",
                          "How long runs take, and what rank 0 does for a message and a row",
                          study_costs);
}
