// SPDX-License-Identifier: MIT
#include "daemon/service/log/limited_log.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/captured_log.h"
#include "tests/support/random.h"

namespace camway::service {
namespace {

using namespace std::chrono_literals;
using Time = LimitedLog::Clock::time_point;

constexpr std::uint64_t kLogSeed = 20261122;
const Time kBegin = Time{} + 1h;

std::size_t lines_of(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

TEST(LimitedLog, ABurstThenTheRateAndWhatWasLeftOutIsSaid) {
  testing::CapturedLog log;
  LimitedLog limited(log.log(), LogLevel::kWarn, "answers",
                     {.lines_per_s = 2.0, .burst_lines = 3.0});
  for (int i = 0; i < 10; ++i) limited.write("line", {{"number", i}}, kBegin);
  EXPECT_EQ(log.text(), "warning line number=0\nwarning line number=1\nwarning line number=2\n");
  log.clear();
  limited.report_suppressed(kBegin + 400ms);
  EXPECT_EQ(log.text(), "");
  limited.report_suppressed(kBegin + 500ms);
  EXPECT_EQ(log.text(), "warning lines left out kind=answers lines=7\n");
  log.clear();
  limited.write("line", {}, kBegin + 1s);
  EXPECT_EQ(log.text(), "warning line\n");
}

TEST(LimitedLog, AFloodIsCountedButEveryTenSeconds) {
  testing::CapturedLog log;
  LimitedLog limited(log.log(), LogLevel::kWarn, "answers",
                     {.lines_per_s = 10.0, .burst_lines = 5.0});
  std::size_t written = 0;
  for (Time now = kBegin; now < kBegin + 35s; now += 10ms, ++written) {
    limited.write("line", {}, now);
    limited.report_suppressed(now);
  }
  std::size_t told = 0;
  const std::string text = log.text();
  for (std::size_t at = text.find("left out"); at != std::string::npos;
       at = text.find("left out", at + 1)) {
    ++told;
  }
  EXPECT_EQ(told, 4u) << "one soon after the burst, then every ten seconds";
  EXPECT_GT(lines_of(text), 300u) << "the others go on at their rate";
  EXPECT_GT(written, 3000u);
}

TEST(LimitedLog, NoStretchOfTimeHoldsMoreThanTheLimitsSayAndNothingIsForgotten) {
  testing::CapturedLog log;
  constexpr double kRate = 10.0;
  constexpr double kBurst = 5.0;
  LimitedLog limited(log.log(), LogLevel::kInfo, "x", {kRate, kBurst});
  testing::Random random(kLogSeed);
  std::vector<Time> logged;
  Time now = kBegin;
  std::size_t before = 0;
  for (int i = 0; i < 2000; ++i) {
    now += std::chrono::milliseconds(random() % 50);
    limited.write("line", {}, now);
    const std::size_t lines = lines_of(log.text());
    logged.insert(logged.end(), lines - before, now);
    before = lines;
  }
  for (std::size_t first = 0; first < logged.size(); first += 7) {
    for (std::size_t last = first; last < logged.size(); last += 13) {
      const std::chrono::duration<double> span = logged[last] - logged[first];
      ASSERT_LE(static_cast<double>(last - first + 1), kBurst + kRate * span.count() + 1e-6);
    }
  }
  limited.report_suppressed(now + 1h);
  std::istringstream text(log.text());
  std::int64_t counted = 0;
  for (std::string line; std::getline(text, line);) {
    const std::size_t at = line.find("lines=");
    counted += at == std::string::npos ? 1 : std::stoll(line.substr(at + 6));
  }
  EXPECT_EQ(counted, 2000);
}

}  // namespace
}  // namespace camway::service
