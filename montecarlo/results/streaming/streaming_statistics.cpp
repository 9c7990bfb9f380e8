#include "montecarlo/results/streaming/streaming_statistics.hpp"

#include "montecarlo/results/summary/judge_campaign.hpp"
#include "montecarlo/results/summary/overtravel.hpp"
#include "montecarlo/results/summary/summary_json.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <utility>

namespace wingspread {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The values of a required output in the pilot.
std::vector<double> pilot_values(const Results& pilot, std::span<const Column> margins,
                                 const RequiredOutput& required) {
  const Column& column = required.column < pilot.outputs.size()
                             ? pilot.outputs[required.column]
                             : margins[required.column - pilot.outputs.size()];
  std::vector<double> values(column.values.begin(), column.values.end());
  if (required.absolute)
    for (double& value : values) value = std::abs(value);
  return values;
}

/// The grid for the angles at which a hinge stopped in stalled runs. If it stopped in none of the pilot's runs: for its
/// final angles in all of them.
Grid grid_of_stopped(const FinalAngleColumns& columns, const Results& pilot) {
  std::vector<double> all, stopped;
  for (std::size_t row = 0; row < pilot.size(); ++row) {
    const auto value = [&](std::size_t column) { return pilot.outputs[column].values[row]; };
    all.push_back(value(columns.angle));
    if (columns.stopped(pilot.status[row], value)) stopped.push_back(all.back());
  }
  return grid_of(stopped.empty() ? all : stopped);
}

std::vector<std::string> names_of(std::span<const Column> columns) {
  std::vector<std::string> names;
  for (const Column& column : columns) names.push_back(column.name);
  return names;
}

} // namespace

bool is_of(const RequiredOutput& required, const Requirement& requirement) {
  return required.output == requirement.output && required.absolute == requirement.absolute &&
         required.from_below == takes_cut_peaks(requirement.output, requirement.min.has_value());
}

bool takes_cut_peaks(const std::string& output, bool lower) {
  return lower && peak_kind(output) != PeakKind::none;
}

std::vector<RequiredOutput> required_outputs(const Campaign& campaign, const ResultNames& names,
                                             const std::vector<std::string>& margins) {
  std::vector<std::string> all = names.outputs;
  all.insert(all.end(), margins.begin(), margins.end());
  std::vector<RequiredOutput> found;
  const auto want = [&](const std::string& output, bool absolute, bool lower) {
    const auto column = static_cast<std::size_t>(std::ranges::find(all, output) - all.begin());
    const RequiredOutput required{output, absolute, column, takes_cut_peaks(output, lower)};
    if (column < all.size() && std::ranges::find(found, required) == found.end())
      found.push_back(required);
  };
  for (const Requirement& requirement : campaign.requirements)
    want(requirement.output, requirement.absolute, requirement.min.has_value());
  for (const ToleranceLimitSpec& limit : campaign.statistics.tolerance_limits)
    for (const std::string& output : names.outputs) want(output, false, limit.side == Side::lower);
  return found;
}

StreamingStatistics::StreamingStatistics(const Campaign& campaign, const ResultNames& names)
    : campaign_(&campaign) {
  // Only the names of the static margins' columns are needed here.
  const std::vector<Column> margins = static_margin_columns(campaign, Results(names));
  required_ = required_outputs(campaign, names, names_of(margins));
  for (const std::string& output : names.outputs)
    is_overtravel_.push_back(output.ends_with(".overtravel"));
  for (const RequiredOutput& required : required_)
    peak_.push_back(required.column < names.outputs.size() ? peak_kind(required.output)
                                                           : PeakKind::none);
  for (const Requirement& requirement : campaign.requirements) {
    const auto found = std::ranges::find_if(
        required_, [&](const RequiredOutput& each) { return is_of(each, requirement); });
    if (found == required_.end() && requirement.output != deployed_output)
      throw std::logic_error("a requirement on an output without a column: " + requirement.output);
    population_of_.push_back(static_cast<std::size_t>(found - required_.begin()));
    requirement_counts_.push_back({0, 0, 0, 0, Extremes(Extremes::End::highest, most_broken)});
  }
  if (names.draws.size() * (names.outputs.size() + 1) <= most_streaming_pairs)
    correlations_.emplace(names.draws.size(), names.outputs.size() + 1);
  draw_z_.resize(names.draws.size());
  output_z_.resize(names.outputs.size() + 1);
  seen_.resize(required_.size());
}

StreamingStatistics::StreamingStatistics(const Campaign& campaign, const ResultNames& names,
                                         const Results& pilot)
    : StreamingStatistics(campaign, names) {
  const std::vector<Column> margins = static_margin_columns(campaign, pilot);
  for (const Column& column : pilot.outputs) {
    const std::vector<double> values(column.values.begin(), column.values.end());
    outputs_.push_back({Population(grid_of(values)), scale_of(values), {}});
  }
  for (const FinalAngleColumns& columns : final_angle_columns(names.outputs))
    stopped_.push_back({columns, Population(grid_of_stopped(columns, pilot))});
  for (const RequiredOutput& required : required_)
    populations_.push_back({Population(grid_of(pilot_values(pilot, margins, required)))});
  for (const Column& column : pilot.draws)
    draw_scales_.push_back(
        scale_of(std::vector<double>(column.values.begin(), column.values.end())));
}

