#include "core/packs/runs_inside.hpp"

namespace wingspread {

const Runs& plain_runs() { return detail::runs_here; }

} // namespace wingspread
