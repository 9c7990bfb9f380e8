/// Predictions of all measured numbers at points of the parameter space, by runs of the tests.
///
/// A trace is compared at its own times. A run is sampled on a fixed grid by the integrator's dense output. Between the
/// grid's times, angles and rates are those of cubic Hermite polynomials of angle and rate, other columns are linear.
/// With a fixed grid the prediction is as smooth in the parameters as the motion. The integrator's steps are no such
/// grid, because they move with the parameters.
/// Interpolation error of an angle: h⁴/384 times its fourth derivative, and about h²/50 times the jump of an
/// acceleration at a latch; of a moment: h²/8 times its second derivative, and up to half its jump at a latch.
/// choose_intervals makes h so small that the errors do not count beside the noise.
///
/// Values that are outputs come from separate runs, which end once the outputs are known.
#pragma once

#include "montecarlo/analyses/fit/parameter_space.hpp"
#include "montecarlo/engine/runs/evaluator.hpp"

#include <memory>
#include <span>
#include <vector>

namespace wingspread {

/// Consecutive measured numbers with one noise: a column of a trace, or a value.
struct Channel {
  std::size_t test = 0;
  std::optional<std::size_t> column{}; ///< of a trace; nothing: a value
  std::size_t value = 0;
  std::size_t first = 0, count = 0; ///< among all numbers
  std::optional<double> std{};
  double offset_std = 0;
  double effective =
      0; ///< n_eff: independent numbers with the same information; tempers the likelihood
};

/// All measured numbers, test by test: columns, then values.
struct FitData {
  std::vector<double> measured;
  std::vector<Channel> channels;
};
[[nodiscard]] FitData data_of(std::span<const FitTest> tests);

/// Numbers in the order of FitData::measured; NaN where the run failed or the output did not happen.
using Prediction = std::vector<double>;

/// The accuracy of runs: as the campaign asks, or good enough to be differentiated (rtol ≤ 1e-10).
enum class RunAccuracy { campaign, derivative };

/// Interpolation may add so much to the χ² of a test. Heuristic: a parameter then moves by at most √0.01 = 0.1 standard
/// deviations, if all errors act on it alone.
inline constexpr double most_interpolated = 0.01;

/// Sets FitTest::interval of every test with a trace, and what interpolation adds to its χ². The interval is halved until
/// that is no more than most_interpolated in half of the runs at `points`. Times that are multiples of one step, on a
/// clock without an offset, need no interpolation: if grid_interval is too coarse, they are the grid. A run keeps at most
/// 80,000 numbers; where this stops the search, `interpolation` stays larger.
/// A column of unknown noise has that of its second differences. @return the number of runs made. @throws Stopped
[[nodiscard]] long choose_intervals(std::vector<FitTest>& tests,
                                    const std::vector<std::size_t>& fitted,
                                    const ParameterSpace& space, Evaluator& evaluator,
                                    std::span<const FitPoint> points, bool are_candidates = false);

class TestRuns {
public:
  /// @param fitted indices of fitted dispersions
  /// @param are_candidates whether the tests are candidates, which have no parameters and offsets of their own
  /// @pre all arguments outlive this object
  TestRuns(std::span<const FitTest> tests, const std::vector<std::size_t>& fitted,
           const ParameterSpace& space, Evaluator& evaluator, bool are_candidates = false);
  TestRuns(const TestRuns&) = delete;
  TestRuns& operator=(const TestRuns&) = delete;
  ~TestRuns();

  /// The predictions at the points, in their order, made on all threads and ranks at once. @throws Stopped
  [[nodiscard]] std::vector<Prediction> predict(std::span<const FitPoint> points,
                                                RunAccuracy accuracy);
  /// Number of runs made.
  [[nodiscard]] long runs() const { return runs_; }
  [[nodiscard]] std::size_t numbers() const { return numbers_; }

private:
  struct Prepared;

  const ParameterSpace& space_;
  Evaluator& evaluator_;
  const bool are_candidates_;
  std::span<const FitPoint> points_;                             ///< the points of the plans' runs
  std::vector<std::vector<std::unique_ptr<Prepared>>> prepared_; ///< by accuracy and test
  std::size_t numbers_ = 0;
  long runs_ = 0;

  void make_runs(const RunPlan& plan, std::size_t count,
                 const std::function<void(const ResultRow&)>& take);
  void make_values(const Prepared& prepared, std::vector<Prediction>& predictions);
  void make_trace(const Prepared& prepared, std::vector<Prediction>& predictions);
};

} // namespace wingspread
