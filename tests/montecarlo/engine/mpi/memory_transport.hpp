/// A transport between the threads of a test; each thread stands for a rank.
#pragma once

#include "montecarlo/analyses/rare/limit_state.hpp"
#include "montecarlo/engine/mpi/rank_evaluator.hpp"
#include "montecarlo/engine/mpi/serve.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <deque>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace wingspread::test {

/// Sent messages that no rank has received yet, by rank.
struct Mailboxes {
  explicit Mailboxes(int ranks) : waiting(static_cast<std::size_t>(ranks)) {}
  std::mutex mutex;
  std::vector<std::deque<Message>> waiting;
};

class MemoryTransport final : public Transport {
public:
  MemoryTransport(std::shared_ptr<Mailboxes> boxes, int rank)
      : boxes_(std::move(boxes)), rank_(rank) {}
  [[nodiscard]] int rank() const override { return rank_; }
  [[nodiscard]] int size() const override { return static_cast<int>(boxes_->waiting.size()); }
  void send(int to, std::string bytes) override {
    const std::lock_guard lock(boxes_->mutex);
    boxes_->waiting[static_cast<std::size_t>(to)].push_back({rank_, std::move(bytes)});
  }
  [[nodiscard]] std::optional<Message> receive() override {
    const std::lock_guard lock(boxes_->mutex);
    auto& mine = boxes_->waiting[static_cast<std::size_t>(rank_)];
    if (mine.empty()) return std::nullopt;
    Message message = std::move(mine.front());
    mine.pop_front();
    return message;
  }

private:
  std::shared_ptr<Mailboxes> boxes_;
  int rank_;
};

/// An MPI job: the test is rank 0, and each other rank is a thread.
class Job {
public:
  /// @param stop_others once true, as if a signal had come to the others
  explicit Job(int ranks, const std::atomic<bool>& stop_others = never)
      : boxes_(std::make_shared<Mailboxes>(ranks)) {
    for (int rank = 1; rank < ranks; ++rank)
      others_.emplace_back([this, rank, &stop_others] {
        MemoryTransport transport(boxes_, rank);
        serve(transport, measure_of_recipe, stop_others);
      });
  }
  ~Job() {
    dismiss(*transport());
    for (std::thread& each : others_) each.join();
  }
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  [[nodiscard]] std::unique_ptr<Transport> transport() {
    return std::make_unique<MemoryTransport>(boxes_, 0);
  }
  [[nodiscard]] RankEvaluator evaluator(int threads, const std::atomic<bool>& stop = never) {
    return {transport(), {.threads = threads}, stop};
  }

private:
  std::shared_ptr<Mailboxes> boxes_;
  std::vector<std::thread> others_;
};

} // namespace wingspread::test
