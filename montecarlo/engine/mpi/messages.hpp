/// What the ranks of a job tell each other.
///
///   rank 0 → another                                    another → rank 0
///   open    a plan, by its description
///   chunk   runs to make, with their points where       report  chunks that it has finished, and how
///           the plan has points of its own                      many more it wants
///   stop    begin no further run
///   close   no more chunks of this plan will come       closed  all that was begun has been reported
///   leave   the job is done
#pragma once

#include "montecarlo/engine/mpi/serializer.hpp"
#include "montecarlo/engine/runs/chunk_scheduler.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

enum class MessageKind : unsigned char { open, chunk, stop, close, leave, report, closed };

/// What a message is; taken out of it first.
[[nodiscard]] inline MessageKind kind_of(Deserializer& message) {
  return message.take<MessageKind>();
}

/// A message of no more than its kind.
[[nodiscard]] std::string word(MessageKind kind);

/// How a plan's runs are to be made, and of what a rank makes the plan again.
struct PlanDescription {
  std::string campaign;    ///< as JSON, resolved: what runs depend on
  std::string recipe;      ///< of its measure; empty: the campaign's outputs
  bool own_points = false; ///< come with every chunk
  bool wants_csv = false;
  int threads = 0; ///< 0: as many as a rank has
  InstructionSet set = InstructionSet::scalar;
  bool operator==(const PlanDescription&) const = default;
};
[[nodiscard]] std::string open_message(const PlanDescription& description);
[[nodiscard]] PlanDescription take_description(Deserializer& message);

/// @param plan whose points go with it, if it has its own
[[nodiscard]] std::string chunk_message(const Chunk& chunk, const RunPlan& plan);
[[nodiscard]] Chunk take_chunk(Deserializer& message);
/// The points that come behind a chunk, run by run. @param dispersions of each
[[nodiscard]] std::vector<Tails> take_points(Deserializer& message, long runs,
                                             std::size_t dispersions);

struct FinishedChunk {
  Chunk chunk;
  Batch batch;
  bool complete = true;
};

struct Report {
  long wanted = 0; ///< chunks that it wants now, besides those that it has
  std::vector<FinishedChunk> finished{};
  bool stopped = false; ///< it was told so by a signal of its own
};
[[nodiscard]] std::string report_message(const Report& report);
[[nodiscard]] Report take_report(Deserializer& message);

/// How it went with a plan.
struct Closing {
  Occupancy occupancy{};
  std::string failure{}; ///< what broke it off; empty: nothing
};
[[nodiscard]] std::string closed_message(const Closing& closing);
[[nodiscard]] Closing take_closing(Deserializer& message);

} // namespace wingspread
