// Work against precision: what every method, and SUNDIALS CVODE on the same right-hand side, costs
// at every tolerance, and how far it then is from references that share nothing with core/.
//
//   build/release/studies/work_precision                 64 scenes; the references take long once
//   build/release/studies/work_precision --quick         4 scenes, 3 tolerances
//   /usr/bin/python3 studies/plots/plot_work_precision.py results/work_precision

#include "montecarlo/campaign/campaign_json.hpp"
#include "montecarlo/formats/csv.hpp"
#include "montecarlo/formats/files.hpp"
#include "montecarlo/runs/run_plan.hpp"
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

constexpr double smoothing_width = 1e-3;                                 // rad
const std::vector<std::optional<double>> latches{{}, {smoothing_width}}; // event, smoothed
constexpr std::array extents{Extent::first_latch, Extent::whole};        // A, B
constexpr long max_steps = 400'000; // more than any useful point of the chart takes

const char* name_of(const std::optional<double>& smoothing) {
  return smoothing ? "smoothed" : "event";
}
const char* name_of(Extent extent) { return extent == Extent::first_latch ? "A" : "B"; }

/// What the command line asks for.
struct Options {
  std::string campaign = "studies/campaigns/work_precision.json";
  std::string out; ///< folder
  bool quick = false;
  long scenes = 0; ///< 0: as the mode has it
  Source reference = Source::extended;
  std::vector<std::string> methods; ///< none: all
};

/// What the mode makes of it.
struct Plan {
  std::vector<double> tolerances; ///< rtol; atol is a hundredth of it
  std::vector<double> steps;      ///< s; for methods with a fixed step
  ReferenceSettings primary, cvode;
  ReferenceSettings second; ///< of another precision than the primary
  int second_scenes = 0;    ///< how many scenes have one
  double patience = 0.05;   ///< how long a point is timed at least, s
};

