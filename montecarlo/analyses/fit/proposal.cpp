#include "montecarlo/analyses/fit/proposal.hpp"

#include "distributions/continuous_law.hpp"
#include "distributions/random_stream.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace wingspread {
namespace {

// All heuristic. A bad choice makes a bad proposal: the chains get longer, but stay right.
constexpr double step = 1.5; // of the quadratic's runs in z, within most of a normal posterior
constexpr std::size_t trials = 32;      // draws by which a quadratic is judged
constexpr double good_acceptance = 0.7; // with a lower one, a cubic is fitted
constexpr double runs_of_a_term = 3;    // of the cubic
constexpr std::size_t most_terms = 600; // d = 13: the cubic takes up to 1800 runs

/// Points z of the runs for the quadratic: 0; ±step in each coordinate; ±step in both coordinates of each pair.
std::vector<Eigen::VectorXd> design_of(Eigen::Index d) {
  std::vector<Eigen::VectorXd> points{Eigen::VectorXd::Zero(d)};
  for (const double sign : {step, -step})
    for (Eigen::Index i = 0; i < d; ++i) {
      points.emplace_back(sign * Eigen::VectorXd::Unit(d, i));
      for (Eigen::Index j = i + 1; j < d; ++j)
        points.emplace_back(sign * (Eigen::VectorXd::Unit(d, i) + Eigen::VectorXd::Unit(d, j)));
    }
  return points;
}

/// Mean probability that an independent move between two of the points is accepted. @param log_ratios log π − log q
double acceptance_between(const std::vector<double>& log_ratios) {
  double sum = 0;
  for (const double from : log_ratios)
    for (const double to : log_ratios)
      if (std::isfinite(from)) sum += std::min(1.0, std::exp(to - from));
  return sum / static_cast<double>(log_ratios.size() * log_ratios.size());
}

bool is_complete(const Prediction& prediction) {
  return std::ranges::all_of(prediction, [](double number) { return std::isfinite(number); });
}

/// Makes the part of the mixture that belongs to one mode: first a quadratic; a cubic if that is not good enough.
class PartMaker {
public:
  PartMaker(const FitMode& mode, const FitData& data, TestRuns& runs, std::uint64_t seed)
      : mode_(mode), data_(data), runs_(runs), seed_(seed),
        squares_(squares_of(data, mode.prediction)), factor_(mode.covariance.llt().matrixL()),
        project_((least_squares_jacobian(data, squares_, runs, mode.at) * factor_).transpose()) {
    part_ = {
        mode.log_posterior + factor_.diagonal().array().log().sum(), mode.at, mode.covariance, {}};
  }

  StudentMixture::Part make() {
    const auto d = static_cast<std::size_t>(mode_.at.size());
    std::vector<FitPoint> points;
    for (const Eigen::VectorXd& z : design_of(mode_.at.size()))
      points.emplace_back(mode_.at + factor_ * z);
    (void)add(points);
    if (z_.size() < PolynomialMap::terms(d, 2)) return part_; // numbers are missing near the mode
    part_.bend.emplace(z_, xi_, 2);
    const std::size_t terms = PolynomialMap::terms(d, 3);
    const std::vector<FitPoint> first = draws(trials);
    if (first.size() < trials / 2) { // the map folds near the mode: most ξ have no z
      part_.bend.reset();
      return part_;
    }
    if (acceptance_of(first) >= good_acceptance || terms > most_terms) return part_;
    (void)add(draws(static_cast<std::size_t>(runs_of_a_term * static_cast<double>(terms))));
    if (z_.size() <= 2 * terms) return part_;
    const PolynomialMap quadratic = *part_.bend;
    part_.bend.emplace(z_, xi_, 3);
    if (draws(trials).size() < trials / 2) part_.bend = quadratic;
    return part_;
  }

private:
  /// Makes runs at the points and keeps their ξ. @return log π
  std::vector<double> add(const std::vector<FitPoint>& points) {
    std::vector<double> logs;
    const std::vector<Prediction> predictions = runs_.predict(points, RunAccuracy::campaign);
    for (std::size_t k = 0; k < points.size(); ++k) {
      logs.push_back(log_posterior(data_, points[k], predictions[k]));
      if (!is_complete(predictions[k])) continue;
      z_.emplace_back(factor_.triangularView<Eigen::Lower>().solve(points[k] - mode_.at));
      xi_.emplace_back(project_ * least_squares(data_, squares_, points[k], predictions[k]));
    }
    return logs;
  }

  std::vector<FitPoint> draws(std::size_t count) {
    const StudentMixture law({part_});
    std::vector<FitPoint> points;
    for (std::size_t k = 0; k < count; ++k) {
      RandomStream random(seed_, streams_++,
                          stream_name("\x7F"
                                      "proposal"));
      FitPoint point = law.draw([&] { return open_uniform(random()); });
      if (point.allFinite()) points.push_back(std::move(point));
    }
    return points;
  }

  double acceptance_of(const std::vector<FitPoint>& points) {
    const StudentMixture law({part_});
    std::vector<double> log_ratios = add(points);
    for (std::size_t k = 0; k < points.size(); ++k) log_ratios[k] -= law.log_density(points[k]);
    return points.empty() ? 0 : acceptance_between(log_ratios);
  }

  const FitMode& mode_;
  const FitData& data_;
  TestRuns& runs_;
  std::uint64_t seed_, streams_ = 0;
  std::vector<double> squares_;
  Eigen::MatrixXd factor_, project_; ///< L, (V L)ᵀ
  StudentMixture::Part part_;
  std::vector<Eigen::VectorXd> z_, xi_; ///< of the runs made
};

} // namespace

StudentMixture proposal_about(const std::vector<FitMode>& modes, const FitData& data,
                              TestRuns& runs, std::uint64_t seed) {
  std::vector<StudentMixture::Part> parts;
  for (const FitMode& mode : modes) parts.push_back(PartMaker(mode, data, runs, seed).make());
  return StudentMixture(parts);
}

} // namespace wingspread
