#include "montecarlo/analyses/sampler/ensemble_sampler.hpp"

#include "distributions/continuous_law.hpp"
#include "distributions/random_stream.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace wingspread {
namespace {

constexpr double stretch = 2;      // a of (1), Goodman and Weare's
constexpr long first_check = 64;   // steps before the first diagnosis; heuristic, as the next two
constexpr double next_check = 1.3; // growth between diagnoses
constexpr double discarded = 0.25; // share of the steps at the start
constexpr std::size_t most_in_group = 10; // walkers: if they never move, R̂ is 1.05 and more
constexpr std::size_t least_groups = 4;

/// Degrees of freedom of the proposal, whose tails must be heavier than the target's. With fixed degrees fewer moves
/// are accepted as d grows. For a normal target, 5 degrees accept 84 % at d = 3 and 67 % at d = 9; 2 d degrees accept
/// 87 % at d = 9.
int degrees_for(Eigen::Index d) { return std::max(5, 2 * static_cast<int>(d)); }

double normal_of(double u) { return inverse(Normal{}, tails_of_uniform(u)); }

class Walkers {
public:
  Walkers(const LogDensity& density, const StudentMixture& proposal, const EnsembleOptions& options)
      : density_(density), proposal_(proposal), options_(options), chains_(options.walkers) {
    for (std::size_t k = 0; k < options.walkers; ++k) {
      RandomStream random = stream(k);
      Eigen::VectorXd start;
      do start = proposal.draw([&] { return open_uniform(random()); });
      while (!start.allFinite());
      at_.push_back(std::move(start));
    }
    log_ = evaluate(at_);
  }

  /// Moves both halves once.
  void step() {
    ++steps_;
    const std::size_t half = options_.walkers / 2;
    move(0, half);
    move(half, options_.walkers);
    for (std::size_t k = 0; k < options_.walkers; ++k) chains_[k].push_back(at_[k]);
  }

  [[nodiscard]] long steps() const { return steps_; }
  [[nodiscard]] EnsembleState state() const {
    EnsembleState state{evaluations_, static_cast<double>(accepted_) / static_cast<double>(moves_),
                        std::numeric_limits<double>::infinity(), 0};
    for (Eigen::Index i = 0; i < at_.front().size(); ++i) {
      std::vector<std::vector<double>> chains(options_.walkers);
      for (std::size_t k = 0; k < options_.walkers; ++k)
        for (std::size_t n = first_kept(); n < chains_[k].size(); ++n)
          chains[k].push_back(chains_[k][n][i]);
      const ChainDiagnostics found =
          diagnose(chains, std::max(least_groups, options_.walkers / most_in_group));
      state.ess = std::min(state.ess, found.ess);
      state.r_hat = std::max(state.r_hat, found.r_hat);
    }
    return state;
  }

  [[nodiscard]] std::vector<std::vector<Eigen::VectorXd>> take_kept() {
    const auto first = static_cast<std::ptrdiff_t>(first_kept());
    for (auto& chain : chains_) chain.erase(chain.begin(), chain.begin() + first);
    return std::move(chains_);
  }

private:
  struct Candidate {
    Eigen::VectorXd at;
    double log_factor; ///< of (1) or (2), besides π
    double toss;       ///< for the acceptance
  };

  /// The random numbers of a walker in the current step.
  [[nodiscard]] RandomStream stream(std::size_t walker) const {
    return {options_.seed, walker,
            stream_name("\x7F"
                        "fit " +
                        std::to_string(steps_))};
  }

  std::vector<double> evaluate(std::span<const Eigen::VectorXd> points) {
    evaluations_ += std::ssize(points);
    return density_(points);
  }

  [[nodiscard]] std::size_t first_kept() const {
    return static_cast<std::size_t>(discarded * static_cast<double>(steps_));
  }

  [[nodiscard]] Candidate candidate_of(std::size_t k, std::size_t first, std::size_t last) const {
    RandomStream random = stream(k);
    const auto uniform = [&] { return open_uniform(random()); };
    const bool independent = uniform() < options_.independent;
    const double toss = uniform();
    if (independent) {
      Eigen::VectorXd y = proposal_.draw(uniform);
      if (!y.allFinite()) return {at_[k], 0, toss}; // stays
      const double factor = proposal_.log_density(at_[k]) - proposal_.log_density(y);
      return {std::move(y), factor, toss};
    }
    const std::size_t others = options_.walkers - (last - first);
    auto other = static_cast<std::size_t>(uniform() * static_cast<double>(others));
    if (first == 0) other += last; // the other half
    const double root = 1 / std::sqrt(stretch);
    const double z = std::pow(root + uniform() * (std::sqrt(stretch) - root), 2);
    return {at_[other] + z * (at_[k] - at_[other]),
            static_cast<double>(at_[k].size() - 1) * std::log(z), toss};
  }

