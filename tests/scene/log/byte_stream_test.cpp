// SPDX-License-Identifier: MIT
#include "daemon/scene/log/byte_stream.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace camway::scene {
namespace {

TEST(ByteStream, GivesBackWhatWasWritten) {
  const double odd = std::bit_cast<double>(0x7ff0'0000'0000'0123U);  // a signalling NaN
  ByteWriter writer;
  writer.put<std::uint64_t>(0x0102'0304'0506'0708U);
  writer.put<std::int16_t>(-2);
  writer.put(-0.0);
  writer.put(std::numeric_limits<float>::denorm_min());
  writer.put_array<double>(std::array{odd});
  writer.put_flag(true);
  writer.put_text("a\0b");
  writer.put_text("");
  const Bytes bytes = std::move(writer).take();
  EXPECT_EQ(bytes[0], std::byte{8}) << "little endian";
  ByteReader reader(bytes);
  EXPECT_EQ(reader.get<std::uint64_t>(), 0x0102'0304'0506'0708U);
  EXPECT_EQ(reader.get<std::int16_t>(), -2);
  EXPECT_TRUE(std::signbit(reader.get<double>()));
  EXPECT_EQ(reader.get<float>(), std::numeric_limits<float>::denorm_min());
  std::array<std::uint64_t, 1> bits{};
  reader.get_array(std::span<std::uint64_t>(bits));
  EXPECT_EQ(bits[0], 0x7ff0'0000'0000'0123U);
  EXPECT_TRUE(reader.get_flag());
  EXPECT_EQ(reader.get_text(3), "a");
  EXPECT_FALSE(reader.is_at_end());
  EXPECT_EQ(reader.remaining(), 8U);
  EXPECT_EQ(reader.get_text(0), "");
  EXPECT_TRUE(reader.is_at_end());
}

TEST(ByteStream, FailsForEverAfterAFailure) {
  ByteWriter writer;
  for (std::uint32_t i = 1; i <= 4; ++i) writer.put(i);
  const Bytes bytes = std::move(writer).take();
  ByteReader reader(bytes);
  EXPECT_EQ(reader.get<std::uint32_t>(), 1U);
  std::array<std::uint64_t, 2> too_many{7, 7};
  reader.get_array(std::span<std::uint64_t>(too_many));
  EXPECT_TRUE(reader.has_failed());
  EXPECT_EQ(too_many[0], 7U);
  EXPECT_EQ(reader.get<std::uint32_t>(), 0U);
  EXPECT_EQ(reader.remaining(), 0U);
  EXPECT_FALSE(reader.is_at_end()) << "although nothing remains";
}

TEST(ByteStream, BelievesNoCountThatTheBytesCannotHold) {
  for (const std::uint64_t count : {std::uint64_t{3}, std::uint64_t{1} << 63, ~std::uint64_t{0}}) {
    ByteWriter writer;
    writer.put(count);
    writer.put_array<double>(std::array{1.0, 2.0});
    const Bytes bytes = std::move(writer).take();
    EXPECT_EQ(ByteReader(bytes).get_count(8), 0U);
    EXPECT_EQ(ByteReader(bytes).get_text(100).size(), count == 3 ? 3U : 0U);
    EXPECT_EQ(ByteReader(bytes).get_text(2), "") << "longer than asked for";
    ByteReader reader(bytes);
    EXPECT_EQ(reader.get_count(5), count == 3 ? 3U : 0U);
    EXPECT_EQ(reader.has_failed(), count != 3);
  }
  const Bytes two{std::byte{2}};
  ByteReader flag(two);
  flag.get_flag();
  EXPECT_TRUE(flag.has_failed());
}

}  // namespace
}  // namespace camway::scene
