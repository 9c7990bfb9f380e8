// Co-moments of columns in which values are missing, against Pearson's coefficient of the pairs that are there.
#include "montecarlo/results/streaming/power_sums.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <random>
#include <span>
#include <vector>

using namespace wingspread;

namespace {

double pearson(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double mean_x = 0, mean_y = 0, xx = 0, yy = 0, xy = 0;
  for (std::size_t k = 0; k < x.size(); ++k) mean_x += x[k] / n, mean_y += y[k] / n;
  for (std::size_t k = 0; k < x.size(); ++k) {
    xx += (x[k] - mean_x) * (x[k] - mean_x), yy += (y[k] - mean_y) * (y[k] - mean_y);
    xy += (x[k] - mean_x) * (y[k] - mean_y);
  }
  return xy / std::sqrt(xx * yy);
}

} // namespace

TEST_CASE("co-moments of parts add up to those of the whole, with values missing on either side",
          "[streaming]") {
  constexpr double missing = std::numeric_limits<double>::quiet_NaN();
  std::mt19937_64 bits(7);
  std::normal_distribution<double> normal;
  std::bernoulli_distribution is_missing(0.3);
  CoMoments whole(2, 2);
  std::vector<CoMoments> parts(3, CoMoments(2, 2));
  std::vector<std::vector<double>> rows;
  for (int run = 0; run < 300; ++run) {
    std::vector<double> row(4);
    for (std::size_t k = 0; k < 4; ++k)
      row[k] = is_missing(bits) ? missing : normal(bits) + (k >= 2 ? row[k - 2] : 5);
    const std::span<const double> all(row);
    whole.add(all.first(2), all.last(2));
    parts[static_cast<std::size_t>(run % 3)].add(all.first(2), all.last(2));
    rows.push_back(row);
  }
  parts[0].add(parts[1]), parts[0].add(parts[2]);
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j) {
      std::vector<double> x, y;
      for (const auto& row : rows)
        if (!std::isnan(row[i]) && !std::isnan(row[2 + j]))
          x.push_back(row[i]), y.push_back(row[2 + j]);
      CAPTURE(i, j);
      for (const CoMoments* sums : {&whole, &parts[0]}) {
        const Correlation found = sums->of(i, j);
        CHECK(found.count == std::ssize(x));
        CHECK(found.pearson == Approx(pearson(x, y)).epsilon(1e-12));
      }
    }
}
