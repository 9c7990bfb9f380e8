// The statistics without rows against those of the rows themselves: of made-up runs, of which there can be many.
#include "montecarlo/results/streaming/streaming_summary.hpp"
#include "montecarlo/results/summary/judge_campaign.hpp"
#include "montecarlo/results/summary/summary_json.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>

using namespace wingspread;
using namespace wingspread::test;

namespace {

constexpr long made_up = 40'000;

Campaign required_campaign() {
  Json json = full_campaign(static_cast<int>(made_up));
  json["outputs"].push_back("final_angle");
  json["requirements"] = parse_json(R"([
    { "output": "deployed", "probability": 0.9, "confidence": 0.9 },
    { "output": "root.peak_moment", "max": 3, "probability": 0.5, "confidence": 0.9 },
    { "output": "root.peak_moment", "max": 2, "probability": 0.9973, "confidence": 0.9 },
    { "output": "mid.latch_rate", "max": 1.5, "abs": true, "probability": 0.5, "confidence": 0.9 },
    { "output": "tip.latch_time", "min": -2, "probability": 0.6, "confidence": 0.9 },
    { "output": "root.peak_moment", "min": 0.5, "probability": 0.5, "confidence": 0.9 },
    { "motorization": "NASA", "hinge": "*", "min": 0.5, "probability": 0.7, "confidence": 0.9 } ])");
  json["statistics"] = parse_json(R"({ "quantiles": [0.001, 0.1, 0.5, 0.9, 0.999],
    "tolerance": [{ "probability": 0.9, "confidence": 0.9, "side": "both" },
      { "probability": 0.6, "confidence": 0.9 }, { "probability": 0.6, "confidence": 0.9, "side": "lower" }] })");
  return campaign_of(json);
}

/// A run with normal outputs, a tenth of them missing, of every status.
ResultRow made_up_row(const ResultNames& names, long run) {
  std::mt19937_64 random(static_cast<std::uint64_t>(run) * 0x9e3779b97f4a7c15 + 1);
  std::normal_distribution<double> normal;
  const auto share = [&] { return std::uniform_real_distribution<double>(0, 1)(random); };
  ResultRow row;
  row.run = run;
  const double kind = share();
  row.status = kind < 0.93   ? Status::deployed
               : kind < 0.96 ? Status::stalled
               : kind < 0.98 ? Status::timed_out
               : kind < 0.99 ? Status::invalid
                             : Status::failed;
  row.draws.push_back(1 + 0.05 * normal(random));
  for (std::size_t i = 1; i < names.draws.size(); ++i)
    row.draws.push_back(10 + 0.1 * normal(random));
  for (std::size_t i = 0; i < names.outputs.size(); ++i)
    row.outputs.push_back(
        share() < 0.1 ? undefined : static_cast<double>(i) / 7 + row.draws[0] + normal(random));
  row.latch_order = kind > 0.97 ? "" : share() < 0.7 ? "root>mid>tip" : "mid>root>tip";
  if (row.status == Status::invalid)
    row.reason = "bodies.panel_1.mass is " + std::to_string(-share()) + ", expected > 0";
  if (row.status == Status::stalled)
    row.reason = share() < 0.5 ? "friction holds tip" : "root turns back";
  row.peaks_final = row.status >= Status::invalid ? PeaksFinal::unknown
                    : share() < 0.98              ? PeaksFinal::yes
                    : share() < 0.8               ? PeaksFinal::no
                    : share() < 0.5               ? PeaksFinal::moments
                                                  : PeaksFinal::forces;
  return row;
}

/// The same runs with their rows and without. Making them takes seconds: one test case asks all.
struct Both {
  Campaign campaign = required_campaign();
  StoredCampaign stored{"nowhere", campaign, stamp_of(campaign, {})};
  ResultNames names = RunPlan(stored.campaign).names();
  Results rows{names};
  std::vector<Column> margins = made_margins();
  long kept = 0;
  StreamingStatistics whole = whole_statistics();
  Summary full = summarize(rows, spec(), {}, 0, stored.campaign.requirements),
          found = streaming_summary(stored, whole, spec());

