#include "montecarlo/model/campaign/wanted_correlations.hpp"

#include "distributions/decompositions.hpp"
#include "montecarlo/foundation/formats/nearest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace wingspread {
namespace {

constexpr std::size_t most_correlations = 100'000;

using Matrix = Eigen::MatrixXd;

/// Rounding unit of proposed coefficients. Rounding changes an eigenvalue by at most half_unit times the number of
/// coupled dispersions; with eigenvalues above twice that, the rounded matrix is positive definite.
constexpr double unit = 1e-4, half_unit = unit / 2;

/// Least eigenvalue of an accepted matrix: far above rounding errors, far below the accuracy of any correlation.
constexpr double least_eigenvalue = 1e-9;

constexpr std::string_view expected_pair = "an array of two dispersions' names";

bool is_inside(const double& coefficient) { return -1 < coefficient && coefficient < 1; }

/// The index of the named dispersion; nothing, with a problem, if there is none.
std::optional<std::size_t> read_name(const JsonCursor& at,
                                     const std::vector<Dispersion>* dispersions) {
  std::string name;
  if (!at.read(name, "a string, the name of a dispersion") || !dispersions) return std::nullopt;
  const auto found = std::ranges::find(*dispersions, name, &Dispersion::name);
  if (found != dispersions->end() && !found->rows.empty()) {
    at.refuse(fmt::format("\"{}\", a column of the rows \"{}\"", name, found->rows),
              "a dispersion with a draw of its own: rows are drawn whole");
    return std::nullopt;
  }
  if (found != dispersions->end()) return static_cast<std::size_t>(found - dispersions->begin());
  std::vector<std::string> names, copies; // all names, and the copies of an `each` with this name
  for (const Dispersion& each : *dispersions) {
    names.push_back(each.name);
    if (each.name.starts_with(name + '.')) copies.push_back(each.name);
  }
  at.refuse("the name of a dispersion" +
            (copies.empty() ? did_you_mean(name, names)
                            : fmt::format(" (did you mean \"{}\"?)", copies.front())));
  return std::nullopt;
}

/// The indices of the two dispersions; nothing, with a problem, if they are not two.
std::optional<std::pair<std::size_t, std::size_t>>
read_pair(const JsonCursor& at, const std::vector<Dispersion>* dispersions) {
  if (!at.value().is_array() || at.value().size() != 2) {
    at.refuse(expected_pair);
    return std::nullopt;
  }
  const auto first = read_name(at.element(0), dispersions);
  const auto second = read_name(at.element(1), dispersions);
  if (!first || !second) return std::nullopt;
  if (*first != *second) return std::minmax(*first, *second);
  at.refuse(describe_value(at.element(0).value()) + " twice", "two dispersions");
  return std::nullopt;
}

/// The coefficient of two normal laws with this covariance; nothing, with a problem, if there is none.
std::optional<double> spearman_of(const JsonCursor& at, double covariance, const Dispersion& first,
                                  const Dispersion& second) {
  const auto std_of = [](const Dispersion& dispersion) {
    const Normal* law = std::get_if<Normal>(&dispersion.distribution.law);
    return law && !dispersion.distribution.truncate ? law->std : 0.0;
  };
  const double largest = std_of(first) * std_of(second);
  if (largest == 0)
    at.refuse("\"spearman\": a covariance is that of two normal laws without truncation");
  else if (!(std::abs(covariance) < largest))
    at.refuse(
        fmt::format("a magnitude below {:.6g}, the product of both standard deviations", largest));
  else
    return spearman_correlation(covariance / largest);
  return std::nullopt;
}

/// Reads a covariance, and a coefficient beside it if there is one. @return whether there was no problem
bool read_covariance(const JsonCursor& at, JsonObject& object,
                     const std::vector<Dispersion>* dispersions, RankCorrelation& correlation) {
  double covariance = 0, given = 0;
  const auto coefficient = object.find("spearman");
  if (!at.read(covariance, "a number, the covariance of both draws") || !dispersions) return false;
  const auto found = spearman_of(at, covariance, (*dispersions)[correlation.first],
                                 (*dispersions)[correlation.second]);
  if (!found) return false;
  if (coefficient && coefficient->read(given, "a number, > -1 and < 1") &&
      std::abs(given - *found) > 0.01) // a rounded coefficient
    return coefficient->refuse(fmt::format("{:.4f}, by the covariance, or none beside it", *found));
  correlation.spearman = *found, correlation.covariance = covariance;
  return true;
}

/// Reads one correlation; nothing if it noted a problem.
std::optional<RankCorrelation> read_correlation(const JsonCursor& at,
                                                const std::vector<Dispersion>* dispersions) {
  RankCorrelation correlation;
  JsonObject object(at, "a correlation: an object");
  std::optional<std::pair<std::size_t, std::size_t>> pair;
  if (const auto between = object.require("between", expected_pair))
    pair = read_pair(*between, dispersions);
  if (pair) std::tie(correlation.first, correlation.second) = *pair;
  const auto covariance = object.find("covariance");
  const bool sound =
      covariance
          ? read_covariance(*covariance, object, pair ? dispersions : nullptr, correlation)
          : object.required("spearman", correlation.spearman, "a number, > -1 and < 1", is_inside);
  object.refuse_others();
  return pair && sound ? std::optional(correlation) : std::nullopt;
}

double rounded(double coefficient) { return std::round(coefficient / unit) * unit; }

/// `"a" and "b" 0.5, …`: the coefficients of the nearest possible matrix that differ from the given ones.
std::string proposal(const Matrix& matrix, const std::vector<Dispersion>& dispersions) {
  const auto coupled = ((matrix.array() != 0).rowwise().count() > 1).count();
  const double margin = 2 * half_unit * static_cast<double>(coupled);
  const Matrix nearest = nearest_correlations(matrix, std::min(margin, 0.5));
  std::string text;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    for (Eigen::Index j = i + 1; j < matrix.cols(); ++j) {
      const double near = rounded(spearman_correlation(nearest(i, j)));
      if (std::abs(near - spearman_correlation(matrix(i, j))) <= half_unit) continue;
      text += fmt::format("{}\"{}\" and \"{}\" {:.4f}", text.empty() ? "" : ", ",
                          dispersions[static_cast<std::size_t>(i)].name,
                          dispersions[static_cast<std::size_t>(j)].name, near);
    }
  return text;
}

void refuse_impossible(const JsonCursor& at, const std::vector<RankCorrelation>& correlations,
                       const std::vector<Dispersion>& dispersions) {
  const Matrix matrix = normal_correlations(dispersions.size(), correlations);
  // With this reserve, Cholesky's factorization succeeds in any order of the dispersions.
  if (cholesky(matrix - least_eigenvalue * Matrix::Identity(matrix.rows(), matrix.cols()))) return;
  const double smallest =
      Eigen::SelfAdjointEigenSolver<Matrix>(matrix, Eigen::EigenvaluesOnly).eigenvalues()(0);
  at.refuse(fmt::format("coefficients that cannot hold together (the smallest eigenvalue of their "
                        "matrix is {:.2g})",
                        smallest),
            "a positive definite matrix; the nearest has " + proposal(matrix, dispersions));
}

} // namespace

