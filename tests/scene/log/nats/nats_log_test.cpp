// SPDX-License-Identifier: MIT
#include "daemon/scene/log/nats/nats_log.h"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "daemon/nats/stream.h"
#include "daemon/scene/log/nats/log_message.h"
#include "tests/integration/process.h"
#include "tests/scene/log/nats/fleet_log.h"
#include "tests/support/nats_server.h"

namespace camway::scene {
namespace {

using integration::eventually;
using std::chrono::milliseconds;
using testing::NatsServer;

constexpr milliseconds kLogWait{3000};
const std::string kAnyText("a.b > * \n \0 \xff \xc3\xa4", 13);

class NatsLogTest : public ::testing::Test {
 protected:
  FleetLog log(NatsLogOptions options = {}) {
    return FleetLog({server_.url()}, std::move(options));
  }
  /// A stream of the log, past the log.
  std::unique_ptr<nats::Stream> stream(nats::Connection& connection, const std::string& name) {
    nats::StreamConfig config;
    config.name = "camway_" + name;
    const bool is_log = name == "LOG";
    config.subject = is_log ? "camway.log.>" : "camway.blob.>";
    config.news = is_log ? "camway.news" : "";
    config.one_for_a_subject = !is_log;
    auto opened = nats::Stream::ensure(connection, config, kLogWait);
    EXPECT_TRUE(opened) << opened.error;
    return *std::move(opened);
  }