bool StreamingStatistics::add(const ResultRow& row, std::span<const double> margins) {
  ++runs_;
  ++status_[static_cast<std::size_t>(row.status)];
  ++peaks_[static_cast<std::size_t>(row.peaks_final.value_or(PeaksFinal::unknown))];
  add_outputs(row);
  add_texts(row);
  if (correlations_) add_correlations(row);
  return add_requirements(row, margins) || row.status != Status::deployed;
}

void StreamingStatistics::add_outputs(const ResultRow& row) {
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    const double value = row.outputs[i];
    if (std::isnan(value)) continue;
    Output& output = outputs_[i];
    output.values.add(value, row.run);
    output.sums.add(output.scale.of(value));
    if (is_overtravel_[i] && value > most_overtravel) ++output.beyond_stowed;
  }
  const auto value = [&](std::size_t column) { return row.outputs[column]; };
  for (StoppedPopulation& hinge : stopped_)
    if (hinge.columns.stopped(row.status, value))
      hinge.angles.add(value(hinge.columns.angle), row.run);
}

bool StreamingStatistics::add_requirements(const ResultRow& row, std::span<const double> margins) {
  const auto is_cut = [&](std::size_t q) {
    return wingspread::is_cut(peak_[q], row.peaks_final.value_or(PeaksFinal::unknown));
  };
  const auto value_of = [&](const RequiredOutput& required) {
    return required.column < row.outputs.size() ? row.outputs[required.column]
                                                : margins[required.column - row.outputs.size()];
  };
  for (std::size_t q = 0; q < required_.size(); ++q) {
    const RequiredOutput& required = required_[q];
    const double value = value_of(required);
    const bool counts =
        row.status == Status::deployed && !std::isnan(value) && (required.from_below || !is_cut(q));
    seen_[q] = !counts ? infinity : required.absolute ? std::abs(value) : value;
    if (counts)
      populations_[q].values.add(seen_[q], row.run);
    else
      ++populations_[q].worse;
  }
  bool breaks = false;
  for (std::size_t r = 0; r < requirement_counts_.size(); ++r) {
    const Requirement& requirement = campaign_->requirements[r];
    const std::size_t q = population_of_[r];
    const double value = q < required_.size()             ? seen_[q]
                         : row.status == Status::deployed ? 0
                                                          : infinity;
    const double badness = value == infinity ? infinity : sign_of(requirement) * value;
    if (!(badness > limit_of(requirement))) continue;
    breaks = true;
    ++requirement_counts_[r].failures;
    requirement_counts_[r].worst.add(badness, row.run);
    if (q >= required_.size()) continue;
    const bool cut = row.status == Status::deployed && is_cut(q);
    if (!cut && badness != infinity) continue;
    ++(cut ? requirement_counts_[r].cut : requirement_counts_[r].absent);
    if (cut && may_meet(requirement, value_of(required_[q]))) ++requirement_counts_[r].open;
  }
  return breaks;
}

void StreamingStatistics::add_texts(const ResultRow& row) {
  if (const auto known = orders_.find(row.latch_order); known != orders_.end())
    ++known->second;
  else if (orders_.size() < most_order_kinds)
    orders_.emplace(row.latch_order, 1);
  else
    ++other_orders_;
  reasons_.add(row.status, row.reason);
}

void StreamingStatistics::add_correlations(const ResultRow& row) {
  for (std::size_t i = 0; i < draw_z_.size(); ++i) draw_z_[i] = draw_scales_[i].of(row.draws[i]);
  for (std::size_t i = 0; i < outputs_.size(); ++i)
    output_z_[i] = outputs_[i].scale.of(row.outputs[i]);
  output_z_.back() = row.status == Status::deployed ? 1 : 0;
  correlations_->add(draw_z_, output_z_);
}

void StreamingStatistics::add(const StreamingStatistics& other) {
  const auto is_new = [&](const auto& entry) { return !orders_.contains(entry.first); };
  const auto kinds =
      orders_.size() + static_cast<std::size_t>(std::ranges::count_if(other.orders_, is_new));
  if (other_orders_ + other.other_orders_ > 0 || kinds > most_order_kinds)
    throw SpecError({{"", "", "more than " + std::to_string(most_order_kinds) + " latch orders",
                      "fewer: orders beyond this number share one count, which cannot be merged"}});
  runs_ += other.runs_;
  for (std::size_t i = 0; i < status_.size(); ++i) status_[i] += other.status_[i];
  for (std::size_t i = 0; i < peaks_.size(); ++i) peaks_[i] += other.peaks_[i];
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    outputs_[i].values.add(other.outputs_[i].values);
    outputs_[i].sums.add(other.outputs_[i].sums);
    outputs_[i].beyond_stowed += other.outputs_[i].beyond_stowed;
  }
  for (std::size_t i = 0; i < stopped_.size(); ++i)
    stopped_[i].angles.add(other.stopped_[i].angles);
  for (std::size_t q = 0; q < populations_.size(); ++q) {
    populations_[q].values.add(other.populations_[q].values);
    populations_[q].worse += other.populations_[q].worse;
  }
  for (std::size_t r = 0; r < requirement_counts_.size(); ++r) {
    requirement_counts_[r].failures += other.requirement_counts_[r].failures;
    requirement_counts_[r].cut += other.requirement_counts_[r].cut;
    requirement_counts_[r].open += other.requirement_counts_[r].open;
    requirement_counts_[r].absent += other.requirement_counts_[r].absent;
    requirement_counts_[r].worst.add(other.requirement_counts_[r].worst);
  }
  if (correlations_) correlations_->add(*other.correlations_);
  for (const auto& [order, count] : other.orders_) orders_[order] += count;
  reasons_.add(other.reasons_);
}

} // namespace wingspread
