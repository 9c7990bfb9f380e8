// Measures how the error of a campaign's statistics falls with the number of runs, for each design: mean,
// standard deviation and quantiles of the latch rates.
//
//   build/release/studies/design_error                 16 replicates of 64 … 4096 runs each
//   build/release/studies/design_error --quick         8 replicates of 64 … 512 runs
//   /usr/bin/python3 studies/plots/plot_design_error.py results/design_error

#include "montecarlo/engine/runs/evaluator.hpp"
#include "montecarlo/foundation/formats/csv.hpp"
#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <map>

using namespace wingspread;

namespace {

constexpr std::array designs{DesignKind::random, DesignKind::latin_hypercube, DesignKind::sobol};
constexpr std::array quantiles{0.01, 0.5, 0.99};
constexpr std::array<const char*, 5> statistic_names{"mean", "std", "q01", "q50", "q99"};
using Statistics = std::array<double, 5>;

constexpr long fewest = 64; // least number of runs of a replicate

struct Options {
  std::string campaign = "studies/campaigns/seed.json";
  std::string out; ///< folder
  bool quick = false;
  long replicates = 0, most = 0, reference = 0; ///< 0: as the mode has it
};

std::string_view name_of(DesignKind design) {
  return design_names[static_cast<std::size_t>(design)];
}

/// The columns of latch rates, NaN where a hinge did not latch.
struct LatchRates {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;
};

LatchRates make(Campaign campaign, const Sampling& sampling) {
  campaign.sampling = sampling;
  const RunPlan plan(campaign);
  LatchRates made;
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < plan.columns().size(); ++i)
    if (plan.columns()[i].quantity == OutputQuantity::latch_rate) {
      chosen.push_back(i);
      made.names.push_back(plan.columns()[i].name);
    }
  made.columns.resize(chosen.size());
  const std::atomic<bool> stop = false;
  const auto keep = [&](const Batch& batch) {
    for (const ResultRow& row : batch.rows)
      for (std::size_t c = 0; c < chosen.size(); ++c)
        made.columns[c].push_back(row.outputs[chosen[c]]);
  };
  (void)ThreadEvaluator({}, stop).make(plan, {0, sampling.runs}, {keep});
  fmt::print(stderr, "  {} {}   \r", name_of(sampling.design), sampling.runs);
  return made;
}

Statistics statistics_of(std::span<const double> values) {
  const std::vector<double> sorted = sorted_present(values);
  const Moments m = moments(sorted);
  Statistics statistics{m.mean, m.std};
  for (std::size_t i = 0; i < quantiles.size(); ++i)
    statistics.at(i + 2) = quantile(sorted, quantiles.at(i));
  return statistics;
}

/// A replicate's first n values. With R replicates, run k is value number k/R (rounded down) of replicate k mod R.
std::vector<double> of_replicate(const std::vector<double>& column, long replicates, long replicate,
                                 long n) {
  std::vector<double> values;
  for (long i = 0; i < n; ++i)
    values.push_back(column[static_cast<std::size_t>(i * replicates + replicate)]);
  return values;
}

/// Mean and spread of one statistic over the replicates.
struct Error {
  double rms;      ///< about the reference
  double spread;   ///< standard deviation over the replicates
  double off_mean; ///< the replicates' mean minus the reference: bias, plus the reference's error
};

Error error_of(std::span<const double> found, double reference) {
  const Moments m = moments(found);
  double squares = 0;
  for (const double each : found) squares += (each - reference) * (each - reference);
  return {std::sqrt(squares / static_cast<double>(found.size())), m.std, m.mean - reference};
}

/// One row of the table.
struct Point {
  DesignKind design;
  long n;
  std::string output;
  std::size_t statistic; ///< index into statistic_names
  Error error;
};

class Study {
public:
  Study(Campaign campaign, const Options& options)
      : campaign_(std::move(campaign)), replicates_(options.replicates), most_(options.most) {
    campaign_.outputs = {OutputFamily::latch_rate};
    campaign_.integration.rtol = 1e-6; // integration error far below the sampling errors
    campaign_.integration.atol = 1e-8;
    const Sampling all{DesignKind::sobol, options.reference, campaign_.sampling.seed + 1, 1};
    const LatchRates rates = make(campaign_, all);
    names_ = rates.names;
    for (const auto& column : rates.columns) references_.push_back(statistics_of(column));
  }

  [[nodiscard]] std::vector<Point> measure() const {
    std::vector<Point> points;
    for (const DesignKind design : designs) {
      const bool nested = design != DesignKind::latin_hypercube; // longer ones extend shorter
      LatchRates rates;
      if (nested) rates = make(campaign_, sampling(design, most_));
      for (long n = fewest; n <= most_; n *= 2) {
        if (!nested) rates = make(campaign_, sampling(design, n));
        add_points(points, design, n, rates);
      }
    }
    return points;
  }

  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] double reference(std::size_t output, std::size_t statistic) const {
    return references_[output].at(statistic);
  }