Plan plan_of(const Options& options, double t_end) {
  Plan plan;
  plan.cvode = {Source::cvode, 1e-14, 1e-15, {}, t_end};
  if (options.quick) {
    plan.tolerances = {1e-4, 1e-7, 1e-10};
    plan.steps = {8e-3, 2e-3, 5e-4};
    plan.primary = {options.reference, 1e-11, 1e-12, {}, t_end};
    plan.patience = 0.005;
    return plan;
  }
  for (int decade = 3; decade <= 12; ++decade) plan.tolerances.push_back(std::pow(10., -decade));
  for (int halving = 0; halving < 9; ++halving) plan.steps.push_back(std::ldexp(1.6e-2, -halving));
  const ReferenceSettings extended{Source::extended, 1e-17, 1e-18, {}, t_end};
  const ReferenceSettings quad{Source::quad, 1e-18, 1e-19, {}, t_end};
  const bool swap = options.reference == Source::quad;
  plan.primary = swap ? quad : extended, plan.second = swap ? extended : quad;
  plan.second_scenes = 4;
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

/// The largest disagreement of some references with the primary ones.
struct Agreement {
  int scenes = 0, other_order = 0;
  double time = 0, rate = 0, moment = 0;

  void add(const Disagreement& off) {
    ++scenes, other_order += !off.same_order;
    time = std::max(time, off.time), rate = std::max(rate, off.rate);
    moment = std::max(moment, off.moment);
  }
  [[nodiscard]] bool within(double tolerance) const {
    return other_order == 0 && std::max({time, rate, moment}) <= tolerance;
  }
};

/// Primary references by latch name, one a scene; and how well the others agree with them.
struct References {
  std::map<std::string, std::vector<Figures>> primary;
  bool sound = true;
};

void print(const Agreement& off, const std::string& latch, Source source) {
  fmt::print("  {:<9} {:<9} {:>6} {:>11} {:>10.1e} {:>10.1e} {:>10.1e}\n", latch, to_string(source),
             off.scenes, off.other_order, off.time, off.rate, off.moment);
}

ReferenceSettings with(ReferenceSettings how, const std::optional<double>& smoothing) {
  how.smoothing = smoothing;
  return how;
}

/// On stderr, on a line that does not stay.
void show_progress(const char* latch, Source source, int scene) {
  fmt::print(stderr, "  {} {} {}   \r", latch, to_string(source), scene);
}

/// Makes the primary references of one latch model, and has CVODE check them.
void find_primary(ReferenceStore& store, const std::vector<Scene>& scenes, const Plan& plan,
                  const std::optional<double>& smoothing, References& found) {
  Agreement agreement;
  std::vector<Figures>& primary = found.primary[name_of(smoothing)];
  for (int k = 0; k < std::ssize(scenes); ++k) {
    show_progress(name_of(smoothing), plan.primary.source, k);
    primary.push_back(store.get(scenes[k], k, with(plan.primary, smoothing)).figures);
    const ReferenceRow other = store.get(scenes[k], k, with(plan.cvode, smoothing));
    agreement.add(disagreement(other.figures, primary[k]));
  }
  print(agreement, name_of(smoothing), Source::cvode);
  found.sound = found.sound && agreement.within(1e-6);
}

/// Has some of them checked in another precision.
void check_primary(ReferenceStore& store, const std::vector<Scene>& scenes, const Plan& plan,
                   const std::optional<double>& smoothing, References& found) {
  Agreement agreement;
  const std::vector<Figures>& primary = found.primary[name_of(smoothing)];
  for (int k = 0; k < std::ssize(scenes) && k < plan.second_scenes; ++k) {
    show_progress(name_of(smoothing), plan.second.source, k);
    const ReferenceRow other = store.get(scenes[k], k, with(plan.second, smoothing));
    agreement.add(disagreement(other.figures, primary[k]));
  }
  if (agreement.scenes > 0) print(agreement, name_of(smoothing), plan.second.source);
  found.sound = found.sound && agreement.within(1e-9);
}

References find_references(const std::filesystem::path& file, const std::vector<Scene>& scenes,
                           const Plan& plan) {
  std::vector<std::string> hinges;
  for (const Hinge& hinge : scenes.front().hinges) hinges.push_back(hinge.name);
  ReferenceStore store(file, hinges);
  fmt::print("References: largest relative disagreement with the primary ones ({}, rtol {:g})\n"
             "  latch     with      scenes other order       time       rate     moment\n",
             to_string(plan.primary.source), plan.primary.rtol);
  References found;
  for (const auto& smoothing : latches) find_primary(store, scenes, plan, smoothing, found);
  for (const auto& smoothing : latches) check_primary(store, scenes, plan, smoothing, found);
  store.write();
  return found;
}

// ---- the chart

/// A method on the chart.
struct Series {
  std::string name;
  bool fixed_step = false;
  Run run;
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
  return {name, false, [peer](const Scene& scene, const Integration& how, const Goal& goal) {
            return peer->run(scene, how, goal);
          }};
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

/// A row of the chart's table.
struct Point {
  std::string method, latch;
  Extent extent;
  double tolerance, step; ///< the one that varies; NaN the other
  Measurement measured;
};

constexpr const char* header =
    "method,latch,phase,tolerance,step,scenes,scored,mismatches,failures,reason,"
    "time_rms,time_max,rate_rms,rate_max,moment_rms,moment_max,evaluations,steps,us\n";

std::string csv_line(const Point& point) {
  const Measurement& m = point.measured;
  std::string line = fmt::format("{},{},{}", point.method, point.latch, name_of(point.extent));
  const auto add = [&](double value) { append_csv_cell(line += ',', value); };
  add(point.tolerance), add(point.step);
  line += fmt::format(",{},{},{},{}", m.scenes, m.scored, m.mismatches, m.failures);
  append_csv_cell(line += ',', m.reason);
  for (const Errors* errors : {&m.errors.time, &m.errors.rate, &m.errors.moment})
    add(errors->rms()), add(errors->count > 0 ? errors->largest : errors->rms());
  add(m.evaluations), add(m.steps), add(m.microseconds);
  return line + '\n';
}

/// What every series is measured on.
struct Study {
  Plan plan;
  std::vector<Scene> scenes;
  References references;
};

Integration integration_of(const Study& study, bool fixed_step, double knob) {
  Integration how;
  how.t_end = study.plan.primary.t_end, how.max_steps = max_steps;
  how.rtol = knob, how.atol = 1e-2 * knob;
  if (fixed_step) how.step = knob, how.rtol = how.atol = 1e6; // so that it refuses no step
  return how;
}

/// One curve: all tolerances, or all steps.
std::vector<Point> measure_curve(const Series& series, const Study& study,
                                 const std::optional<double>& smoothing, Extent extent) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const std::string latch = name_of(smoothing);
  std::vector<Point> curve;
  for (const double knob : series.fixed_step ? study.plan.steps : study.plan.tolerances) {
    Integration how = integration_of(study, series.fixed_step, knob);
    how.smoothing = smoothing;
    curve.push_back({series.name, latch, extent, series.fixed_step ? none : knob,
                     series.fixed_step ? knob : none,
                     measure(series.run, study.scenes, study.references.primary.at(latch), how,
                             extent, study.plan.patience)});
  }
  return curve;
}

/// A figure of the table, a dash when there is none.
std::string shown(double error) { return std::isnan(error) ? "–" : fmt::format("{:.1e}", error); }

void print(const Point& point) {
  const Measurement& m = point.measured;
  const std::string knob = std::isnan(point.step) ? fmt::format("{:.0e}", point.tolerance)
                                                  : fmt::format("{:.1e} s", point.step);
  fmt::print("  {:<23} {:<9} {}  {:>9} {:>9} {:>9} {:>9} {:>9.0f} {:>10.1f} {:>5} {:>5}\n",
             point.method, point.latch, name_of(point.extent), knob, shown(m.errors.time.rms()),
             shown(m.errors.rate.rms()), shown(m.errors.moment.rms()), m.evaluations,
             m.microseconds, m.mismatches, m.failures);
}

/// Three points of a curve: all of a quick study; else those of 1e-4, 1e-7 and 1e-10.
void print_some(const std::vector<Point>& curve) {
  const bool all = curve.size() <= 3;
  for (const std::size_t k : all ? std::array{0, 1, 2} : std::array{1, 4, 7}) print(curve[k]);
}

/// The lines that an earlier study left of series that are not measured now.
std::string lines_of_others(const std::filesystem::path& file, const std::vector<Series>& now) {
  std::ifstream in(file, std::ios::binary);
  std::string line, kept;
  std::getline(in, line); // the header
  while (std::getline(in, line))
    if (std::ranges::find(now, line.substr(0, line.find(',')), &Series::name) == now.end())
      kept += line + '\n';
  return kept;
}

void print_header(std::size_t scenes) {
  fmt::print("\nRMS relative errors over {} scenes and their hinges; work a run\n"
             "  {:<23} latch     phase {:>7} {:>9} {:>9} {:>9} {:>9} {:>10} other fails\n",
             scenes, "method", "rtol/step", "time", "rate", "moment", "evals", "us");
}

/// @param others lines of the file that stay
void measure_all(const std::vector<Series>& all, const Study& study,
                 const std::filesystem::path& file, const std::string& others) {
  print_header(study.scenes.size());
  std::string text = header + others;
  for (const Series& series : all) {
    for (const auto& smoothing : latches)
      for (const Extent extent : extents) {
        const std::vector<Point> curve = measure_curve(series, study, smoothing, extent);
        print_some(curve);
        for (const Point& point : curve) text += csv_line(point);
      }
    write_file(file, text); // what is done is kept
    std::fflush(stdout);
  }
}

int carry_out(const Options& options) {
  const Campaign campaign = read_campaign_file(options.campaign);
  const std::vector<Series> series = all_series(options.methods);
  const long all = options.quick ? 4 : campaign.sampling.runs;
  Study study{plan_of(options, campaign.integration.t_end),
              dispersed_scenes(campaign, options.scenes > 0 ? options.scenes : all),
              {}};
  const std::filesystem::path folder = options.out, file = folder / "work_precision.csv";
  make_folder(folder);
  study.references = find_references(folder / "references.csv", study.scenes, study.plan);
  measure_all(series, study, file, options.methods.empty() ? "" : lines_of_others(file, series));
  fmt::print("\n{}\n", file.string());
  if (!study.references.sound) fmt::print(stderr, "error: the references disagree\n");
  return study.references.sound ? 0 : 1;
}

} // namespace

int main(int count, char** arguments) {
  Options options;
  CLI::App app(
      "What every integration method costs, and how far it is from independent references");
  app.add_option("--campaign", options.campaign, "Whose runs are the scenes")
      ->capture_default_str();
  app.add_flag("--quick", options.quick, "4 scenes, 3 tolerances, coarser references");
  app.add_option("--scenes", options.scenes, "How many of the campaign's runs")
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
