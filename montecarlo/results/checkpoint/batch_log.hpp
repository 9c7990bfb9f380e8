/// The checkpoint of a sampler (`fit`): the results of each batch of its evaluations, in order. The sampler is
/// deterministic, so with the recorded results it continues where it was interrupted.
///
///   record 1   JSON: which study the file belongs to
///   f64…       the results of a batch
#pragma once

#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/results/checkpoint/record_file.hpp"

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

namespace wingspread {

class BatchLog {
public:
  /// Opens the file if it exists, else creates it.
  /// @throws SpecError if the file belongs to another study, with each value that differs
  BatchLog(std::filesystem::path file, const Json& about);

  /// The results of the next batch: recorded ones, or those of `make`, which are then recorded.
  [[nodiscard]] std::vector<double> next(std::size_t size,
                                         const std::function<std::vector<double>()>& make);
  void sync();

private:
  using Clock = std::chrono::steady_clock;

  std::filesystem::path file_;
  std::optional<RecordReader> in_; ///< while recorded batches are left
  std::optional<RecordWriter> out_;
  Clock::time_point synced_ = Clock::now();
};

} // namespace wingspread