  [[nodiscard]] const StatisticsSpec& spec() const { return stored.campaign.statistics; }

  std::vector<Column> made_margins() {
    for (long run = 0; run < made_up; ++run) rows.append(made_up_row(names, run));
    return static_margin_columns(stored.campaign, rows);
  }

  [[nodiscard]] StreamingStatistics empty_statistics() const {
    Results pilot(names);
    for (std::size_t i = 0; i < 4096; ++i) pilot.append(rows.row(i));
    return {stored.campaign, names, pilot};
  }

  bool add(StreamingStatistics& statistics, std::size_t row) const {
    std::vector<double> of_row;
    for (const Column& column : margins) of_row.push_back(column.values[row]);
    return statistics.add(rows.row(row), of_row);
  }

  StreamingStatistics whole_statistics() {
    StreamingStatistics statistics = empty_statistics();
    for (std::size_t row = 0; row < rows.size(); ++row) kept += add(statistics, row);
    return statistics;
  }
};

std::string bytes_of(const StreamingStatistics& statistics) {
  StateWriter to;
  statistics.write(to);
  return std::move(to).finish();
}

/// A deployed run, all of whose outputs have the value.
ResultRow even_row(const ResultNames& names, long run, double value) {
  return {run,
          Status::deployed,
          std::vector<double>(names.draws.size(), 1.0),
          std::vector<double>(names.outputs.size(), value),
          "root>mid>tip",
          ""};
}

/// a ≤ b where there are both; none where there is none.
bool holds(std::optional<double> a, std::optional<double> b) {
  return a.has_value() == b.has_value() && (!a || *a <= *b);
}

/// A quantile without rows and with them.
void check_near(const QuantileValue& a, const QuantileValue& b) {
  CHECK(a.error.has_value() == !std::isnan(b.value));
  if (a.error) CHECK((a.error->lower <= b.value && b.value <= a.error->upper));
  if (a.error)
    CHECK(a.error->rank <=
          20); // of 36,000 values 2^-13 deviations apart: 36,000 · 0.4/4096 and chance
  CHECK(holds(a.bounds.lower, b.bounds.lower));
  CHECK(holds(b.bounds.upper, a.bounds.upper));
  if (a.bounds.upper) CHECK(*a.bounds.upper - *b.bounds.upper < 1e-3);
  if (a.bounds.lower) CHECK(*b.bounds.lower - *a.bounds.lower < 1e-3);
}

void check_counts_and_moments(const Both& made) {
  const Summary &full = made.full, &found = made.found;
  REQUIRE(found.runs == made_up);
  for (std::size_t i = 0; i < full.statuses.size(); ++i) {
    CHECK(found.statuses[i].count == full.statuses[i].count);
    CHECK(found.statuses[i].bounds.upper == full.statuses[i].bounds.upper);
  }
  REQUIRE(found.reasons.size() == full.reasons.size());
  for (std::size_t i = 0; i < full.reasons.size(); ++i) {
    CHECK(found.reasons[i].reason == full.reasons[i].reason);
    CHECK(found.reasons[i].count == full.reasons[i].count);
  }
  REQUIRE(found.latch_orders.size() == full.latch_orders.size());
  CHECK(found.latch_orders[1].count == full.latch_orders[1].count);
  CHECK(found.without_latch == full.without_latch);
  REQUIRE(found.outputs.size() == full.outputs.size());
  for (std::size_t i = 0; i < full.outputs.size(); ++i) {
    const Moments &a = found.outputs[i].moments, &b = full.outputs[i].moments;
    CHECK(a.count == b.count);
    CHECK(found.outputs[i].missing == full.outputs[i].missing);
    CHECK(a.min == b.min);
    CHECK(a.max == b.max);
    CHECK(a.mean == Approx(b.mean).epsilon(1e-14).margin(1e-14)); // of values of order 1
    CHECK(a.std == Approx(b.std).epsilon(1e-13));
    CHECK(a.skewness == Approx(b.skewness).margin(1e-12));
    CHECK(a.kurtosis == Approx(b.kurtosis).margin(1e-12));
  }
  REQUIRE(found.correlations.size() == full.correlations.size());
  for (std::size_t i = 0; i < full.correlations.size(); ++i) {
    CHECK(found.correlations[i].output == full.correlations[i].output);
    CHECK(found.correlations[i].value.count == full.correlations[i].value.count);
    CHECK(found.correlations[i].value.pearson ==
          Approx(full.correlations[i].value.pearson).margin(1e-12));
  }
}

