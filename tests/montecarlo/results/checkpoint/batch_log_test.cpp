#include "montecarlo/results/checkpoint/batch_log.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <random>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// Asks a log for batches of these sizes. @return the results, and how many of them were made anew
std::pair<std::vector<std::vector<double>>, std::size_t>
ask(const std::filesystem::path& file, const std::vector<std::size_t>& sizes) {
  BatchLog log(file, {{"study", 1}});
  std::vector<std::vector<double>> results;
  std::size_t made = 0;
  for (const std::size_t size : sizes)
    results.push_back(log.next(size, [&] {
      ++made;
      std::vector<double> batch;
      for (std::size_t i = 0; i < size; ++i)
        batch.push_back(static_cast<double>(100 * results.size() + i));
      return batch;
    }));
  return {results, made};
}

} // namespace

TEST_CASE("a log answers again what it has answered, also after batches of another size",
          "[checkpoint]") {
  const Folder folder;
  std::mt19937_64 random(4);
  for (int trial = 0; trial < 50; ++trial) {
    CAPTURE(trial);
    const auto file = folder.path() / ("log" + std::to_string(trial));
    std::vector<std::size_t> sizes(1 + random() % 6);
    for (std::size_t& size : sizes) size = 1 + random() % 5;
    const auto [first, made_first] = ask(file, sizes);
    CHECK(made_first == sizes.size());
    std::vector<std::size_t> other = sizes;
    const std::size_t from = random() % sizes.size();
    for (std::size_t k = from; k < other.size(); ++k) other[k] = 6 + random() % 3;
    const auto [second, made_second] = ask(file, other);
    CHECK(made_second == other.size() - from);
    const auto [third, made_third] = ask(file, other);
    CHECK(made_third == 0);
    CHECK(third == second);
  }
}
