// What the viewer listens to.
#include "firmware-app/viewer/listener.hpp"

#include <gtest/gtest.h>

namespace pliant::viewer {
namespace {

TEST(ViewerListener, TakesEveryPrefixThatATrackerTakes) {
  for (const std::size_t length : {std::size_t{1}, std::size_t{46}, std::size_t{47}, std::size_t{54}}) {
    Stream stream;
    Listener listener("memq://", std::string(length, 'A'), stream);
    const Outcome connected = listener.connect();
    EXPECT_TRUE(connected) << connected.error().message;
    EXPECT_EQ(listener.link().fault, "");
  }
  Stream stream;
  Listener listener("memq://", std::string(55, 'A'), stream);
  EXPECT_FALSE(listener.connect());
}

}  // namespace
}  // namespace pliant::viewer
