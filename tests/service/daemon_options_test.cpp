// SPDX-License-Identifier: MIT
#include "daemon/service/daemon_options.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <vector>

namespace camway::service {
namespace {

ParsedOptions parse(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "camwayd");
  return parse_daemon_options(static_cast<int>(arguments.size()), arguments.data());
}

TEST(DaemonOptions, Defaults) {
  unsetenv("LCM_DEFAULT_URL");
  const ParsedOptions parsed = parse({"--scene", "office=o.obj"});
  ASSERT_TRUE(parsed.options);
  EXPECT_EQ(parsed.options->lcm_url, "udpm://239.255.76.67:7667?ttl=0");
  EXPECT_EQ(parsed.options->service.prefix, "CAMWAY");
  EXPECT_GE(parsed.options->service.workers, 1);
  EXPECT_EQ(parsed.options->log_level, spdlog::level::info);
}

TEST(DaemonOptions, TheEnvironmentNamesTheUrlUnlessTheCommandLineDoes) {
  setenv("LCM_DEFAULT_URL", "memq://", 1);
  EXPECT_EQ(parse({"--scene", "a=b"}).options->lcm_url, "memq://");
  EXPECT_EQ(parse({"--scene", "a=b", "--url", "udpm://"}).options->lcm_url, "udpm://");
  unsetenv("LCM_DEFAULT_URL");
}

TEST(DaemonOptions, ReadsEveryFlag) {
  const ParsedOptions parsed =
      parse({"--scene", "a=x.obj,scale=2", "--scene", "b=y.obj,occupancy=0.1", "--prefix", "TEST",
             "--workers", "3", "--queue", "5", "--client-queue", "2", "--deadline-s", "1.5",
             "--max-deadline-s", "4", "--log-level", "warn"});
  ASSERT_TRUE(parsed.options);
  const DaemonOptions& options = *parsed.options;
  ASSERT_EQ(options.scenes.size(), 2U);
  EXPECT_EQ(options.scenes[0].options.import.scale, 2.0);
  EXPECT_EQ(options.scenes[1].options.occupancy_resolution_m, 0.1);
  EXPECT_EQ(options.service.prefix, "TEST");
  EXPECT_EQ(options.service.workers, 3);
  EXPECT_EQ(options.service.queue.jobs, 5U);
  EXPECT_EQ(options.service.queue.jobs_of_a_client, 2U);
  EXPECT_EQ(options.service.deadline.default_s, 1.5);
  EXPECT_EQ(options.service.deadline.max_s, 4.0);
  EXPECT_EQ(options.log_level, spdlog::level::warn);
}

TEST(DaemonOptions, BadFlagsEndWithCode2AndSayWhy) {
  const std::vector<std::pair<std::vector<const char*>, std::string>> table{
      {{}, "--scene"},
      {{"--scene", "office.obj"}, "must be NAME=FILE"},
      {{"--scene", "a=b,scale=x"}, "scale=x"},
      {{"--scene", "a=b", "--scene", "a=c"}, "'a' is given twice"},
      {{"--scene", "a=b", "--workers", "0"}, "workers"},
      {{"--scene", "a=b", "--workers", "many"}, "--workers"},
      {{"--scene", "a=b", "--queue", "-1"}, "--queue"},
      {{"--scene", "a=b", "--client-queue", "0"}, "--client-queue"},
      {{"--scene", "a=b", "--prefix", "no blanks"}, "prefix 'no blanks'"},
      {{"--scene", "a=b", "--deadline-s", "nan"}, "deadline"},
      {{"--scene", "a=b", "--log-level", "loud"}, "--log-level"},
      {{"--scene", "a=b", "--colour"}, "--colour"},
  };
  for (const auto& [arguments, reason] : table) {
    ::testing::internal::CaptureStderr();
    const ParsedOptions parsed = parse(arguments);
    const std::string said = ::testing::internal::GetCapturedStderr();
    EXPECT_FALSE(parsed.options) << reason;
    EXPECT_EQ(parsed.exit_code, 2) << reason;
    EXPECT_NE(said.find(reason), std::string::npos) << said;
  }
}

TEST(DaemonOptions, HelpAndVersionEndWithCode0) {
  for (const char* flag : {"--help", "--version"}) {
    ::testing::internal::CaptureStdout();
    const ParsedOptions parsed = parse({flag});
    EXPECT_FALSE(parsed.options);
    EXPECT_EQ(parsed.exit_code, 0);
    EXPECT_NE(::testing::internal::GetCapturedStdout().find("camwayd"), std::string::npos);
  }
}

}  // namespace
}  // namespace camway::service
