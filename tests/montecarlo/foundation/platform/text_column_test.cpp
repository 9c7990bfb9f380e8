#include "montecarlo/foundation/platform/text_column.hpp"

#include <catch2/catch.hpp>

#include <string>

using namespace wingspread;

TEST_CASE("a column of texts has them row by row, empty ones too") {
  TextColumn texts;
  for (const char* text : {"", "root lacks 0.5 J", "", "x"}) texts.push_back(text);
  REQUIRE(texts.size() == 4);
  CHECK(
      (texts[0].empty() && texts[1] == "root lacks 0.5 J" && texts[2].empty() && texts[3] == "x"));
  texts.release();
  CHECK(texts[1] == "root lacks 0.5 J");
}

TEST_CASE("texts that come again are kept once") {
  DictionaryColumn orders;
  for (const char* text : {"root>tip", "", "root>tip", "tip>root", ""}) orders.push_back(text);
  REQUIRE(orders.size() == 5);
  CHECK((orders[2] == "root>tip" && orders[3] == "tip>root" && orders[4].empty()));
  CHECK(orders.texts().size() == 3);
  CHECK(orders.codes() == std::vector<std::uint32_t>{0, 1, 0, 2, 1});
}

TEST_CASE("a dictionary of many texts, beyond what is kept in memory") {
  DictionaryColumn column;
  constexpr std::size_t rows = 100'000, different = 40'000;
  const auto text = [](std::size_t row) { return "order " + std::to_string(row % different); };
  for (std::size_t row = 0; row < rows; ++row) column.push_back(text(row));
  column.release();
  CHECK(column.texts().size() == different);
  std::size_t same = 0;
  for (std::size_t row = 0; row < rows; ++row) same += column[row] == text(row) ? 1 : 0;
  CHECK(same == rows);
}
