/// Changes one value, key or element of a JSON document at a time, so that the result is JSON and passes the parser. One
/// change in four is libFuzzer's own, on the bytes.
#include <nlohmann/json.hpp>

#include <array>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <vector>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

using Json = nlohmann::ordered_json;
using Random = std::minstd_rand;

/// Boundary values.
constexpr std::array values{"0",
                            "-0.0",
                            "1",
                            "-1",
                            "2",
                            "0.5",
                            "1e-300",
                            "5e-324",
                            "1e308",
                            "-1e308",
                            "2147483648",
                            "9223372036854775807",
                            "18446744073709551615",
                            "1e19",
                            "null",
                            "true",
                            "[]",
                            "{}",
                            "[[]]",
                            "\"\"",
                            "\"*\"",
                            "\"base\"",
                            "\"free\"",
                            "\"prescribed\"",
                            "\"exact\"",
                            "\"auto\"",
                            "\"sobol\"",
                            "\"latin_hypercube\"",
                            "\"hinges.*.spring.torque_stowed\"",
                            "\"bodies.*.mass\"",
                            "[0,0]",
                            "[1,2,3]",
                            "\"\\u001b[2J\"",
                            "\"a\\nb\"",
                            R"({"type":"normal","mean":1,"std":0.1})",
                            R"({"type":"discrete","values":[1,2],"weights":[1,0]})",
                            R"({"type":"beta","alpha":1e-3,"beta":1e3,"lower":0,"upper":1})",
                            R"({"lower":0.9,"upper":1.1})",
                            "\"1 deg\"",
                            "\"-2 in*lbf\"",
                            "\"1e400 N*m/rad\"",
                            "\"power\"",
                            "\"eddy_current\"",
                            "\"monotone\"",
                            "\"hinges.*.damper.scale\"",
                            "\"synchronisations.*.stiffness\"",
                            R"({"table":{"angle":[2,1,0],"torque":[1,"3 N*mm",-1]}})",
                            R"({"angle":[2,1,0],"deploying":[1,1,1],"stowing":[2,2,1]})",
                            R"({"table":{"travel":[0,1,4],"travel_of_second":[0,2,3]}})",
                            R"({"stiffness":1e9,"dissipation":1,"gap":0})",
                            R"({"time":[0,1,3],"rate":[0,0.1,0]})",
                            R"({"time":[-1,0.5],"acceleration":[[0,1],[1,0]]})"};

std::size_t below(Random& random, std::size_t count) { return random() % count; }

/// Every value of the document, the root first.
void gather(Json& at, std::vector<Json*>& all) {
  all.push_back(&at);
  if (at.is_structured())
    for (Json& each : at) gather(each, all);
}

void change_member(Json& object, const std::vector<Json*>& all, Random& random) {
  auto member = object.begin();
  std::advance(member, below(random, object.size()));
  const std::string key = member.key();
  if (below(random, 2) == 0) return void(object.erase(key));
  const Json& donor = *all[below(random, all.size())]; // a key of another object
  if (donor.is_object() && !donor.empty()) object[donor.begin().key()] = Json(*member);
}

void change_element(Json& array, Random& random) {
  const std::size_t index = below(random, array.size());
  if (below(random, 2) == 0)
    array.erase(index);
  else
    array.push_back(Json(array[index]));
}

void change(Json& document, Random& random) {
  std::vector<Json*> all;
  gather(document, all);
  Json& at = *all[below(random, all.size())];
  const std::size_t how = below(random, 4);
  if (how == 0 && at.is_object() && !at.empty()) return change_member(at, all, random);
  if (how == 0 && at.is_array() && !at.empty()) return change_element(at, random);
  if (how == 1) return void(at = Json(*all[below(random, all.size())]));
  if (how == 2 && at.is_number()) {
    const double scale[] = {-1, 0.5, 2, 1e-8, 1e8};
    return void(at = at.get<double>() * scale[below(random, 5)]);
  }
  at = Json::parse(values[below(random, values.size())]);
}

} // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  Random random(seed);
  Json document = Json::parse(data, data + size, nullptr, false);
  if (document.is_discarded() || below(random, 4) == 0) return LLVMFuzzerMutate(data, size, most);
  for (std::size_t changes = 1 + below(random, 3); changes > 0; --changes) change(document, random);
  const std::string text = document.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() > most) return LLVMFuzzerMutate(data, size, most);
  std::memcpy(data, text.data(), text.size());
  return text.size();
}
