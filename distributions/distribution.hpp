/// The laws of dispersions, as plain data.
///
/// Values, mean, std, scale, lower, mode and upper have the unit of the dispersed parameter, or none for a factor; a
/// rate has its inverse. Shapes, weights and parameters named _log have no unit. Each law lists its parameters once,
/// for readers, writers and checks.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace wingspread {

/// `shape`: of a gamma or beta law, > 0 and ≤ largest_shape, up to which the inverse distribution function is accurate;
/// a law with the largest shape has a relative spread of 1e-3.
enum class Range { finite, positive, non_negative, shape };
inline constexpr double largest_shape = 1e6;

/// A parameter of a law: its key, its member and its range.
template <class Law, class Value> struct LawParameter {
  std::string_view name;
  Value Law::*member;
  Range range = Range::finite; ///< of the value, or of each element
};

template <class Law, class Value>
LawParameter(const char*, Value Law::*) -> LawParameter<Law, Value>;
template <class Law, class Value>
LawParameter(const char*, Value Law::*, Range) -> LawParameter<Law, Value>;

struct Normal {
  double mean = 0;
  double std = 1; ///< > 0
  static constexpr std::string_view type = "normal";
  static constexpr auto parameters() {
    return std::array{LawParameter{"mean", &Normal::mean},
                      LawParameter{"std", &Normal::std, Range::positive}};
  }
};

struct Uniform {
  double lower = 0;
  double upper = 1; ///< > lower
  static constexpr std::string_view type = "uniform";
  static constexpr auto parameters() {
    return std::array{LawParameter{"lower", &Uniform::lower},
                      LawParameter{"upper", &Uniform::upper}};
  }
};

struct Triangular {
  double lower = 0;
  double mode = 0.5; ///< in [lower, upper]
  double upper = 1;  ///< > lower
  static constexpr std::string_view type = "triangular";
  static constexpr auto parameters() {
    return std::array{LawParameter{"lower", &Triangular::lower},
                      LawParameter{"mode", &Triangular::mode},
                      LawParameter{"upper", &Triangular::upper}};
  }
};

/// exp(Z) with Z normal.
struct Lognormal {
  double mu_log = 0;    ///< mean of Z
  double sigma_log = 1; ///< standard deviation of Z, > 0
  static constexpr std::string_view type = "lognormal";
  static constexpr auto parameters() {
    return std::array{LawParameter{"mu_log", &Lognormal::mu_log},
                      LawParameter{"sigma_log", &Lognormal::sigma_log, Range::positive}};
  }
};

struct Weibull {
  double shape = 1; ///< > 0
  double scale = 1; ///< > 0
  static constexpr std::string_view type = "weibull";
  static constexpr auto parameters() {
    return std::array{LawParameter{"shape", &Weibull::shape, Range::positive},
                      LawParameter{"scale", &Weibull::scale, Range::positive}};
  }
};

struct Gamma {
  double shape = 1; ///< > 0, ≤ largest_shape
  double scale = 1; ///< > 0
  static constexpr std::string_view type = "gamma";
  static constexpr auto parameters() {
    return std::array{LawParameter{"shape", &Gamma::shape, Range::shape},
                      LawParameter{"scale", &Gamma::scale, Range::positive}};
  }
};

/// Density ∝ (x − lower)^(alpha − 1) (upper − x)^(beta − 1).
struct Beta {
  double alpha = 1; ///< > 0, ≤ largest_shape
  double beta = 1;  ///< > 0, ≤ largest_shape
  double lower = 0;
  double upper = 1; ///< > lower
  static constexpr std::string_view type = "beta";
  static constexpr auto parameters() {
    return std::array{LawParameter{"alpha", &Beta::alpha, Range::shape},
                      LawParameter{"beta", &Beta::beta, Range::shape},
                      LawParameter{"lower", &Beta::lower}, LawParameter{"upper", &Beta::upper}};
  }
};

struct Exponential {
  double rate = 1; ///< > 0; the mean is 1/rate
  static constexpr std::string_view type = "exponential";
  static constexpr auto parameters() {
    return std::array{LawParameter{"rate", &Exponential::rate, Range::positive}};
  }
};

/// One of the values, with probabilities in proportion to the weights. Values may be unordered and repeat.
struct Discrete {
  std::vector<double> values;
  std::vector<double> weights; ///< ≥ 0, one for each value, not all zero; need not add up to 1
  static constexpr std::string_view type = "discrete";
  static constexpr auto parameters() {
    return std::array{LawParameter{"values", &Discrete::values},
                      LawParameter{"weights", &Discrete::weights, Range::non_negative}};
  }
};

/// One of the measured values with equal probabilities (a bootstrap draw). Interpolation between values was ruled out:
/// it draws values that were not measured, and its choice changes the spread.
struct Empirical {
  std::vector<double> values;
  static constexpr std::string_view type = "empirical";
  static constexpr auto parameters() {
    return std::array{LawParameter{"values", &Empirical::values}};
  }
};

struct Constant {
  double value = 0;
  static constexpr std::string_view type = "constant";
  static constexpr auto parameters() { return std::array{LawParameter{"value", &Constant::value}}; }
};

using ContinuousLaw =
    std::variant<Normal, Uniform, Triangular, Lognormal, Weibull, Gamma, Beta, Exponential>;
using Law = std::variant<Normal, Uniform, Triangular, Lognormal, Weibull, Gamma, Beta, Exponential,
                         Discrete, Empirical, Constant>;

template <class L>
concept Continuous = requires(const L& law) {
  ContinuousLaw(law);
};

/// Conditions a continuous law on values in [lower, upper].
struct Truncation {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity(); ///< > lower
};

struct Distribution {
  Law law;
  std::optional<Truncation> truncate;
};

/// An invalid parameter.
struct DistributionFault {
  std::string path;     ///< e.g. "std", "weights/2" or "truncate/upper"; empty for the whole
  std::string found;    ///< the value
  std::string expected; ///< the condition, e.g. "> 0"
};

/// All invalid parameters: values that are not finite, out of range or out of order; missing or unpaired values and
/// weights; a truncation of a stepped law, or to an interval without probability. Empty if the distribution can be
/// prepared.
[[nodiscard]] std::vector<DistributionFault> faults(const Distribution& distribution);

struct LawMoments {
  double mean = 0;
  double standard_deviation = 0;
};

/// The moments of the law without truncation. Requires a law without faults.
[[nodiscard]] LawMoments moments(const Law& law);

} // namespace wingspread
