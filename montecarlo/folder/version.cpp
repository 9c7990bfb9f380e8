#include "montecarlo/folder/version.hpp"

namespace wingspread {

std::string_view version() { return WINGSPREAD_VERSION; }

} // namespace wingspread
