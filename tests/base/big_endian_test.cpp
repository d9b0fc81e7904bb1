// SPDX-License-Identifier: MIT
#include "daemon/base/big_endian.h"

#include <gtest/gtest.h>

#include <array>

namespace camway::base {
namespace {

TEST(BigEndian, TheFirstByteIsTheMostSignificant) {
  constexpr std::array<std::uint8_t, 8> kBytes{0xED, 0xA1, 0xDA, 0x01, 0x02, 0x03, 0x04, 0xFF};
  static_assert(big_endian(std::span(kBytes).first(4)) == 0xEDA1DA01);
  EXPECT_EQ(big_endian(kBytes), 0xEDA1DA01020304FFU);
  EXPECT_EQ(big_endian(std::span(kBytes).last(1)), 255U);
  EXPECT_EQ(big_endian({}), 0U);
}

}  // namespace
}  // namespace camway::base
