// URLs and prefixes that a user may give, checked before LCM sees them.
#include "drivers/lcm/lcm_url.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

namespace pliant {
namespace {

TEST(LcmUrl, FillsInWhatIsLeftOut) {
  for (const char* text :
       {"udpm://", "udpm://239.255.76.67", "udpm://:7667", "udpm://239.255.76.67:7667?ttl=0"}) {
    const auto url = LcmUrl::parse(text);
    ASSERT_TRUE(url) << text;
    EXPECT_EQ(url->spelled, kDefaultLcmUrl) << text;
  }
  const auto full = LcmUrl::parse("udpm://224.1.2.3:9000?recv_buf_size=2097152&ttl=1");
  ASSERT_TRUE(full);
  EXPECT_EQ(full->spelled, "udpm://224.1.2.3:9000?ttl=1&recv_buf_size=2097152");
  EXPECT_EQ(full->group, 0xE0010203U);
  EXPECT_EQ(full->port, 9000);
}

TEST(LcmUrl, EmptyTakesTheEnvironmentsElseTheDefault) {
  ASSERT_EQ(setenv("LCM_DEFAULT_URL", "udpm://239.1.1.1:7000?ttl=0", 1), 0);
  auto url = LcmUrl::parse("");
  ASSERT_TRUE(url);
  EXPECT_EQ(url->port, 7000);
  ASSERT_EQ(unsetenv("LCM_DEFAULT_URL"), 0);
  url = LcmUrl::parse("");
  ASSERT_TRUE(url);
  EXPECT_EQ(url->spelled, kDefaultLcmUrl);
}

TEST(LcmUrl, LogFilesAndMemory) {
  const auto memory = LcmUrl::parse("memq://");
  ASSERT_TRUE(memory);
  EXPECT_EQ(memory->provider, LcmUrl::Provider::in_process);
  const auto written = LcmUrl::parse("file://track.log?mode=w");
  ASSERT_TRUE(written);
  EXPECT_TRUE(written->writes);
  const auto read = LcmUrl::parse("file:///var/track.log?speed=0");
  ASSERT_TRUE(read);
  EXPECT_FALSE(read->writes);
}

TEST(LcmUrl, RefusesInOneLineThatNamesTheUrl) {
  for (const char* text :
       {"PLIANT", "udpm:/239.255.76.67", "udpm://127.0.0.1:7667", "udpm://example.org:7667",
        "udpm://240.0.0.1:1", "udpm://239.255.76.67:0", "udpm://239.255.76.67:65536",
        "udpm://239.255.76.67:76x", "udpm://239.255.76.67:7667?ttl=256",
        "udpm://239.255.76.67:7667?ttl=", "udpm://239.255.76.67:7667?tll=1",
        "udpm://239.255.76.67:7667?recv_buf_size=-1", "tcpq://127.0.0.1:7700", "mpudpm://", "http://x",
        "file://", "file://x.log?mode=x", "file://x.log?sped=1", "memq://x"}) {
    const auto url = LcmUrl::parse(text);
    ASSERT_FALSE(url) << text;
    EXPECT_EQ(url.error().kind, ErrorKind::bad_input);
    EXPECT_NE(url.error().message.find(text), std::string::npos) << url.error().message;
    EXPECT_EQ(url.error().message.find('\n'), std::string::npos);
  }
}

TEST(LcmPrefix, FitsLcmsChannelNamesWithItsSuffix) {
  EXPECT_TRUE(check_channel_prefix("PLIANT"));
  EXPECT_TRUE(check_channel_prefix("left_arm/PLIANT-2.a"));
  EXPECT_TRUE(check_channel_prefix(std::string(54, 'A')));
  for (const std::string& prefix :
       {std::string(), std::string(55, 'A'), std::string("A*"), std::string("A B"), std::string("Ä"),
        std::string("A\0B", 3), std::string("(A)")}) {
    const auto checked = check_channel_prefix(prefix);
    ASSERT_FALSE(checked) << prefix;
    EXPECT_EQ(checked.error().kind, ErrorKind::bad_input);
  }
}

}  // namespace
}  // namespace pliant
