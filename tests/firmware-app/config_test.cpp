#include "firmware-app/config/config.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/temporary_folder.hpp"

namespace pliant {
namespace {

std::string fault_of(std::string_view text) {
  Config config;
  const Outcome parsed = parse_config(text, "p.toml", config);
  return parsed ? std::string() : parsed.error().message;
}

TEST(Config, EmptyTextKeepsDefaults) {
  Config config;
  ASSERT_TRUE(parse_config("", "p.toml", config));
  EXPECT_EQ(config.lcm.prefix, "PLIANT");
  EXPECT_EQ(config.track.max_regions, 8);
  EXPECT_DOUBLE_EQ(config.track.budget_ms, 33);
  EXPECT_FALSE(config.track.material);  // the model says it
  EXPECT_TRUE(config.run.affinity.empty());
}

TEST(Config, ReadsEveryKey) {
  Config config;
  const Outcome parsed = parse_config(R"(model = "a.model"
source = "recording:rec"
[lcm]
url = "none"
prefix = "ARM"
publish_depth = true
[track]
budget_ms = 20
max_regions = 3
material = 0.25
[sensor]
description = "s.toml"
[run]
threads = 2
priority = 10
affinity = [0, 1]
[view]
bind = "0.0.0.0"
port = 80
)",
                                      "p.toml", config);
  ASSERT_TRUE(parsed) << parsed.error().message;
  EXPECT_EQ(config.model, "a.model");
  EXPECT_EQ(config.source, "recording:rec");
  EXPECT_EQ(config.lcm.url, "none");
  EXPECT_EQ(config.lcm.prefix, "ARM");
  EXPECT_TRUE(config.lcm.publish_depth);
  EXPECT_DOUBLE_EQ(config.track.budget_ms, 20);
  EXPECT_EQ(config.track.max_regions, 3);
  EXPECT_EQ(config.track.material, 0.25);
  EXPECT_EQ(config.sensor.description, "s.toml");
  EXPECT_EQ(config.run.threads, 2);
  EXPECT_EQ(config.run.priority, 10);
  EXPECT_EQ(config.run.affinity, (std::vector<int>{0, 1}));
  EXPECT_EQ(config.view.bind, "0.0.0.0");
  EXPECT_EQ(config.view.port, 80);
}

TEST(Config, UnknownKeyNamesPlaceAndNearestKey) {
  EXPECT_EQ(fault_of("[track]\nmax_region = 3\n"),
            "p.toml:2:1: unknown key 'track.max_region'; the nearest known one is 'track.max_regions'");
  EXPECT_EQ(fault_of("  prefx = \"A\"\n"),
            "p.toml:1:3: unknown key 'prefx'; the nearest known one is 'lcm.prefix'");
  EXPECT_EQ(fault_of("[lmc]\nurl = \"none\"\n"),
            "p.toml:1:2: unknown key 'lmc'; the nearest known one is 'lcm.url'");
}

TEST(Config, OutOfRangeNamesPlaceAndWhatIsAllowed) {
  EXPECT_EQ(fault_of("[track]\nmax_regions = 9\n"),
            "p.toml:2:15: track.max_regions must be a whole number from 1 to 8");
  EXPECT_EQ(fault_of("[track]\nbudget_ms = 0.5\n"),
            "p.toml:2:13: track.budget_ms must be a number from 1 to 1000 (ms)");
  EXPECT_NE(fault_of("[track]\nmaterial = nan\n"), "");
  EXPECT_NE(fault_of("[track]\nmax_regions = 99999999999999\n"), "");
  EXPECT_NE(fault_of("[run]\naffinity = [0, -1]\n"), "");
  EXPECT_NE(fault_of("[lcm]\nprefix = \"\"\n"), "");
}

TEST(Config, WrongTypeNamesPlaceAndWhatIsAllowed) {
  EXPECT_EQ(fault_of("[track]\nmax_regions = \"many\"\n"),
            "p.toml:2:15: track.max_regions must be a whole number from 1 to 8");
  EXPECT_EQ(fault_of("[lcm]\npublish_depth = 1\n"), "p.toml:2:17: lcm.publish_depth must be true or false");
  EXPECT_EQ(fault_of("lcm = 3\n"), "p.toml:1:7: 'lcm' must be a table, written [lcm]");
  EXPECT_NE(fault_of("[track]\nmax_regions = 3.5\n"), "");
  EXPECT_NE(fault_of("[model]\nx = 1\n"), "");
  EXPECT_NE(fault_of("[[lcm]]\nurl = \"none\"\n"), "");
}

TEST(Config, MalformedTextNamesPlace) {
  EXPECT_EQ(fault_of("[track\n").rfind("p.toml:1:7: not valid TOML", 0), 0U) << fault_of("[track\n");
  EXPECT_NE(fault_of("model = \"a\"\nmodel = \"b\"\n").find("p.toml:2:"), std::string::npos);
  EXPECT_NE(fault_of(std::string("\xff\xfe\x00", 3)), "");
}

TEST(Config, FailureLeavesTheConfigAlone) {
  Config config;
  config.lcm.prefix = "KEEP";
  EXPECT_FALSE(parse_config("[lcm]\nprefix = \"NEW\"\n[track]\nmax_regions = 0\n", "p.toml", config));
  EXPECT_EQ(config.lcm.prefix, "KEEP");
}

TEST(Config, PathsAreRelativeToTheFile) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "p.toml")
      << "model = \"a.model\"\nsource = \"recording:rec\"\n[sensor]\ndescription = "
         "\"/abs/s.toml\"\n";
  const Result<Config> config = read_config((folder / "p.toml").string());
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->model, (folder / "a.model").string());
  EXPECT_EQ(config->source, "recording:" + (folder / "rec").string());
  EXPECT_EQ(config->sensor.description, "/abs/s.toml");
}

TEST(Config, TheLogsPathIsRelativeToTheFile) {
  const test::TemporaryFolder folder;
  const auto url_of = [&](const std::string& url) {
    std::ofstream(folder / "p.toml") << "[lcm]\nurl = \"" << url << "\"\n";
    const Result<Config> config = read_config((folder / "p.toml").string());
    EXPECT_TRUE(config);
    return config ? config->lcm.url : std::string();
  };
  EXPECT_EQ(url_of("file://logs/run.log?mode=w"), "file://" + (folder / "logs/run.log").string() + "?mode=w");
  EXPECT_EQ(url_of("file://run.log"), "file://" + (folder / "run.log").string());
  for (const char* same : {"file:///abs/run.log?mode=w", "udpm://239.255.76.67:7667?ttl=0", "none", ""})
    EXPECT_EQ(url_of(same), same);
}

TEST(Config, MissingFileIsBadInput) {
  const Result<Config> config = read_config("/nowhere/p.toml");
  ASSERT_FALSE(config);
  EXPECT_EQ(config.error().kind, ErrorKind::bad_input);
  EXPECT_NE(config.error().message.find("/nowhere/p.toml"), std::string::npos);
}

TEST(Config, TheShippedFileIsValid) {
  const Result<Config> config = read_config(PLIANT_CONFIG_FOLDER "/pliant.toml");
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_TRUE(std::filesystem::exists(config->sensor.description)) << config->sensor.description;
}

}  // namespace
}  // namespace pliant
