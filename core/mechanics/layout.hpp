/// The state vector of a wing and the indices of its components.
#pragma once

#include <vector>

namespace wingspread {

template <class T> using State = std::vector<T>;

/// Indices in the state (q, q̇, S): q = (x, y, θ_0 of a free base; φ_1 … φ_n), S = S_1 … S_n of smoothed latches.
struct Layout {
  int base = 0; ///< 3 for a free base, else 0
  int bodies = 0;
  bool smoothed = false;

  [[nodiscard]] int freedoms() const { return base + bodies; }
  [[nodiscard]] int size() const { return 2 * freedoms() + (smoothed ? bodies : 0); }
  [[nodiscard]] int angle(int i) const { return base + i - 1; }           ///< φ_i
  [[nodiscard]] int rate(int i) const { return freedoms() + angle(i); }   ///< φ̇_i
  [[nodiscard]] int latch(int i) const { return 2 * freedoms() + i - 1; } ///< S_i
};

} // namespace wingspread
