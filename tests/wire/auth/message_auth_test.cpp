// SPDX-License-Identifier: MIT
#include "lcmtypes/wire/auth/message_auth.h"

#include <gtest/gtest.h>

#include <string>

#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/envelope.h"

namespace camway::wire {
namespace {

using Bytes = std::vector<std::uint8_t>;

const std::string kChannel = "CAMWAY_PLAN_REQUEST";
const Bytes kMessage{1, 2, 3, 4, 5};

std::int64_t now_us = 0;  // of the clock below
std::int64_t test_clock() { return now_us; }

std::shared_ptr<const MessageKeys> keys(const std::string& text) {
  return MessageKeys::from_text(text, "keys").keys;
}
const std::string kOld = "1 " + std::string(64, '1') + "\n";
const std::string kNew = "2 " + std::string(64, '2') + "\n";
const std::string kForged = "1 " + std::string(64, '3') + "\n";

class MessageAuthTest : public ::testing::Test {
 protected:
  void SetUp() override { now_us = 1'800'000'000'000'000; }

  static MessageAuth auth_with(const std::string& text) {
    return {keys(text), ReplayGuard::Limits{}, &test_clock};
  }
  static void expect_refused(MessageAuth& auth, const Bytes& sealed, Distrust why,
                             const std::string& channel = kChannel) {
    const MessageAuth::Opened opened = auth.open(channel, sealed);
    EXPECT_FALSE(opened.message);
    EXPECT_EQ(to_string(opened.why), to_string(why));
  }
};

TEST_F(MessageAuthTest, WhatIsSealedIsOpenedOnce) {
  MessageAuth sender = auth_with(kOld);
  MessageAuth receiver = auth_with(kOld);
  for (const Bytes& message : {Bytes{}, kMessage, Bytes(kMaxMessageBytes, 7)}) {
    const Bytes sealed = sender.seal(kChannel, message);
    EXPECT_LE(sealed.size(), kMaxEnvelopeBytes);
    const MessageAuth::Opened opened = receiver.open(kChannel, sealed);
    ASSERT_TRUE(opened.message) << to_string(opened.why);
    EXPECT_EQ(*opened.message, message);
    expect_refused(receiver, sealed, Distrust::kReplayed);
  }
}

TEST_F(MessageAuthTest, EveryBitCounts) {
  MessageAuth sender = auth_with(kOld + kNew);
  MessageAuth receiver = auth_with(kOld + kNew);
  const Bytes sealed = sender.seal(kChannel, kMessage);
  for (std::size_t bit = 0; bit < 8 * sealed.size(); ++bit) {
    Bytes altered = sealed;
    altered[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    EXPECT_FALSE(receiver.open(kChannel, altered).message) << "bit " << bit;
  }
  for (std::size_t size = 0; size < sealed.size(); ++size) {
    const Bytes cut(sealed.begin(), sealed.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_FALSE(receiver.open(kChannel, cut).message) << size << " bytes";
  }
  EXPECT_TRUE(receiver.open(kChannel, sealed).message) << "no refused one counts as seen";
}

TEST_F(MessageAuthTest, SaysWhyItDoesNotTrust) {
  MessageAuth sender = auth_with(kOld);
  MessageAuth receiver = auth_with(kOld);
  const Bytes sealed = sender.seal(kChannel, kMessage);
  expect_refused(receiver, kMessage, Distrust::kUnsigned);
  expect_refused(receiver, {}, Distrust::kUnsigned);
  expect_refused(receiver, Bytes(sealed.begin(), sealed.end() - 1), Distrust::kBroken);
  expect_refused(receiver, sealed, Distrust::kAltered, "CAMWAY_CANCEL");
  MessageAuth forger = auth_with(kForged);
  expect_refused(receiver, forger.seal(kChannel, kMessage), Distrust::kAltered);
  MessageAuth stranger = auth_with(kNew);
  expect_refused(receiver, stranger.seal(kChannel, kMessage), Distrust::kUnknownKey);
}

TEST_F(MessageAuthTest, ClocksMayDifferByTheWindow) {
  MessageAuth receiver = auth_with(kOld);
  const std::int64_t window = ReplayGuard::Limits{}.window_us;
  const std::int64_t later = now_us + 10 * window;
  const auto sealed_at = [](std::int64_t time) {
    now_us = time;
    MessageAuth sender = auth_with(kOld);
    return sender.seal(kChannel, kMessage);
  };
  for (const std::int64_t off : {-window, std::int64_t{0}, window}) {
    const Bytes sealed = sealed_at(later + off);
    now_us = later;
    EXPECT_TRUE(receiver.open(kChannel, sealed).message) << off;
  }
  for (const std::int64_t off : {-window - 1, window + 1}) {
    const Bytes sealed = sealed_at(later + off);
    now_us = later;
    expect_refused(receiver, sealed, Distrust::kStale);
  }
}

TEST_F(MessageAuthTest, WhatWasSentBeforeARestartIsNotTakenAgain) {
  MessageAuth sender = auth_with(kOld);
  const Bytes sealed = sender.seal(kChannel, kMessage);
  {
    MessageAuth receiver = auth_with(kOld);
    EXPECT_TRUE(receiver.open(kChannel, sealed).message);
  }
  now_us += 1;
  MessageAuth restarted = auth_with(kOld);
  expect_refused(restarted, sealed, Distrust::kStale);
}

TEST_F(MessageAuthTest, KeysAreChangedOneAfterTheOther) {
  MessageAuth daemon = auth_with(kOld);
  MessageAuth client = auth_with(kOld);
  const auto understand_each_other = [&] {
    return daemon.open(kChannel, client.seal(kChannel, kMessage)).message &&
           client.open(kChannel, daemon.seal(kChannel, kMessage)).message;
  };
  // The new key is known everywhere before the first use, and the old one until after the last.
  for (const std::string& text : {kOld + kNew, kNew + kOld, kNew}) {
    daemon.set_keys(keys(text));
    EXPECT_TRUE(understand_each_other()) << "the daemon has:\n" << text;
    client.set_keys(keys(text));
    EXPECT_TRUE(understand_each_other()) << "both have:\n" << text;
  }
  daemon.set_keys(keys(kOld));
  EXPECT_FALSE(understand_each_other());
}

TEST_F(MessageAuthTest, OfARecordingOnlyTheTagCounts) {
  MessageAuth sender = auth_with(kOld);
  const Bytes sealed = sender.seal(kChannel, kMessage);
  const auto known = keys(kOld);
  for (int time = 0; time < 2; ++time) {
    EXPECT_EQ(open_recorded(*known, kChannel, sealed).message, kMessage);
  }
  Bytes altered = sealed;
  altered.back() ^= 1U;
  EXPECT_FALSE(open_recorded(*known, kChannel, altered).message);
  EXPECT_FALSE(open_recorded(*known, "ELSEWHERE", sealed).message);
}

TEST_F(MessageAuthTest, WhoHasNoKeyReadsWhatIsWithin) {
  MessageAuth sender = auth_with(kOld);
  EXPECT_EQ(payload_unchecked(sender.seal(kChannel, kMessage)), kMessage);
  EXPECT_EQ(payload_unchecked(kMessage), kMessage);
  const Bytes sealed = sender.seal(kChannel, kMessage);
  EXPECT_FALSE(payload_unchecked(std::span(sealed).first(sealed.size() - 1)));
}

}  // namespace
}  // namespace camway::wire
