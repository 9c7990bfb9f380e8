#include "montecarlo/engine/mpi/plan_copy.hpp"

#include "montecarlo/model/campaign/campaign_json.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace wingspread {
namespace {

/// The parts of a campaign that runs depend on, as JSON. The stamp marks the JSON as complete, so that the reader adds
/// no outputs.
std::string text_of(const Campaign& campaign) {
  Json json = campaign.resolved;
  for (const char* key :
       {"cases", "case", "statistics", "requirements", "until", "margin", "motorization"})
    json.erase(key);
  json["outputs"] = write_outputs(campaign.outputs);
  json[stamp_key] = Json::object();
  return json.dump();
}

} // namespace

std::optional<PlanDescription> describe(const RunPlan& plan, const ThreadPool& pool,
                                        bool wants_csv) {
  const std::string recipe = plan.measure() ? plan.measure()->recipe : "";
  if (plan.measure() && recipe.empty()) return std::nullopt;
  return PlanDescription{text_of(plan.campaign()),
                         recipe,
                         plan.samples(),
                         plan.has_own_points(),
                         wants_csv,
                         pool.threads,
                         pool.set};
}

PlanCopy::PlanCopy(PlanDescription description, const MeasureMaker& make_measure)
    : description_(std::move(description)), campaign_(read_campaign(description_.campaign, "")) {
  UnitPoints points;
  if (description_.own_points) points = [this](long run, std::span<Tails> u) { place(run, u); };
  if (description_.samples) {
    plan_.emplace(campaign_, std::move(points), *description_.samples);
  } else if (description_.recipe.empty()) {
    plan_.emplace(campaign_, std::move(points));
  } else {
    plan_.emplace(campaign_, std::move(points), make_measure(campaign_, description_.recipe));
  }
}

ThreadPool PlanCopy::pool() const {
  const std::vector<InstructionSet>& here = instruction_sets();
  const bool has_it = std::ranges::find(here, description_.set) != here.end();
  return {description_.threads, has_it ? description_.set : here.back()};
}

void PlanCopy::expect(const Chunk& chunk, Deserializer& message) {
  if (!description_.own_points) return;
  Points points{chunk.runs,
                read_points(message, chunk.runs.size(), plan_->coordinates().names.size())};
  const std::lock_guard lock(guard_);
  points_.emplace(chunk.runs.first, std::move(points));
}

void PlanCopy::forget(const Chunk& chunk) {
  const std::lock_guard lock(guard_);
  points_.erase(chunk.runs.first);
}

void PlanCopy::place(long run, std::span<Tails> u) const {
  const std::lock_guard lock(guard_);
  const Points& points = std::prev(points_.upper_bound(run))->second;
  const auto first = points.u.begin() + (run - points.runs.first) * std::ssize(u);
  std::copy_n(first, u.size(), u.begin());
}

} // namespace wingspread
