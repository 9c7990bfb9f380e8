#include "montecarlo/results/results_folder/version.hpp"

#include <build_stamp.hpp> // made by build_stamp.cmake

namespace wingspread {

std::string_view version() { return WINGSPREAD_VERSION WINGSPREAD_BUILD; }

} // namespace wingspread
