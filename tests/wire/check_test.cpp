// SPDX-License-Identifier: MIT
#include "lcmtypes/wire/check.h"

#include <gtest/gtest.h>
#include <lcm/lcm.h>

#include "lcmtypes/wire/channels.h"
#include "tests/messages/message_mutation.h"
#include "tests/messages/random_messages.h"
#include "tests/support/allocation_meter.h"
#include "tests/support/random.h"

namespace camway {
namespace {

using testing::AllocationMeter;
using testing::kSeed;
using testing::mutate;
using testing::Random;
using testing::random_message;
using wire::check;
using wire::Fault;
using wire::layout_of;
using Bytes = std::vector<std::uint8_t>;

/// Largest memory of a decoded message for each byte of its encoding. The maximum is a row of three
/// indices, 12 bytes on the wire: the row's vector (24) and the indices (12).
constexpr std::size_t kDecodedPerByte = 3;
constexpr std::size_t kDecodedConstant = 256;

template <class Message>
class WireCheck : public ::testing::Test {};
using Messages =
    ::testing::Types<plan_request_t, plan_response_t, cancel_t, plan_progress_t, missing_pages_t,
                     map_page_t, occupancy_request_t, occupancy_response_t, scene_request_t,
                     scene_response_t, upload_page_t, upload_status_t, watch_t, watch_report_t,
                     claim_t, status_t, error_t, envelope_t, fleet_job_t, fleet_answer_t,
                     planner_status_t>;
TYPED_TEST_SUITE(WireCheck, Messages);

TYPED_TEST(WireCheck, AcceptsWhatTheEncoderWrites) {
  Random random(kSeed);
  int within_limits = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    SCOPED_TRACE(::testing::Message() << "trial " << trial);
    const Bytes bytes = wire::encode(random_message<TypeParam>(random));
    const std::optional<Fault> fault = check(layout_of<TypeParam>(), bytes);
    if (bytes.size() > layout_of<TypeParam>().max_bytes) {
      ASSERT_TRUE(fault);
      continue;
    }
    ++within_limits;
    ASSERT_FALSE(fault) << fault->text(TypeParam::getTypeName());
    const auto decoded = wire::decode<TypeParam>(bytes);
    ASSERT_TRUE(decoded.message);
    ASSERT_EQ(wire::encode(*decoded.message), bytes);
  }
  EXPECT_GT(within_limits, 1500);
}

TYPED_TEST(WireCheck, RefusesEveryTruncationAndAnyTrailingByte) {
  Random random(kSeed);
  for (int trial = 0; trial < 20; ++trial) {
    Bytes bytes = wire::encode(random_message<TypeParam>(random));
    if (bytes.size() >= layout_of<TypeParam>().max_bytes) continue;
    const std::size_t step = 1 + bytes.size() / 500;
    for (std::size_t size = 0; size < bytes.size(); size += step) {
      ASSERT_TRUE(check(layout_of<TypeParam>(), std::span(bytes).first(size)))
          << "trial " << trial << ", " << size << " bytes";
    }
    bytes.push_back(0);
    ASSERT_TRUE(check(layout_of<TypeParam>(), bytes));
  }
}

// 17,000 mutants of each type. A message that passes the check must decode without an exception,
// with little memory, and be the message that was sent. A refused one never reaches the decoder.
TYPED_TEST(WireCheck, MutantsAreRefusedOrHarmless) {
  constexpr int kMutants = 17'000;
  Random random(kSeed);
  Bytes original;
  int accepted = 0;
  for (int trial = 0; trial < kMutants; ++trial) {
    SCOPED_TRACE(::testing::Message() << "trial " << trial);
    if (trial % 20 == 0) original = wire::encode(random_message<TypeParam>(random));
    Bytes bytes = original;
    mutate(bytes, random);

    const wire::Layout layout = layout_of<TypeParam>();
    std::optional<Fault> fault;
    ASSERT_NO_THROW(fault = check(layout, bytes));
    if (fault) {
      ASSERT_FALSE(fault->reason.empty());
      continue;
    }
    ++accepted;
    std::optional<wire::Decoded<TypeParam>> decoded;
    const AllocationMeter meter;
    ASSERT_NO_THROW(decoded = wire::decode<TypeParam>(bytes));
    ASSERT_LE(meter.bytes(), kDecodedPerByte * bytes.size() + kDecodedConstant);
    ASSERT_TRUE(decoded->message) << decoded->fault.text("");
    ASSERT_EQ(wire::encode(*decoded->message), bytes);
  }
  EXPECT_GT(accepted, kMutants / 50) << "the mutants are too wild to test anything";
  EXPECT_LT(accepted, kMutants);
}

TYPED_TEST(WireCheck, AllocatesNothingForAMessageThatIsRight) {
  Random random(kSeed);
  for (int trial = 0; trial < 100; ++trial) {
    const Bytes bytes = wire::encode(random_message<TypeParam>(random));
    if (bytes.size() > layout_of<TypeParam>().max_bytes) continue;
    const wire::Layout layout = layout_of<TypeParam>();
    const AllocationMeter meter;
    const bool right = !check(layout, bytes);
    ASSERT_EQ(meter.bytes(), 0U);
    ASSERT_TRUE(right);
  }
}

/// Returns a message with the int32 at `offset` from the begin replaced by `value`.
Bytes with_int32(Bytes bytes, std::size_t offset, std::int32_t value) {
  const auto bits = static_cast<std::uint32_t>(value);
  for (std::size_t i = 0; i < 4; ++i) {
    bytes[offset + i] = static_cast<std::uint8_t>(bits >> (24 - 8 * i));
  }
  return bytes;
}

occupancy_request_t small_batch() {
  occupancy_request_t message{};
  message.client_id = "abc";
  message.scene = "room";
  message.num_points = 1;
  message.points_m = {{1, 2, 3}};
  return message;
}

// Offsets in small_batch().
constexpr std::size_t kClientIdLength = 8;
constexpr std::size_t kClientId = kClientIdLength + 4;
constexpr std::size_t kPointCount = kClientId + 4 + 8 + 8 + 4 + 5 + 8;

struct HostileCase {
  const char* what;
  Bytes bytes;
  const char* field;
  const char* reason;
};

// On the first five, the decoder of LCM 1.3.1 threw or allocated 1.5 GB.
TEST(WireCheckFaults, NamesTheFieldAtFault) {
  const Bytes good = wire::encode(small_batch());
  Bytes no_nul = good;
  no_nul[kClientId + 3] = 'd';
  Bytes inner_nul = good;
  inner_nul[kClientId + 1] = 0;
  Bytes other_type = good;
  other_type[3] ^= 1;
  Bytes trailing = good;
  trailing.push_back(7);
  const std::vector<HostileCase> cases{
      {"count -1", with_int32(good, kPointCount, -1), "points_m", "count -1 is negative"},
      {"count 2^31-1", with_int32(good, kPointCount, 0x7fffffff), "points_m", "bytes"},
      {"count 2e8", with_int32(good, kPointCount, 200'000'000), "points_m", "4800000000 bytes"},
      {"length 0", with_int32(good, kClientIdLength, 0), "client_id", "length 0 is below 1"},
      {"length -5", with_int32(good, kClientIdLength, -5), "client_id", "length -5 is below 1"},
      {"length too large", with_int32(good, kClientIdLength, 34), "client_id", "above 32"},
      {"no NUL", no_nul, "client_id", "does not end in a NUL"},
      {"inner NUL", inner_nul, "client_id", "holds a NUL before its end"},
      {"other type", other_type, "fingerprint", "other type or other version"},
      {"trailing byte", trailing, "", "1 bytes follow"},
      {"nothing", {}, "message", "needs 8 bytes, only 0 are left"},
      {"too long", Bytes(wire::kMaxMessageBytes + 1), "", "59901 bytes are more"},
  };
  ASSERT_FALSE(check(layout_of<occupancy_request_t>(), good));
  for (const HostileCase& hostile : cases) {
    SCOPED_TRACE(hostile.what);
    const std::optional<Fault> fault = check(layout_of<occupancy_request_t>(), hostile.bytes);
    ASSERT_TRUE(fault);
    EXPECT_EQ(fault->field, hostile.field);
    EXPECT_NE(fault->reason.find(hostile.reason), std::string::npos) << fault->reason;
  }
}

TEST(WireCheckFaults, NamesTheElementAtFault) {
  status_t status{};
  status.scenes.resize(3);
  status.num_scenes = 3;
  status.scenes[2].name = std::string(wire::kMaxSceneNameBytes + 1, 'x');
  const std::optional<Fault> fault = check(layout_of<status_t>(), wire::encode(status));
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->text("status_t"), "status_t.scenes[2].name: length 129 is above 128");
}

