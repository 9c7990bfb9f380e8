#include "montecarlo/model/campaign/guarantees.hpp"

#include "montecarlo/model/campaign/campaign_settings.hpp"

#include <fmt/format.h>

#include <utility>

namespace wingspread {
namespace {

std::vector<std::string> output_names(const Scene& scene, const Outputs& outputs) {
  std::vector<std::string> names;
  for (OutputColumn& column : output_columns(scene, outputs))
    names.push_back(std::move(column.name));
  return names;
}

} // namespace

void refuse_dependent_draws(const JsonCursor& at, const char* what, DesignKind design) {
  if (design == DesignKind::random) return;
  at.refuse(fmt::format("{} with the design \"{}\"", what,
                        design_names[static_cast<std::size_t>(design)]),
            "the design \"random\": these statistics hold for independent draws only");
}

GuaranteeReader::GuaranteeReader(const Scene* scene, const Outputs& outputs, DesignKind design,
                                 std::optional<double> t_end)
    : scene_(scene), design_(design), t_end_(t_end) {
  if (!scene_) return;
  names_ = output_names(*scene, outputs);
  all_names_ = output_names(*scene, all_outputs());
}

void GuaranteeReader::read(const JsonCursor& at, std::vector<Requirement>& requirements,
                           Judged judged) const {
  read_requirements(at, scene_ ? &names_ : nullptr, all_names_, requirements, scene_, judged);
  if (t_end_) refuse_late_limits(at, requirements, *t_end_);
  if (!requirements.empty()) refuse_dependent_draws(at, "requirements", design_);
}

void GuaranteeReader::read(const JsonCursor& at, const std::vector<Requirement>* requirements,
                           StoppingRule& until) const {
  std::vector<std::string> names;
  if (requirements)
    for (const Requirement& requirement : *requirements) names.push_back(name_of(requirement));
  read_stopping_rule(at, scene_ ? &names_ : nullptr, requirements ? &names : nullptr, until);
  if (!until.empty()) refuse_dependent_draws(at, "goals to stop at", design_);
}

GuaranteeReader guarantee_reader(const Campaign& campaign) {
  return {&campaign.scene, campaign.outputs, campaign.sampling.design, campaign.integration.t_end};
}

std::vector<std::string> keys_of_requirements(const Json& document) {
  constexpr const char* list = "requirements";
  if (!document.is_object()) return {};
  const bool analyzed = document.contains(analyzed_key);
  const Json& holder = analyzed ? document[analyzed_key] : document;
  if (!holder.is_object() || !holder.contains(list)) return {};
  return analyzed ? std::vector<std::string>{analyzed_key, list} : std::vector<std::string>{list};
}

std::vector<Requirement> read_requirements_file(const std::filesystem::path& path,
                                                const Campaign& campaign) {
  const Json document = parse_json_file(path);
  std::vector<Problem> problems;
  std::vector<Requirement> requirements;
  JsonCursor list(document, path.string(), problems);
  for (const std::string& key : keys_of_requirements(document)) list = list.member(key);
  guarantee_reader(campaign).read(list, requirements, Judged::may_be);
  if (!problems.empty()) throw SpecError(std::move(problems));
  return requirements;
}

} // namespace wingspread
