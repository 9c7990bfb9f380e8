// Measures cost and gain of a thread pool against the amount of work, on free processors and beside as many busy
// threads. Prints means, because the slowest thread decides. `operations_worth_threads`
// (montecarlo/foundation/platform/thread_pool.hpp) follows from the figures.
//
//   build/release/studies/team_costs            team_costs.csv
//   build/release/studies/team_costs --quick    a twentieth of the time

#include "montecarlo/foundation/platform/thread_pool.hpp"
#include "studies/support/study.hpp"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

using namespace wingspread;

namespace {

constexpr std::size_t tasks = 8; // a typical number of a campaign's dispersions

/// Busy threads on all processors during the lifetime of this object.
class Others {
public:
  explicit Others(int count) {
    for (int k = 0; k < count; ++k)
      threads_.emplace_back([this] {
        while (!done_) {
        }
      });
  }
  ~Others() {
    done_ = true;
    for (std::thread& each : threads_) each.join();
  }
  Others(const Others&) = delete;
  Others& operator=(const Others&) = delete;

private:
  std::atomic<bool> done_ = false;
  std::vector<std::thread> threads_;
};

/// Compensated Σ x², the inner loop of most statistics. One operation is one term.
double work(const std::vector<double>& x) {
  double sum = 0, rest = 0;
  for (const double each : x) {
    const double term = each * each - rest, next = sum + term;
    rest = (next - sum) - term;
    sum = next;
  }
  return sum;
}

/// Mean time of all tasks on `threads` threads, µs.
double mean_time(int threads, std::size_t operations, double seconds) {
  const std::vector<double> x(operations / tasks, 1.1);
  std::vector<double> sums(tasks);
  using Clock = std::chrono::steady_clock;
  const auto since = [start = Clock::now()] {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  long calls = 0;
  for (; since() < seconds; ++calls)
    for_each_task(threads, tasks, [&](std::size_t i) { sums[i] = work(x); });
  return 1e6 * since() / static_cast<double>(calls);
}

void study_costs(const study::StudyOptions& options) {
  const int all = thread_count(0);
  const double seconds = options.quick ? 0.05 : 1;
  study::Table table{"operations", "processors free, 1 thread [us]", "processors free, all [us]",
                     "all wanted, 1 thread [us]", "all wanted, all [us]"};
  fmt::print("{:>12}{:>24}{:>24}\n", "", "processors free, µs", "all wanted, µs");
  fmt::print("{:>12}{:>12}{:>12}{:>12}{:>12}\n", "operations", "1 thread", all, "1 thread", all);
  for (std::size_t operations = 1 << 10; operations <= 1 << 26; operations *= 4) {
    std::vector<double> times;
    for (const int others : {0, all}) {
      const Others busy(others);
      for (const int threads : {1, all}) times.push_back(mean_time(threads, operations, seconds));
    }
    fmt::print("{:12}{:12.1f}{:12.1f}{:12.1f}{:12.1f}\n", operations, times[0], times[1], times[2],
               times[3]);
    table.add({static_cast<double>(operations), times[0], times[1], times[2], times[3]});
  }
  table.write(options.folder / "team_costs.csv");
}

} // namespace

int main(int count, char** arguments) {
  return study::run_study(count, arguments, "team_costs",
                          "What a thread pool costs and gains against the amount of work",
                          study_costs);
}
