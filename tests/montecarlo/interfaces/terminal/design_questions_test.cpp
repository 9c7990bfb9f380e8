#include "montecarlo/interfaces/terminal/design_questions.hpp"

#include <catch2/catch.hpp>

#include <sstream>

using namespace wingspread;

TEST_CASE("answers on a terminal make a wing; an empty line keeps what is in brackets") {
  std::istringstream in("sat\n2\n4\ny\n70.866 in\n\n9 kg\n"
                        "\n\n\n\n\n12 in*lbf\n\n\n0\n");
  std::ostringstream out;
  const WingDesign design = ask_design(in, out).value();
  CHECK(design.name == "sat");
  CHECK(design.wings == 2);
  CHECK(design.panels == 4);
  CHECK(design.yoke);
  CHECK(design.panel_length == Approx(1.8).epsilon(1e-4));
  CHECK(design.panel_width == WingDesign().panel_width);
  CHECK(design.panel_mass == 9);
  CHECK(design.yoke_length == WingDesign().yoke_length);
  CHECK(design.spring == Approx(12 * 0.0254 * 4.4482216152605));
  CHECK(design.damper == 0);
  CHECK(out.str().find("mass of the yoke [3.5 kg]: ") != std::string::npos);
}

TEST_CASE("an answer that cannot be read is asked again") {
  std::istringstream in("sat\nthree\n1\n99\n2\nn\n-1\n3 kg\n2\n" + std::string(20, '\n'));
  std::ostringstream out;
  const WingDesign design = ask_design(in, out).value();
  CHECK(design.panels == 2);
  CHECK_FALSE(design.yoke);
  CHECK(design.panel_length == 2);
  CHECK(design.panel_mass == WingDesign().panel_mass);
  const std::string said = out.str();
  CHECK(said.find("  found three, expected 1 to 2\n") != std::string::npos);
  CHECK(said.find("  found 99, expected 1 to 20\n") != std::string::npos);
  CHECK(said.find("  found -1, expected a number, m, > 0") != std::string::npos);
  CHECK(said.find("  found 3 kg, expected a number, m, > 0") != std::string::npos);
  CHECK(said.find("yoke [") == std::string::npos); // nothing more of a yoke
}

TEST_CASE("no wing is made when the input ends before the last answer") {
  // a yoke and several panels: all numbers are asked for, and the damper
  const std::string answers = "sat\n2\n4\ny\n" + std::string(design_numbers().size() + 1, '\n');
  for (std::size_t length = 0; length <= answers.size(); ++length) {
    CAPTURE(length);
    std::istringstream in(answers.substr(0, length));
    std::ostringstream out;
    CHECK(ask_design(in, out).has_value() == (length == answers.size()));
  }
}

TEST_CASE("the command of a wing names what is not the default") {
  CHECK(command_of({}) == "wingspread new");
  WingDesign design;
  design.name = "sat", design.wings = 2, design.panels = 4, design.yoke = true;
  design.panel_mass = 9, design.damper = 0;
  CHECK(command_of(design) ==
        "wingspread new --name sat --wings 2 --panels 4 --yoke --panel-mass 9 --damper 0");
  CHECK(command_of({}, "a b&c") == "wingspread new --out 'a b&c'");
}

TEST_CASE(
    "a number of a wing is finite and above 0, or 0 where it may be, in any unit of its kind") {
  for (const DesignNumber& number : design_numbers()) {
    CAPTURE(number.option);
    WingDesign design;
    const double usual = design.*number.value;
    const std::string unit = " " + std::string(number.dimension.unit);
    for (const std::string refused : {"-1", "-0.001", "inf", "nan", "1 K", "", "one"}) {
      CAPTURE(refused);
      CHECK(read_design_number(refused, number, design).has_value());
      CHECK(design.*number.value == usual);
    }
    for (const std::string zero : {"0", "0.0"})
      for (const std::string& text : {zero, zero + unit})
        CHECK(read_design_number(text, number, design).has_value() == !number.may_be_zero);
    for (const std::string& text : {std::string("0.25"), "0.25" + unit}) {
      CHECK_FALSE(read_design_number(text, number, design));
      CHECK(design.*number.value == 0.25);
    }
  }
  WingDesign design;
  CHECK(read_damper("-1", design).has_value());
  CHECK_FALSE(design.damper);
  CHECK_FALSE(read_damper("0", design));
  CHECK(design.damper == 0);
}