TEST(PeekSender, ReadsIdsOfABrokenRequest) {
  occupancy_request_t message = small_batch();
  message.request_id = -7;
  Bytes bytes = wire::encode(message);
  bytes.resize(kClientId + 4 + 8);
  ASSERT_TRUE(check(layout_of<occupancy_request_t>(), bytes));
  const std::optional<wire::Sender> sender =
      wire::peek_sender(layout_of<occupancy_request_t>(), bytes);
  ASSERT_TRUE(sender);
  EXPECT_EQ(sender->client_id, "abc");
  EXPECT_EQ(sender->request_id, -7);
}

TEST(PeekSender, RefusesWhatMustNotBecomeAChannel) {
  for (const std::string& id : {std::string(""), std::string("a b"), std::string(".*"),
                                std::string("ä"), std::string(33, 'x')}) {
    occupancy_request_t message = small_batch();
    message.client_id = id;
    EXPECT_FALSE(wire::peek_sender(layout_of<occupancy_request_t>(), wire::encode(message))) << id;
  }
  const Bytes good = wire::encode(small_batch());
  EXPECT_TRUE(wire::peek_sender(layout_of<occupancy_request_t>(), good));
  EXPECT_FALSE(wire::peek_sender(layout_of<plan_request_t>(), good)) << "another type";
  for (std::size_t size = 0; size < kClientId + 4 + 8; ++size) {
    EXPECT_FALSE(wire::peek_sender(layout_of<occupancy_request_t>(), std::span(good).first(size)));
  }
  EXPECT_FALSE(
      wire::peek_sender(layout_of<occupancy_request_t>(), with_int32(good, kClientIdLength, -5)));
}

TEST(Channels, FitLcmWithTheLongestNames) {
  const wire::Channels channels{std::string(wire::kMaxPrefixLength, 'P')};
  const std::string id(wire::kMaxClientIdLength, 'c');
  ASSERT_TRUE(wire::is_prefix(channels.prefix) && wire::is_client_id(id));
  EXPECT_EQ(wire::kMaxChannelLength, std::size_t{LCM_MAX_CHANNEL_NAME_LENGTH});
  EXPECT_LE(channels.occupancy_response(id).size(), wire::kMaxChannelLength);
  EXPECT_LE(channels.plan_response(id).size(), wire::kMaxChannelLength);
}

}  // namespace
}  // namespace camway
