#include <gtest/gtest.h>

#include <cstdint>

#include "core/memory/fixed_vector.hpp"
#include "core/memory/workspace.hpp"
#include "tests/core/synthetic.hpp"

namespace pliant {
namespace {

TEST(Workspace, HandsOutCacheLinesFrontToBack) {
  std::vector<std::byte> storage;
  const std::span<std::byte> block = synthetic::OwnedWorkspace::aligned(storage, 1024);
  Workspace workspace(block);
  const std::span<std::uint8_t> a = workspace.take<std::uint8_t>(3);
  const std::span<double> b = workspace.take<double>(9);
  ASSERT_EQ(a.size(), 3U);
  ASSERT_EQ(b.size(), 9U);
  EXPECT_EQ(static_cast<void*>(a.data()), static_cast<void*>(block.data()));
  EXPECT_EQ(static_cast<void*>(b.data()), static_cast<void*>(block.data() + 64));
  EXPECT_EQ(workspace.used(), 64U + 128U);
  EXPECT_FALSE(workspace.exhausted());
  EXPECT_FALSE(workspace.measuring());
}

TEST(Workspace, MeasuresWhatARealOneTakes) {
  Workspace measure;
  EXPECT_TRUE(measure.measuring());
  for (std::size_t n : {1U, 63U, 64U, 65U, 1000U}) EXPECT_TRUE(measure.take<std::uint32_t>(n).empty());
  EXPECT_FALSE(measure.exhausted());
  std::vector<std::byte> storage;
  Workspace real(synthetic::OwnedWorkspace::aligned(storage, measure.used()));
  for (std::size_t n : {1U, 63U, 64U, 65U, 1000U}) EXPECT_EQ(real.take<std::uint32_t>(n).size(), n);
  EXPECT_EQ(real.used(), measure.used());
  EXPECT_FALSE(real.exhausted());
}

TEST(Workspace, SaysWhenItIsExhaustedAndStaysSo) {
  std::vector<std::byte> storage;
  Workspace workspace(synthetic::OwnedWorkspace::aligned(storage, 128));
  EXPECT_EQ(workspace.take<std::byte>(128).size(), 128U);
  EXPECT_FALSE(workspace.exhausted());
  EXPECT_TRUE(workspace.take<std::byte>(1).empty());
  EXPECT_TRUE(workspace.exhausted());
  EXPECT_TRUE(workspace.take<std::byte>(0).empty());
  EXPECT_TRUE(workspace.exhausted());
}

TEST(FixedVector, HoldsUpToItsCapacity) {
  FixedVector<int, 3> v;
  EXPECT_TRUE(v.empty());
  EXPECT_TRUE(v.push_back(1));
  EXPECT_TRUE(v.push_back(2));
  EXPECT_TRUE(v.push_back(3));
  EXPECT_TRUE(v.full());
  EXPECT_FALSE(v.push_back(4));
  EXPECT_EQ(v.size(), 3U);
  EXPECT_EQ(v.back(), 3);
  v.pop_back();
  EXPECT_EQ(v.back(), 2);
  v.clear();
  EXPECT_TRUE(v.empty());
}

TEST(FixedVector, ErasesAndKeepsTheOrder) {
  FixedVector<int, 5> v;
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(v.push_back(i));
  v.erase(1);
  v.erase(3);  // the last
  v.erase(0);
  ASSERT_EQ(v.size(), 2U);
  EXPECT_EQ(v[0], 2);
  EXPECT_EQ(v[1], 3);
  int sum = 0;
  for (const int x : v.view()) sum += x;
  EXPECT_EQ(sum, 5);
}

}  // namespace
}  // namespace pliant
