#include "montecarlo/model/input_checks/draw_check.hpp"

#include "montecarlo/model/campaign/campaign_json.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <numeric>
#include <utility>
#include <variant>
#include <vector>

namespace wingspread {
namespace {

/// Heuristic: one draw in a thousand is then missed once in seven campaigns, and a case costs some ten milliseconds.
constexpr long most_draws = 2000;

/// The unphysical draws of one law.
struct Found {
  Fault first;                     ///< of the first such draw
  std::vector<std::string> shares; ///< "12 of 2000 draws in case cold"
};

std::size_t common_length(const std::string& a, const std::string& b) {
  return static_cast<std::size_t>(std::ranges::mismatch(a, b).in1 - a.begin());
}

/// The last dispersion that changes the faulty parameter; if none does, one of the same object, to whose value the
/// parameter must fit ("friction.static" to "friction.coulomb").
const Dispersion* cause_of(const Fault& fault, const Campaign& campaign) {
  const std::size_t owner = fault.path.find('.') + 1;
  std::size_t longest = owner;
  const Dispersion* cause = nullptr;
  for (const Dispersion& dispersion : campaign.dispersions)
    for_each_effect(dispersion, [&](Apply, const auto& targets, const Curve*) {
      for (const std::string& path : paths_of(campaign.scene, targets))
        if (const std::size_t length = common_length(path, fault.path); length >= longest)
          longest = length, cause = &dispersion;
    });
  return cause;
}

/// The place of the law that drew it: a case's own, or the dispersion's.
std::string place_of_law(const Campaign& whole, const std::string& of_case,
                         const Dispersion& dispersion) {
  const auto own = std::ranges::find(whole.cases, of_case, &CaseSpec::name);
  if (own != whole.cases.end())
    for (const CaseDistribution& law : own->distributions)
      if (is_drawn_by(whole, law.dispersion, dispersion))
        return fmt::format("/cases/{}/distributions{}", own - whole.cases.begin(),
                           pointer_token(law.dispersion));
  return place_of(whole, dispersion);
}

/// Unphysical parameters in the draws of one case, by the law's place: for each law the fault that most draws have.
class CaseFaults {
public:
  CaseFaults(const Campaign& whole, const Campaign& of_case) : whole_(whole), case_(of_case) {}

  void draw(const DrawScenes& draw) {
    const long runs = std::min<long>(case_.sampling.runs, most_draws);
    std::map<std::string, std::pair<long, Fault>> found; // by the fault's parameter
    draw(case_, runs, [&](const Scene& scene) {
      for (const Fault& fault : unphysical(scene))
        ++found.try_emplace(fault.path, 0, fault).first->second.first;
    });
    std::map<std::string, long> most; // by the law's place
    for (const auto& [path, counted] : found) {
      const Dispersion* cause = cause_of(counted.second, case_);
      const std::string place =
          cause ? place_of_law(whole_, case_.of_case, *cause) : "/dispersions";
      if (counted.first > most[place])
        most[place] = counted.first,
        faults[place] = {counted.second,
                         {fmt::format("{} of {} draws{}", counted.first, runs, in_case())}};
      paths.insert(path);
    }
  }

  /// Tries each value of the discrete laws, the others at their medians: hardly a draw may have it.
  void try_values() {
    std::vector<double> draws;
    for (const Dispersion& dispersion : case_.dispersions)
      draws.push_back(PreparedDistribution(dispersion.distribution).quantile(0.5));
    for (std::size_t i = 0; i < draws.size(); ++i) {
      const auto* law = std::get_if<Discrete>(&case_.dispersions[i].distribution.law);
      const double median = draws[i];
      for (std::size_t k = 0; law && k < law->values.size(); ++k)
        if (law->weights[k] > 0) try_value(*law, k, i, draws);
      draws[i] = median;
    }
  }

  std::map<std::string, Found> faults;
  std::set<std::string> paths;

private:
  void try_value(const Discrete& law, std::size_t k, std::size_t i, std::vector<double>& draws) {
    const Dispersion& dispersion = case_.dispersions[i];
    const std::string place = place_of_law(whole_, case_.of_case, dispersion);
    if (faults.contains(place)) return;
    draws[i] = law.values[k];
    const std::vector<Fault> found = unphysical(scene_with(case_, draws));
    if (found.empty()) return;
    const double all = std::accumulate(law.weights.begin(), law.weights.end(), 0.0);
    faults[place] = {found.front(),
                     {fmt::format("those of {} = {:.4g}, a share of {:.3g}{}", dispersion.name,
                                  draws[i], law.weights[k] / all, in_case())}};
    paths.insert(found.front().path);
  }

  [[nodiscard]] std::string in_case() const {
    return case_.of_case.empty() ? "" : " in case " + case_.of_case;
  }

  const Campaign& whole_;
  const Campaign& case_;
};

} // namespace

std::string place_of(const Campaign& campaign, const Dispersion& dispersion) {
  const std::string place = fmt::format("/dispersions/{}", entry_of(campaign, dispersion));
  return dispersion.rows.empty() ? place : place + "/rows/columns" + pointer_token(dispersion.name);
}

std::set<std::string> check_draws(const Campaign& campaign, const DrawScenes& draw,
                                  InputWarnings& warnings) {
  std::set<std::string> paths;
  std::map<std::string, Found> all; // by the place of the law
  for (const Campaign& of_case : campaigns_of(campaign)) {
    CaseFaults found(campaign, of_case);
    found.draw(draw);
    found.try_values();
    paths.merge(found.paths);
    for (auto& [place, fault] : found.faults) {
      const auto [own, is_first] = all.try_emplace(place, fault);
      if (!is_first) own->second.shares.push_back(fault.shares.front());
    }
  }
  for (const auto& [place, found] : all)
    warnings.add(place,
                 fmt::format("unphysical draws, {}: {} is {:.4g} in the first, expected {}",
                             fmt::join(found.shares, ", "), found.first.path,
                             std::strtod(found.first.found.c_str(), nullptr), found.first.expected),
                 "draws that a wing can have: these runs are invalid and break every requirement "
                 "(another law or table, or \"truncate\")");
  return paths;
}

} // namespace wingspread
