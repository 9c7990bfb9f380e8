/// Streaming statistics: with --no-rows, all that is kept of a campaign's runs. They consist of counts, exact sums, and
/// extreme values with ties decided by run number.
///
/// They depend neither on the order of the runs nor on how runs are split among objects that are added together. The
/// same runs give the same bytes on any number of threads, after interruptions, and from shards.
#pragma once

#include "montecarlo/engine/runs/results.hpp"
#include "montecarlo/model/campaign/campaign.hpp"
#include "montecarlo/results/streaming/population.hpp"
#include "montecarlo/results/streaming/power_sums.hpp"
#include "montecarlo/results/summary/reason_pattern.hpp"
#include "montecarlo/results/summary/summary.hpp"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace wingspread {

/// Most kinds of latch orders counted separately; kinds that appear later are counted together. Heuristic: 100,000
/// texts take some 10 MB. With more kinds, of one shard or of all, merging is refused: the common count cannot be split.
inline constexpr std::size_t most_order_kinds = 100'000;
/// Most pairs of draws and outputs; with more pairs no correlations are computed. A pair takes 5 exact sums of 544
/// bytes: 40,000 pairs are 109 MB.
inline constexpr std::size_t most_streaming_pairs = 40'000;

/// An output used by a requirement or a tolerance limit. Its population covers all runs: runs that rank as worse than
/// any number (verdict.hpp) are counted separately.
struct RequiredOutput {
  std::string output;
  bool absolute = false;
  std::size_t column = 0; ///< index into the outputs, followed by the static margins
  bool from_below =
      false; ///< of a peak that a `min` or a lower limit needs: one that t_end cut has its value
  bool operator==(const RequiredOutput&) const = default;
};

/// Whether a limit on that side takes a peak that t_end cut as its value (verdict.hpp).
[[nodiscard]] bool takes_cut_peaks(const std::string& output, bool lower);

/// Whether it is the output that the requirement judges.
[[nodiscard]] bool is_of(const RequiredOutput& required, const Requirement& requirement);

/// The required outputs of a campaign, each once. @param margins names of the static margins' columns
[[nodiscard]] std::vector<RequiredOutput> required_outputs(const Campaign& campaign,
                                                           const ResultNames& names,
                                                           const std::vector<std::string>& margins);

/// The runs that break a requirement.
struct RequirementCounts {
  long failures = 0, cut = 0; ///< `cut`: deployed runs among them whose peak t_end cut
  long open = 0;              ///< runs among those cut that may meet it (verdict.hpp)
  long absent = 0;            ///< runs among them that did not deploy or lack the output
  Extremes worst;             ///< the worst runs; a value worse than any number is infinite
};

struct RequiredPopulation {
  Population values;
  long worse = 0; ///< runs worse than any number
};

/// Where a hinge stopped in the stalled runs in which it did not latch.
struct StoppedPopulation {
  FinalAngleColumns columns;
  Population angles;
};

using PeaksCounts = std::array<long, all_peaks_final.size()>; ///< runs by PeaksFinal

class StreamingStatistics {
public:
  /// Statistics of no runs. @param pilot the campaign's first runs, which only decide where bins lie
  StreamingStatistics(const Campaign& campaign, const ResultNames& names, const Results& pilot);
  /// Reads statistics written by write(). @throws SpecError if they are damaged or of another campaign
  StreamingStatistics(const Campaign& campaign, const ResultNames& names, StateReader& from);

  /// @param margins the run's required static margins, in the order of static_margin_columns
  /// @return whether the run's row is to be kept: it did not deploy, or breaks a requirement
  bool add(const ResultRow& row, std::span<const double> margins);
  /// @pre of the same campaign and other runs
  /// @throws SpecError if both together have more than most_order_kinds latch orders; then nothing is changed
  void add(const StreamingStatistics& other);
  void write(StateWriter& to) const;

  [[nodiscard]] long runs() const { return runs_; }
  [[nodiscard]] long count_of(Status status) const {
    return status_[static_cast<std::size_t>(status)];
  }

  struct Output {
    Population values;
    Scale scale;
    PowerSums sums;
    long beyond_stowed = 0; ///< of an overtravel: values beyond most_overtravel
  };
  [[nodiscard]] const std::vector<Output>& outputs() const { return outputs_; }
  [[nodiscard]] const std::vector<StoppedPopulation>& stopped() const { return stopped_; }
  [[nodiscard]] const std::vector<RequiredOutput>& required() const { return required_; }
  [[nodiscard]] const std::vector<RequiredPopulation>& required_values() const {
    return populations_;
  }
  [[nodiscard]] const std::vector<RequirementCounts>& requirements() const {
    return requirement_counts_;
  }
  [[nodiscard]] const std::map<std::string, long>& latch_orders() const { return orders_; }
  [[nodiscard]] long other_orders() const { return other_orders_; }
  [[nodiscard]] const PeaksCounts& peaks() const { return peaks_; }
  [[nodiscard]] const ReasonCounts& reasons() const { return reasons_; }
  /// Each draw with each output and, last, with `deployed`; nothing if there are too many pairs.
  [[nodiscard]] const std::optional<CoMoments>& correlations() const { return correlations_; }

private:
  StreamingStatistics(const Campaign& campaign, const ResultNames& names);
  void add_outputs(const ResultRow& row);
  bool add_requirements(const ResultRow& row, std::span<const double> margins);
  void add_texts(const ResultRow& row);
  void add_correlations(const ResultRow& row);

  const Campaign* campaign_;
  long runs_ = 0;
  std::array<long, 5> status_{};
  PeaksCounts peaks_{};
  std::vector<Output> outputs_;
  std::vector<bool> is_overtravel_;
  std::vector<StoppedPopulation> stopped_;
  std::vector<RequiredOutput> required_;
  std::vector<PeakKind> peak_; ///< of each required output
  std::vector<RequiredPopulation> populations_;
  std::vector<RequirementCounts> requirement_counts_;
  /// For each requirement, the index of its population; "deployed" has none, and the index is populations_.size().
  std::vector<std::size_t> population_of_;
  std::vector<Scale> draw_scales_;
  std::optional<CoMoments> correlations_;
  std::map<std::string, long> orders_;
  long other_orders_ = 0;
  ReasonCounts reasons_;
  std::vector<double> draw_z_, output_z_, seen_; ///< work space; seen_: required outputs
};

} // namespace wingspread
