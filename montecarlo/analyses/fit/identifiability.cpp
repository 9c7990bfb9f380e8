#include "montecarlo/analyses/fit/identifiability.hpp"

#include "distributions/decompositions.hpp"

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace wingspread {
namespace {

/// "0.71 spring − 0.70 friction".
std::string combination(const Eigen::VectorXd& weights, const std::vector<std::string>& names,
                        const std::vector<Eigen::Index>& which) {
  std::string text;
  for (const Eigen::Index i : which) {
    const bool minus = weights[i] < 0;
    text += text.empty() ? (minus ? "−" : "") : (minus ? " − " : " + ");
    text += fmt::format("{:.2f} {}", std::abs(weights[i]), names[static_cast<std::size_t>(i)]);
  }
  return text;
}

double log_determinant(const Eigen::MatrixXd& matrix) {
  return 2 * Eigen::MatrixXd(matrix.llt().matrixL()).diagonal().array().log().sum();
}

} // namespace

std::vector<FitDirection> directions_of(const Eigen::MatrixXd& covariance,
                                        const Eigen::MatrixXd& prior) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance, prior);
  std::vector<FitDirection> directions;
  for (Eigen::Index k = covariance.rows(); k-- > 0;) {
    FitDirection direction{solver.eigenvectors().col(k).normalized(),
                           std::sqrt(std::max(0.0, solver.eigenvalues()[k]))};
    Eigen::Index largest = 0;
    direction.weights.cwiseAbs().maxCoeff(&largest);
    if (direction.weights[largest] < 0) direction.weights = -direction.weights;
    directions.push_back(std::move(direction));
  }
  return directions;
}

std::string describe(const FitDirection& direction, const std::vector<std::string>& names,
                     const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& prior) {
  std::vector<Eigen::Index> which;
  for (Eigen::Index i = 0; i < direction.weights.size(); ++i)
    if (std::abs(direction.weights[i]) >= named_weight) which.push_back(i);
  const auto name = [&](std::size_t k) { return names[static_cast<std::size_t>(which[k])]; };
  if (which.size() == 1)
    return fmt::format("the tests do not see {}: its sd stays {:.2f} of the prior's", name(0),
                       direction.std_ratio);
  const auto unseen = [&] {
    return fmt::format("the tests do not see {}: its sd stays {:.2f} of the prior's",
                       combination(direction.weights, names, which), direction.std_ratio);
  };
  if (which.size() != 2) return unseen();
  Eigen::VectorXd seen = Eigen::VectorXd::Zero(direction.weights.size());
  seen[which[0]] = -direction.weights[which[1]], seen[which[1]] = direction.weights[which[0]];
  seen.normalize();
  const double sd = std::sqrt(seen.dot(covariance * seen) / seen.dot(prior * seen));
  const auto own = [&](Eigen::Index i) { return std::sqrt(covariance(i, i) / prior(i, i)); };
  if (!(sd < std::min({unseen_ratio, own(which[0]), own(which[1])}))) return unseen();
  const bool same_sign = direction.weights[which[0]] * direction.weights[which[1]] > 0;
  return fmt::format("the tests tell {} and {} only by their {}: sd of the {} {:.2f} of the "
                     "prior's, of the {} {:.2g}",
                     name(0), name(1), same_sign ? "difference" : "sum",
                     same_sign ? "sum" : "difference", direction.std_ratio,
                     same_sign ? "difference" : "sum", sd);
}

std::vector<double> widening_by_held(const FitData& data, const Prediction& prediction,
                                     TestRuns& runs, const FitPoint& at,
                                     const std::vector<std::size_t>& fitted,
                                     const Eigen::MatrixXd& covariance,
                                     const Eigen::MatrixXd& among_held,
                                     const Eigen::MatrixXd& coupling) {
  const Eigen::MatrixXd v = least_squares_jacobian(data, squares_of(data, prediction), runs, at);
  const auto own = static_cast<Eigen::Index>(fitted.size());
  Eigen::MatrixXd seen(v.rows(), own), held(v.rows(), v.cols() - own);
  for (Eigen::Index column = 0, k = 0, h = 0; column < v.cols(); ++column)
    if (std::ranges::find(fitted, static_cast<std::size_t>(column)) != fitted.end())
      seen.col(k++) = v.col(column);
    else
      held.col(h++) = v.col(column);
  const Eigen::MatrixXd shift =
      coupling * (seen.transpose() * seen).llt().solve(seen.transpose() * held);
  const Eigen::MatrixXd of_scores = coupling * covariance * coupling.transpose();
  std::vector<double> widening;
  for (Eigen::Index k = 0; k < own; ++k)
    widening.push_back(std::sqrt(1 + std::max(0.0, shift.row(k).dot(shift.row(k) * among_held)) /
                                         of_scores(k, k)));
  return widening;
}

std::vector<CandidateGain> candidate_gains(std::span<const FitTest> candidates, TestRuns& runs,
                                           const FitMode& mode, const Eigen::MatrixXd& coupling) {
  const Eigen::MatrixXd slopes = jacobian_of(runs, mode.at);
  const FitData data = data_of(candidates);
  const Eigen::Index size = mode.at.size();
  const Eigen::MatrixXd before = mode.covariance.llt().solve(Eigen::MatrixXd::Identity(size, size));
  const auto of_scores = [&](const Eigen::MatrixXd& covariance) {
    return Eigen::MatrixXd(coupling * covariance * coupling.transpose());
  };
  std::vector<CandidateGain> gains;
  for (std::size_t t = 0; t < candidates.size(); ++t) {
    Eigen::MatrixXd information = before;
    for (const Channel& channel : data.channels) {
      if (channel.test != t) continue;
      const Eigen::MatrixXd j = slopes.middleRows(static_cast<Eigen::Index>(channel.first),
                                                  static_cast<Eigen::Index>(channel.count));
      const double precision = 1 / (*channel.std * *channel.std);
      information += precision * j.transpose() * j;
      if (channel.offset_std > 0) { // Sherman–Morrison: (σ² I + s² 1 1ᵀ)⁻¹
        const Eigen::VectorXd sum = j.colwise().sum().transpose();
        const double n = static_cast<double>(channel.count);
        information -= precision * precision /
                       (1 / (channel.offset_std * channel.offset_std) + n * precision) * sum *
                       sum.transpose();
      }
    }
    const Eigen::MatrixXd after = information.llt().solve(Eigen::MatrixXd::Identity(size, size));
    CandidateGain gain{
        candidates[t].name, 0.5 * (log_determinant(mode.covariance) - log_determinant(after)), {}};
    for (Eigen::Index i = 0; i < size; ++i)
      gain.shrink.push_back(std::sqrt(of_scores(after)(i, i) / of_scores(mode.covariance)(i, i)));
    gains.push_back(std::move(gain));
  }
  return gains;
}

} // namespace wingspread
