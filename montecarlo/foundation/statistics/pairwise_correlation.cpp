#include "montecarlo/foundation/statistics/pairwise_correlation.hpp"

#include "montecarlo/foundation/platform/thread_pool.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

namespace wingspread {
namespace {

/// Which rows have a value; empty: all of them.
using Presence = std::vector<bool>;

Presence presence_of(const RankedColumn& column) {
  if (column.complete()) return {};
  Presence present;
  for (const std::uint32_t doubled : column.doubled_ranks()) present.push_back(doubled != 0);
  column.doubled_ranks().release();
  return present;
}

Presence both(const Presence& a, const Presence& b) {
  if (a.empty() || b.empty()) return a.empty() ? b : a;
  Presence result;
  for (std::size_t row = 0; row < a.size(); ++row) result.push_back(a[row] && b[row]);
  return result;
}

/// Groups columns that have values in the same rows: their indices, by these rows.
std::map<Presence, std::vector<std::size_t>> by_presence(std::span<const RankedColumn> columns) {
  std::map<Presence, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < columns.size(); ++i) groups[presence_of(columns[i])].push_back(i);
  return groups;
}

/// A column restricted to the rows in which all columns of a group have values.
class KeptColumn {
public:
  /// @param keep the rows to keep; empty: all rows
  KeptColumn(const RankedColumn& column, const Presence& keep) {
    if (keep.empty()) {
      column_ = &column;
      value_standard_ = standard_of(column.values());
      rank_standard_ = standard_of(column.ranks());
    } else {
      keep_rows(column, keep);
    }
    column.values().release();
  }

  [[nodiscard]] std::size_t size() const { return values().size(); }
  /// z of values and ranks, starting at row `first`; zeros if undefined.
  void standardize(std::size_t first, std::span<double> value_z, std::span<double> rank_z) const {
    for (std::size_t i = 0; i < value_z.size(); ++i)
      value_z[i] = value_standard_ ? value_standard_->of(values()[first + i]) : 0;
    for (std::size_t i = 0; i < rank_z.size(); ++i)
      rank_z[i] = rank_standard_ ? rank_standard_->of(doubled_ranks()[first + i] / 2.0) : 0;
  }
  void release(std::size_t first, std::size_t last) const {
    values().release(first, last);
    doubled_ranks().release(first, last);
  }
  /// Nothing if Pearson's correlation is undefined: too few rows, or all equal.
  [[nodiscard]] const std::optional<Standard>& value_standard() const { return value_standard_; }
  [[nodiscard]] const std::optional<Standard>& rank_standard() const { return rank_standard_; }

private:
  void keep_rows(const RankedColumn& column, const Presence& keep) {
    std::vector<double> kept = column.ranks_where(keep);
    rank_standard_ = standard_of(kept);
    for (const double rank : kept) own_ranks_.push_back(static_cast<std::uint32_t>(2 * rank));
    kept.clear();
    for (std::size_t row = 0; row < keep.size(); ++row)
      if (keep[row]) kept.push_back(column.values()[row]);
    value_standard_ = standard_of(kept);
    own_values_ = kept;
  }
  [[nodiscard]] const Spilled<double>& values() const {
    return column_ ? column_->values() : own_values_;
  }
  [[nodiscard]] const Spilled<std::uint32_t>& doubled_ranks() const {
    return column_ ? column_->doubled_ranks() : own_ranks_;
  }

  const RankedColumn* column_ = nullptr; ///< where all rows are kept
  Spilled<double> own_values_;
  Spilled<std::uint32_t> own_ranks_;
  std::optional<Standard> value_standard_, rank_standard_;
};

/// Columns with values in the same rows.
struct ColumnGroup {
  std::vector<KeptColumn> x, y;
};

std::vector<KeptColumn> keep_columns(std::span<const RankedColumn> columns,
                                     const std::vector<std::size_t>& which, const Presence& keep,
                                     int threads) {
  std::vector<std::optional<KeptColumn>> kept(which.size());
  const std::size_t bytes = 32 * columns.front().values().size(); // 20 of vectors, 12 mapped
  constexpr double operations = 8; // per row: two standardisations, and copying the kept values
  const double all =
      operations * static_cast<double>(which.size() * columns.front().values().size());
  for_each_task(threads_within_memory(threads_worth(threads, all), bytes), which.size(),
                [&](std::size_t i) { kept[i].emplace(columns[which[i]], keep); });
  std::vector<KeptColumn> result;
  for (auto& column : kept) result.push_back(std::move(*column));
  return result;
}

struct Products {
  Sum values, ranks; ///< Σ z_x z_y
};

/// The sums for some pairs of a group. Pairs are numbered by x, then y.
class PairSums {
public:
  PairSums(const ColumnGroup& group, std::size_t first, std::size_t last)
      : group_(&group), first_(first), last_(last), sums_(last - first) {}

