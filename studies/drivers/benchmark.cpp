// Measures the time of an acceleration evaluation against the number of bodies, and the time of whole runs.
// Writes benchmark.json. Each figure is the least of several repetitions in one process. Compare ratios: times scatter.
//
//   build/release/studies/benchmark                      everything
//   build/release/studies/benchmark --quick              a tenth of the repetitions

#include "core/deployment.hpp"
#include "core/mechanics/system.hpp"
#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "studies/peers/dense_chain.hpp"
#include "studies/support/study.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>

using namespace wingspread;
using study::stack;
using Json = nlohmann::ordered_json;

namespace {

double effort = 1; // share of the full repetitions

/// Runs f `count` times; ns a call.
template <class Function> double round_of(long count, Function& f) {
  const auto start = std::chrono::steady_clock::now();
  for (long k = 0; k < count; ++k) f();
  const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - start;
  return taken.count() / static_cast<double>(count);
}

/// Least time of one call of f, ns, over five rounds of about 50 ms, or of one call if it takes longer.
template <class Function> double time_of(Function f) {
  const double once = round_of(1, f), some = round_of(1 + static_cast<long>(1e5 / once), f);
  const long count = 1 + static_cast<long>(5e7 * effort / some);
  double best = some;
  for (int round = 0; round < 5 && !(some > 1e9); ++round)
    best = std::min(best, round_of(count, f));
  return best;
}

/// Dependent additions per ns, to compare the other times with: one per cycle on most processors.
double cycles_per_ns() {
  unsigned long x = 1;
  const double block = time_of([&] {
#pragma GCC unroll 32
    for (int k = 0; k < 32; ++k) asm volatile("add $1, %0" : "+r"(x));
  });
  return 32 / block;
}

struct EvaluationTime {
  double dependent, independent; // ns; dependent: each evaluation needs the previous one
};

template <class Topology> EvaluationTime recursion(const Wing<double>& wing) {
  Workspace<double> work;
  System<double, Topology, BaseMotion::fixed> system(wing, std::nullopt, work);
  State<double> x, dxdt;
  system.start(x);
  dxdt = x;
  const int n = wing.size();
  const double dependent = time_of([&] {
    system(x, dxdt, 0.0);
    for (int i = 0; i < n; ++i) x[i] = fused(1e-300, dxdt[n + i], x[i]);
  });
  return {dependent, time_of([&] { system(x, dxdt, 0.0); })};
}

template <int N> double dense(const Scene& scene) {
  using Chain = study::DenseChain<N>;
  Chain chain(scene);
  const int n = static_cast<int>(scene.bodies.size());
  typename Chain::Vector angle(n), rate(n), moment(n), out(n);
  double sum = 0;
  for (int i = 0; i < n; ++i) angle[i] = sum += scene.hinges[i].stowed;
  rate.setZero(), moment.setConstant(2);
  return time_of([&] {
    chain.accelerate(angle, rate, moment, out);
    for (int i = 0; i < n; ++i) angle[i] = fused(1e-300, out[i], angle[i]);
  });
}

Json evaluations() {
  Json rows = Json::array();
  for (const int n : {1, 2, 3, 4, 10, 30, 100, 300, 1000}) {
    const Scene scene = stack(n);
    Wing<double> wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    const EvaluationTime tree = recursion<Tree>(wing);
    EvaluationTime best = tree;
    if (n == 1) best = recursion<Chain<1>>(wing);
    if (n == 2) best = recursion<Chain<2>>(wing);
    if (n == 3) best = recursion<Chain<3>>(wing);
    if (n == 4) best = recursion<Chain<4>>(wing);
    Json row{{"bodies", n},
             {"ns", best.dependent},
             {"ns_per_body", best.dependent / n},
             {"ns_independent", best.independent},
             {"ns_as_tree", tree.dependent}};
    if (n <= 100) {
      const double by_hand = n == 3 ? dense<3>(scene) : dense<Eigen::Dynamic>(scene);
      row["ns_dense_by_hand"] = by_hand, row["dense_over_recursion"] = by_hand / best.dependent;
    }
    rows.push_back(row);
  }
  return rows;
}

Json one_run(const std::string& name, const Scene& scene, const Integration& how,
             const Goal& goal) {
  Deployment deployment;
  Outcome out = deployment.run(scene, how, goal);
  const double ns = time_of([&] { out = deployment.run(scene, how, goal); });
  return {{"run", name},
          {"us", ns * 1e-3},
          {"status", to_string(out.status)},
          {"t_end", out.t_end},
          {"steps", out.work.steps},
          {"rhs_evaluations", out.work.rhs_evaluations},
          {"ns_per_evaluation", ns / static_cast<double>(out.work.rhs_evaluations)}};
}

Json runs() {
  const Scene seed = study::seed_wing();
  Goal all{.audit = false}, moments{.peak_force = false, .audit = false},
      latches{.peak_moment = false, .peak_force = false, .audit = false},
      whole{.audit = false, .to_t_end = true};
  Json rows = Json::array();
  for (const double rtol : {1e-6, 1e-8, 1e-10}) {
    Integration how;
    how.rtol = rtol, how.atol = 1e-2 * rtol;
    const auto name = [&](const std::string& what) {
      return "three_panel, rtol " + Json(rtol).dump() + ", " + what;
    };
    rows.push_back(one_run(name("all outputs"), seed, how, all));
    rows.push_back(one_run(name("latches and peak moments"), seed, how, moments));
    rows.push_back(one_run(name("latches"), seed, how, latches));
    how.t_end = 12;
    rows.push_back(one_run(name("to 12 s"), seed, how, whole));
  }
  for (const char* scene : {"three_panel_flight", "two_wing_free", "prescribed_base", "long_chain"})
    rows.push_back(one_run(std::string(scene) + ", defaults, all outputs",
                           read_scene_file(std::string("studies/scenes/") + scene + ".json"), {},
                           all));
  return rows;
}

} // namespace

int main(int count, char** arguments) {
  return study::run_study(count, arguments, "benchmark",
                          "Time of an evaluation against the number of bodies, and of whole runs",
                          [](const study::StudyOptions& options) {
                            if (options.quick) effort = 0.1;
                            const Json found{{"cycles_per_ns", cycles_per_ns()},
                                             {"evaluation", evaluations()},
                                             {"runs", runs()}};
                            write_file(options.folder / "benchmark.json", found.dump(2) + '\n');
                          });
}
