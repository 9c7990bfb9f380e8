#include "montecarlo/foundation/formats/output_name.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace wingspread {

namespace {

constexpr std::string_view rate_at = ".rate_at.";

static_assert(std::ranges::all_of(output_kinds, [](const OutputKind& kind) {
  return &kind_of(kind.quantity) == &kind;
}));

} // namespace

OutputName parse_output_name(std::string_view name) {
  const std::size_t dot = name.rfind('.');
  const bool has_owner = dot != std::string_view::npos;
  const std::string_view owner = has_owner ? name.substr(0, dot) : "";
  const std::string_view quantity = has_owner ? name.substr(dot + 1) : name;
  for (const OutputKind& kind : output_kinds)
    if (quantity == kind.name && kind.owner != OutputOwner::two_hinges &&
        has_owner != (kind.owner == OutputOwner::wing) &&
        (kind.owner != OutputOwner::base || owner == "base"))
      return {std::string(owner), std::string(quantity), "", kind.unit, &kind};
  if (const std::size_t at = name.find(rate_at); at != std::string_view::npos) {
    const OutputKind& kind = kind_of(OutputQuantity::rate_at);
    return {std::string(name.substr(0, at)), std::string(kind.name),
            std::string(name.substr(at + rate_at.size())), kind.unit, &kind};
  }
  return {"", std::string(name), "", ""};
}

std::string output_name(OutputQuantity quantity, const std::string& owner,
                        const std::string& other) {
  const OutputKind& kind = kind_of(quantity);
  if (kind.owner == OutputOwner::wing) return std::string(kind.name);
  return fmt::format("{}.{}{}{}", kind.owner == OutputOwner::base ? "base" : owner, kind.name,
                     other.empty() ? "" : ".", other);
}

std::string meaning_of(const OutputKind& kind, std::string_view owner, std::string_view other) {
  return fmt::format(fmt::runtime(kind.meaning), owner, other);
}

PeakKind peak_kind(std::string_view output) {
  const OutputKind* kind = parse_output_name(output).kind;
  return kind ? kind->peak : PeakKind::none;
}

} // namespace wingspread
