#include "montecarlo/campaign/margin_spec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <set>
#include <utility>

namespace wingspread {
namespace {

constexpr std::int64_t most_points = 1000;
constexpr std::array<std::string_view, 2> case_names{"nominal", "one_spring_out"};
constexpr const char* expected_range = "an array of two numbers, 0 < lower < upper";

bool is_point_count(const std::int64_t& number) { return number >= 2 && number <= most_points; }
bool is_at_least_2(const std::int64_t& number) { return number >= 2; }

/// A number with the key that it has in a campaign.
template <class Owner> struct Key {
  const char* name;
  double Owner::*member;
};

constexpr std::array ecss_keys{Key<EcssFactors>{"inertia", &EcssFactors::inertia},
                               Key<EcssFactors>{"spring", &EcssFactors::spring},
                               Key<EcssFactors>{"motor", &EcssFactors::motor},
                               Key<EcssFactors>{"friction", &EcssFactors::friction},
                               Key<EcssFactors>{"hysteresis", &EcssFactors::hysteresis},
                               Key<EcssFactors>{"harness", &EcssFactors::harness},
                               Key<EcssFactors>{"adhesion", &EcssFactors::adhesion},
                               Key<EcssFactors>{"motorization", &EcssFactors::motorization},
                               Key<EcssFactors>{"acceleration", &EcssFactors::acceleration},
                               Key<EcssFactors>{"available", &EcssFactors::available}};
// That of the acceleration has no part in a static margin.
constexpr std::array nasa_keys{Key<NasaFactors>{"fixed", &NasaFactors::fixed},
                               Key<NasaFactors>{"variable", &NasaFactors::variable}};
// What the scene itself has, spring, friction and harness, is not given twice.
constexpr std::array torque_keys{
    Key<MotorizationTerms>{"inertia", &MotorizationTerms::inertia},
    Key<MotorizationTerms>{"motor", &MotorizationTerms::motor},
    Key<MotorizationTerms>{"hysteresis", &MotorizationTerms::hysteresis},
    Key<MotorizationTerms>{"adhesion", &MotorizationTerms::adhesion},
    Key<MotorizationTerms>{"acceleration", &MotorizationTerms::acceleration},
    Key<MotorizationTerms>{"delivered", &MotorizationTerms::delivered}};

template <class Owner, std::size_t n>
void read_keys(JsonObject& object, const std::array<Key<Owner>, n>& keys, Owner& owner,
               const char* expected, bool (*holds)(const double&)) {
  for (const auto& [name, member] : keys) object.optional(name, owner.*member, expected, holds);
  object.refuse_others();
}

template <class Owner, std::size_t n>
Json write_keys(const std::array<Key<Owner>, n>& keys, const Owner& owner) {
  Json json = Json::object();
  for (const auto& [name, member] : keys) json[name] = owner.*member;
  return json;
}

void read_range(const JsonCursor& at, MarginSpec& margin) {
  std::vector<double> range;
  if (!at.read(range, expected_range)) return;
  if (range.size() != 2 || !(range[0] > 0 && range[0] < range[1]))
    return void(at.refuse(expected_range));
  margin.lower = range[0];
  margin.upper = range[1];
}

void read_cases(const JsonCursor& at, MarginSpec& margin) {
  if (!at.value().is_array() || at.value().empty())
    return void(at.refuse("an array of " + quoted_list(case_names)));
  std::set<std::size_t> cases;
  for (const JsonCursor& element : at.elements())
    if (const auto index = element.choice(case_names); index && !cases.insert(*index).second)
      element.refuse_repeated("each case once");
  margin.nominal = cases.contains(0);
  margin.one_spring_out = cases.contains(1);
}

void read_ecss(const JsonCursor& at, MotorizationSpec& spec) {
  JsonObject object(at, "an object with factors");
  object.optional_choice("basis", spec.ecss_basis, ecss_basis_names);
  spec.ecss = spec.ecss_basis == EcssBasis::measured ? ecss_measured() : EcssFactors{};
  read_keys(object, ecss_keys, spec.ecss, "a factor: a number, > 0", is_positive);
}

void read_nasa(const JsonCursor& at, MotorizationSpec& spec) {
  JsonObject object(at, "an object with factors");
  object.optional_choice("basis", spec.nasa_basis, nasa_basis_names);
  if (spec.nasa_basis == NasaBasis::development_test) spec.nasa = nasa_development_test();
  if (spec.nasa_basis == NasaBasis::acceptance) spec.nasa = nasa_acceptance();
  read_keys(object, nasa_keys, spec.nasa, "a factor: a number, > 0", is_positive);
}

void read_torques(const JsonCursor& at, const Scene* scene,
                  std::vector<MotorizationTerms>& torques) {
  JsonObject hinges(at, "an object with the torques of hinges by their names");
  if (!scene) return;
  for (std::size_t i = 0; i < scene->hinges.size(); ++i)
    if (const auto hinge = hinges.find(scene->hinges[i].name)) {
      JsonObject object(*hinge, "an object with torques");
      read_keys(object, torque_keys, torques[i], "a number, N·m, ≥ 0", is_not_negative);
    }
  hinges.refuse_others();
}

void read_motorization(const JsonCursor& at, const Scene* scene, MotorizationSpec& spec) {
  JsonObject object(at, "an object with the static margins' factors");
  if (const auto ecss = object.find("ecss")) read_ecss(*ecss, spec);
  if (const auto nasa = object.find("nasa")) read_nasa(*nasa, spec);
  if (const auto torques = object.find("torques")) read_torques(*torques, scene, spec.torques);
  object.optional("points", spec.points, fmt::format("an integer from 2 to {}", most_points),
                  is_point_count);
  object.refuse_others();
}

Json write_motorization(const MotorizationSpec& spec, const Scene& scene) {
  Json ecss{{"basis", ecss_basis_names[static_cast<std::size_t>(spec.ecss_basis)]}};
  ecss.update(write_keys(ecss_keys, spec.ecss));
  Json nasa{{"basis", nasa_basis_names[static_cast<std::size_t>(spec.nasa_basis)]}};
  nasa.update(write_keys(nasa_keys, spec.nasa));
  Json torques = Json::object();
  for (std::size_t i = 0; i < scene.hinges.size(); ++i)
    torques[scene.hinges[i].name] = write_keys(torque_keys, spec.torques[i]);
  return {{"ecss", ecss}, {"nasa", nasa}, {"torques", torques}, {"points", spec.points}};
}

/// Those of a spring's numbers that it has.
std::vector<SceneParameter> of_spring(const Scene& scene, int hinge,
                                      std::initializer_list<std::string_view> fields) {
  std::vector<SceneParameter> parameters;
  for (const std::string_view field : fields)
    for (const ParameterMatch& match :
         resolve(scene, fmt::format("hinges.{}.spring.{}", scene.hinges[hinge].name, field))
             .matches)
      parameters.push_back(match.parameter);
  return parameters;
}

void refuse_unusable(const JsonCursor& at, const MarginSpec& margin, const Scene& scene) {
  const auto of_hinge = [](const SceneParameter& parameter) {
    return parameter.owner == SceneParameter::Owner::hinge;
  };
  const auto is_spring = [&](const SceneParameter& parameter) {
    return of_hinge(parameter) && sizes_spring({&parameter, 1}, scene, parameter.index);
  };
  if (margin.mode == MarginMode::each && !std::ranges::all_of(margin.scaled, of_hinge))
    at.refuse("\"each\" with a parameter that is not a hinge's", "parameters of hinges", "/mode");
  if (margin.one_spring_out && std::ranges::none_of(margin.scaled, is_spring))
    at.refuse("\"one_spring_out\" with no spring's torque in \"scale\"",
              "a spring that can be lost", "/cases");
}

} // namespace

std::vector<SceneParameter> spring_torques(const Scene& scene, int hinge) {
  if (scene.hinges[hinge].spring.table) return of_spring(scene, hinge, {"scale"});
  return of_spring(scene, hinge, {"torque_stowed", "torque_latched"});
}

bool sizes_spring(std::span<const SceneParameter> scaled, const Scene& scene, int hinge) {
  const auto all = of_spring(scene, hinge, {"torque_stowed", "torque_latched", "scale"});
  return std::ranges::any_of(scaled, [&](const SceneParameter& parameter) {
    return std::ranges::find(all, parameter) != all.end();
  });
}

MarginSpec read_margin(const JsonCursor& at, const Scene* scene) {
  MarginSpec margin;
  if (scene) margin.motorization.torques.resize(scene->hinges.size());
  const std::size_t before = at.problems().size();
  JsonObject object(at, "what to size: an object");
  if (const auto scale = object.require("scale", "the paths of the parameters to size"))
    margin.scaled = read_paths(*scale, scene);
  if (const auto range = object.require("range", expected_range)) read_range(*range, margin);
  object.optional_choice("mode", margin.mode, margin_mode_names);
  const std::string points = fmt::format("an integer from 2 to {}", most_points);
  object.optional("points", margin.points, points, is_point_count);
  object.optional("tolerance", margin.edge_tolerance, "a number, > 0 and < 1", is_proper_share);
  if (const auto cases = object.find("cases")) read_cases(*cases, margin);
  object.optional("springs_per_hinge", margin.springs_per_hinge, "an integer, ≥ 2", is_at_least_2);
  if (const auto factors = object.find("motorization"))
    read_motorization(*factors, scene, margin.motorization);
  object.refuse_others();
  if (scene && at.problems().size() == before) refuse_unusable(at, margin, *scene);
  return margin;
}

Json write_margin(const MarginSpec& margin, const Scene& scene) {
  Json cases = Json::array();
  if (margin.nominal) cases.push_back(case_names[0]);
  if (margin.one_spring_out) cases.push_back(case_names[1]);
  return {{"scale", paths_of(scene, margin.scaled)},
          {"range", {margin.lower, margin.upper}},
          {"mode", margin_mode_names[static_cast<std::size_t>(margin.mode)]},
          {"points", margin.points},
          {"tolerance", margin.edge_tolerance},
          {"cases", cases},
          {"springs_per_hinge", margin.springs_per_hinge},
          {"motorization", write_motorization(margin.motorization, scene)}};
}

} // namespace wingspread
