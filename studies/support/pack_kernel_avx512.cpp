#include "studies/support/pack_kernel.hpp"
#include "studies/support/pack_kernel_timing.hpp"

namespace wingspread::study {

KernelTimes avx512_evaluation(int bodies) {
  return bodies == 3 ? time_evaluation<Pack<8>, 3>() : time_evaluation<Pack<8>, 10>();
}

} // namespace wingspread::study