void check_stopped_hinges(const Both& made) {
  const std::vector<StoppedHinge>&full = made.full.stalled_at, &found = made.found.stalled_at;
  REQUIRE(full.size() == 3);
  REQUIRE(found.size() == full.size());
  for (std::size_t i = 0; i < full.size(); ++i) {
    CHECK(full[i].runs > 50); // of 1,200 that stalled, a tenth without a latch time
    CHECK(full[i].least < full[i].median);
    CHECK(found[i].hinge == full[i].hinge);
    CHECK(found[i].runs == full[i].runs);
    CHECK(found[i].median == full[i].median);
    CHECK(found[i].least == full[i].least);
    CHECK(found[i].largest == full[i].largest);
  }
}

void check_quantiles(const Both& made) {
  const StatisticsSpec& spec = made.spec();
  const Summary &full = made.full, &found = made.found;
  int absent = 0, existing = 0;
  for (std::size_t i = 0; i < full.outputs.size(); ++i) {
    CAPTURE(full.outputs[i].name);
    CHECK(found.outputs[i].missing_end == full.outputs[i].missing_end);
    for (std::size_t k = 0; k < spec.quantiles.size(); ++k) {
      const QuantileEstimate &a = found.outputs[i].quantiles[k], &b = full.outputs[i].quantiles[k];
      CHECK(std::isnan(a.all.value) == std::isnan(b.all.value));
      CHECK(why_no_quantile(found.outputs[i], a) == why_no_quantile(full.outputs[i], b));
      ++(std::isnan(a.all.value) ? absent : existing);
      check_near(a.all, b.all);
      REQUIRE((a.among && b.among));
      check_near(*a.among, *b.among);
    }
    CHECK(found.outputs[i].quantiles[0].among->value ==
          full.outputs[i].quantiles[0].among->value); // an extreme
    std::vector<double> ordered;
    for (const double value : made.rows.outputs[i].values)
      if (!std::isnan(value)) ordered.push_back(value);
    std::ranges::sort(ordered);
    const Histogram& histogram = found.outputs[i].histogram;
    CHECK(std::ssize(histogram.counts) == std::ssize(full.outputs[i].histogram.counts));
    for (std::size_t bin = 0; bin < histogram.counts.size(); ++bin) {
      const bool last = bin + 1 == histogram.counts.size();
      const double lower = histogram.edges[bin], upper = histogram.edges[bin + 1];
      const auto end = last ? std::ranges::upper_bound(ordered, upper)
                            : std::ranges::lower_bound(ordered, upper);
      CHECK(histogram.counts[bin] == end - std::ranges::lower_bound(ordered, lower));
      if (last) continue;
      const double wanted =
          std::lerp(histogram.edges.front(), histogram.edges.back(),
                    static_cast<double>(bin + 1) / static_cast<double>(histogram.counts.size()));
      double nearest = std::numeric_limits<double>::infinity();
      for (const auto& stored : made.whole.outputs()[i].values.counts().bins())
        nearest =
            std::min({nearest, std::abs(stored.lower - wanted), std::abs(stored.upper - wanted)});
      CHECK(std::abs(upper - wanted) <= nearest); // no stored edge is nearer to that of equal bins
    }
  }
  CHECK((absent > 5 && existing > 20)); // or the test has lost its variety
}

