// SPDX-License-Identifier: MIT
#include "daemon/base/base64.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "tests/support/random.h"

namespace camway::base {
namespace {

TEST(Base64, IsThatOfTheStandard) {
  // RFC 4648, section 10.
  for (const auto& [bytes, text] : {std::pair<std::string, std::string>{"", ""},
                                    {"f", "Zg=="},
                                    {"fo", "Zm8="},
                                    {"foo", "Zm9v"},
                                    {"foob", "Zm9vYg=="},
                                    {"fooba", "Zm9vYmE="},
                                    {"foobar", "Zm9vYmFy"},
                                    {"\xfb\xff\xbf", "+/+/"}}) {
    EXPECT_EQ(encode_base64(bytes), text);
    EXPECT_EQ(decode_base64(text), bytes);
  }
}

TEST(Base64, RefusesWhatIsNone) {
  for (const char* const wrong :
       {"Z", "Zm9", "Zm9v=", "Zm9*", "=m9v", "Z===", "====", "Zg==Zg=="}) {
    EXPECT_FALSE(decode_base64(wrong)) << wrong;
  }
}

TEST(Base64, ComesBack) {
  testing::Random random(64);
  for (int i = 0; i < 1000; ++i) {
    std::string bytes;
    for (int k = random.integer(0, 50); k > 0; --k) {
      bytes += static_cast<char>(random.integer(0, 255));
    }
    EXPECT_EQ(decode_base64(encode_base64(bytes)), bytes);
  }
}

}  // namespace
}  // namespace camway::base
