// Measures cost and error of every method, and of SUNDIALS CVODE on the same right-hand side, at every tolerance.
// The references use no code of core/.
//
//   build/release/studies/work_precision                 64 scenes of each case; the references
//                                                        take long once
//   build/release/studies/work_precision --cases rubbing only one case, the others' rows stay
//   build/release/studies/work_precision --quick         4 scenes, 3 tolerances
//   /usr/bin/python3 studies/plots/plot_work_precision.py results/work_precision

#include "montecarlo/engine/runs/run_plan.hpp"
#include "montecarlo/foundation/formats/csv.hpp"
#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "studies/peers/cvode_peer.hpp"
#include "studies/support/precision_measurement.hpp"
#include "studies/support/precision_references.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <fstream>
#include <map>

using namespace wingspread;
using namespace wingspread::study;

namespace {

/// Dispersed wings of one kind.
struct Case {
  const char* name;
  const char* campaign;                 ///< the campaign of these runs, in studies/campaigns
  std::optional<double> smoothing = {}; ///< ε of the smoothed latch, rad
  bool exact_friction = false;
};
const std::vector<Case> all_cases{
    {"event", "work_precision.json"},
    {"smoothed", "work_precision.json", 1e-3},
    {"rubbing", "work_precision_rubbing.json"},       // harness and regularized friction
    {"near_stall", "work_precision_near_stall.json"}, // the same, with little torque to spare
    {"sticking", "work_precision_sticking.json", {}, true}};
constexpr std::array extents{Extent::first_latch, Extent::whole}; // A, B
constexpr long max_steps = 100'000; // more than any useful point of the chart needs

const char* name_of(Extent extent) { return extent == Extent::first_latch ? "A" : "B"; }

/// The options of the command line.
struct Options {
  std::vector<std::string> cases; ///< none: all
  std::string out;                ///< folder
  bool quick = false;
  long scenes = 0; ///< 0: as the mode has it
  Source reference = Source::extended;
  std::vector<std::string> methods; ///< none: all
};

/// Sizes of the study, full or quick.
struct Plan {
  std::vector<double> tolerances; ///< rtol; atol is a hundredth of it
  std::vector<double> steps;      ///< s; for methods with a fixed step
  ReferenceSettings primary, cvode;
  ReferenceSettings second; ///< of another precision than the primary
  int second_scenes = 0;    ///< number of scenes with a second reference
  double patience = 0.05;   ///< least time for which a point is timed, s
};

Plan plan_of(const Options& options, const Case& of, double t_end) {
  Plan plan;
  plan.cvode = of.exact_friction
                   ? ReferenceSettings{Source::regularized, 1e-10, 1e-12, of.smoothing, t_end}
                   : ReferenceSettings{Source::cvode, 1e-14, 1e-15, of.smoothing, t_end};
  if (options.quick) {
    plan.tolerances = {1e-4, 1e-7, 1e-10};
    plan.steps = {8e-3, 2e-3, 5e-4};
    plan.primary = {options.reference, 1e-11, 1e-12, of.smoothing, t_end};
    plan.patience = 0.005;
    return plan;
  }
  for (int decade = 3; decade <= 12; ++decade) plan.tolerances.push_back(std::pow(10., -decade));
  for (int halving = 0; halving < 9; ++halving) plan.steps.push_back(std::ldexp(1.6e-2, -halving));
  const ReferenceSettings extended{Source::extended, 1e-16, 1e-17, of.smoothing, t_end};
  const ReferenceSettings quad{Source::quad, 1e-17, 1e-18, of.smoothing, t_end};
  const bool swap = options.reference == Source::quad;
  plan.primary = swap ? quad : extended, plan.second = swap ? extended : quad;
  plan.second_scenes = options.scenes > 0 ? 0 : 2; // they take minutes each
  return plan;
}

/// The scenes of the campaign's first runs.
std::vector<Scene> dispersed_scenes(const Campaign& campaign, long count) {
  const RunPlan runs(campaign);
  std::vector<Scene> scenes(count, campaign.scene);
  std::vector<double> draws(campaign.dispersions.size());
  for (long k = 0; k < count; ++k) {
    runs.draw(k, draws);
    apply(campaign, draws, campaign.scene, scenes[k]);
  }
  return scenes;
}

// ---- references

/// The largest difference between other references and the primary ones.
struct Agreement {
  int scenes = 0, other_order = 0;
  double time = 0, rate = 0, moment = 0, force = 0;