void check_verdicts(const Both& made) {
  const Summary& found = made.found;
  const std::vector<Verdict> full = judge_campaign(made.stored.campaign, made.rows);
  REQUIRE(found.requirements.size() == full.size());
  std::set<long> broken;
  for (std::size_t i = 0; i < made.rows.size(); ++i)
    if (made.rows.status[i] != Status::deployed) broken.insert(made.rows.runs[i]);
  bool passed = false, failed = false;
  for (std::size_t i = 0; i < full.size(); ++i) {
    const Verdict &a = found.requirements[i], &b = full[i];
    CAPTURE(to_string(b.requirement));
    CHECK(a.decision == b.decision);
    CHECK(a.failures() == b.failures());
    CHECK((a.cut == b.cut && a.open == b.open && a.disproved == b.disproved));
    CHECK(a.allowed == b.allowed);
    CHECK(evidence(a) == evidence(b));
    CHECK(a.guaranteed_share == b.guaranteed_share);
    CHECK(std::ssize(a.broken) == std::min<long>(b.failures(), most_broken));
    CHECK(std::equal(a.broken.begin(), a.broken.end(), b.broken.begin()));
    const bool is_min = b.requirement.min.has_value();
    if (b.requirement.output != "deployed")
      CHECK((is_min ? holds(a.guaranteed, b.guaranteed) : holds(b.guaranteed, a.guaranteed)));
    CHECK(a.margin.has_value() == b.margin.has_value());
    if (a.margin) CHECK((*a.margin >= 0) == (a.decision == Decision::pass));
    if (a.margin) CHECK(*a.margin == Approx(*b.margin).margin(1e-3));
    if (a.observed) CHECK(*a.observed == Approx(*b.observed).margin(1e-3));
    broken.insert(b.broken.begin(), b.broken.end());
    passed = passed || b.decision == Decision::pass;
    failed = failed || b.decision == Decision::fail;
  }
  CHECK((passed && failed)); // or the test has lost its variety
  CHECK(made.kept == std::ssize(broken));
}

void check_tolerance_limits(const Both& made) {
  const Summary& found = made.found;
  for (std::size_t i = 0; i < found.outputs.size(); ++i) {
    const RankedOutput ranks(made.rows, made.rows.outputs[i]);
    REQUIRE(found.outputs[i].tolerance_limits.size() == 3);
    for (const auto& [limit, limits, beyond] : found.outputs[i].tolerance_limits) {
      const Bounds full = output_limits(ranks, limit);
      CHECK((beyond >= 0 && beyond < static_cast<long>(made.rows.size())));
      CHECK(holds(limits.lower, full.lower));
      CHECK(holds(full.upper, limits.upper));
      if (full.upper) CHECK(*limits.upper - *full.upper < 1e-3);
    }
  }
}

void check_bytes_in_any_order(const Both& made) {
  const std::string whole = bytes_of(made.whole);
  std::vector<std::size_t> order(made.rows.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), std::mt19937(1));
  StreamingStatistics parts[3] = {made.empty_statistics(), made.empty_statistics(),
                                  made.empty_statistics()};
  for (std::size_t i = 0; i < order.size(); ++i)
    made.add(parts[i < 11 ? 0 : i < 30'001 ? 1 : 2], order[i]);
  parts[2].add(parts[0]);
  StateReader from(bytes_of(parts[2]), "state");
  StreamingStatistics read(made.stored.campaign, made.names, from);
  CHECK(from.at_end());
  read.add(parts[1]);
  CHECK((bytes_of(read) == whole)); // printed, a difference takes minutes
}

} // namespace

TEST_CASE("without rows: what the rows say, in any order") {
  static const Both made; // for all sections
  SECTION("counts, moments and correlations are those of the rows") {
    check_counts_and_moments(made);
  }
  SECTION("hinges stopped where the rows say") { check_stopped_hinges(made); }
  SECTION("quantiles are within what they say, and bounds hold those of the rows") {
    check_quantiles(made);
  }
  SECTION("verdicts are those of the rows, and what they guarantee is no less safe") {
    check_verdicts(made);
  }
  SECTION("tolerance limits hold those of the rows") { check_tolerance_limits(made); }
  SECTION("the same bytes however runs are shared out, and read back") {
    check_bytes_in_any_order(made);
  }
}