  NatsServer server_;
};

TEST_F(NatsLogTest, KeepsScenesNotesAndRemovalsBeyondARestart) {
  {
    FleetLog writer = log();
    EXPECT_EQ(writer->append(kAnyText, sample_entry(0, 3, kAnyText)).error, "");
    EXPECT_EQ(writer->append(kAnyText, sample_entry(3, 4, "")).error, "");
    EXPECT_EQ(writer->append("gone", sample_entry(0, 9, "a")).error, "");
    EXPECT_EQ(writer->remove("gone", 9).error, "");
    EXPECT_EQ(writer->append("sum", sample_entry(0, 1, "a")).error, "");
    EXPECT_EQ(writer->append("sum", sample_entry(1, 2, "b")).error, "");
    EXPECT_EQ(writer->summarize("sum", 2, log_bytes("all"), {}).error, "");
    EXPECT_EQ(writer->append("sum", sample_entry(2, 5, "c")).error, "");
    EXPECT_EQ(writer->set_note(kAnyText, kAnyText).error, "");
    EXPECT_EQ(writer->set_note("other", "old").error, "");
    EXPECT_EQ(writer->set_note("other", "").error, "");
    EXPECT_EQ(writer->note(kAnyText), kAnyText);
  }
  server_.kill();
  server_.start();
  FleetLog reader = log();
  EXPECT_EQ(text_of_scenes(*reader->scenes()), kAnyText + " at 0: \n  0 -> 3: " + kAnyText +
                                                   "\n  3 -> 4: \nsum at 2: all\n  2 -> 5: c\n");
  EXPECT_EQ(reader->highest_removed(), 9U);
  EXPECT_EQ(reader->note(kAnyText), kAnyText);
  EXPECT_EQ(reader->note("other"), "");
  EXPECT_EQ(reader->note("none"), "");
}

TEST_F(NatsLogTest, ListsNotesByTheBeginOfTheirKeys) {
  FleetLog one = log();
  ASSERT_EQ(one->set_note("of one", "1").error, "");
  ASSERT_EQ(one->set_note("of two", "old").error, "");
  ASSERT_EQ(one->set_note("of two", "2").error, "");
  ASSERT_EQ(one->set_note("of three", "3").error, "");
  ASSERT_EQ(one->set_note("of three", "").error, "");
  ASSERT_EQ(one->set_note("other", "4").error, "");
  const auto notes = log()->notes("of ");
  ASSERT_TRUE(notes) << notes.error;
  EXPECT_EQ(*notes, (std::map<std::string, std::string>{{"of one", "1"}, {"of two", "2"}}));
}

TEST_F(NatsLogTest, RemembersTheRequestsOfRemovals) {
  {
    FleetLog one = log();
    ASSERT_EQ(one->append("office", sample_entry(0, 1, "a")).error, "");
    ASSERT_EQ(one->remove("office", 1, "first").error, "");
    ASSERT_EQ(one->append("office", sample_entry(0, 2, "a")).error, "");
    ASSERT_EQ(one->remove("office", 2, "second").error, "");
    ASSERT_EQ(one->append("office", sample_entry(0, 3, "a")).error, "");
    ASSERT_EQ(one->append("hall", sample_entry(0, 1, "a")).error, "");
    ASSERT_EQ(one->remove("hall", 1, "third").error, "");
    EXPECT_EQ(one->removals(), (std::vector<std::string>{"third", "first", "second"}));
  }
  EXPECT_EQ(log()->removals(), (std::vector<std::string>{"third", "first", "second"}));
}

TEST_F(NatsLogTest, RefusesWhatDoesNotFollow) {
  FleetLog one = log();
  FleetLog two = log();
  EXPECT_EQ(one->append("office", sample_entry(1, 2, "a")).error, "there is no scene 'office'");
  EXPECT_EQ(one->append("office", sample_entry(0, 1, "a")).error, "");
  EXPECT_EQ(one->append("office", sample_entry(0, 1, "a")).error,
            "scene 'office' is at revision 1, not at 0");
  EXPECT_EQ(one->append("office", sample_entry(1, 1, "a")).fault, AppendFault::kBroken);
  // The second one does not follow, and is told by the server.
  EXPECT_EQ(two->append("office", sample_entry(0, 1, "b")).fault, AppendFault::kConflict);
  EXPECT_EQ(two->append("office", sample_entry(1, 2, "b")).error, "");
  EXPECT_EQ(one->summarize("office", 1, log_bytes("s"), {}).fault, AppendFault::kConflict);
  EXPECT_EQ(one->remove("office", 1).fault, AppendFault::kConflict);
  EXPECT_EQ(one->remove("office", 2).error, "");
  EXPECT_EQ(two->append("office", sample_entry(2, 3, "c")).fault, AppendFault::kConflict);
  EXPECT_EQ(one->remove("office", 0).error, "no scene has revision 0");
}

TEST_F(NatsLogTest, AnAppendGoesOnAfterTheSummaryOfAnother) {
  FleetLog one = log();
  FleetLog two = log();
  EXPECT_EQ(one->append("office", sample_entry(0, 1, "a")).error, "");
  EXPECT_EQ(two->append("office", sample_entry(0, 1, "a")).fault, AppendFault::kConflict);
  EXPECT_EQ(two->summarize("office", 1, log_bytes("s"), {}).error, "");
  // The revision is the same, the last message is another one.
  EXPECT_EQ(one->append("office", sample_entry(1, 2, "b")).error, "");
}

TEST_F(NatsLogTest, KeepsRecordsOfAnySize) {
  const std::string large(3'000'000, 'r');
  FleetLog writer = log();
  EXPECT_EQ(writer->append("office", sample_entry(0, 1, large)).error, "");
  EXPECT_EQ(writer->drop_unused_blobs().error, "");
  EXPECT_EQ(text_of_log({server_.url()}), "office at 0: \n  0 -> 1: " + large + "\n");
}

TEST_F(NatsLogTest, KeepsLargeBlobs) {
  std::string text(3U << 20U, 'b');
  for (std::size_t i = 0; i < text.size(); i += 7) text[i] = static_cast<char>(i);
  const SampleBlob large(text);
  const SampleBlob empty("");
  FleetLog writer = log();
  EXPECT_FALSE(writer->has_blob(large.id));
  EXPECT_FALSE(writer->blob(large.id));
  for (const SampleBlob* const blob : {&large, &empty}) {
    EXPECT_EQ(writer->put_blob(blob->id, blob->blob).error, "");
    EXPECT_EQ(writer->put_blob(blob->id, blob->blob).error, "");
    const FleetLog reader = log();
    EXPECT_TRUE(reader->has_blob(blob->id));
    const auto bytes = reader->blob(blob->id);
    ASSERT_TRUE(bytes) << bytes.error;
    EXPECT_TRUE(*bytes == blob->blob.bytes);
  }
  const SampleBlob needy("needy", {blob_id_of(log_bytes("nowhere"))});
  EXPECT_EQ(writer->put_blob(needy.id, needy.blob).fault, AppendFault::kBroken);
  EXPECT_EQ(writer->append("office", sample_entry(0, 1, "a", needy.blob.needs)).fault,
            AppendFault::kBroken);
}

TEST_F(NatsLogTest, NoticesADamagedBlob) {
  FleetLog writer = log();
  const auto blobs = stream(writer.connection(), "BLOBS");
  const SampleBlob blob(std::string(1'200'000, 'b'));
  ASSERT_EQ(writer->put_blob(blob.id, blob.blob).error, "");
  const std::string subject = "camway.blob." + token_of(blob.id);
  const auto part = blobs->last(subject + ".2", kLogWait);
  ASSERT_TRUE(part && *part);
  std::vector<std::uint8_t> bytes = (*part)->payload;
  bytes[1000] ^= 1U;
  ASSERT_TRUE(blobs->publish(subject + ".2", bytes, std::nullopt, kLogWait));
  EXPECT_EQ(writer->blob(blob.id).error,
            "a mesh or map in the log of the fleet is damaged: it has other bytes than its name "
            "says");
  ASSERT_TRUE(*blobs->purge(subject + ".2", ~std::uint64_t{0}, kLogWait) > 0);
  EXPECT_EQ(writer->blob(blob.id).error,
            "a mesh or map in the log of the fleet is damaged: a part of it is lost");
  // Another process that wants to name it has to write it again.
  FleetLog other = log();
  EXPECT_FALSE(other->has_blob(blob.id));
  EXPECT_EQ(other->put_blob(blob.id, blob.blob).error, "");
  EXPECT_TRUE(other->blob(blob.id));
}

TEST_F(NatsLogTest, NoticesADamagedLog) {
  FleetLog writer = log();
  for (std::uint64_t i = 0; i < 5; ++i) {
    ASSERT_EQ(writer->append("office", sample_entry(i, i + 1, "a")).error, "");
  }
  const auto raw = stream(writer.connection(), "LOG");
  // The first messages are the reserve.
  const auto first = raw->last("camway.log.reserve.15", kLogWait);
  ASSERT_TRUE(first && *first);
  const std::uint64_t before = (*first)->sequence;
  ASSERT_TRUE(raw->remove(before + 3, kLogWait));
  const std::string end =
      ". Restore backups of the streams camway_LOG and camway_BLOBS in NATS, or delete both to "
      "begin anew";
  EXPECT_EQ(writer->scenes().error,
            "the log of fleet 'camway' is damaged: scene 'office' lost its changes after revision "
            "2 until revision 3, before message " +
                std::to_string(before + 4) + end);
  ASSERT_TRUE(raw->publish("camway.log.scene.00", {}, std::nullopt, kLogWait));
  EXPECT_EQ(writer->scenes().error,
            "the log of fleet 'camway' is damaged: scene '" + std::string(1, '\0') + "', message " +
                std::to_string(before + 6) + ": a message is damaged, or a newer camwayd wrote it" +
                end);
}

TEST_F(NatsLogTest, SaysThatItIsFull) {
  NatsLogOptions options;
  options.most_bytes = 20'000;
  FleetLog writer = log(options);
  AppendResult result;
  for (std::uint64_t i = 0; i < 100 && result.fault == AppendFault::kNone; ++i) {
    result = writer->append("office", sample_entry(i, i + 1, std::string(1000, 'x')));
  }
  EXPECT_EQ(result.fault, AppendFault::kFull);
  EXPECT_EQ(result.error,
            "the log of the fleet has no room left (maximum bytes exceeded): make room on the "
            "disks of NATS, or raise its limits");
  const SampleBlob blob(std::string(100'000, 'b'));
  EXPECT_EQ(writer->put_blob(blob.id, blob.blob).fault, AppendFault::kFull);
  FleetLog reader = log(options);
  EXPECT_GT(reader.revision("office"), 10U);
}

TEST_F(NatsLogTest, FleetsDoNotMix) {
  NatsLogOptions other;
  other.fleet = "other";
  FleetLog one = log();
  FleetLog two = log(other);
  EXPECT_EQ(one->append("office", sample_entry(0, 1, "a")).error, "");
  EXPECT_EQ(two->append("office", sample_entry(0, 1, "b")).error, "");
  EXPECT_EQ(text_of_log({server_.url()}), "office at 0: \n  0 -> 1: a\n");
  other.fleet = "a.b";
  EXPECT_EQ(NatsLog::open(one.connection(), other).error,
            "'a.b' is no name of a fleet: letters, digits, - and _ are possible");
}

TEST_F(NatsLogTest, DropsUnusedBlobsAfterAWhile) {
  NatsLogOptions options;
  options.blob_grace = milliseconds(300);
  FleetLog one = log(options);
  const SampleBlob base("base");
  const SampleBlob difference("difference", {base.id});
  const SampleBlob unused(std::string(200'000, 'u'));
  for (const SampleBlob* const blob : {&base, &difference, &unused}) {
    ASSERT_EQ(one->put_blob(blob->id, blob->blob).error, "");
  }
  ASSERT_EQ(one->append("office", sample_entry(0, 1, "a", {difference.id})).error, "");
  EXPECT_EQ(one->drop_unused_blobs().error, "");
  FleetLog other = log(options);
  EXPECT_TRUE(other->blob(unused.id)) << "somebody may be about to name it";
  std::this_thread::sleep_for(milliseconds(350));
  EXPECT_EQ(one->drop_unused_blobs().error, "");
  EXPECT_FALSE(other->blob(unused.id));
  EXPECT_TRUE(other->blob(base.id));
  EXPECT_TRUE(other->blob(difference.id));
  const auto blobs = stream(one.connection(), "BLOBS");
  EXPECT_TRUE(eventually([&] {
    EXPECT_EQ(one->drop_unused_blobs().error, "");
    return blobs->subjects("camway.blob.>", kLogWait)->size() == 2;
  })) << "its parts go, too";
  ASSERT_EQ(one->remove("office", 1).error, "");
  EXPECT_TRUE(eventually([&] {
    EXPECT_EQ(one->drop_unused_blobs().error, "");
    return !other->blob(base.id) && !other->blob(difference.id);
  }));
}

TEST_F(NatsLogTest, DropsNoBlobThatAnotherProcessHolds) {
  NatsLogOptions options;
  options.blob_grace = milliseconds(400);
  FleetLog dropper = log(options);
  FleetLog user = log(options);
  const SampleBlob blob(std::string(200'000, 'b'));
  ASSERT_EQ(dropper->put_blob(blob.id, blob.blob).error, "");
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(dropper->drop_unused_blobs().error, "");
  std::this_thread::sleep_for(milliseconds(410));
  // The next call would drop it, if this one did not hold it.
  EXPECT_TRUE(user->has_blob(blob.id));
  ASSERT_EQ(dropper->drop_unused_blobs().error, "");
  EXPECT_TRUE(user->blob(blob.id));
  EXPECT_EQ(user->append("office", sample_entry(0, 1, "a", {blob.id})).error, "");
  std::this_thread::sleep_for(milliseconds(410));
  ASSERT_EQ(dropper->drop_unused_blobs().error, "");
  EXPECT_TRUE(user->blob(blob.id));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, milliseconds(5000));
}

TEST_F(NatsLogTest, BlobsThatAreDroppedAndPutAtOnceAreWholeOrGone) {
  NatsLogOptions options;
  options.blob_grace = milliseconds(20);
  FleetLog dropper = log(options);
  FleetLog user = log(options);
  const SampleBlob blob(std::string(150'000, 'b'));
  std::atomic<bool> ends = false;
  std::thread dropping([&] {
    while (!ends) EXPECT_EQ(dropper->drop_unused_blobs().error, "");
  });
  std::uint64_t revision = 0;
  int puts = 0;
  for (; puts < 40; ++puts) {
    std::this_thread::sleep_for(milliseconds(puts));
    EXPECT_EQ(user->put_blob(blob.id, blob.blob).error, "");
    const AppendResult named =
        user->append("office", sample_entry(0, revision + 1, "a", {blob.id}));
    // With so little grace, it may be dropped again before it is named.
    if (named.fault != AppendFault::kNone) continue;
    ++revision;
    const auto bytes = user->blob(blob.id);
    EXPECT_TRUE(bytes) << bytes.error;
    EXPECT_EQ(user->remove("office", revision).error, "");
  }
  ends = true;
  dropping.join();
  EXPECT_GT(revision, 20U);
}

TEST_F(NatsLogTest, WorksWithDurableStart) {
  FleetLog one = log();
  EXPECT_EQ(one->followed(), 0U);
  EXPECT_TRUE(one->is_in_touch());
  EXPECT_EQ(one->set_note("a", "b").error, "");
  EXPECT_EQ(one->append("office", sample_entry(0, 1, "a")).error, "");
  EXPECT_GT(log()->followed(), 0U);
}

TEST(NatsLogs, NeedJetStreamAndARight) {
  const NatsServer plain("");
  nats::ConnectOptions connect;
  connect.servers = {plain.url()};
  const auto connection = nats::Connection::open(connect);
  ASSERT_TRUE(connection) << connection.error;
  EXPECT_EQ(NatsLog::open(**connection, {}).error,
            plain.url() + " has no JetStream, or not for this user");
  NatsLogOptions options;
  options.replicas = 3;
  const NatsServer alone;
  connect.servers = {alone.url()};
  const auto other = nats::Connection::open(connect);
  ASSERT_TRUE(other) << other.error;
  EXPECT_EQ(NatsLog::open(**other, options).error,
            "stream camway_LOG: replicas > 1 not supported in non-clustered mode");
}

}  // namespace
}  // namespace camway::scene
