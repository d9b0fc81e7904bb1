// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <string_view>

#include "daemon/scene/log/scene_log.h"

namespace camway::scene {
namespace {

std::string hexadecimal(const BlobId& id) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const std::byte byte : id) {
    text += kDigits[std::to_integer<std::size_t>(byte >> 4)];
    text += kDigits[std::to_integer<std::size_t>(byte & std::byte{15})];
  }
  return text;
}

// The test vectors of FIPS 180-4.
TEST(BlobId, IsSha256) {
  EXPECT_EQ(hexadecimal(blob_id_of({})),
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  Bytes abc(3);
  std::memcpy(abc.data(), "abc", abc.size());
  EXPECT_EQ(hexadecimal(blob_id_of(abc)),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

}  // namespace
}  // namespace camway::scene
