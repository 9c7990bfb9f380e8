/// The share of failed runs as a rising step function of an index.
///
/// It is the least-squares fit among all rising functions (pool adjacent violators). Between two indices it has the
/// larger value: a gap without runs shows no improvement. A smooth law of the index would fill such a gap. For a draw
/// with a rare weak value (0.3 in 3 % of the runs, else 1) it promises that a mean 1.4 % larger is enough, where only
/// the weak value's move across the gap helps.
///
/// Source: R. E. Barlow, D. J. Bartholomew, J. M. Bremner, H. D. Brunk, Statistical Inference under Order Restrictions
/// (1972), section 1.2.
#pragma once

#include <span>
#include <vector>

namespace wingspread {

class FailureCurve {
public:
  /// Cost O(n log n).
  /// @param failed 1 of a run that failed, else 0
  /// @pre at least one run; both spans have the same length
  FailureCurve(std::span<const double> index, std::span<const double> failed);

  /// The share at an index; that of the largest one beyond it.
  [[nodiscard]] double at(double index) const;

private:
  struct Step {
    double last; ///< its largest index
    double failed, runs;
    [[nodiscard]] double share() const { return failed / runs; }
  };
  std::vector<Step> steps_; ///< ascending, of rising share
};

} // namespace wingspread
