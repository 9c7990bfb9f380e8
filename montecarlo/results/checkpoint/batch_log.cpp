#include "montecarlo/results/checkpoint/batch_log.hpp"

#include "montecarlo/results/checkpoint/checkpoint.hpp"

#include <cstring>

namespace wingspread {
namespace {

constexpr std::chrono::seconds between_syncs{5};

} // namespace

BatchLog::BatchLog(std::filesystem::path file, const Json& about) : file_(std::move(file)) {
  if (!std::filesystem::exists(file_)) {
    out_.emplace(file_, about.dump());
    return;
  }
  refuse_other_study(file_, about_of_log(file_), about);
  in_.emplace(file_);
  (void)in_->next(); // the study
}

std::vector<double> BatchLog::next(std::size_t size,
                                   const std::function<std::vector<double>()>& make) {
  if (in_) {
    const RecordsEnd before = in_->end();
    if (in_->next() && in_->record().size() == size * sizeof(double)) {
      std::vector<double> results(size);
      std::memcpy(results.data(), in_->record().data(), in_->record().size());
      return results;
    }
    in_.reset();
    out_.emplace(file_, before);
  }
  const std::vector<double> results = make();
  out_->add({reinterpret_cast<const char*>(results.data()), // NOLINT: bytes of numbers
             results.size() * sizeof(double)});
  if (Clock::now() - synced_ > between_syncs) sync();
  return results;
}

void BatchLog::sync() {
  if (out_) out_->sync();
  synced_ = Clock::now();
}

} // namespace wingspread
