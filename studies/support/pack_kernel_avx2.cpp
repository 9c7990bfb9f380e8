#include "studies/support/pack_kernel.hpp"
#include "studies/support/pack_kernel_timing.hpp"

namespace wingspread::study {

KernelTimes avx2_evaluation(int bodies) {
  return bodies == 3 ? time_evaluation<Pack<4>, 3>() : time_evaluation<Pack<4>, 10>();
}

} // namespace wingspread::study
