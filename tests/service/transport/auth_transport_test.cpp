// SPDX-License-Identifier: MIT
#include "daemon/service/transport/auth_transport.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include "lcmtypes/wire/pages.h"
#include "tests/service/fake_transport.h"
#include "tests/support/captured_log.h"

namespace camway::service {
namespace {

using ::testing::HasSubstr;
using wire::Bytes;

std::shared_ptr<wire::MessageAuth> auth_with(char digit) {
  const auto read = wire::MessageKeys::from_text("1 " + std::string(64, digit), "keys");
  return std::make_shared<wire::MessageAuth>(read.keys, wire::ReplayGuard::Limits{});
}

class AuthTransportTest : public ::testing::Test {
 protected:
  void start(bool required) {
    transport_.emplace(inner_, auth_with('1'), required,
                       LimitedLog(log_.log(), LogLevel::kWarn, "distrusted", {}));
    ASSERT_TRUE(transport_->subscribe("IN", 10, [this](std::span<const std::uint8_t> message) {
      heard_.emplace_back(message.begin(), message.end());
    }));
  }
  void deliver(const Bytes& bytes) {
    inner_.deliver("IN", bytes);
    ASSERT_TRUE(transport_->poll(std::chrono::milliseconds(0)));
  }
  [[nodiscard]] std::int64_t distrusted(wire::Distrust why) const {
    return transport_->distrusted().at(static_cast<std::size_t>(why));
  }

  testing::FakeTransport inner_;
  testing::CapturedLog log_;
  std::optional<AuthTransport> transport_;
  std::vector<Bytes> heard_;
  const Bytes message_{1, 2, 3};
};

TEST_F(AuthTransportTest, HandsOnWhatIsSignedAndDropsAndCountsTheRest) {
  start(true);
  const auto peer = auth_with('1');
  const Bytes sealed = peer->seal("IN", message_);
  deliver(sealed);
  EXPECT_EQ(heard_, std::vector<Bytes>{message_});
  deliver(sealed);
  deliver(message_);
  deliver(peer->seal("OUT", message_));
  deliver(auth_with('2')->seal("IN", message_));
  EXPECT_EQ(heard_.size(), 1U);
  EXPECT_EQ(distrusted(wire::Distrust::kReplayed), 1);
  EXPECT_EQ(distrusted(wire::Distrust::kUnsigned), 1);
  EXPECT_EQ(distrusted(wire::Distrust::kAltered), 2);
  EXPECT_THAT(log_.text(), HasSubstr("warning distrusted message channel=IN bytes="));
}

TEST_F(AuthTransportTest, UnsignedOnesPassWhereSignaturesAreNotRequired) {
  start(false);
  deliver(message_);
  EXPECT_EQ(heard_, std::vector<Bytes>{message_});
  EXPECT_EQ(distrusted(wire::Distrust::kUnsigned), 1);
  deliver(auth_with('2')->seal("IN", message_));
  EXPECT_EQ(heard_.size(), 1U) << "a bad signature is worse than none";
}

TEST_F(AuthTransportTest, SignsWhatGoesOut) {
  start(true);
  const auto receiver = auth_with('1');
  ASSERT_TRUE(transport_->publish("OUT", message_));
  const Bytes sent = inner_.published_on("OUT").at(0);
  EXPECT_EQ(receiver->open("OUT", sent).message, message_);
}

}  // namespace
}  // namespace camway::service
