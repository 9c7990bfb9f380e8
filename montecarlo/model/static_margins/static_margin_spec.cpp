#include "montecarlo/model/static_margins/static_margin_spec.hpp"

#include <fmt/format.h>

namespace wingspread {
namespace {

bool is_point_count(const std::int64_t& number) {
  return number >= 2 && number <= most_margin_points;
}

bool is_at_least_2(const std::int64_t& number) { return number >= 2; }

/// A factor or term and its key.
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
// Without NasaFactors::acceleration: static margins have no inertial torque to deliver.
constexpr std::array nasa_keys{Key<NasaFactors>{"fixed", &NasaFactors::fixed},
                               Key<NasaFactors>{"variable", &NasaFactors::variable}};
constexpr std::array phase_keys{Key<PhaseFactors>{"known", &PhaseFactors::known},
                                Key<PhaseFactors>{"variable", &PhaseFactors::variable}};
// Without spring, friction, harness and damper, which the scene gives.
constexpr std::array torque_keys{Key<TorqueTerms>{"inertia", &TorqueTerms::inertia},
                                 Key<TorqueTerms>{"motor", &TorqueTerms::motor},
                                 Key<TorqueTerms>{"hysteresis", &TorqueTerms::hysteresis},
                                 Key<TorqueTerms>{"adhesion", &TorqueTerms::adhesion},
                                 Key<TorqueTerms>{"acceleration", &TorqueTerms::acceleration},
                                 Key<TorqueTerms>{"delivered", &TorqueTerms::delivered}};

template <class Owner, std::size_t n>
void read_factors(JsonObject& object, const std::array<Key<Owner>, n>& keys, Owner& owner) {
  for (const auto& [name, member] : keys)
    object.optional(name, owner.*member, "a factor: a number, > 0", is_positive);
  object.refuse_others();
}

template <class Owner, std::size_t n>
Json write_keys(const std::array<Key<Owner>, n>& keys, const Owner& owner) {
  Json json = Json::object();
  for (const auto& [name, member] : keys) json[name] = owner.*member;
  return json;
}

void read_ecss(const JsonCursor& at, StaticMarginSpec& spec) {
  JsonObject object(at, "an object with factors");
  object.optional_choice("basis", spec.ecss_basis, ecss_basis_names);
  spec.ecss = spec.ecss_basis == EcssBasis::measured ? ecss_measured() : EcssFactors{};
  read_factors(object, ecss_keys, spec.ecss);
}

void read_nasa(const JsonCursor& at, StaticMarginSpec& spec) {
  JsonObject object(at, "an object with factors");
  object.optional_choice("basis", spec.nasa_basis, nasa_basis_names);
  if (spec.nasa_basis == NasaBasis::development_test) spec.nasa = nasa_development_test();
  if (spec.nasa_basis == NasaBasis::acceptance) spec.nasa = nasa_acceptance();
  read_factors(object, nasa_keys, spec.nasa);
}

void read_phase(const JsonCursor& at, MarginPhase& phase, PhaseFactors& factors) {
  JsonObject object(at, "an object with factors");
  object.optional_choice("phase", phase, margin_phase_names);
  factors = phase_factors(phase);
  read_factors(object, phase_keys, factors);
}

Json phase_json(MarginPhase phase, const PhaseFactors& factors) {
  Json json{{"phase", margin_phase_names[static_cast<std::size_t>(phase)]}};
  json.update(write_keys(phase_keys, factors));
  return json;
}

void read_torques(const JsonCursor& at, const Scene* scene, std::vector<TorqueTerms>& torques) {
  JsonObject hinges(at, "an object with the torques of hinges by their names");
  hinges.keys_are_names();
  if (!scene) return;
  for (std::size_t i = 0; i < scene->hinges.size(); ++i)
    if (const auto hinge = hinges.find(scene->hinges[i].name)) {
      JsonObject object(*hinge, "an object with torques");
      for (const auto& [name, member] : torque_keys)
        object.optional(name, torques[i].*member, Dimension{"N·m", "≥ 0"}, is_not_negative);
      object.refuse_others();
    }
  hinges.refuse_others();
}

void read_rates(const JsonCursor& at, const Scene* scene, std::vector<double>& rates) {
  JsonObject hinges(at, "an object with the rates of hinges by their names");
  hinges.keys_are_names();
  if (!scene) return;
  for (std::size_t i = 0; i < scene->hinges.size(); ++i)
    hinges.optional(scene->hinges[i].name, rates[i], Dimension{"rad/s", "≥ 0"}, is_not_negative);
  hinges.refuse_others();
}

} // namespace

StaticMarginSpec default_static_margins(const Scene& scene) {
  StaticMarginSpec spec;
  spec.torques.resize(scene.hinges.size());
  spec.rates.resize(scene.hinges.size());
  return spec;
}

void read_static_margins(const JsonCursor& at, const Scene* scene, StaticMarginSpec& spec) {
  constexpr std::string_view what = "an object with the static margins' factors";
  at.note(Question::What::object, what, "motorization");
  JsonObject object(at, what);
  if (const auto ecss = object.find("ecss")) read_ecss(*ecss, spec);
  if (const auto nasa = object.find("nasa")) read_nasa(*nasa, spec);
  if (const auto gevs = object.find("gevs")) read_phase(*gevs, spec.gevs_phase, spec.gevs);
  if (const auto aiaa = object.find("aiaa")) read_phase(*aiaa, spec.aiaa_phase, spec.aiaa);
  if (const auto torques = object.find("torques")) read_torques(*torques, scene, spec.torques);
  if (const auto rates = object.find("rates")) read_rates(*rates, scene, spec.rates);
  object.optional("points", spec.points, fmt::format("an integer from 2 to {}", most_margin_points),
                  is_point_count);
  read_springs_per_hinge(object, spec);
  object.refuse_others();
}

void read_springs_per_hinge(JsonObject& object, StaticMarginSpec& spec) {
  object.optional("springs_per_hinge", spec.springs_per_hinge, "an integer, ≥ 2", is_at_least_2);
}

Json write_static_margins(const StaticMarginSpec& spec, const Scene& scene) {
  Json ecss{{"basis", ecss_basis_names[static_cast<std::size_t>(spec.ecss_basis)]}};
  ecss.update(write_keys(ecss_keys, spec.ecss));
  Json nasa{{"basis", nasa_basis_names[static_cast<std::size_t>(spec.nasa_basis)]}};
  nasa.update(write_keys(nasa_keys, spec.nasa));
  Json torques = Json::object(), rates = Json::object();
  for (std::size_t i = 0; i < scene.hinges.size(); ++i) {
    torques[scene.hinges[i].name] = write_keys(torque_keys, spec.torques[i]);
    rates[scene.hinges[i].name] = spec.rates[i];
  }
  return {{"ecss", ecss},
          {"nasa", nasa},
          {"gevs", phase_json(spec.gevs_phase, spec.gevs)},
          {"aiaa", phase_json(spec.aiaa_phase, spec.aiaa)},
          {"torques", torques},
          {"rates", rates},
          {"points", spec.points}};
}

} // namespace wingspread