  void add(const Disagreement& off) {
    ++scenes, other_order += !off.same_order;
    time = std::max(time, off.time), rate = std::max(rate, off.rate);
    moment = std::max(moment, off.moment), force = std::max(force, off.force);
  }
  [[nodiscard]] bool within(double tolerance) const {
    return other_order == 0 && std::max({time, rate, moment, force}) <= tolerance;
  }
};

/// Scenes and references that every method is measured on.
struct Study {
  Case of;
  Plan plan;
  std::vector<Scene> scenes;
  std::vector<Figures> references = {}; ///< one a scene
  bool sound = true;                    ///< other references agree with them
};

void print(const Agreement& off, const char* name, Source source) {
  fmt::print("  {:<10} {:<11} {:>6} {:>11} {:>10.1e} {:>10.1e} {:>10.1e} {:>10.1e}\n", name,
             to_string(source), off.scenes, off.other_order, off.time, off.rate, off.moment,
             off.force);
  std::fflush(stdout);
}

/// Prints progress to stderr, on a line that is overwritten.
void show_progress(const char* name, Source source, int scene) {
  fmt::print(stderr, "  {} {} {}   \r", name, to_string(source), scene);
}

/// Compares the primary references of the first scenes with other references.
/// @param tolerance largest difference that is accepted
void check_references(ReferenceStore& store, const ReferenceSettings& other, int scenes,
                      double tolerance, Study& study) {
  Agreement agreement;
  for (int k = 0; k < std::ssize(study.scenes) && k < scenes; ++k) {
    show_progress(study.of.name, other.source, k);
    const ReferenceRow row = store.get(study.scenes[k], k, other);
    agreement.add(disagreement(row.figures, study.references[k]));
  }
  if (agreement.scenes > 0) print(agreement, study.of.name, other.source);
  study.sound = study.sound && agreement.within(tolerance);
}

void find_references(const std::filesystem::path& folder, Study& study) {
  std::vector<std::string> hinges;
  for (const Hinge& hinge : study.scenes.front().hinges) hinges.push_back(hinge.name);
  ReferenceStore store(folder / fmt::format("references_{}.csv", study.of.name), hinges);
  fmt::print(
      "\nReferences: largest relative disagreement with the primary ones ({}, rtol {:g})\n"
      "  case       with        scenes other order       time       rate     moment      force\n",
      to_string(study.plan.primary.source), study.plan.primary.rtol);
  for (int k = 0; k < std::ssize(study.scenes); ++k) {
    show_progress(study.of.name, study.plan.primary.source, k);
    study.references.push_back(store.get(study.scenes[k], k, study.plan.primary).figures);
  }
  // regularized friction is its limit to its width, 1e-6 rad/s, and more where a hinge comes to rest
  check_references(store, study.plan.cvode, static_cast<int>(study.scenes.size()),
                   study.of.exact_friction ? 1e-3 : 1e-6, study);
  check_references(store, study.plan.second, study.plan.second_scenes, 1e-9, study);
  store.write();
}

// ---- the chart

/// A method on the chart.
struct Series {
  std::string name;
  bool fixed_step = false;
  Run run;
  bool smooth_only = false; ///< cannot integrate contacts
};

Series series_of(const MethodInfo& method) {
  const auto deployment = std::make_shared<Deployment>();
  const bool fixed =
      method.name == "runge_kutta4" || method.kind.find("fixed") != std::string::npos;
  return {method.name, fixed,
          [deployment, name = method.name](const Scene& scene, Integration how, const Goal& goal) {
            how.method = name;
            return deployment->run(scene, how, goal);
          }};
}

Series series_of(const std::string& name, CvodePeer::Kind kind) {
  const auto peer = std::make_shared<CvodePeer>(kind);
  return {name, false,
          [peer](const Scene& scene, const Integration& how, const Goal& goal) {
            return peer->run(scene, how, goal);
          },
          true};
}

std::vector<Series> all_series(const std::vector<std::string>& wanted) {
  std::vector<Series> all;
  for (const MethodInfo& method : methods()) all.push_back(series_of(method));
  all.push_back(series_of("cvode_adams", CvodePeer::Kind::adams));
  all.push_back(series_of("cvode_bdf", CvodePeer::Kind::bdf));
  if (wanted.empty()) return all;
  std::vector<Series> some;
  for (const std::string& name : wanted) {
    const auto found = std::ranges::find(all, name, &Series::name);
    if (found == all.end()) throw std::invalid_argument("no method is called " + name);
    some.push_back(*found);
  }
  return some;
}

/// One row of the chart's table.
struct Point {
  std::string method, of; ///< the case
  Extent extent;
  double tolerance, step; ///< one of them varies, the other is NaN
  Measurement measured;
};

constexpr const char* header =
    "method,case,phase,tolerance,step,scenes,scored,mismatches,failures,reason,"
    "time_rms,time_max,rate_rms,rate_max,moment_rms,moment_max,force_rms,force_max,evaluations,"
    "steps,us\n";

std::string csv_line(const Point& point) {
  const Measurement& m = point.measured;
  std::string line = fmt::format("{},{},{}", point.method, point.of, name_of(point.extent));
  const auto add = [&](double value) { append_csv_cell(line += ',', value); };
  add(point.tolerance), add(point.step);
  line += fmt::format(",{},{},{},{}", m.scenes, m.scored, m.mismatches, m.failures);
  append_csv_cell(line += ',', m.reason);
  for (const Errors* errors : {&m.errors.time, &m.errors.rate, &m.errors.moment, &m.errors.force})
    add(errors->rms()), add(errors->count > 0 ? errors->largest : errors->rms());
  add(m.evaluations), add(m.steps), add(m.microseconds);
  return line + '\n';
}

Integration integration_of(const Study& study, bool fixed_step, double knob) {
  Integration how;
  how.t_end = study.plan.primary.t_end, how.max_steps = max_steps;
  how.rtol = knob, how.atol = 1e-2 * knob;
  if (fixed_step) how.step = knob, how.rtol = how.atol = 1e6; // so that no step is refused
  return how;
}

/// One curve: all tolerances, or all steps.
std::vector<Point> measure_curve(const Series& series, const Study& study, Extent extent) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  std::vector<Point> curve;
  for (const double knob : series.fixed_step ? study.plan.steps : study.plan.tolerances) {
    Integration how = integration_of(study, series.fixed_step, knob);
    how.smoothing = study.of.smoothing;
    curve.push_back(
        {series.name, study.of.name, extent, series.fixed_step ? none : knob,
         series.fixed_step ? knob : none,
         measure(series.run, study.scenes, study.references, how, extent, study.plan.patience)});
  }
  return curve;
}

