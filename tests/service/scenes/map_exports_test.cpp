// SPDX-License-Identifier: MIT
#include "daemon/service/scenes/map_exports.h"

#include <gtest/gtest.h>

#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/checksum.h"
#include "lcmtypes/wire/layout.h"

namespace camway::service {
namespace {

using Clock = MapExports::Clock;

std::vector<std::uint8_t> some_bytes(std::size_t count) {
  std::vector<std::uint8_t> bytes(count);
  for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<std::uint8_t>(i * 7 + i / 251);
  return bytes;
}

TEST(MapPages, HoldAllBytesInOrderAndFitMessages) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, wire::kMapPageBytes,
                                 wire::kMapPageBytes + 1, 3 * wire::kMapPageBytes - 1}) {
    const std::vector<std::uint8_t> bytes = some_bytes(size);
    const Pages pages = map_pages({"client", 9}, bytes);
    std::vector<std::uint8_t> together;
    for (std::size_t i = 0; i < pages->size(); ++i) {
      ASSERT_LE((*pages)[i].size(), wire::kMaxMessageBytes);
      const auto page = wire::decode<map_page_t>((*pages)[i]);
      ASSERT_TRUE(page.message) << page.fault.text("map_page_t");
      EXPECT_EQ(page.message->client_id, "client");
      EXPECT_EQ(page.message->request_id, 9);
      EXPECT_EQ(page.message->status, map_page_t::STATUS_OK);
      EXPECT_EQ(page.message->page, static_cast<std::int32_t>(i));
      EXPECT_EQ(page.message->num_pages, static_cast<std::int32_t>(pages->size()));
      EXPECT_EQ(page.message->page_checksum,
                wire::crc64(page.message->bytes.data(), page.message->bytes.size()));
      together.insert(together.end(), page.message->bytes.begin(), page.message->bytes.end());
    }
    EXPECT_EQ(together, bytes);
  }
}

TEST(MapExports, ForgetWhatNobodyAskedForWhenOthersNeedTheRoom) {
  const Clock::time_point start = Clock::now();
  const auto at = [&](int seconds) { return start + std::chrono::seconds(seconds); };
  const auto pages = [](std::int64_t id) { return map_pages({"a", id}, some_bytes(1000)); };
  std::size_t size = 0;
  const Pages one = pages(1);
  for (const Bytes& page : *one) size += page.size();
  MapExports exports({.exports = 3, .bytes = 2 * size, .idle = std::chrono::seconds(50)});
  EXPECT_TRUE(exports.keep({"a", 1}, pages(1), at(0)));
  EXPECT_TRUE(exports.keep({"a", 2}, pages(2), at(1)));
  EXPECT_TRUE(exports.find({"a", 1}, at(2)));
  EXPECT_FALSE(exports.find({"b", 1}, at(2))) << "another client's";
  EXPECT_TRUE(exports.keep({"a", 3}, pages(3), at(3)));
  EXPECT_TRUE(exports.find({"a", 1}, at(4)));
  EXPECT_FALSE(exports.find({"a", 2}, at(4))) << "made room";
  EXPECT_EQ(exports.bytes(), 2 * size);
  EXPECT_TRUE(exports.keep({"a", 1}, pages(1), at(5)));
  EXPECT_EQ(exports.bytes(), 2 * size) << "again is not twice";
  EXPECT_TRUE(exports.keep({"a", 4}, pages(4), at(100)));
  EXPECT_EQ(exports.bytes(), size) << "what is old went";
  EXPECT_FALSE(exports.keep({"a", 5}, map_pages({"a", 5}, some_bytes(3000)), at(101)));
  EXPECT_TRUE(exports.find({"a", 4}, at(102))) << "nobody goes for what has no room at all";
}

}  // namespace
}  // namespace camway::service