// The grid is that of pilot runs with small values: at 1000 its bins are wider than the 40 asked for, and their edges are
// the nearest to several of these.
TEST_CASE("a histogram without rows has no bin without width") {
  constexpr long runs = 101;
  Json json = quick_campaign(static_cast<int>(runs));
  json["statistics"] = {{"bins", 40}};
  const Campaign campaign = campaign_of(json);
  const ResultNames names = RunPlan(campaign).names();
  const auto row = [&](long run, double value) { return even_row(names, run, value); };
  Results pilot(names);
  for (long run = 0; run < runs; ++run) pilot.append(row(run, 1e-5 * static_cast<double>(run)));
  StreamingStatistics statistics(campaign, names, pilot);
  for (long run = 0; run < runs; ++run)
    (void)statistics.add(row(run, 1000 + static_cast<double>(run)), {});
  const Summary found =
      streaming_summary({"r", campaign, stamp_of(campaign, {})}, statistics, campaign.statistics);
  REQUIRE_FALSE(found.outputs.empty());
  for (const OutputSummary& output : found.outputs) {
    const auto& [edges, counts] = output.histogram;
    REQUIRE(edges.size() == counts.size() + 1);
    CHECK((edges.front() == 1000 && edges.back() == 1100));
    CHECK((counts.size() > 2 && counts.size() < 40));
    CHECK(std::ranges::adjacent_find(edges, std::ranges::greater_equal{}) == edges.end());
    CHECK(std::accumulate(counts.begin(), counts.end(), 0L) == runs);
  }
}

TEST_CASE("without rows a passed requirement's quantiles are not beyond its limit, an atom too") {
  constexpr long runs = 600;
  std::mt19937_64 random(9);
  for (int trial = 0; trial < 30; ++trial) {
    const double limit = std::uniform_real_distribution<double>(1, 4)(random);
    CAPTURE(limit);
    Json json = quick_campaign(static_cast<int>(runs));
    json["requirements"] = {
        {{"output", "root.latch_time"}, {"max", limit}, {"probability", 0.65}, {"confidence", 0.9}},
        {{"output", "root.latch_time"},
         {"min", limit},
         {"probability", 0.55},
         {"confidence", 0.9}}};
    const Campaign campaign = campaign_of(json);
    const ResultNames names = RunPlan(campaign).names();
    const auto row = [&](long run) { // 40 % below the limit, 30 % at it, 30 % above
      return even_row(names, run, limit + (run % 10 < 4 ? -0.1 : run % 10 < 7 ? 0 : 0.1));
    };
    Results pilot(names);
    for (long run = 0; run < 300; ++run) pilot.append(row(run));
    StreamingStatistics statistics(campaign, names, pilot);
    for (long run = 0; run < runs; ++run) (void)statistics.add(row(run), {});
    const Summary found =
        streaming_summary({"r", campaign, stamp_of(campaign, {})}, statistics, campaign.statistics);
    for (const Verdict& verdict : found.requirements) {
      REQUIRE(verdict.decision == Decision::pass);
      CHECK(verdict.observed == limit);
      CHECK(verdict.guaranteed == limit);
      CHECK(verdict.margin == 0.0);
    }
  }
}

TEST_CASE("without rows there are as many kinds of latch orders as with them, listed or not") {
  const Campaign campaign = campaign_of(quick_campaign(10));
  const ResultNames names = RunPlan(campaign).names();
  for (const std::size_t kinds : {std::size_t{3}, most_latch_orders, most_latch_orders + 7}) {
    Results rows(names);
    StreamingStatistics statistics(campaign, names, rows);
    for (std::size_t k = 0; k < kinds; ++k) {
      ResultRow row = even_row(names, static_cast<long>(k), 1);
      row.latch_order = "order" + std::to_string(k);
      (void)statistics.add(row, {});
    }
    const Summary found =
        streaming_summary({"r", campaign, stamp_of(campaign, {})}, statistics, campaign.statistics);
    CHECK(found.latch_order_kinds == static_cast<long>(kinds));
    CHECK(found.latch_orders.size() == std::min(kinds, most_latch_orders));
  }
}
