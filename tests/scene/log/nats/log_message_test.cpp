// SPDX-License-Identifier: MIT
#include "daemon/scene/log/nats/log_message.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "tests/scene/log/log_samples.h"

namespace camway::scene {
namespace {

LogMessage sample_message() {
  LogMessage message;
  message.id = new_message_id();
  message.after = new_message_id();
  message.before = 3;
  message.revision = 5;
  message.removed = 2;
  message.needs = {blob_id_of(log_bytes("a")), blob_id_of(log_bytes("b"))};
  message.record = log_bytes(std::string("text \0\xff", 7));
  return message;
}

TEST(LogMessage, IsReadAsItWasWritten) {
  const LogMessage message = sample_message();
  const auto read = log_message_from(bytes_of(message));
  ASSERT_TRUE(read) << read.error;
  EXPECT_EQ(read->kind, LogMessage::Kind::kEntry);
  EXPECT_EQ(read->id, message.id);
  EXPECT_EQ(read->after, message.after);
  EXPECT_EQ(read->before, 3U);
  EXPECT_EQ(read->revision, 5U);
  EXPECT_EQ(read->removed, 2U);
  EXPECT_EQ(read->needs, message.needs);
  EXPECT_EQ(read->record, message.record);
  EXPECT_FALSE(read->blob);
  LogMessage summary;
  summary.kind = LogMessage::Kind::kSummary;
  summary.id = new_message_id();
  summary.revision = 7;
  summary.replaces = {message.id};
  summary.blob = message.needs.front();
  const auto other = log_message_from(bytes_of(summary));
  ASSERT_TRUE(other) << other.error;
  EXPECT_EQ(other->kind, LogMessage::Kind::kSummary);
  EXPECT_EQ(other->replaces, summary.replaces);
  EXPECT_EQ(other->blob, summary.blob);
}

TEST(LogMessage, IsRefusedInPartAndWithMore) {
  Bytes bytes = bytes_of(sample_message());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(log_message_from(std::span(bytes).first(size))) << size;
  }
  bytes.push_back(std::byte{0});
  EXPECT_FALSE(log_message_from(bytes));
}

TEST(LogMessage, IsRefusedIfItsMembersDoNotFitTogether) {
  const auto is_refused = [](const auto& change) {
    LogMessage message = sample_message();
    change(message);
    return !log_message_from(bytes_of(message));
  };
  EXPECT_FALSE(is_refused([](LogMessage&) {}));
  EXPECT_TRUE(is_refused([](LogMessage& m) { m.before = 5; }));
  EXPECT_TRUE(is_refused([](LogMessage& m) { m.id = {}; }));
  EXPECT_TRUE(is_refused([](LogMessage& m) { m.after = m.id; }));
  EXPECT_TRUE(is_refused([](LogMessage& m) { m.kind = LogMessage::Kind::kRemoval; }));
  EXPECT_TRUE(is_refused([](LogMessage& m) { m.kind = static_cast<LogMessage::Kind>(3); }));
  EXPECT_TRUE(is_refused([](LogMessage& m) { m.replaces.resize(kMostReplaced + 1); }));
}

TEST(LogMessage, HasAnIdOfItsOwn) {
  std::set<MessageId> ids;
  for (int i = 0; i < 1000; ++i) EXPECT_TRUE(ids.insert(new_message_id()).second);
}

TEST(BlobHead, IsReadAsItWasWritten) {
  const BlobHead small{4, 0, {blob_id_of(log_bytes("a"))}, log_bytes("text")};
  const auto read = blob_head_from(bytes_of(small));
  ASSERT_TRUE(read) << read.error;
  EXPECT_EQ(read->content, small.content);
  EXPECT_EQ(read->needs, small.needs);
  EXPECT_TRUE(blob_head_from(bytes_of(BlobHead{1'000'000, 2, {}, {}})));
  EXPECT_FALSE(blob_head_from(bytes_of(BlobHead{5, 0, {}, log_bytes("text")})));
  EXPECT_FALSE(blob_head_from(bytes_of(BlobHead{4, 1, {}, log_bytes("text")})));
  EXPECT_FALSE(blob_head_from(bytes_of(BlobHead{4, 5, {}, {}})));
}

TEST(SubjectToken, HoldsAnyText) {
  for (const std::string& text :
       {std::string(), std::string("office"), std::string("a.b > *\0\n\xff", 9)}) {
    const std::string token = token_of(text);
    EXPECT_EQ(token.find_first_not_of("0123456789abcdef_"), std::string::npos);
    EXPECT_EQ(text_from_token(token), text);
  }
  EXPECT_EQ(token_of("office"), "6f6666696365");
  for (const char* const wrong : {"", "6", "6F", "6g", "__", "6f_"}) {
    EXPECT_EQ(text_from_token(wrong), std::nullopt) << wrong;
  }
  const BlobId id = blob_id_of(log_bytes("a"));
  EXPECT_EQ(blob_id_from_token(token_of(id)), id);
  EXPECT_EQ(blob_id_from_token("00"), std::nullopt);
}

}  // namespace
}  // namespace camway::scene