  void move(std::size_t first, std::size_t last) {
    std::vector<Candidate> candidates;
    std::vector<Eigen::VectorXd> points;
    for (std::size_t k = first; k < last; ++k) {
      candidates.push_back(candidate_of(k, first, last));
      points.push_back(candidates.back().at);
    }
    const std::vector<double> there = evaluate(points);
    for (std::size_t k = first; k < last; ++k) {
      Candidate& candidate = candidates[k - first];
      ++moves_;
      const double log_ratio = candidate.log_factor + there[k - first] - log_[k];
      if (!(std::log(candidate.toss) < log_ratio)) continue;
      at_[k] = std::move(candidate.at);
      log_[k] = there[k - first];
      ++accepted_;
    }
  }

  const LogDensity& density_;
  const StudentMixture& proposal_;
  const EnsembleOptions& options_;
  std::vector<Eigen::VectorXd> at_;
  std::vector<double> log_;
  std::vector<std::vector<Eigen::VectorXd>> chains_;
  long steps_ = 0, evaluations_ = 0, moves_ = 0, accepted_ = 0;
};

} // namespace

StudentMixture::StudentMixture(const std::vector<Part>& parts) {
  double largest = -std::numeric_limits<double>::infinity(), sum = 0;
  for (const Part& part : parts) largest = std::max(largest, part.log_weight);
  for (const Part& part : parts) sum += std::exp(part.log_weight - largest);
  for (const Part& part : parts) {
    Prepared& prepared = parts_.emplace_back();
    prepared.share = std::exp(part.log_weight - largest) / sum;
    prepared.center = part.center;
    prepared.factor = part.covariance.llt().matrixL();
    prepared.bend = part.bend;
    prepared.log_scale = prepared.factor.diagonal().array().log().sum();
  }
}

Eigen::VectorXd StudentMixture::draw(const std::function<double()>& uniform) const {
  double at = uniform();
  std::size_t k = 0;
  while (k + 1 < parts_.size() && at >= parts_[k].share) at -= parts_[k++].share;
  Eigen::VectorXd normal(parts_[k].center.size());
  for (double& z : normal) z = normal_of(uniform());
  double square = 0;
  const int degrees = degrees_for(normal.size());
  for (int i = 0; i < degrees; ++i) square += std::pow(normal_of(uniform()), 2);
  const Eigen::VectorXd xi = normal * std::sqrt(degrees / square);
  if (!parts_[k].bend) return parts_[k].center + parts_[k].factor * xi;
  const auto z = parts_[k].bend->inverse(xi);
  if (!z) return Eigen::VectorXd::Constant(xi.size(), std::numeric_limits<double>::quiet_NaN());
  return parts_[k].center + parts_[k].factor * *z;
}

double StudentMixture::log_density(const Eigen::VectorXd& at) const {
  double largest = -std::numeric_limits<double>::infinity(), sum = 0;
  std::vector<double> logs;
  for (const Prepared& part : parts_) {
    const Eigen::VectorXd z = part.factor.triangularView<Eigen::Lower>().solve(at - part.center);
    const auto stretched = part.bend ? part.bend->log_determinant(z) : 0;
    if (!stretched) continue;
    const Eigen::VectorXd xi = part.bend ? (*part.bend)(z) : z;
    const double d = static_cast<double>(at.size()), degrees = degrees_for(at.size());
    logs.push_back(std::log(part.share) - part.log_scale + *stretched -
                   0.5 * (degrees + d) * std::log1p(xi.squaredNorm() / degrees));
    largest = std::max(largest, logs.back());
  }
  if (logs.empty()) return largest;
  for (const double log : logs) sum += std::exp(log - largest);
  return largest + std::log(sum);
}

long least_evaluations(std::size_t walkers) {
  return static_cast<long>(walkers) * (first_check + 1); // the walkers' first points too
}

Ensemble run_ensemble(const LogDensity& density, const StudentMixture& proposal,
                      const EnsembleOptions& options,
                      const std::function<void(const EnsembleState&)>& report_progress) {
  Walkers walkers(density, proposal, options);
  Ensemble ensemble;
  double check = first_check;
  const auto each_step = static_cast<long>(options.walkers);
  while (!ensemble.finished) {
    while (static_cast<double>(walkers.steps()) < check) walkers.step();
    ensemble.state = walkers.state();
    report_progress(ensemble.state);
    ensemble.finished = ensemble.state.ess >= options.ess && ensemble.state.r_hat <= options.r_hat;
    check = std::ceil(check * next_check);
    const auto more = static_cast<long>(check) - walkers.steps();
    if (ensemble.state.evaluations + more * each_step > options.most_evaluations) break;
  }
  ensemble.chains = walkers.take_kept();
  return ensemble;
}

} // namespace wingspread