std::vector<RankCorrelation> read_wanted_correlations(const JsonCursor& at,
                                                      const std::vector<Dispersion>* dispersions) {
  if (!at.value().is_array()) at.refuse("an array of correlations");
  std::vector<RankCorrelation> correlations;
  const std::size_t problems_before = at.problems().size();
  for (const JsonCursor& element : at.elements(most_correlations)) {
    const auto read = read_correlation(element, dispersions);
    if (!read) continue;
    const auto is_same = [&](const RankCorrelation& other) {
      return other.first == read->first && other.second == read->second;
    };
    if (std::ranges::any_of(correlations, is_same))
      element.refuse("a pair that is named before", "each pair once", "/between");
    correlations.push_back(*read);
  }
  if (dispersions && at.problems().size() == problems_before)
    refuse_impossible(at, correlations, *dispersions);
  return correlations;
}

Json write_wanted_correlations(const std::vector<RankCorrelation>& correlations,
                               const std::vector<Dispersion>& dispersions) {
  Json json = Json::array();
  for (const auto& [first, second, spearman, covariance] : correlations) {
    json.push_back({{"between", {dispersions[first].name, dispersions[second].name}}});
    json.back()[covariance ? "covariance" : "spearman"] = covariance.value_or(spearman);
  }
  return json;
}

} // namespace wingspread
