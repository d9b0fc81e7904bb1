// SPDX-License-Identifier: MIT
#include "daemon/record/event_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <lcm/lcm-cpp.hpp>

#include "tests/support/random.h"
#include "tests/tools/camway/replay/log_builder.h"

namespace camway::record {
namespace {

using ::testing::HasSubstr;
using tools::LogBuilder;
using tools::TemporaryFolder;

std::vector<std::uint8_t> any_data(testing::Random& random, std::size_t size) {
  std::vector<std::uint8_t> data(size);
  for (std::uint8_t& byte : data) byte = static_cast<std::uint8_t>(random());
  return data;
}

LogBuilder any_log(testing::Random& random, int count) {
  LogBuilder log;
  for (int i = 0; i < count; ++i) {
    log.add_event("CHANNEL_" + std::to_string(i), any_data(random, random() % 60));
  }
  return log;
}

/// Returns the events that are read from a file with these bytes.
std::vector<LogEvent> read(const TemporaryFolder& folder, const std::string& bytes,
                           LogSummary& summary) {
  std::vector<LogEvent> events;
  summary = read_event_log(folder.write("log", bytes),
                           [&](LogEvent&& event) { events.push_back(std::move(event)); });
  return events;
}

TEST(EventLog, ReadsWhatLcmWrites) {
  const TemporaryFolder folder;
  testing::Random random(1);
  std::vector<std::vector<std::uint8_t>> written;
  {
    lcm::LogFile log(folder.file("log"), "w");
    ASSERT_TRUE(log.good());
    for (int i = 0; i < 20; ++i) {
      written.push_back(any_data(random, static_cast<std::size_t>(i) * 37));
      lcm::LogEvent event;
      event.eventnum = i;
      event.timestamp = 1000 + i;
      event.channel = "CAMWAY_TEST";
      event.datalen = static_cast<std::int32_t>(written.back().size());
      event.data = written.back().data();
      ASSERT_EQ(log.writeEvent(&event), 0);
    }
  }
  std::size_t count = 0;
  const LogSummary summary = read_event_log(folder.file("log"), [&](LogEvent&& event) {
    EXPECT_EQ(event.number, static_cast<std::int64_t>(count));
    EXPECT_EQ(event.utime, 1000 + static_cast<std::int64_t>(count));
    EXPECT_EQ(event.channel, "CAMWAY_TEST");
    EXPECT_EQ(event.data, written.at(count));
    ++count;
  });
  EXPECT_EQ(count, 20U);
  EXPECT_EQ(summary.events, 20U);
  EXPECT_EQ(summary.damage, "");
  EXPECT_EQ(summary.bytes_used, summary.bytes);
}

TEST(EventLog, UsesEveryGoodEventOfALogCutAtAnyByte) {
  const TemporaryFolder folder;
  testing::Random random(2);
  const LogBuilder log = any_log(random, 6);
  for (std::size_t length = 0; length <= log.bytes().size(); ++length) {
    std::size_t whole = 0;  // events that end at or before the cut
    bool at_an_end = length == 0;
    for (std::size_t i = 0; i < log.offsets().size(); ++i) {
      const std::size_t end =
          i + 1 < log.offsets().size() ? log.offsets()[i + 1] : log.bytes().size();
      if (end <= length) ++whole;
      at_an_end = at_an_end || end == length;
    }
    LogSummary summary;
    const auto events = read(folder, log.bytes().substr(0, length), summary);
    ASSERT_EQ(events.size(), whole) << length;
    ASSERT_EQ(summary.events, whole);
    ASSERT_EQ(summary.damage.empty(), at_an_end) << length << summary.damage;
    if (at_an_end) continue;
    EXPECT_THAT(summary.damage, HasSubstr(folder.file("log")));
    EXPECT_THAT(summary.damage, HasSubstr("breaks off"));
    EXPECT_THAT(summary.damage, HasSubstr(std::to_string(whole) + " good event"));
  }
}

TEST(EventLog, DoesNotTrustLengths) {
  const TemporaryFolder folder;
  testing::Random random(3);
  const LogBuilder log = any_log(random, 3);
  const std::size_t channel_length_at = log.offsets()[1] + 20;
  const std::size_t data_length_at = log.offsets()[1] + 24;
  for (const std::size_t at : {channel_length_at, data_length_at}) {
    for (const char first : {'\x7f', '\xff', '\x0f'}) {  // 2 GB, negative, 250 MB
      std::string bytes = log.bytes();
      bytes[at] = first;
      LogSummary summary;
      EXPECT_EQ(read(folder, bytes, summary).size(), 1U);
      EXPECT_EQ(summary.bytes_used, log.offsets()[1]);
      EXPECT_NE(summary.damage, "");
    }
  }
}

TEST(EventLog, StopsWhereThereIsNoEvent) {
  const TemporaryFolder folder;
  testing::Random random(4);
  std::string bytes = any_log(random, 3).bytes();
  bytes += "this is text and no event, longer than the head of one";
  LogSummary summary;
  EXPECT_EQ(read(folder, bytes, summary).size(), 3U);
  EXPECT_THAT(summary.damage, HasSubstr("there is no event here; 3 good events before it"));
}

TEST(EventLog, SurvivesRandomDamage) {
  const TemporaryFolder folder;
  constexpr unsigned kSeed = 5;
  testing::Random random(kSeed);
  const LogBuilder log = any_log(random, 8);
  for (int i = 0; i < 300; ++i) {
    std::string bytes = log.bytes();
    for (int k = 0; k < 3; ++k) bytes[random() % bytes.size()] = static_cast<char>(random());
    LogSummary summary;
    const auto events = read(folder, bytes, summary);
    EXPECT_EQ(events.size(), summary.events);
    EXPECT_LE(summary.bytes_used, summary.bytes);
  }
}

TEST(EventLog, SaysThatAFileIsMissingOrNone) {
  const auto ignore = [](LogEvent&&) {};
  EXPECT_THAT(read_event_log("/nonexistent/log", ignore).damage,
              HasSubstr("/nonexistent/log: does not exist"));
  EXPECT_THAT(read_event_log("/", ignore).damage, HasSubstr("cannot be read as a file"));
}

}  // namespace
}  // namespace camway::record