/// An error for the table; a dash for NaN.
std::string shown(double error) { return std::isnan(error) ? "–" : fmt::format("{:.1e}", error); }

void print(const Point& point) {
  const Measurement& m = point.measured;
  const std::string knob = std::isnan(point.step) ? fmt::format("{:.0e}", point.tolerance)
                                                  : fmt::format("{:.1e} s", point.step);
  fmt::print("  {:<23} {:<10} {}  {:>9} {:>9} {:>9} {:>9} {:>9} {:>9.0f} {:>10.1f} {:>5} {:>5}\n",
             point.method, point.of, name_of(point.extent), knob, shown(m.errors.time.rms()),
             shown(m.errors.rate.rms()), shown(m.errors.moment.rms()), shown(m.errors.force.rms()),
             m.evaluations, m.microseconds, m.mismatches, m.failures);
}

/// Prints three points of a curve: all of a quick study; else the second, fifth and eighth.
void print_some(const std::vector<Point>& curve) {
  const bool all = curve.size() <= 3;
  for (const std::size_t k : all ? std::array{0, 1, 2} : std::array{1, 4, 7}) print(curve[k]);
}

/// The lines of an earlier study's file for cases and methods that this study does not measure.
std::string lines_of_others(const std::filesystem::path& file, const std::vector<Series>& series,
                            const Case& of) {
  std::ifstream in(file, std::ios::binary);
  std::string line, kept;
  std::getline(in, line); // the header
  if (line + '\n' != header) return {};
  while (std::getline(in, line)) {
    const std::size_t comma = line.find(','), next = line.find(',', comma + 1);
    const bool measured =
        line.substr(comma + 1, next - comma - 1) == of.name &&
        std::ranges::find(series, line.substr(0, comma), &Series::name) != series.end();
    if (!measured) kept += line + '\n';
  }
  return kept;
}

