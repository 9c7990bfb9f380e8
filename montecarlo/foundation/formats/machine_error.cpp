#include "montecarlo/foundation/formats/machine_error.hpp"

#include <cerrno>
#include <system_error>
#include <utility>

namespace wingspread {
namespace {

bool is_the_paths_fault(int error) {
  return error == ENOENT || error == ENOTDIR || error == EISDIR || error == EEXIST ||
         error == ENAMETOOLONG || error == ELOOP;
}

} // namespace

MachineError::MachineError(const Problem& problem) : MachineError(to_string(problem)) {}

MachineError::MachineError(std::string message) : message_(std::move(message)) {}

void refuse_path(const std::filesystem::path& path, int error, const char* expected) {
  if (path.empty()) throw SpecError({{"", "", "an empty path", expected}});
  Problem problem{path.string(), "", std::generic_category().message(error), expected};
  if (is_the_paths_fault(error)) throw SpecError({std::move(problem)});
  throw MachineError(problem);
}

} // namespace wingspread
