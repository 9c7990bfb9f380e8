// Every number that `simulate --check` prints or writes, against the check that it is given.
#include "montecarlo/report/text/check_report.hpp"
#include "montecarlo/report/text/replay_report.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

using namespace wingspread;

namespace {

/// A latch time that agrees, a moment that moved by 3/4, an overtravel without a value on either side, and a rate that only
/// the reference has.
RunCheck moved_check() {
  RunCheck check;
  check.method = "seulex", check.rtol = 2.5e-11;
  check.status = "stalled", check.latch_order = "root,mid";
  check.agrees = true;
  const double none = std::nan("");
  check.outputs = {{"root.latch_time", 4.125, 4.1250001, 7, false},
                   {"root.peak_moment", 25, 100, 0, true},
                   {"mid.overtravel", none, none, 16, false},
                   {"mid.latch_rate", none, -0.5, 0, true}};
  return check;
}

std::vector<std::string> words_of_line(const std::string& text, const std::string& name) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::vector<std::string> found;
    for (std::string word; words >> word;) found.push_back(word);
    if (!found.empty() && found.front() == name) return found;
  }
  return {};
}

bool says(const std::vector<std::string>& lines, const std::string& part) {
  return std::ranges::any_of(
      lines, [&](const std::string& line) { return line.find(part) != std::string::npos; });
}

} // namespace

TEST_CASE("a check's table has both values, the unit, and the digits that agree") {
  const std::string text = check_text(moved_check());
  using Words = std::vector<std::string>;
  CHECK(words_of_line(text, "root.latch_time") ==
        Words{"root.latch_time", "s", "4.125", "4.1250001", "7"});
  CHECK(words_of_line(text, "root.peak_moment") ==
        Words{"root.peak_moment", "N·m", "25", "100", "0"});
  CHECK(words_of_line(text, "mid.overtravel") == Words{"mid.overtravel", "rad", "–", "–", "–"});
  CHECK(words_of_line(text, "mid.latch_rate") ==
        Words{"mid.latch_rate", "rad/s", "–", "-0.5", "0"});
  CHECK(text.find("CHECK by seulex at rtol 2.5e-11") != std::string::npos);
  CHECK(check_text(std::nullopt).find("none") != std::string::npos);
}

TEST_CASE("a check's JSON has the numbers, and its warnings what moved by how much") {
  const Json json = check_json(moved_check());
  CHECK(json["reference_method"] == "seulex");
  CHECK(json["reference_rtol"] == 2.5e-11);
  CHECK(json["status"] == "stalled");
  CHECK(json["latch_order"] == "root,mid");
  CHECK(json["agrees"] == true);
  REQUIRE(json["outputs"].size() == 4);
  CHECK(json["outputs"][1] == Json{{"output", "root.peak_moment"},
                                   {"value", 25.0},
                                   {"reference", 100.0},
                                   {"digits", 0},
                                   {"moved", true}});
  CHECK(json["outputs"][2]["digits"].is_null()); // neither run has it
  CHECK(json["outputs"][3]["value"].is_null());
  const auto warned = json["warnings"].get<std::vector<std::string>>();
  CHECK(warned.size() == 3); // two outputs, and what to do
  CHECK(says(warned, "root.peak_moment moves by 75 %: 25 N·m here, 100 N·m by the reference"));
  CHECK(says(warned, "mid.latch_rate: none here, -0.5 rad/s by the reference"));
  CHECK_FALSE(says(warned, "root.latch_time"));
  CHECK(check_json(std::nullopt).is_null());
}

TEST_CASE("a check without moved outputs warns of nothing, and one that ends otherwise says how") {
  RunCheck check = moved_check();
  check.outputs.resize(1);
  CHECK(check_json(check)["warnings"].empty());
  CHECK(check_text(check).find("WARNING") == std::string::npos);
  check.agrees = false;
  const auto told = [&] { return check_json(check)["warnings"][0].get<std::string>(); };
  CHECK_THAT(told(), Catch::Contains("stalls") && Catch::Contains("root,mid"));
  check.status = "deployed";
  CHECK_THAT(told(), Catch::Contains("deploys"));
  check.status = "timed_out", check.latch_order = "";
  CHECK_THAT(told(), Catch::Contains("runs to t_end") && Catch::Contains("none"));
  CHECK(check_text(check).find("WARNING") != std::string::npos);
}

TEST_CASE("the options of a simulation are those that differ from the defaults") {
  Integration how;
  Outcome ended;
  ended.status = Status::deployed;
  CHECK(options_of(how, ended).empty());
  how.rtol = 1e-6, how.t_end = 12.5;
  CHECK(options_of(how, ended) == " --rtol 1e-06 --t-end 12.5");
  how.rtol = Integration().rtol, how.t_end = Integration().t_end;
  how.atol = 2e-9, how.smoothing = 0.001;
  CHECK(options_of(how, ended) == " --atol 2e-09 --latch smoothed:0.001");
  how = Integration();
  how.method = "runge_kutta4";
  CHECK(options_of(how, ended) == " --method runge_kutta4 --step 0.0001");
  how = Integration();
  how.max_steps = 5;
  CHECK(options_of(how, ended).empty()); // simulate goes on, and needs more
  ended.status = Status::failed;
  CHECK(options_of(how, ended) == " --max-steps 5");
  ended.status = Status::deployed, how.max_steps = 2'000'000;
  CHECK(options_of(how, ended) == " --max-steps 2000000");
}
