#include "montecarlo/report/data/page_numbers.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace wingspread;

TEST_CASE("numbers of the page have the digits asked for, and no more", "[page]") {
  CHECK(rounded(1.0 / 3) == 0.3333333);
  CHECK(rounded(-123456.789, 3) == -123000.0);
  CHECK(rounded(6.02214076e23, 4) == 6.022e23);
  CHECK(rounded(4e-320, 1) == 4e-320); // denormal
  CHECK(!std::signbit(rounded(-0.0)));
  CHECK(std::isnan(rounded(std::nan(""))));
  CHECK(page_number(std::numeric_limits<double>::infinity()).is_null());
  CHECK(page_number(std::optional<double>{}).is_null());
  CHECK(page_text(page_numbers(std::vector{0.1 + 0.2, std::nan("")})) == "[0.3,null]");
}

TEST_CASE("a share has the digits of its distance to 1", "[page]") {
  CHECK(page_share(1.0 / 3) == 0.3333333);
  CHECK(page_share(0.99) == 0.99);
  CHECK(page_share(1 - 1e-8) == 1 - 1e-8);
  CHECK(page_share(2.5e-8) == 2.5e-8);
  CHECK(page_share(1) == 1.0);
  CHECK(page_share(std::nan("")).is_null());
  Json bounds;
  add_share_bounds(bounds, {1 - 3e-9, {}});
  CHECK((bounds["lower"] == 1 - 3e-9 && bounds["upper"].is_null()));
}

TEST_CASE("nothing in the block of data can end it or begin a comment", "[page]") {
  const Json json{{"reason", "</script><!-- <b> \x80 \u2028"}};
  const std::string text = page_text(json);
  CHECK(text.find('<') == text.npos);
  CHECK(Json::parse(text)["reason"] == "</script><!-- <b> \uFFFD \u2028");
  CHECK(text.find('\n') == text.npos);
}