  void add_all_rows() {
    const std::size_t rows = group_->x.front().size();
    for (std::size_t row = 0; row < rows; row += stretch) {
      add_rows(row, std::min(stretch, rows - row));
      if ((row / stretch + 1) % stretches_held == 0) release(row + stretch);
    }
    release(rows);
  }
  [[nodiscard]] const Products& operator[](std::size_t pair) const { return sums_[pair - first_]; }

private:
  static constexpr std::size_t stretch = 512; ///< rows: their z stay in the processor's cache
  static constexpr std::size_t stretches_held = spill_bytes / (stretch * sizeof(double));

  /// z of a column's values and ranks.
  struct Stretch {
    std::array<double, stretch> values, ranks;
  };

  [[nodiscard]] std::size_t first_x() const { return first_ / group_->y.size(); }
  [[nodiscard]] std::size_t end_x() const { return (last_ - 1) / group_->y.size() + 1; }

  void add_rows(std::size_t row, std::size_t count) {
    const auto standardize = [&](const KeptColumn& column, Stretch& z) {
      column.standardize(row, std::span(z.values).first(count), std::span(z.ranks).first(count));
    };
    for (std::size_t j = 0; j < y_.size(); ++j) standardize(group_->y[j], y_[j]);
    for (std::size_t pair = first_; pair < last_; ++pair) {
      const std::size_t i = pair / y_.size(), j = pair % y_.size();
      if (pair == first_ || j == 0) standardize(group_->x[i], x_);
      add(x_, y_[j], count, sums_[pair - first_]);
    }
  }

  static void add(const Stretch& x, const Stretch& y, std::size_t count, Products& sums) {
    Products local = sums; // in registers; the two sums do not wait for each other
    for (std::size_t k = 0; k < count; ++k) {
      local.values.add(x.values[k] * y.values[k]);
      local.ranks.add(x.ranks[k] * y.ranks[k]);
    }
    sums = local;
  }

  void release(std::size_t row) {
    for (const KeptColumn& column : group_->y) column.release(released_, row);
    for (std::size_t i = first_x(); i < end_x(); ++i) group_->x[i].release(released_, row);
    released_ = row;
  }

  const ColumnGroup* group_;
  std::size_t first_, last_, released_ = 0;
  std::vector<Products> sums_;
  std::vector<Stretch> y_ = std::vector<Stretch>(group_->y.size());
  Stretch x_{};
};

Correlation correlation_of(const KeptColumn& x, const KeptColumn& y, const Products& products) {
  const auto of = [](const auto& a, const auto& b, const Sum& sum) {
    return a && b ? pearson(*a, *b, sum.value()) : undefined;
  };
  return {static_cast<long>(x.size()), of(x.value_standard(), y.value_standard(), products.values),
          of(x.rank_standard(), y.rank_standard(), products.ranks)};
}

/// Ordered by x, then y.
std::vector<Correlation> correlate(const ColumnGroup& group, int threads) {
  const std::size_t pairs = group.x.size() * group.y.size();
  const int team = threads_worth(threads, 2 * static_cast<double>(pairs * group.x.front().size()));
  const auto parts = std::min<std::size_t>(pairs, static_cast<std::size_t>(team));
  std::vector<Correlation> result(pairs);
  for_each_task(team, parts, [&](std::size_t part) {
    const std::size_t first = part * pairs / parts, last = (part + 1) * pairs / parts;
    PairSums sums(group, first, last);
    sums.add_all_rows();
    for (std::size_t pair = first; pair < last; ++pair)
      result[pair] = correlation_of(group.x[pair / group.y.size()], group.y[pair % group.y.size()],
                                    sums[pair]);
  });
  return result;
}

} // namespace

std::vector<Correlation> pairwise_correlations(std::span<const RankedColumn> x,
                                               std::span<const RankedColumn> y, int threads) {
  std::vector<Correlation> result(x.size() * y.size());
  const auto groups_x = by_presence(x), groups_y = by_presence(y);
  for (const auto& [present_x, which_x] : groups_x)
    for (const auto& [present_y, which_y] : groups_y) {
      const Presence keep = both(present_x, present_y);
      const ColumnGroup group{keep_columns(x, which_x, keep, threads),
                              keep_columns(y, which_y, keep, threads)};
      const std::vector<Correlation> found = correlate(group, threads);
      for (std::size_t pair = 0; pair < found.size(); ++pair)
        result[which_x[pair / which_y.size()] * y.size() + which_y[pair % which_y.size()]] =
            found[pair];
    }
  return result;
}

} // namespace wingspread
