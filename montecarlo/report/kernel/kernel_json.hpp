/// The campaign's numbers for the kernel in the page: KERNEL of page/DATA.md.
#pragma once

#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/model/campaign/campaign.hpp"

namespace wingspread {

/// Null if the numbers would make the page too large (empirical laws with very many values), and for flexible bodies,
/// which the kernel does not know.
[[nodiscard]] Json kernel_json(const Campaign& campaign);

} // namespace wingspread
