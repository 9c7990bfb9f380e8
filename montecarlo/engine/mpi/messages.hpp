/// The messages between the ranks of a job.
///
///   rank 0 → another                                    another → rank 0
///   open    description of a plan
///   chunk   runs to make, with their points if the      report  finished chunks, and how many more are wanted
///           plan has points of its own
///   stop    begin no further run
///   close   no more chunks of this plan will come       closed  everything begun has been reported
///   leave   the job is done
#pragma once

#include "montecarlo/engine/mpi/serializer.hpp"
#include "montecarlo/engine/runs/chunk_scheduler.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

enum class MessageKind : unsigned char { open, chunk, stop, close, leave, report, closed };

/// Reads the kind of a message, which is its first value.
[[nodiscard]] inline MessageKind kind_of(Deserializer& message) {
  return message.take<MessageKind>();
}

/// A message that consists of its kind only.
[[nodiscard]] std::string bare_message(MessageKind kind);

/// Everything another rank needs to rebuild a plan and make its runs.
struct PlanDescription {
  std::string campaign; ///< resolved JSON, without the parts that no run depends on
  std::string recipe;   ///< of the plan's measure; empty: the campaign's outputs, or samples
  std::optional<SampledColumns> samples; ///< instead of outputs
  bool own_points = false;               ///< points come with every chunk
  bool wants_csv = false;
  int threads = 0; ///< 0: as many as the rank has
  InstructionSet set = InstructionSet::scalar;
  bool operator==(const PlanDescription&) const = default;
};
[[nodiscard]] std::string open_message(const PlanDescription& description);
[[nodiscard]] PlanDescription read_description(Deserializer& message);

/// @param plan if the plan has its own points, those of the chunk are added
[[nodiscard]] std::string chunk_message(const Chunk& chunk, const RunPlan& plan);
[[nodiscard]] Chunk read_chunk(Deserializer& message);
/// The points after a chunk, run by run. @param coordinates of the plan
[[nodiscard]] std::vector<Tails> read_points(Deserializer& message, long runs,
                                             std::size_t coordinates);

struct FinishedChunk {
  Chunk chunk;
  Batch batch;
  bool complete = true;
};

struct Report {
  long wanted = 0; ///< chunks wanted now, besides those the rank has
  std::vector<FinishedChunk> finished{};
  bool stopped = false; ///< the rank received a signal
};
[[nodiscard]] std::string report_message(const Report& report);
[[nodiscard]] Report read_report(Deserializer& message);

/// The end of a plan on a rank.
struct Closing {
  Occupancy occupancy{};
  std::string failure{}; ///< error that ended the rank's work; empty: none
};
[[nodiscard]] std::string closed_message(const Closing& closing);
[[nodiscard]] Closing read_closing(Deserializer& message);

} // namespace wingspread
