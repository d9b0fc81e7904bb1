// SPDX-License-Identifier: MIT
#include "tools/view/display/glb_cache.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace camway::view {
namespace {

GlbCache::Glb of_size(std::size_t bytes) { return std::make_shared<const std::string>(bytes, 'x'); }

TEST(GlbCache, DropsWhatNobodyHasAskedForTheLongest) {
  GlbCache cache(100);
  cache.put("a", of_size(40));
  cache.put("b", of_size(40));
  EXPECT_TRUE(cache.find("a"));
  cache.put("c", of_size(40));
  EXPECT_FALSE(cache.find("b"));
  EXPECT_TRUE(cache.find("a"));
  EXPECT_TRUE(cache.find("c"));
  cache.put("d", of_size(100));
  EXPECT_FALSE(cache.find("a"));
  EXPECT_FALSE(cache.find("c"));
  EXPECT_EQ(cache.find("d")->size(), 100);
}

TEST(GlbCache, ReplacesAKeyAndCountsItOnce) {
  GlbCache cache(100);
  for (int i = 0; i < 10; ++i) cache.put("a", of_size(60));
  cache.put("b", of_size(40));
  EXPECT_TRUE(cache.find("a"));
  EXPECT_TRUE(cache.find("b"));
}

TEST(GlbCache, KeepsNothingThatIsTooLarge) {
  GlbCache cache(100);
  cache.put("a", of_size(10));
  cache.put("b", of_size(101));
  EXPECT_FALSE(cache.find("b"));
  EXPECT_TRUE(cache.find("a"));
  cache.put("a", of_size(101));
  EXPECT_FALSE(cache.find("a"));
}

}  // namespace
}  // namespace camway::view
