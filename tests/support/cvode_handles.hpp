/// Owners of CVODE's objects, and its error codes as exceptions.
#pragma once

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace wingspread::oracle {

/// @throws std::runtime_error with the call's name if the flag is an error
inline void require(int flag, const char* call) {
  if (flag < 0)
    throw std::runtime_error(std::string(call) + " failed with flag " + std::to_string(flag));
}

struct Free {
  void operator()(SUNContext context) const { SUNContext_Free(&context); }
  void operator()(N_Vector vector) const { N_VDestroy(vector); }
  void operator()(SUNMatrix matrix) const { SUNMatDestroy(matrix); }
  void operator()(SUNLinearSolver solver) const { SUNLinSolFree(solver); }
  void operator()(void* memory) const { CVodeFree(&memory); }
};
template <class Handle> using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Free>;

} // namespace wingspread::oracle
