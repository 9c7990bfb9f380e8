/// The laws a dispersion may follow, as plain data.
///
/// Values carry the unit of what they disperse, or none where they scale a nominal; so do mean,
/// std, scale, lower, mode and upper, and a rate its inverse. Shapes, weights and what is named
/// _log have no unit. Each law names its parameters once, for those who read, write and check them.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace wingspread {

/// `shape`: of a gamma or beta law, > 0 and no larger than what the inverse of its distribution function is
/// good for; such a law has a spread of a thousandth.
enum class Range { finite, positive, non_negative, shape };
inline constexpr double largest_shape = 1e6;

/// A parameter of a law: its name in a campaign's file, where it lives, and what it may be.
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

/// One of the values, each as often as its weight says. Values may stand in any order and repeat.
struct Discrete {
  std::vector<double> values;
  std::vector<double> weights; ///< ≥ 0, one for each value, not all zero; need not add up to 1
  static constexpr std::string_view type = "discrete";
  static constexpr auto parameters() {
    return std::array{LawParameter{"values", &Discrete::values},
                      LawParameter{"weights", &Discrete::weights, Range::non_negative}};
  }
};

/// One of the measured values, each as often as the others (a bootstrap draw): its distribution
/// function is the step function of the data. Interpolating between them was ruled out: it draws
/// values nobody measured, and narrows or widens the data by a choice that the data do not make.
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

/// The law given that its value lies in [lower, upper]. For continuous laws only.
struct Truncation {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity(); ///< > lower
};

struct Distribution {
  Law law;
  std::optional<Truncation> truncate;
};

/// A parameter that makes no distribution.
struct DistributionFault {
  std::string path;     ///< e.g. "std", "weights/2" or "truncate/upper"; empty for the whole
  std::string found;    ///< the value
  std::string expected; ///< what would do, e.g. "> 0"
};

/// Every invalid parameter, all together: what is not finite, not positive or not in order, values
/// and weights that are missing or do not pair up, a truncation of a law that takes none or to an
/// interval without probability. Empty when the distribution can be prepared.
[[nodiscard]] std::vector<DistributionFault> faults(const Distribution& distribution);

struct LawMoments {
  double mean = 0;
  double standard_deviation = 0;
};

/// The law's moments, truncation left out (hence of the law). Requires a law without faults.
[[nodiscard]] LawMoments moments(const Law& law);

} // namespace wingspread
