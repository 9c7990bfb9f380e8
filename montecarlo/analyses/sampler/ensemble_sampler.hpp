/// An ensemble sampler: walkers whose moves are proposed by one another or by a fixed mixture of Student laws.
///
///   symbol     meaning
///   d, K       dimensions; number of walkers, even; `fit` takes at least 4 d
///   z          stretch, density ∝ 1/√z on [1/a, a], a = 2
///   π, q       target density, density of the fixed proposal
///
/// The walkers are two halves. Each half moves in turn, all its walkers at once: one batch of evaluations. A walker x
/// makes one of two moves by chance; both leave π invariant:
///
///   stretch      y = x' + z (x − x'), x' a walker of the other half;  min(1, z^{d−1} π(y)/π(x))     (1)
///   independent  y ~ q;                                               min(1, π(y) q(x)/(π(x) q(y)))  (2)
///
/// (1): J. Goodman, J. Weare, Comm. App. Math. Comp. Sci. 5 (2010) 65–80. (2) makes chains short if q is close to π;
/// (1) reaches regions that q misses. On a normal target of 3 dimensions the mixture needs less than a third of the
/// evaluations that (1) alone needs for an effective sample (ensemble_sampler_test.cpp).
#pragma once

#include "montecarlo/analyses/sampler/polynomial_map.hpp"
#include "montecarlo/foundation/statistics/chain_diagnostics.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <vector>

namespace wingspread {

/// log π of points, up to a constant; −∞ where π is 0.
using LogDensity = std::function<std::vector<double>(std::span<const Eigen::VectorXd>)>;

/// q: a mixture of multivariate Student laws with max(5, 2 d) degrees of freedom, each of ξ = G(z), x = center + L z.
class StudentMixture {
public:
  struct Part {
    double log_weight = 0;
    Eigen::VectorXd center;
    Eigen::MatrixXd covariance;          ///< L Lᵀ, positive definite
    std::optional<PolynomialMap> bend{}; ///< G; nothing: ξ = z
  };
  explicit StudentMixture(const std::vector<Part>& parts);

  /// NaN where ξ = G(z) has no solution. @param uniform source of uniform numbers in (0, 1)
  [[nodiscard]] Eigen::VectorXd draw(const std::function<double()>& uniform) const;
  /// log q, up to a constant; −∞ where draw() never leads.
  [[nodiscard]] double log_density(const Eigen::VectorXd& at) const;

private:
  struct Prepared {
    double share;
    double log_scale;
    Eigen::VectorXd center;
    Eigen::MatrixXd factor; ///< L, lower triangular
    std::optional<PolynomialMap> bend;
  };
  std::vector<Prepared> parts_;
};

struct EnsembleOptions {
  std::size_t walkers = 64; ///< even, at least 4
  std::uint64_t seed = 1;
  double ess = 1000;   ///< least effective sample size of every coordinate
  double r_hat = 1.01; ///< largest nested split R̂ of every coordinate
  long most_evaluations = 1'000'000;
  double independent = 0.5; ///< share of independent moves
};

struct EnsembleState {
  long evaluations = 0;
  double acceptance = 0; ///< share of accepted moves
  double ess = 0;        ///< the least
  double r_hat = 0;      ///< the largest
};

struct Ensemble {
  bool finished = false;
  EnsembleState state;
  std::vector<std::vector<Eigen::VectorXd>> chains; ///< by walker, without the first quarter
};

/// Evaluations up to the first diagnosis: no run of the sampler makes fewer.
[[nodiscard]] long least_evaluations(std::size_t walkers);

/// Moves the walkers until ESS and R̂ are reached, or the evaluations are used up. Pure if the density is:
/// interruption, threads and lanes change nothing.
/// @param report_progress called after each diagnosis
[[nodiscard]] Ensemble
run_ensemble(const LogDensity& density, const StudentMixture& proposal,
             const EnsembleOptions& options,
             const std::function<void(const EnsembleState&)>& report_progress);

} // namespace wingspread
