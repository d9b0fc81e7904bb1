// SPDX-License-Identifier: MIT
#include "daemon/process/recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "lcmtypes/wire/layout.h"

namespace camway::process {
namespace {

using ::testing::HasSubstr;

TEST(Recording, IsInTheStatusWithItsTrouble) {
  DaemonOptions options;
  options.record.folder = "/var/lib/camway/recorded";
  record::RecordCounts counts;
  counts.bytes = 5'000'000'000;
  counts.dropped = 427;
  counts.trouble = "has reached record.most_bytes";
  status_t status{};
  add_recording(options, counts, status);
  EXPECT_EQ(status.recording_folder, "/var/lib/camway/recorded");
  EXPECT_EQ(status.recorded_bytes, 5'000'000'000);
  EXPECT_EQ(status.not_recorded, 427);
  EXPECT_EQ(status.recording_trouble, "has reached record.most_bytes");
  EXPECT_THAT(record_metrics(counts), HasSubstr("\ncamway_recording_failing 1\n"));
  counts.trouble.clear();
  add_recording(options, counts, status);
  EXPECT_EQ(status.recording_trouble, "");
  EXPECT_THAT(record_metrics(counts), HasSubstr("\ncamway_recording_failing 0\n"));
}

TEST(Recording, KeepsTheBeginningOfLongTexts) {
  DaemonOptions options;
  record::RecordCounts counts;
  options.record.folder = std::string(4000, 'f');
  counts.trouble = std::string(wire::kMaxRecordingTroubleBytes - 1, 't') + "\u00e4";
  status_t status{};
  add_recording(options, counts, status);
  EXPECT_EQ(status.recording_folder, std::string(wire::kMaxRecordingFolderBytes, 'f'));
  EXPECT_EQ(status.recording_trouble, std::string(wire::kMaxRecordingTroubleBytes - 1, 't'));
}

}  // namespace
}  // namespace camway::process