private:
  [[nodiscard]] Sampling sampling(DesignKind design, long n) const {
    return {design, n * replicates_, campaign_.sampling.seed, replicates_};
  }

  void add_points(std::vector<Point>& points, DesignKind design, long n,
                  const LatchRates& rates) const {
    for (std::size_t output = 0; output < names_.size(); ++output) {
      std::array<std::vector<double>, 5> found;
      for (long r = 0; r < replicates_; ++r) {
        const auto values = of_replicate(rates.columns[output], replicates_, r, n);
        const Statistics statistics = statistics_of(values);
        for (std::size_t s = 0; s < found.size(); ++s) found.at(s).push_back(statistics.at(s));
      }
      for (std::size_t s = 0; s < found.size(); ++s)
        points.push_back(
            {design, n, names_[output], s, error_of(found.at(s), reference(output, s))});
    }
  }

  Campaign campaign_;
  long replicates_, most_;
  std::vector<std::string> names_;     ///< of the outputs
  std::vector<Statistics> references_; ///< per output
};

std::string csv_text(const std::vector<Point>& points, const Study& study, long replicates) {
  std::string text =
      "design,runs,replicates,output,statistic,reference,rms_error,spread,off_mean\n";
  for (const auto& [design, n, output, statistic, error] : points) {
    const auto index = std::ranges::find(study.names(), output) - study.names().begin();
    text += fmt::format("{},{},{},{},{}", name_of(design), n, replicates, output,
                        statistic_names.at(statistic));
    for (const double value : {study.reference(static_cast<std::size_t>(index), statistic),
                               error.rms, error.spread, error.off_mean})
      append_csv_cell(text += ',', value);
    text += '\n';
  }
  return text;
}

/// Prints the gain of the other designs at the largest number of runs: ratios of the replicates' variances.
/// The variance of the mean of independent draws is known, σ²/n, and not estimated.
void print_gains(const std::vector<Point>& points, const Study& study, long n) {
  std::map<std::tuple<DesignKind, std::string, std::size_t>, double> spread;
  for (const Point& point : points)
    if (point.n == n) spread[{point.design, point.output, point.statistic}] = point.error.spread;
  for (std::size_t i = 0; i < study.names().size(); ++i)
    spread[{DesignKind::random, study.names()[i], 0}] =
        study.reference(i, 1) / std::sqrt(static_cast<double>(n));
  fmt::print("Variance of independent draws over the design's, {} runs\n  {:<18}{:<18}", n,
             "output", "design");
  for (const char* name : statistic_names) fmt::print("{:>9}", name);
  fmt::print("\n");
  for (const auto& [key, value] : spread) {
    const auto& [design, output, statistic] = key;
    if (design == DesignKind::random) continue;
    if (statistic == 0) fmt::print("  {:<18}{:<18}", output, name_of(design));
    fmt::print("{:>9.1f}", std::pow(spread.at({DesignKind::random, output, statistic}) / value, 2));
    if (statistic + 1 == statistic_names.size()) fmt::print("\n");
  }
}

int carry_out(const Options& options) {
  const Study study(read_campaign_file(options.campaign), options);
  const std::vector<Point> points = study.measure();
  const std::filesystem::path folder = options.out, file = folder / "design_error.csv";
  make_folder(folder);
  write_file(file, csv_text(points, study, options.replicates));
  print_gains(points, study, options.most);
  fmt::print("{}\n", file.string());
  return 0;
}

/// The defaults of the mode, full or quick, for options that are not given.
void complete(Options& options) {
  const auto or_else = [](long& number, long fallback) { number = number > 0 ? number : fallback; };
  or_else(options.replicates, options.quick ? 8 : 16);
  or_else(options.most, options.quick ? 512 : 4096);
  options.most =
      fewest * static_cast<long>(std::bit_floor(static_cast<unsigned long>(options.most / fewest)));
  or_else(options.reference, options.quick ? 8192 : 131'072);
  if (options.out.empty())
    options.out = options.quick ? "results/design_error_quick" : "results/design_error";
}

} // namespace

int main(int count, char** arguments) {
  Options options;
  CLI::App app("How the error of a campaign's statistics falls with the runs, design by design");
  app.add_option("--campaign", options.campaign, "Whose latch rates")->capture_default_str();
  app.add_flag("--quick", options.quick, "8 replicates of up to 512 runs, a coarse reference");
  app.add_option("--replicates", options.replicates, "Of each design (default: 16)")
      ->check(CLI::Range(2L, 10'000L));
  app.add_option("--runs", options.most,
                 "Largest number of a replicate (default: 4096), rounded down to 64, 128, 256, …")
      ->check(CLI::Range(fewest, 1'000'000L));
  app.add_option("--reference", options.reference,
                 "Runs of the Sobol' campaign that errors are measured from (default: 131072)")
      ->check(CLI::Range(fewest, 100'000'000L));
  app.add_option("--out", options.out,
                 "Folder; results/design_error by default, with --quick …_quick");
  CLI11_PARSE(app, count, arguments);
  complete(options);
  try {
    return carry_out(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 2;
  }
}
