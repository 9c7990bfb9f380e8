#include "montecarlo/results/results_folder/row_check.hpp"

#include "montecarlo/foundation/formats/output_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace wingspread {
namespace {

constexpr std::string_view latch_order_column = "latch_order";

/// The parts of "root>mid>tip".
std::vector<std::string> split_order(std::string_view order) {
  std::vector<std::string> names;
  while (!order.empty()) {
    const std::size_t end = std::min(order.find('>'), order.size());
    names.emplace_back(order.substr(0, end));
    order.remove_prefix(std::min(end + 1, order.size()));
  }
  return names;
}

} // namespace

RowCheck::RowCheck(const ResultNames& names, const RowRules& rules) : rules_(rules) {
  for (std::size_t i = 0; i < names.outputs.size(); ++i) {
    const OutputName name = parse_output_name(names.outputs[i]);
    if (name.kind && !name.kind->has_sign)
      not_negative_.push_back({names.outputs[i], i, std::string_view(name.unit) == "s"});
    if (name.quantity == "latch_time") latches_.push_back({name.hinge, i});
    if (name.quantity == "deployment_time") deployment_time_ = i;
  }
}

std::optional<RowFault> RowCheck::fault_in(const ResultRow& row) const {
  if (auto fault = fault_of_size(row)) return fault;
  if (auto fault = fault_of_status(row)) return fault;
  if (auto fault = fault_of_latches(row)) return fault;
  return fault_of_order(row);
}

std::optional<RowFault> RowCheck::fault_of_size(const ResultRow& row) const {
  for (const auto& [name, column, is_time] : not_negative_) {
    const double value = row.outputs[column];
    if (value < 0)
      return RowFault{name, fmt::format("{}", value),
                      is_time ? "a time ≥ 0" : "≥ 0: this output has no sign"};
    if (is_time && value > rules_.t_end * (1 + 1e-9)) // of a tool that rounds
      return RowFault{name, fmt::format("{} s", value),
                      fmt::format("at most t_end, {} s: a run ends there", rules_.t_end)};
  }
  return std::nullopt;
}

std::optional<RowFault> RowCheck::fault_of_status(const ResultRow& row) const {
  const bool deployed = row.status == Status::deployed;
  for (const auto& [hinge, column] : latches_)
    if (deployed && std::isnan(row.outputs[column]))
      return RowFault{hinge + ".latch_time", "nothing in a deployed run",
                      "a time: every latch of a deployed run is engaged"};
  if (deployed && deployment_time_)
    for (const auto& [hinge, column] : latches_)
      if (row.outputs[column] > row.outputs[*deployment_time_])
        return RowFault{
            "deployment_time",
            fmt::format("{} s, before {} latched", row.outputs[*deployment_time_], hinge),
            "the largest latch time"};
  if (!deployment_time_ || std::isnan(row.outputs[*deployment_time_]) != deployed)
    return std::nullopt;
  if (deployed)
    return RowFault{"deployment_time", "nothing in a deployed run", "when the last hinge latched"};
  return RowFault{"deployment_time",
                  fmt::format("{} s in a run that is {}", row.outputs[*deployment_time_],
                              to_string(row.status)),
                  "nothing: only a deployed run has a deployment time"};
}

std::optional<RowFault> RowCheck::fault_of_latches(const ResultRow& row) const {
  const bool ended_open = row.status == Status::stalled || row.status == Status::timed_out;
  if (!ended_open || rules_.holds || latches_.empty() ||
      std::ranges::any_of(latches_,
                          [&](const Latch& each) { return std::isnan(row.outputs[each.column]); }))
    return std::nullopt;
  return RowFault{"status",
                  fmt::format("{} with the latch times of all hinges", to_string(row.status)),
                  "deployed, or a hinge without a latch time: nothing but its latches holds it"};
}

std::optional<RowFault> RowCheck::fault_of_order(const ResultRow& row) const {
  const auto fault = [&](const std::string& what, const char* expected) {
    return RowFault{std::string(latch_order_column), fmt::format("'{}', {}", row.latch_order, what),
                    expected};
  };
  if (latches_.empty()) return std::nullopt;
  std::vector<std::string> seen;
  double last = 0;
  for (const std::string& name : split_order(row.latch_order)) {
    const auto latch = std::ranges::find(latches_, name, &Latch::hinge);
    if (latch == latches_.end())
      return fault(fmt::format("in which no hinge with a latch is named '{}'", name),
                   "names of hinges with latches, with '>' in between");
    if (std::ranges::find(seen, name) != seen.end())
      return fault(fmt::format("with '{}' more than once", name), "each hinge once");
    const double time = row.outputs[latch->column];
    if (std::isnan(time))
      return fault(fmt::format("but {}.latch_time is empty", name), "hinges that latched");
    if (time < last)
      return fault(fmt::format("but {} latched earlier, at {} s", name, time),
                   "hinges in the order of their latch times");
    seen.push_back(name);
    last = time;
  }
  for (const auto& [hinge, column] : latches_)
    if (!seen.empty() && !std::isnan(row.outputs[column]) &&
        std::ranges::find(seen, hinge) == seen.end())
      return fault(fmt::format("without {}, which latched at {} s", hinge, row.outputs[column]),
                   "every hinge with a latch time");
  return std::nullopt;
}

} // namespace wingspread
