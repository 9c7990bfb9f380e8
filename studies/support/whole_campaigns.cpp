#include "studies/support/whole_campaigns.hpp"

#include "montecarlo/engine/runs/run_plan.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "studies/support/wing_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

namespace wingspread::study {
namespace {

struct Rate {
  const char* campaign;
  long runs; ///< number of timed runs
};
constexpr Rate rates[] = {
    {"seed", 2000}, {"yoke_wing", 400}, {"two_wing_free", 200}, {"prescribed_base", 400}};

Made make_campaign(const Campaign& campaign, InstructionSet set, const What& what, long count) {
  const RunPlan plan(campaign);
  std::vector<double> draws(campaign.dispersions.size());
  const auto set_scene = [&](Scene& scene, long k) {
    plan.draw(k, draws);
    apply(campaign, draws, campaign.scene, scene);
  };
  return make(campaign.scene, set_scene, set, campaign.integration, what.goal, count, 2);
}

/// The first n panels of a chain.
Scene first_panels(Scene scene, int n) {
  scene.bodies.resize(static_cast<std::size_t>(n));
  scene.hinges.resize(static_cast<std::size_t>(n));
  return scene;
}

double mean_end(const std::vector<Outcome>& outcomes) {
  double sum = 0;
  for (const Outcome& out : outcomes) sum += out.t_end;
  return sum / static_cast<double>(outcomes.size());
}

double mean_last_latch(const std::vector<Outcome>& outcomes) {
  double sum = 0;
  for (const Outcome& out : outcomes) sum += out.latches.empty() ? 0 : out.latches.back().time;
  return sum / static_cast<double>(outcomes.size());
}

} // namespace

nlohmann::ordered_json campaign_rates(const StudyOptions& options) {
  fmt::print("\nwhole campaigns, as they stand: µs a run of one core\n  "
             "{:<18}{:<24}{:>12}{:>12}{:>12}{:>8}{:>10}\n",
             "", "", "evaluations", "alone", "in packs", "ratio", "runs/s");
  Table table({"campaign", "what", "evaluations", "scalar us", "packs us"});
  nlohmann::ordered_json rows;
  for (const auto& [name, runs] : rates) {
    Campaign campaign = read_campaign_file(fmt::format("studies/campaigns/{}.json", name));
    campaign.cases.clear(); // of a campaign with cases only the nominal wing
    for (const What& what : {every_output, first_latch}) {
      const long count = std::max(16L, options.quick ? runs / 20 : runs);
      const Made alone = make_campaign(campaign, InstructionSet::scalar, what, count);
      const Made packed = make_campaign(campaign, instruction_sets().back(), what, count);
      table.add(
          {std::string(name), std::string(what.name), packed.evaluations, alone.us, packed.us});
      rows.push_back({{"campaign", name},
                      {"what", what.name},
                      {"evaluations", packed.evaluations},
                      {"scalar_us", alone.us},
                      {"packs_us", packed.us},
                      {"ratio", alone.us / packed.us}});
      fmt::print("  {:<18}{:<24}{:>12.0f}{:>12.1f}{:>12.1f}{:>8.2f}{:>10.0f}\n", name, what.name,
                 packed.evaluations, alone.us, packed.us, alone.us / packed.us, 1e6 / packed.us);
      std::fflush(stdout);
    }
  }
  table.write(options.folder / "campaigns.csv");
  return rows;
}

nlohmann::ordered_json panel_rates(const StudyOptions& options) {
  fmt::print("\nwhole runs against panels: the first n of the long chain, all outputs\n  "
             "{:<6}{:>14}{:>12}{:>14}{:>12}{:>22}{:>10}\n",
             "n", "evaluations", "µs a run", "last latch, s", "end, s", "evaluations a second",
             "runs/s");
  Table table({"panels", "evaluations", "us", "last latch [s]", "end [s]"});
  nlohmann::ordered_json rows;
  const Scene chain = read_campaign_file("studies/campaigns/long_chain.json").scene;
  for (const int n : {1, 2, 3, 4, 6, 10, 15, 20}) {
    if (options.quick && n > 6) break;
    const Units units(first_panels(chain, n));
    const long count = options.quick ? 8 : n < 10 ? 64 : 16;
    const Made made = make(units, instruction_sets().back(), within(1e-8, every_output),
                           every_output.goal, count, 1);
    const double end = mean_end(made.outcomes), last = mean_last_latch(made.outcomes);
    table.add({double(n), made.evaluations, made.us, last, end});
    rows.push_back({{"panels", n},
                    {"evaluations", made.evaluations},
                    {"us", made.us},
                    {"last_latch", last},
                    {"end", end}});
    fmt::print("  {:<6}{:>14.0f}{:>12.0f}{:>14.2f}{:>12.2f}{:>22.0f}{:>10.0f}\n", n,
               made.evaluations, made.us, last, end, made.evaluations / end, 1e6 / made.us);
    std::fflush(stdout);
  }
  table.write(options.folder / "panels.csv");
  return rows;
}

} // namespace wingspread::study
