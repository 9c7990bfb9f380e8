#include "montecarlo/statistics/bonferroni.hpp"

namespace wingspread {

double at_each_of(double confidence, long count) {
  return count > 1 ? 1 - (1 - confidence) / static_cast<double>(count) : confidence;
}

} // namespace wingspread
