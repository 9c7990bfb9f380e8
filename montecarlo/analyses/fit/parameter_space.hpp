/// The unknowns of a fit in the standard normal space of their priors: u ~ N(0, I).
///
/// A fitted dispersion is u → Φ(u) → copula → quantile, as in `rare`. So bounds and correlations of the priors hold
/// without further rules, and all unknowns have the scale 1. An offset of a clock or of a sensor is its standard
/// deviation times u.
///
/// The copula takes the dispersions in this order: those common to all tests, those that some tests have of their own,
/// those that every test has of its own. So a common dispersion has one value in all tests, and a test's own value
/// follows its law given the common values. (The campaign's own order is by name. Of two correlated dispersions that
/// only some tests have of their own, the first one's own value moves the second.)
#pragma once

#include "distributions/copula.hpp"
#include "montecarlo/analyses/fit/fit_spec.hpp"
#include "montecarlo/engine/runs/run_plan.hpp"

#include <Eigen/Core>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace wingspread {

using FitPoint = Eigen::VectorXd; ///< u

struct FitParameter {
  enum class Kind { dispersion, time_offset, column_offset };
  Kind kind = Kind::dispersion;
  std::string name;
  std::size_t dispersion = 0;      ///< index in the campaign
  std::optional<std::size_t> test; ///< nothing: common to all tests without a value of their own
  std::size_t column = 0;          ///< of a column_offset
  double std = 1;                  ///< of an offset
  std::string_view unit{};         ///< of an offset
};

/// The unknowns, in this order: fitted dispersions common to the tests; those that a test has of its own; offsets. An
/// offset of a column with known noise is no unknown, because likelihood.hpp integrates it out.
class ParameterSpace {
public:
  ParameterSpace(const Campaign& campaign, const FitSpec& spec);

  [[nodiscard]] const std::vector<FitParameter>& list() const { return list_; }
  [[nodiscard]] std::size_t size() const { return list_.size(); }
  /// Number of common dispersions, which come first in the list.
  [[nodiscard]] std::size_t common() const { return common_; }

  /// The dispersions that every test has of its own and that depend on common ones through correlations: a new unit's
  /// values are to be drawn beside those of the common ones.
  [[nodiscard]] const std::vector<std::size_t>& dependent() const { return dependent_; }

  /// The unit point of a run of the test, coupled: for a campaign without_correlations(). Dispersions that are not fitted
  /// are at their medians, given the fitted ones. @param u output, per dispersion
  void place(std::optional<std::size_t> test, const FitPoint& at, std::span<Tails> u) const;
  /// z = L u: the normal scores of the parameters. Priors correlate some of them, so L Lᵀ are the correlations of z. An
  /// offset's score is its u.
  [[nodiscard]] Eigen::MatrixXd coupling() const;
  /// Clock offset of the test at the point, s.
  [[nodiscard]] double time_offset(std::size_t test, const FitPoint& at) const;
  /// Offset of a column of the test, if it is an unknown; else 0.
  [[nodiscard]] double column_offset(std::size_t test, std::size_t column,
                                     const FitPoint& at) const;

private:
  std::vector<FitParameter> list_;
  std::size_t common_ = 0,
              dispersions_; ///< numbers of common parameters, and of the campaign's dispersions
  GaussianCopula copula_;
  std::vector<std::size_t> dependent_;
};

/// The moments of a law, also of a truncated one.
[[nodiscard]] LawMoments moments_of(const Distribution& distribution);

/// The prior of a parameter, as its dispersion applies it; of an offset in SI.
struct ParameterPrior {
  double mean = 0, std = 0;
  double lower = 0, upper = 0; ///< quantiles at both ends of the interval
  std::string_view unit{};     ///< none of a factor
};
/// @param campaign whose laws the parameter has
/// @param confidence of the interval
[[nodiscard]] ParameterPrior prior_of(const FitParameter& parameter, const Campaign& campaign,
                                      double confidence);

/// The campaign in which these dispersions have normal laws with their own medians and standard deviations, each column
/// of `rows` for itself: near u = 0 a unit of u is then a standard deviation of the law, whatever the law is.
[[nodiscard]] Campaign with_normal_laws(Campaign campaign, const std::vector<std::size_t>& held);

/// The correlations of these dispersions that are columns of the same `rows`; 0 between others. (Those of the campaign's
/// "correlations" act through its copula.)
[[nodiscard]] Eigen::MatrixXd correlations_in_rows(const Campaign& campaign,
                                                   const std::vector<std::size_t>& dispersions);

/// The campaign whose coordinates are coupled already.
[[nodiscard]] Campaign without_correlations(Campaign campaign);

/// The campaign in which only fitted dispersions vary: all others have their medians.
[[nodiscard]] Campaign fixed_but(Campaign campaign, const std::vector<std::size_t>& fitted);

/// u → dispersions as they are applied, offsets in SI.
class PhysicalValues {
public:
  /// @pre the space outlives the object
  PhysicalValues(const Campaign& campaign, const FitSpec& spec, const ParameterSpace& space);
  PhysicalValues(const PhysicalValues&) = delete;
  PhysicalValues& operator=(const PhysicalValues&) = delete;
  ~PhysicalValues();

  /// The values of all parameters of the space, in its order. A test's own ones follow the laws of the test's case.
  [[nodiscard]] std::vector<double> of(const FitPoint& at);
  /// The same by the campaign's laws alone: what a new unit has.
  [[nodiscard]] std::vector<double> of_new_unit(const FitPoint& at);

private:
  struct Laws; // of the campaign, or of a test

  [[nodiscard]] std::vector<double> values(const FitPoint& at, bool by_tests);

  const ParameterSpace& space_;
  std::optional<std::size_t> test_;
  const FitPoint* at_ = nullptr;
  std::vector<std::unique_ptr<Laws>>
      laws_; ///< the campaign's, then each test's; null: it has nothing of its own
};

} // namespace wingspread
