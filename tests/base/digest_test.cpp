// SPDX-License-Identifier: MIT
#include "daemon/base/digest.h"

#include <gtest/gtest.h>

#include <string_view>

namespace camway::base {
namespace {

std::string digest_of(std::string_view bytes) {
  Digest digest;
  digest.add(bytes.data(), bytes.size());
  return digest.text();
}

TEST(Digest, IsXxh3) {
  // The command `xxhsum -H2` prints the same, so other programs can compute it.
  EXPECT_EQ(digest_of(""), "99aa06d3014798d86001c324468d497f");
}

TEST(Digest, DependsOnTheBytesAndNotOnTheirPieces) {
  Digest pieces;
  pieces.add("cam", 3);
  pieces.add("", 0);
  pieces.add("way", 3);
  EXPECT_EQ(pieces.text(), digest_of("camway"));
  EXPECT_EQ(Digest::text_of(pieces.bytes()), pieces.text());
  EXPECT_NE(digest_of("camway"), digest_of("camwaz"));
}

}  // namespace
}  // namespace camway::base
