// SPDX-License-Identifier: MIT
#include "daemon/service/prefix_claim.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <limits>

#include <camway/claim_t.hpp>

#include "lcmtypes/wire/check.h"
#include "tests/service/running_service.h"

namespace camway::service {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using testing::RunningService;

constexpr std::int64_t kLowest = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t kHighest = std::numeric_limits<std::int64_t>::max();

ServiceConfig with_window(std::chrono::milliseconds window) {
  ServiceConfig config;
  config.claim_window = window;
  return config;
}

/// A window longer than any test: a claim that ends earlier has another reason.
ServiceConfig asking() { return with_window(100s); }

claim_t claim(std::int8_t state, std::int64_t start_id, std::int64_t asked_by = 0,
              double served_s = 0.0) {
  claim_t message{};
  message.start_id = start_id;
  message.asked_by = asked_by;
  message.state = state;
  message.served_s = served_s;
  message.host = "elsewhere";
  message.pid = 77;
  return message;
}

class PrefixClaimTest : public ::testing::Test {
 protected:
  static claim_t said(const RunningService& running, std::size_t which) {
    const auto bytes = running.transport.message_on("CAMWAY_CLAIM", which);
    const auto decoded = wire::decode<claim_t>(bytes.value_or(Bytes{}));
    EXPECT_TRUE(decoded.message);
    return decoded.message.value_or(claim_t{});
  }
  static void hear(RunningService& running, const claim_t& message) {
    running.send_on("CAMWAY_CLAIM", wire::encode(message));
  }
  static bool serves(const RunningService& running) {
    return running.transport.wait_for_messages_on("CAMWAY_STATUS", 1);
  }
};

TEST_F(PrefixClaimTest, AsksSeveralTimesBeforeItServes) {
  RunningService running(with_window(120ms));
  const claim_t first = said(running, 0);
  EXPECT_EQ(first.state, claim_t::ASKS);
  ASSERT_TRUE(serves(running));
  const auto all = running.transport.published();
  std::size_t asked = 0;
  while (asked < all.size() && all[asked].channel == "CAMWAY_CLAIM") ++asked;
  EXPECT_GE(asked, 2U);
  EXPECT_EQ(all[asked].channel, "CAMWAY_STATUS");
  EXPECT_EQ(said(running, 1).start_id, first.start_id);
}

TEST_F(PrefixClaimTest, WithoutAWindowItAsksNobody) {
  RunningService running;
  ASSERT_TRUE(serves(running));
  EXPECT_TRUE(running.transport.published_on("CAMWAY_CLAIM").empty());
}

TEST_F(PrefixClaimTest, EndsWhereAnotherServes) {
  RunningService running(asking());
  hear(running, claim(claim_t::SERVES, kHighest, said(running, 0).start_id));
  EXPECT_EQ(running.wait_for_end(), RunOutcome::kPrefixTaken);
  EXPECT_THAT(running.log_text(), HasSubstr("another daemon serves with this prefix"));
  EXPECT_THAT(running.log_text(), HasSubstr("host elsewhere, process 77"));
  EXPECT_THAT(running.log_text(), HasSubstr("--share-prefix"));
  EXPECT_TRUE(running.transport.published_on("CAMWAY_STATUS").empty());
}

TEST_F(PrefixClaimTest, AnswersToOthersAndNoiseDoNotCount) {
  RunningService running(with_window(300ms));
  const std::int64_t own = said(running, 0).start_id;
  hear(running, claim(claim_t::SERVES, kLowest, own + 1));
  hear(running, claim(claim_t::SERVES, kLowest, 0));
  hear(running, claim(claim_t::ASKS, own));  // its own, as a network gives it back
  running.send_on("CAMWAY_CLAIM", Bytes(50, 7));
  EXPECT_TRUE(serves(running));
  EXPECT_EQ(running.stop(), RunOutcome::kDrained);
}

TEST_F(PrefixClaimTest, OfTwoThatStartTheOneWithTheLowerNumberGoesOn) {
  RunningService lower(with_window(300ms));
  said(lower, 0);
  hear(lower, claim(claim_t::ASKS, kHighest));
  RunningService higher(asking());
  said(higher, 0);
  hear(higher, claim(claim_t::ASKS, kLowest));
  EXPECT_EQ(higher.wait_for_end(), RunOutcome::kPrefixTaken);
  EXPECT_TRUE(serves(lower));
}

TEST_F(PrefixClaimTest, OneThatServesAnswersAtOnceWhoeverAsks) {
  RunningService running;
  ASSERT_TRUE(serves(running));
  hear(running, claim(claim_t::ASKS, kLowest));
  const claim_t answer = said(running, 0);
  EXPECT_EQ(answer.state, claim_t::SERVES);
  EXPECT_EQ(answer.asked_by, kLowest);
  EXPECT_NE(answer.host, "");
  EXPECT_GT(answer.pid, 0);
  EXPECT_EQ(running.stop(), RunOutcome::kDrained);
}

TEST_F(PrefixClaimTest, ALateAnswerOfAnOlderDaemonCountsStill) {
  RunningService running(with_window(1ms));
  ASSERT_TRUE(serves(running));
  hear(running, claim(claim_t::SERVES, kHighest, said(running, 0).start_id, 1000.0));
  EXPECT_EQ(running.wait_for_end(), RunOutcome::kPrefixTaken);
}

TEST_F(PrefixClaimTest, OfTwoThatServeSinceTheSameTimeOneYields) {
  RunningService lower(with_window(1ms));
  ASSERT_TRUE(serves(lower));
  hear(lower, claim(claim_t::SERVES, kHighest, said(lower, 0).start_id, 0.0));
  RunningService higher(with_window(1ms));
  ASSERT_TRUE(serves(higher));
  hear(higher, claim(claim_t::SERVES, kLowest, said(higher, 0).start_id, 0.0));
  EXPECT_EQ(higher.wait_for_end(), RunOutcome::kPrefixTaken);
  EXPECT_EQ(lower.stop(), RunOutcome::kDrained);
}

TEST_F(PrefixClaimTest, OneThatSharesItsPrefixYieldsToNobody) {
  RunningService running;
  ASSERT_TRUE(serves(running));
  hear(running, claim(claim_t::ASKS, kLowest));
  hear(running, claim(claim_t::SERVES, kLowest, said(running, 0).start_id, 1000.0));
  hear(running, claim(claim_t::ASKS, kLowest));
  said(running, 1);
  EXPECT_EQ(running.stop(), RunOutcome::kDrained);
}

TEST_F(PrefixClaimTest, AStopEndsTheAsking) {
  RunningService running(asking());
  said(running, 0);
  EXPECT_EQ(running.stop(), RunOutcome::kDrained);
}

}  // namespace
}  // namespace camway::service
