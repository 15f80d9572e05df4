#include "drivers/common/toml_guard.hpp"

#include <gtest/gtest.h>

#include "firmware-app/config/config.hpp"

namespace pliant {
namespace {

TEST(TomlGuard, LettersBeyondAsciiMayStandInQuotesAndComments) {
  for (const char* text :
       {"", "a = 1\n", "a = \"größe\" # größe\nb = 'größe'\n",
        "\xEF\xBB\xBF"
        "a = 1\n",
        "a = \"\\\"ö\\\\\"\n", "# ö", "a = [\n  \"ö\", 'ö',\n{x = \"ö\", \"ö\".\"ö\" = 1}]\n[\"ö\"]\n"})
    EXPECT_FALSE(stray_character(text)) << text;
}

TEST(TomlGuard, NamesThePlaceOfOthers) {
  const auto at = [](std::string_view text) {
    const std::optional<TextPlace> place = stray_character(text);
    EXPECT_TRUE(place) << text;
    return place ? std::pair(place->line, place->column) : std::pair<std::size_t, std::size_t>(0, 0);
  };
  EXPECT_EQ(at("größe = 1"), std::pair(std::size_t{1}, std::size_t{3}));
  EXPECT_EQ(at("a = \"ö\"ö"), std::pair(std::size_t{1}, std::size_t{8}));
  EXPECT_EQ(at("# ö\n\na = 'x' ö"), std::pair(std::size_t{3}, std::size_t{9}));
  EXPECT_EQ(at("a = \"not closed\nö"), std::pair(std::size_t{2}, std::size_t{1}));
  EXPECT_EQ(at("a = \"\"\"\\\n ö\"\"\""), std::pair(std::size_t{2}, std::size_t{2}));
  EXPECT_EQ(at("a = 19x\"ö\""), std::pair(std::size_t{1}, std::size_t{9}));  // a quote inside a word
  EXPECT_EQ(at("a = \"\\\\\"ö"), std::pair(std::size_t{1}, std::size_t{9}));
}

TEST(TomlGuard, AConfigWithAnUmlautInAKeyGetsItsLine) {
  Config config;
  const Outcome parsed = parse_config("[track]\nmaterial = 0.5\ngröße = 1\n", "pliant.toml", config);
  ASSERT_FALSE(parsed);
  EXPECT_EQ(parsed.error().message.rfind("pliant.toml:3:3: ", 0), 0U) << parsed.error().message;
  EXPECT_TRUE(parse_config("model = \"größe.model\"\n", "pliant.toml", config));
  EXPECT_EQ(config.model, "größe.model");
}

}  // namespace
}  // namespace pliant
