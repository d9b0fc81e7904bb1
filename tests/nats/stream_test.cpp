// SPDX-License-Identifier: MIT
#include "daemon/nats/stream.h"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "daemon/nats/jetstream_api.h"
#include "tests/integration/process.h"
#include "tests/support/nats_server.h"
#include "tests/support/random.h"

namespace camway::nats {
namespace {

using testing::NatsServer;

constexpr std::chrono::milliseconds kStreamWait{3000};
constexpr std::uint64_t kToTheEnd = ~std::uint64_t{0};

std::span<const std::uint8_t> stream_payload(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::string text_of_message(const StoredMessage& message) {
  return std::to_string(message.sequence) + " " + message.subject + " " +
         std::string(message.payload.begin(), message.payload.end());
}

std::unique_ptr<Connection> connection_to(const std::string& url) {
  ConnectOptions options;
  options.servers = {url};
  auto opened = Connection::open(options);
  EXPECT_TRUE(opened) << opened.error;
  return opened ? *std::move(opened) : nullptr;
}

StreamConfig plain_stream() {
  StreamConfig config;
  config.name = "T";
  config.subject = "t.>";
  return config;
}

class NatsStream : public ::testing::Test {
 protected:
  std::unique_ptr<Stream> make(const StreamConfig& config) {
    auto made = Stream::ensure(*connection_, config, kStreamWait);
    EXPECT_TRUE(made) << made.error;
    return made ? *std::move(made) : nullptr;
  }
  std::string why_not(const StreamConfig& config) {
    const auto made = Stream::ensure(*connection_, config, kStreamWait);
    EXPECT_FALSE(made);
    return made.error;
  }
  static std::uint64_t put(Stream& stream, const std::string& subject, const std::string& text,
                           std::optional<std::uint64_t> expected = std::nullopt) {
    const auto done = stream.publish(subject, stream_payload(text), expected, kStreamWait);
    EXPECT_TRUE(done) << done.error;
    return done ? *done : 0;
  }
  static std::vector<std::string> all(Stream& stream, std::uint64_t from = 1,
                                      std::uint64_t to = kToTheEnd,
                                      const std::string& filter = "t.>") {
    std::vector<std::string> texts;
    const auto read = stream.read(
        from, to, filter,
        [&](const StoredMessage& message) { texts.push_back(text_of_message(message)); },
        kStreamWait);
    EXPECT_TRUE(read) << read.error;
    return texts;
  }

  const StreamConfig config_ = plain_stream();
  NatsServer server_;
  std::unique_ptr<Connection> connection_ = connection_to(server_.url());
};

TEST_F(NatsStream, KeepsMessagesInOrder) {
  const auto stream = make(config_);
  EXPECT_EQ(put(*stream, "t.a", "one"), 1U);
  EXPECT_EQ(put(*stream, "t.b", std::string("\0\xff", 2)), 2U);
  EXPECT_EQ(put(*stream, "t.a", ""), 3U);
  const std::string second = "2 t.b " + std::string("\0\xff", 2);
  EXPECT_EQ(all(*stream), (std::vector<std::string>{"1 t.a one", second, "3 t.a "}));
  EXPECT_EQ(all(*stream, 2, 2), (std::vector<std::string>{second}));
  EXPECT_EQ(all(*stream, 1, kToTheEnd, "t.a"), (std::vector<std::string>{"1 t.a one", "3 t.a "}));
  EXPECT_EQ(all(*stream, 4), (std::vector<std::string>{}));
  EXPECT_EQ(text_of_message(**stream->last("t.b", kStreamWait)), second);
}

TEST_F(NatsStream, AppendsOnlyWhereItIsExpected) {
  const auto stream = make(config_);
  const auto fault = [&](const std::string& subject, std::uint64_t expected) {
    return stream->publish(subject, {}, expected, kStreamWait).fault;
  };
  EXPECT_EQ(fault("t.a", 1), StreamFault::kConflict);
  EXPECT_EQ(put(*stream, "t.a", "", 0), 1U);
  EXPECT_EQ(fault("t.a", 0), StreamFault::kConflict);
  EXPECT_EQ(put(*stream, "t.b", "", 0), 2U);
  EXPECT_EQ(fault("t.a", 2), StreamFault::kConflict);
  EXPECT_EQ(put(*stream, "t.a", "", 1), 3U);
}

TEST_F(NatsStream, ReadsAcrossWhatIsDeleted) {
  testing::Random random(31);
  const auto stream = make(config_);
  std::vector<std::string> kept;
  for (int i = 1; i <= 200; ++i) {
    const std::string subject = random.chance(0.5) ? "t.a" : "t.b";
    put(*stream, subject, std::to_string(i));
    kept.push_back(std::to_string(i) + " " + subject + " " + std::to_string(i));
  }
  for (int round = 0; round < 4; ++round) {
    for (int i = 0; i < 40; ++i) {
      const auto sequence = static_cast<std::uint64_t>(random.integer(1, 200));
      const std::string begin = std::to_string(sequence) + " ";
      const auto was_there =
          std::erase_if(kept, [&](const auto& k) { return k.starts_with(begin); });
      const auto removed = stream->remove(sequence, kStreamWait);
      ASSERT_TRUE(removed) << removed.error;
      EXPECT_EQ(*removed, was_there > 0);
    }
    EXPECT_EQ(all(*stream), kept);
  }
  const auto purged = stream->purge("t.a", 150, kStreamWait);
  ASSERT_TRUE(purged) << purged.error;
  EXPECT_GT(*purged, 0U);
  std::erase_if(kept, [](const std::string& text) {
    return text.find("t.a") != std::string::npos && std::stoi(text) < 150;
  });
  EXPECT_EQ(all(*stream), kept);
}

TEST_F(NatsStream, ReadsAllThatIsAppendedMeanwhile) {
  constexpr std::uint64_t kMessages = 3000;
  const auto stream = make(config_);
  std::vector<std::thread> writers;
  for (int i = 0; i < 3; ++i) {
    writers.emplace_back([&, i] {
      for (std::uint64_t k = 0; k < kMessages / 3; ++k) put(*stream, "t." + std::to_string(i), "");
    });
  }
  std::uint64_t last = 0;
  const auto begin = std::chrono::steady_clock::now();
  while (last < kMessages && std::chrono::steady_clock::now() - begin < std::chrono::minutes(1)) {
    const auto read = stream->read(
        last + 1, kToTheEnd, "t.>",
        [&](const StoredMessage& message) {
          EXPECT_EQ(message.sequence, last + 1);
          last = message.sequence;
        },
        kStreamWait);
    EXPECT_TRUE(read) << read.error;
  }
  for (std::thread& writer : writers) writer.join();
  EXPECT_EQ(last, kMessages);
}

TEST_F(NatsStream, KeepsOneMessageForASubject) {
  StreamConfig config = config_;
  config.one_for_a_subject = true;
  const auto stream = make(config);
  put(*stream, "t.a", "old");
  put(*stream, "t.b", "text");
  put(*stream, "t.a", "new");
  EXPECT_EQ(all(*stream), (std::vector<std::string>{"2 t.b text", "3 t.a new"}));
  const auto subjects = stream->subjects("t.>", kStreamWait);
  ASSERT_TRUE(subjects) << subjects.error;
  EXPECT_EQ(*subjects, (std::map<std::string, std::uint64_t>{{"t.a", 1}, {"t.b", 1}}));
  const auto found = stream->last_of_any_server("t.a", kStreamWait);
  ASSERT_TRUE(found && *found);
  EXPECT_EQ(text_of_message(**found), "3 t.a new");
  const auto none = stream->last_of_any_server("t.c", kStreamWait);
  ASSERT_TRUE(none);
  EXPECT_FALSE(none->has_value());
}

TEST_F(NatsStream, TellsWhatIsNew) {
  StreamConfig config = config_;
  config.news = "new";
  const auto stream = make(config);
  std::atomic<int> news = 0;
  const auto subscription = connection_->subscribe(
      "new.>", [&](const std::string& subject, std::span<const std::uint8_t> payload) {
        if (subject == "new.a" && payload.empty()) ++news;
      });
  put(*stream, "t.a", "text");
  EXPECT_TRUE(integration::eventually([&] { return news > 0; }));
}

TEST_F(NatsStream, SaysWhenItIsFull) {
  StreamConfig config = config_;
  config.most_bytes = 2000;
  auto stream = make(config);
  StreamFault fault = StreamFault::kNone;
  for (int i = 0; i < 100 && fault == StreamFault::kNone; ++i) {
    fault = stream->publish("t.a", stream_payload(std::string(100, 'x')), std::nullopt, kStreamWait)
                .fault;
  }
  EXPECT_EQ(fault, StreamFault::kFull);
  config.most_bytes = 20'000;
  stream = make(config);
  EXPECT_GT(put(*stream, "t.a", "text"), 0U) << "the limit was raised";
  config.most_bytes = 0;
  stream = make(config);
  EXPECT_GT(put(*stream, "t.a", "text"), 0U);
}

TEST_F(NatsStream, RefusesWhatWasMadeForSomethingElse) {
  make(config_);
  StreamConfig other = config_;
  other.subject = "u.>";
  EXPECT_EQ(why_not(other),
            "stream T: was made for something else, or by another version: subjects is "
            "[\"t.>\"], not [\"u.>\"]");
  other = config_;
  other.name = "U";
  EXPECT_NE(why_not(other), "") << "subjects overlap";
  other.subject = "u.>";
  other.replicas = 3;
  EXPECT_EQ(why_not(other), "stream U: replicas > 1 not supported in non-clustered mode");
}

TEST(NatsStreams, NeedJetStream) {
  const NatsServer server("");
  const auto connection = connection_to(server.url());
  const auto made = Stream::ensure(*connection, plain_stream(), kStreamWait);
  EXPECT_EQ(made.error, server.url() + " has no JetStream, or not for this user");
}

}  // namespace
}  // namespace camway::nats
