#include "drivers/common/toml_text.hpp"

#include <gtest/gtest.h>

#include "firmware-app/config/config.hpp"

namespace pliant {
namespace {

TEST(TomlText, LettersBeyondAsciiMayStandInQuotesAndComments) {
  for (const char* text : {"", "a = 1\n", "a = \"größe\" # größe\nb = 'größe'\n", "a = \"\\\"ö\\\\\"\n",
                           "# ö", "a = [\n  \"ö\", 'ö',\n]\nt = {y = \"ö\", \"ö\".z = 1}\n[\"ö\"]\n",
                           "a = \"\"\"o\\\"\"\"\"\" # ö\nb = '''o''o''' # ö\n"}) {
    EXPECT_FALSE(stray_character(text)) << text;
    EXPECT_TRUE(parse_toml(text, "a.toml")) << text;
  }
  EXPECT_TRUE(
      parse_toml("\xEF\xBB\xBF"
                 "a = 1\n",
                 "a.toml"));
}

TEST(TomlText, NamesThePlaceOfOthers) {
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
  EXPECT_EQ(at("a = [\"\"\"x\"\"\"\"\", ö]"), std::pair(std::size_t{1}, std::size_t{17}));
  EXPECT_EQ(at("a = \"\\\\\"ö"), std::pair(std::size_t{1}, std::size_t{9}));
}

TEST(TomlText, WhatIsNeitherTomlNorTextGetsItsPlace) {
  const auto fault = [](std::string_view text) {
    const Result<toml::table> parsed = parse_toml(text, "a.toml");
    EXPECT_FALSE(parsed) << text;
    return parsed ? std::string() : parsed.error().message;
  };
  EXPECT_EQ(fault("a = 1\nb = \"ö\xFF\""),
            "a.toml:2:7: not valid TOML: not UTF-8; save the file as UTF-8 text");
  for (const char* text : {"\xC0\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xE2\x82", "\xF8", "\x80"})
    EXPECT_NE(fault(text).find("not UTF-8"), std::string::npos);
  // Quotes where no string begins: toml++ would walk on over what stands in them.
  for (const char* text :
       {"a = 19x\"ö\"", "a = [1[[\"ö\"]]]", "a = 1 = \"ö\"", "a = 1{\"ö\"}", "a = t.\"ö\""})
    EXPECT_EQ(fault(text).rfind("a.toml:1:", 0), 0U) << fault(text);
}

TEST(TomlText, AConfigWithAnUmlautInAKeyGetsItsLine) {
  Config config;
  const Outcome parsed = parse_config("[track]\nmaterial = 0.5\ngröße = 1\n", "pliant.toml", config);
  ASSERT_FALSE(parsed);
  EXPECT_EQ(parsed.error().message.rfind("pliant.toml:3:3: ", 0), 0U) << parsed.error().message;
  EXPECT_TRUE(parse_config("model = \"größe.model\"\n", "pliant.toml", config));
  EXPECT_EQ(config.model, "größe.model");
}

}  // namespace
}  // namespace pliant
