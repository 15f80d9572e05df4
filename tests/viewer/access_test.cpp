// Who may look at the viewer.
#include "firmware-app/viewer/access.hpp"

#include <gtest/gtest.h>

namespace pliant::viewer {
namespace {

TEST(ViewerAccess, OnTheLoopbackOnlyTheLoopbacksNamesAreAnswered) {
  EXPECT_TRUE(may_look({.host = "127.0.0.1:8080"}, ""));
  EXPECT_TRUE(may_look({.host = "localhost"}, ""));
  EXPECT_TRUE(may_look({.host = "[::1]:8080"}, ""));
  EXPECT_FALSE(may_look({.host = "evil.example:8080"}, "")) << "a name that was made to lead here";
  EXPECT_FALSE(may_look({.host = "127.evil.example"}, ""));
  EXPECT_FALSE(may_look({}, ""));
}

TEST(ViewerAccess, PagesOfOtherOriginsAreRefused) {
  EXPECT_TRUE(may_look({.host = "localhost:8080", .origin = "http://localhost:8080"}, ""));
  EXPECT_FALSE(may_look({.host = "localhost:8080", .origin = "http://localhost:9000"}, ""));
  EXPECT_FALSE(may_look({.host = "localhost:8080", .origin = "null"}, ""));
}

TEST(ViewerAccess, ElsewhereTheTokenDecides) {
  const std::string token = random_token();
  EXPECT_EQ(token.size(), 32U);
  EXPECT_NE(token, random_token());
  const std::string query = "x=1&token=" + token;
  const std::string cookie = "a=b; pliant_token=" + token;
  EXPECT_TRUE(may_look({.host = "robot:8080", .query = query}, token));
  EXPECT_TRUE(may_look({.host = "robot:8080", .cookie = cookie}, token));
  EXPECT_FALSE(may_look({.host = "robot:8080"}, token));
  EXPECT_FALSE(may_look({.host = "localhost:8080"}, token));
  EXPECT_FALSE(may_look({.host = "robot", .query = "token="}, token));
  EXPECT_FALSE(may_look({.host = "robot", .query = "token=" + token + "0"}, token));
  EXPECT_FALSE(may_look({.host = "robot", .origin = "http://other", .query = query}, token));
}

TEST(ViewerAccess, TheLoopbackIsKnown) {
  for (const char* host : {"127.0.0.1", "127.1.2.3", "localhost", "::1"})
    EXPECT_TRUE(is_loopback(host)) << host;
  for (const char* host : {"0.0.0.0", "::", "192.168.1.2", "127.x", ""})
    EXPECT_FALSE(is_loopback(host)) << host;
}

}  // namespace
}  // namespace pliant::viewer
