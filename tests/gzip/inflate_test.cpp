// SPDX-License-Identifier: MIT
#include "daemon/gzip/inflate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <string>

#include "tests/support/random.h"

namespace camway::gzip {
namespace {

using camway::testing::Random;
using ::testing::HasSubstr;

/// The bytes as zlib compresses them, in the format of gzip.
std::string deflated(std::string bytes) {
  z_stream stream{};
  EXPECT_EQ(
      deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY),
      Z_OK);
  std::string made(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(made.data());
  stream.avail_out = static_cast<uInt>(made.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  made.resize(stream.total_out);
  deflateEnd(&stream);
  return made;
}

/// Bytes of few values, which compress well, or of all.
std::string some_bytes(Random& random, std::size_t count, int values) {
  std::string bytes(count, '\0');
  for (char& byte : bytes) byte = static_cast<char>(random.integer(0, values - 1));
  return bytes;
}

TEST(Inflate, GivesBackWhatZlibCompressed) {
  Random random(71);
  for (const std::size_t count : {0U, 1U, 1000U, 262'144U, 262'145U, 1'500'000U}) {
    for (const int values : {1, 7, 256}) {
      const std::string bytes = some_bytes(random, count, values);
      const std::string packed = deflated(bytes);
      EXPECT_TRUE(is_gzip(packed));
      const base::Result<std::string> text = inflated(packed);
      ASSERT_TRUE(text) << text.error;
      EXPECT_EQ(*text, bytes) << count << " bytes of " << values << " values";
    }
  }
}

TEST(Inflate, JoinsPartsAndLeavesWhatFollows) {
  const base::Result<std::string> text = inflated(deflated("one, ") + deflated("two") + "padding");
  ASSERT_TRUE(text) << text.error;
  EXPECT_EQ(*text, "one, two");
}

TEST(Inflate, RefusesEveryTruncation) {
  const std::string packed = deflated("Camera paths that are proved free of collision.");
  for (std::size_t bytes = 0; bytes < packed.size(); ++bytes) {
    const base::Result<std::string> text = inflated(packed.substr(0, bytes));
    ASSERT_FALSE(text) << bytes;
    EXPECT_THAT(text.error, HasSubstr("damaged or cut off"));
  }
}

TEST(Inflate, RefusesEveryDamagedByteOfDataAndChecksum) {
  const std::string packed = deflated("Camera paths that are proved free of collision.");
  constexpr std::size_t kHeaderBytes = 10;  // of RFC 1952; time and system in it are not checked
  for (std::size_t at = kHeaderBytes; at < packed.size(); ++at) {
    std::string damaged = packed;
    damaged[at] = static_cast<char>(damaged[at] ^ 1);
    EXPECT_FALSE(inflated(damaged)) << at;
  }
}

TEST(Inflate, RefusesMoreThanTheLimit) {
  const std::string packed = deflated(std::string(3U << 20U, 'a'));
  EXPECT_TRUE(inflated(packed, 3U << 20U));
  const base::Result<std::string> text = inflated(packed, (3U << 20U) - 1);
  ASSERT_FALSE(text);
  EXPECT_THAT(text.error, HasSubstr("holds more than 2 MiB"));
}

}  // namespace
}  // namespace camway::gzip
