/// Copies structs of numbers into and out of one lane of packs, field by field.
///
/// A struct template such as HingeTerms<T> is the same list of fields for a run (T = double) and for
/// W runs in lanes (T = Pack<W>). `fields` finds that list by itself: a new field needs no line here,
/// and a struct with more fields than `fields` knows does not compile.
#pragma once

#include "core/mechanics/wing.hpp"
#include "core/number/pack.hpp"
#include "core/scene/scene.hpp"

#include <array>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <vector>

namespace wingspread {

namespace detail {

/// Converts to every type. Used only to count fields at compile time; never evaluated.
struct AnyField {
  template <class T> operator T() const; // NOLINT: implicit, as a field's initializer
};

/// The largest number of initializers that the aggregate S takes, which is the number of its fields.
template <class S, class... Known> [[nodiscard]] consteval std::size_t count_fields() {
  if constexpr (requires { S{Known{}..., AnyField{}}; })
    return count_fields<S, Known..., AnyField>();
  else
    return sizeof...(Known);
}

/// References to the fields of an aggregate, in the order of their declaration. A structured binding
/// must name every field, so each number of fields needs a line of its own.
template <class S> [[nodiscard]] auto fields(S& s) {
  constexpr std::size_t count = count_fields<std::remove_const_t<S>>();
  static_assert(2 <= count && count <= 24, "add a line for a struct with so many fields");
  // clang-format off
#define WINGSPREAD_FIELDS(number, ...) \
  if constexpr (count == number) { auto& [__VA_ARGS__] = s; return std::tie(__VA_ARGS__); }
  WINGSPREAD_FIELDS(2, a, b)
  WINGSPREAD_FIELDS(3, a, b, c)
  WINGSPREAD_FIELDS(4, a, b, c, d)
  WINGSPREAD_FIELDS(5, a, b, c, d, e)
  WINGSPREAD_FIELDS(6, a, b, c, d, e, f)
  WINGSPREAD_FIELDS(7, a, b, c, d, e, f, g)
  WINGSPREAD_FIELDS(8, a, b, c, d, e, f, g, h)
  WINGSPREAD_FIELDS(9, a, b, c, d, e, f, g, h, i)
  WINGSPREAD_FIELDS(10, a, b, c, d, e, f, g, h, i, j)
  WINGSPREAD_FIELDS(11, a, b, c, d, e, f, g, h, i, j, k)
  WINGSPREAD_FIELDS(12, a, b, c, d, e, f, g, h, i, j, k, l)
  WINGSPREAD_FIELDS(13, a, b, c, d, e, f, g, h, i, j, k, l, m)
  WINGSPREAD_FIELDS(14, a, b, c, d, e, f, g, h, i, j, k, l, m, n)
  WINGSPREAD_FIELDS(15, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o)
  WINGSPREAD_FIELDS(16, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p)
  WINGSPREAD_FIELDS(17, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q)
  WINGSPREAD_FIELDS(18, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r)
  WINGSPREAD_FIELDS(19, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, t)
  WINGSPREAD_FIELDS(20, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, t, u)
  WINGSPREAD_FIELDS(21, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, t, u, v)
  WINGSPREAD_FIELDS(22, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, t, u, v, w)
  WINGSPREAD_FIELDS(23, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, t, u, v, w, x)
  WINGSPREAD_FIELDS(24, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, t, u, v, w, x, y)
#undef WINGSPREAD_FIELDS
  // clang-format on
}

template <class T> inline constexpr bool is_pack = false;
template <int W> inline constexpr bool is_pack<Pack<W>> = true;

template <class T> inline constexpr bool is_list = false;
template <class T> inline constexpr bool is_list<std::vector<T>> = true;
template <class T, std::size_t N> inline constexpr bool is_list<std::array<T, N>> = true;

/// Part of a wing's structure, which an engine sets once: all its runs have the same.
template <class T>
inline constexpr bool is_structure =
    std::is_same_v<T, BaseMotion> || std::is_same_v<T, Tree> || std::is_same_v<T, std::vector<int>>;

} // namespace detail

/// Calls visit(field of a, field of b) for every field of two structs made from one template.
template <class A, class B, class Visit> void for_each_field(A& a, B& b, Visit visit) {
  std::apply(
      [&](auto&... of_a) {
        std::apply([&](auto&... of_b) { (visit(of_a, of_b), ...); }, detail::fields(b));
      },
      detail::fields(a));
}

/// Copies every number of `from` into the lanes of the mask; both are structs of packs, or packs.
template <class Mask, class Packs>
void assign_where(const Mask& mask, Packs& to, const Packs& from) {
  if constexpr (detail::is_pack<Packs>)
    to = select(mask, from, to);
  else
    for_each_field(to, from,
                   [&](auto& part, const auto& part_from) { assign_where(mask, part, part_from); });
}

/// Copies a run's numbers into one lane.
/// @pre lists in `to` are at least as long as those in `from`
template <class Packs, class Numbers> void set_lane(int lane, Packs& to, const Numbers& from) {
  if constexpr (detail::is_pack<Packs>)
    to.v[lane] = from;
  else if constexpr (detail::is_structure<Packs>)
    return;
  else if constexpr (std::is_same_v<Packs, bool>)
    to = to || from; // packs compute what any of their lanes needs
  else if constexpr (std::is_scalar_v<Packs>)
    to = from; // an index, a law, a pointer to a table: the same in all runs of one structure
  else if constexpr (detail::is_list<Packs>)
    for (std::size_t k = 0; k < from.size(); ++k) set_lane(lane, to[k], from[k]);
  else
    for_each_field(to, from,
                   [lane](auto& part, const auto& part_from) { set_lane(lane, part, part_from); });
}

/// Copies one lane's numbers out to a run.
/// @pre lists in `from` are at least as long as those in `to`
template <class Packs, class Numbers> void get_lane(int lane, const Packs& from, Numbers& to) {
  if constexpr (detail::is_pack<Packs>)
    to = from.v[lane];
  else if constexpr (detail::is_list<Packs>)
    for (std::size_t k = 0; k < to.size(); ++k) get_lane(lane, from[k], to[k]);
  else
    for_each_field(from, to,
                   [lane](const auto& part_from, auto& part) { get_lane(lane, part_from, part); });
}

/// Gives a wing of packs this structure, and numbers without which an idle lane would divide by zero. @return the wing
template <int W>
const Wing<Pack<W>>& set_harmless(Wing<Pack<W>>& wing, const Wing<double>& structure) {
  Wing<double> harmless = structure;
  harmless.base = {};
  for (BodyTerms<double>& body : harmless.bodies) {
    body = {};
    body.mass = body.inertia = body.central_inertia = 1, body.minus_inverse = -1;
  }
  for (HingeTerms<double>& hinge : harmless.hinges) hinge = {}, hinge.sense = hinge.slip_rate = 1;
  for (RealHingeTerms<double>& real : harmless.real) {
    real = {}, real.stop.sense = real.far_stop.sense = real.friction.slip_rate = 1;
    real.damper.rate = 1;
  }
  for (PlateTerms<double>& plate : harmless.plates) plate = {};
  wing.real.resize(structure.real.size());
  wing.loops.resize(structure.loops.size());
  wing.plates.resize(structure.plates.size());
  wing.releases.resize(structure.releases.size());
  wing.base.motion = structure.base.motion;
  wing.tree = structure.tree;
  wing.bodies.resize(structure.bodies.size());
  wing.hinges.resize(structure.hinges.size());
  wing.initial_rates.resize(structure.initial_rates.size());
  for (int lane = 0; lane < W; ++lane) set_lane(lane, wing, harmless);
  return wing;
}

} // namespace wingspread
