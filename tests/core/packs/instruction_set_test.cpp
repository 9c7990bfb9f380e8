#include "core/packs/instruction_set.hpp"

#include <catch2/catch.hpp>

#include <string>

using namespace wingspread;

TEST_CASE("how well lanes were used adds up, number by number") {
  Occupancy sum{1, 20, 300, 4000, 0.5, {}}, more{10, 200, 3000, 40000, 0.25, {}};
  for (std::size_t k = 0; k < cause_names.size(); ++k)
    sum.outside[k] = 1 + static_cast<double>(k), more.outside[k] = 16 * sum.outside[k];
  sum += more;
  CHECK(sum.trial_steps == 11);
  CHECK(sum.busy == 220);
  CHECK(sum.scalar == 3300);
  CHECK(sum.returns == 44000);
  CHECK(sum.in_lanes == 0.75);
  for (std::size_t k = 0; k < cause_names.size(); ++k)
    CHECK(sum.outside[k] == 17 * (1 + static_cast<double>(k)));
  const Occupancy none{};
  CHECK(none.trial_steps + none.busy + none.scalar + none.returns == 0);
}

TEST_CASE("every instruction set has a name of its own and its number of lanes") {
  CHECK(to_string(InstructionSet::scalar) == std::string("scalar"));
  CHECK(to_string(InstructionSet::neon) == std::string("neon"));
  CHECK(to_string(InstructionSet::avx2) == std::string("avx2"));
  CHECK(to_string(InstructionSet::avx512) == std::string("avx512"));
  CHECK(lanes_of(InstructionSet::scalar) == 1);
  CHECK(lanes_of(InstructionSet::neon) == 2);
  CHECK(lanes_of(InstructionSet::avx2) == 4);
  CHECK(lanes_of(InstructionSet::avx512) == 8);
  CHECK(instruction_sets().front() == InstructionSet::scalar);
}