void print_header(std::size_t scenes) {
  fmt::print("\nRMS relative errors over {} scenes and their hinges; work a run\n"
             "  {:<23} case       phase {:>7} {:>9} {:>9} {:>9} {:>9} {:>9} {:>10} other fails\n",
             scenes, "method", "rtol/step", "time", "rate", "moment", "force", "evals", "us");
}

/// @param others lines to keep in the file
void measure_all(const std::vector<Series>& all, const Study& study,
                 const std::filesystem::path& file, const std::string& others) {
  print_header(study.scenes.size());
  std::string text = header + others;
  for (const Series& series : all) {
    if (series.smooth_only && study.of.exact_friction) continue;
    for (const Extent extent : extents) {
      const std::vector<Point> curve = measure_curve(series, study, extent);
      print_some(curve);
      for (const Point& point : curve) text += csv_line(point);
    }
    write_file(file, text); // an interrupted study keeps it
    std::fflush(stdout);
  }
}

/// Measures one case. @return whether its references agree with each other
bool study_case(const Options& options, const Case& of, const std::vector<Series>& series) {
  const Campaign campaign = read_campaign_file(std::string("studies/campaigns/") + of.campaign);
  const long all = options.quick ? 4 : campaign.sampling.runs;
  Study study{of, plan_of(options, of, campaign.integration.t_end),
              dispersed_scenes(campaign, options.scenes > 0 ? options.scenes : all)};
  const std::filesystem::path folder = options.out, file = folder / "work_precision.csv";
  make_folder(folder);
  find_references(folder, study);
  measure_all(series, study, file, lines_of_others(file, series, of));
  return study.sound;
}

int carry_out(const Options& options) {
  const std::vector<Series> series = all_series(options.methods);
  bool sound = true;
  for (const Case& of : all_cases)
    if (options.cases.empty() || std::ranges::count(options.cases, of.name) > 0)
      sound = study_case(options, of, series) && sound;
  fmt::print("\n{}\n", (std::filesystem::path(options.out) / "work_precision.csv").string());
  if (!sound) fmt::print(stderr, "error: the references disagree\n");
  return sound ? 0 : 1;
}

} // namespace

int main(int count, char** arguments) {
  Options options;
  CLI::App app(
      "What every integration method costs, and how far it is from independent references");
  std::vector<std::string> cases;
  for (const Case& of : all_cases) cases.emplace_back(of.name);
  app.add_option("--cases", options.cases, "Only these, the others' rows stay (default: all)")
      ->delimiter(',')
      ->check(CLI::IsMember(cases));
  app.add_flag("--quick", options.quick, "4 scenes, 3 tolerances, coarser references");
  app.add_option("--scenes", options.scenes, "How many of each case")
      ->check(CLI::Range(1L, 1'000'000L));
  app.add_option("--out", options.out,
                 "Folder; results/work_precision by default, with --quick …_quick");
  app.add_option("--reference", options.reference, "Precision of the primary references")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Source>{{"extended", Source::extended}, {"quad", Source::quad}}));
  app.add_option("--methods", options.methods,
                 "Only these, the others' rows stay (default: all, and CVODE's two)")
      ->delimiter(',');
  CLI11_PARSE(app, count, arguments);
  if (options.out.empty())
    options.out = options.quick ? "results/work_precision_quick" : "results/work_precision";
  try {
    return carry_out(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 2;
  }
}
