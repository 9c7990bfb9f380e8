#include "distributions/distribution.hpp"

#include "distributions/truncated_law.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <iterator>
#include <numeric>
#include <utility>

namespace wingspread {
namespace {

/// The shortest text that reads back as the number.
std::string text(double number) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number).ptr;
  return {buffer.data(), end};
}

// Not by operator+: GCC 12 at -O3 then warns wrongly of an overlap (GCC bug 105651).
std::string joined(std::initializer_list<std::string_view> parts) {
  std::string whole;
  for (const std::string_view part : parts) whole += part;
  return whole;
}

/// Collects the faults of one distribution.
class Checker {
public:
  void expect(bool holds, std::string path, std::string found, std::string expected) {
    if (!holds) faults_.push_back({std::move(path), std::move(found), std::move(expected)});
  }

  void expect_range(double number, Range range, const std::string& path) {
    if (!std::isfinite(number))
      expect(false, path, text(number), "a finite number");
    else if (range == Range::positive)
      expect(number > 0, path, text(number), "> 0");
    else if (range == Range::shape)
      expect(number > 0 && number <= largest_shape, path, text(number), "> 0 and ≤ 1e6");
    else if (range == Range::non_negative)
      expect(number >= 0, path, text(number), "≥ 0");
  }

  void expect_range(const std::vector<double>& numbers, Range range, const std::string& path) {
    expect(!numbers.empty(), path, "none", "at least one");
    for (std::size_t i = 0; i < numbers.size(); ++i)
      expect_range(numbers[i], range, joined({path, "/", std::to_string(i)}));
  }

  /// Infinite ends count as ordered; NaN does not.
  void expect_order(double lower, double upper, const std::string& prefix) {
    for (const auto& [name, end] : {std::pair{"lower", lower}, std::pair{"upper", upper}})
      expect(!std::isnan(end), joined({prefix, name}), text(end), "a number");
    expect(!(lower >= upper), joined({prefix, "upper"}), text(upper),
           joined({"> lower (", text(lower), ")"}));
  }

  [[nodiscard]] bool clean() const { return faults_.empty(); }
  [[nodiscard]] std::vector<DistributionFault> faults() && { return std::move(faults_); }

private:
  std::vector<DistributionFault> faults_;
};

bool all_finite(const std::vector<double>& numbers) {
  return std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); });
}

/// Checks the sum of the weights; each weight alone is checked before.
void check_weights(const Discrete& law, Checker& checker) {
  const std::size_t count = law.weights.size();
  if (count == 0 || !all_finite(law.weights)) return;
  checker.expect(count == law.values.size() || law.values.empty(), "weights", std::to_string(count),
                 joined({"one for each of the ", std::to_string(law.values.size()), " values"}));
  checker.expect(std::ranges::count(law.weights, 0.) < std::ssize(law.weights), "weights",
                 "all zero", "at least one > 0");
  const double sum = std::accumulate(law.weights.begin(), law.weights.end(), 0.);
  checker.expect(std::isfinite(sum), "weights", joined({"a sum of ", text(sum)}), "a finite sum");
}

/// Checks each parameter, then the finite ones against each other.
template <class L> void check_law(const L& law, Checker& checker) {
  for (const auto& parameter : L::parameters())
    checker.expect_range(law.*parameter.member, parameter.range, std::string(parameter.name));
  if constexpr (requires { law.lower; })
    if (all_finite({law.lower, law.upper})) {
      checker.expect_order(law.lower, law.upper, "");
      checker.expect(law.upper - law.lower <= std::numeric_limits<double>::max(), "upper",
                     text(law.upper),
                     joined({"a finite distance to lower (", text(law.lower), ")"}));
    }
  if constexpr (requires { law.mode; })
    if (all_finite({law.lower, law.mode, law.upper}) && law.lower < law.upper)
      checker.expect(
          law.lower <= law.mode && law.mode <= law.upper, "mode", text(law.mode),
          joined({"in [lower, upper] = [", text(law.lower), ", ", text(law.upper), "]"}));
  if constexpr (requires { law.weights; }) check_weights(law, checker);
}

template <class L> void check_truncation(const L& law, Truncation truncation, Checker& checker) {
  const bool sound = checker.clean();
  checker.expect_order(truncation.lower, truncation.upper, "truncate/");
  if constexpr (!Continuous<L>)
    checker.expect(false, "truncate", joined({"a truncated ", L::type, " law"}),
                   "a continuous law");
  else if (sound && checker.clean())
    checker.expect(truncated(law, truncation).mass >= std::numeric_limits<double>::min(),
                   "truncate",
                   joined({"[", text(truncation.lower), ", ", text(truncation.upper), "]"}),
                   "an interval in which the law has a probability that doubles can hold");
}

} // namespace

std::vector<DistributionFault> faults(const Distribution& distribution) {
  Checker checker;
  std::visit(
      [&](const auto& law) {
        check_law(law, checker);
        if (distribution.truncate) check_truncation(law, *distribution.truncate, checker);
      },
      distribution.law);
  return std::move(checker).faults();
}

} // namespace wingspread
