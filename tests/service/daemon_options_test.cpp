// SPDX-License-Identifier: MIT
#include "daemon/service/daemon_options.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <vector>

#include "tests/support/temporary_folder.h"

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
  EXPECT_EQ(parsed.options->log_level, LogLevel::kInfo);
}

TEST(DaemonOptions, TheEnvironmentNamesTheUrlUnlessTheCommandLineDoes) {
  setenv("LCM_DEFAULT_URL", "memq://", 1);
  EXPECT_EQ(parse({"--scene", "a=b"}).options->lcm_url, "memq://");
  EXPECT_EQ(parse({"--scene", "a=b", "--url", "udpm://"}).options->lcm_url, "udpm://");
  setenv("LCM_DEFAULT_URL", "bogus://", 1);
  EXPECT_EQ(parse({"--scene", "a=b"}).text.find("camwayd: LCM_DEFAULT_URL: must begin with"), 0U);
  EXPECT_TRUE(parse({"--scene", "a=b", "--url", "udpm://"}).options);
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
  EXPECT_EQ(options.log_level, LogLevel::kWarn);
}

TEST(DaemonOptions, BadFlagsEndWithCode2AndSayWhy) {
  const std::vector<std::pair<std::vector<const char*>, std::string>> table{
      {{}, "--scene"},
      {{"--scene-roots", "/:/nonexistent/folder"}, "--scene-roots: scene root '/nonexistent/fold"},
      {{"--scene", "office.obj"}, "must be NAME=FILE"},
      {{"--scene", "a=b,scale=x"}, "scale=x"},
      {{"--scene", "a=b", "--scene", "a=c"}, "'a' is given twice"},
      {{"--scene", "a=b", "--workers", "257"}, "--workers"},
      {{"--scene", "a=b", "--workers", "many"}, "--workers"},
      {{"--scene", "a=b", "--queue", "-1"}, "--queue"},
      {{"--scene", "a=b", "--client-queue", "0"}, "--client-queue"},
      {{"--scene", "a=b", "--workers", "1.5"}, "--workers: must be a whole number"},
      {{"--scene", "a=b", "--prefix", "no blanks"}, "--prefix: 'no blanks'"},
      {{"--scene", "a=b", "--url", "bogus://"}, "--url: must begin with a provider"},
      {{"--scene", "a=b", "--deadline-s", "nan"}, "--deadline-s: must be within"},
      {{"--scene", "a=b", "--deadline-s", "61"}, "--deadline-s: planning.deadline_s is 61, but"},
      {{"--scene", "a=b", "--max-deadline-s", "9"}, "--max-deadline-s: planning.deadline_s is 10"},
      {{"--scene", "a=b", "--log-level", "loud"}, "--log-level: must be one of trace, "},
      {{"--scene", "a=b", "--log-format", "xml"}, "--log-format: must be one of text, json"},
      {{"--scene", "a=b", "--colour"}, "--colour"},
  };
  for (const auto& [arguments, reason] : table) {
    const ParsedOptions parsed = parse(arguments);
    EXPECT_FALSE(parsed.options) << reason;
    EXPECT_EQ(parsed.exit_code, 2) << reason;
    EXPECT_NE(parsed.text.find(reason), std::string::npos) << parsed.text;
  }
}

/// A configuration file and a scene file beside it, gone with the test.
class DaemonOptionsFile : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const {
    return temporary_.write(name, text);
  }

  testing::TemporaryFolder temporary_;
  const std::filesystem::path& folder_ = temporary_.path();
  std::string room_ = write("room.obj", "v 0 0 0\n");
};

TEST_F(DaemonOptionsFile, TheCommandLineGoesBeforeTheFileAndTheFileBeforeTheDefaults) {
  const std::string file = write("c.toml", R"(
      [lcm]
      prefix = "FILE"
      [queue]
      requests = 7
      [log]
      level = "error"
      [[scene]]
      name = "room"
      file = "room.obj"
      [[scene]]
      name = "hall"
      file = "/hall.obj")");
  const ParsedOptions parsed = parse({"--queue", "9", "--config", file.c_str(), "--scene",
                                      "hall=other.obj", "--scene", "attic=attic.obj"});
  ASSERT_TRUE(parsed.options) << parsed.text;
  const DaemonOptions& options = *parsed.options;
  EXPECT_EQ(options.config_file, file);
  EXPECT_EQ(options.service.prefix, "FILE");
  EXPECT_EQ(options.service.queue.jobs, 9U);
  EXPECT_EQ(options.log_level, LogLevel::kError);
  EXPECT_EQ(options.service.deadline.default_s, 10.0);
  EXPECT_GE(options.service.workers, 1);
  ASSERT_EQ(options.scenes.size(), 3U);
  EXPECT_EQ(options.scenes[0].file, folder_ / "room.obj");
  EXPECT_EQ(options.scenes[1].file, "other.obj");
  EXPECT_EQ(options.scenes[2].file, "attic.obj");

  const auto flags =
      parse({"--config", file.c_str(), "--log-level", "warn", "--log-format", "json"});
  EXPECT_EQ(flags.options->log_level, LogLevel::kWarn);
  EXPECT_EQ(flags.options->log_format, LogFormat::kJson);
}

TEST_F(DaemonOptionsFile, ChecksAConfigurationAndSaysWhatItComesTo) {
  const std::string file = write("c.toml", R"(
      [queue]
      requests = 7
      [[scene]]
      name = "room"
      file = "room.obj")");
  const ParsedOptions good = parse({"--check-config", "--config", file.c_str()});
  EXPECT_FALSE(good.options);
  EXPECT_EQ(good.exit_code, 0);
  EXPECT_EQ(good.text, "camwayd: the configuration is right\nscene 'room': " +
                           (folder_ / "room.obj").string() +
                           "\nqueue.requests = 7 (default 256)\n");

  const ParsedOptions no_scene =
      parse({"--check-config", "--config", file.c_str(), "--scene", "hall=/nowhere.obj"});
  EXPECT_EQ(no_scene.exit_code, 2);
  EXPECT_EQ(no_scene.text, "camwayd: --scene: scene 'hall': /nowhere.obj cannot be read\n");
}

TEST_F(DaemonOptionsFile, FaultsOfMoreThanOneValueNameFileAndLine) {
  const std::string file = write("c.toml", R"([planning]
max_deadline_s = 5
[scenes]
roots = "/nonexistent"
)");
  EXPECT_EQ(parse({"--config", file.c_str()}).text,
            "camwayd: " + file +
                ":2: planning.max_deadline_s: planning.deadline_s is 10, but must be at most "
                "planning.max_deadline_s, which is 5\n"
                "camwayd: " +
                file + ":4: scenes.roots: scene root '/nonexistent' is not a folder that can be " +
                "read\n");
  EXPECT_EQ(parse({"--config", file.c_str(), "--deadline-s", "4", "--scene-roots", "/"}).text, "")
      << "what was said before the file's faults";
}

TEST_F(DaemonOptionsFile, SharesAreNoLargerThanTheWhole) {
  const std::string file = write("c.toml", R"([queue]
requests = 10
[scenes]
roots = "/"
upload_bytes = 500000000
[watch]
paths = 10
paths_of_a_client = 20
)");
  EXPECT_EQ(parse({"--config", file.c_str()}).text,
            "camwayd: " + file +
                ":5: scenes.upload_bytes: is 500000000, but must be at most "
                "scenes.all_uploads_bytes, which is 268435456\ncamwayd: " +
                file +
                ":8: watch.paths_of_a_client: is 20, but must be at most watch.paths, which is "
                "10\n")
      << "who wants fewer requests than a client may usually have means them all";
}

TEST_F(DaemonOptionsFile, ChecksThatThisMachineHasWhatTheFileNames) {
  const std::string file = write("c.toml", R"([metrics]
address = "192.0.2.1"
[auth]
key_file = "/nonexistent/keys"
[[scene]]
name = "room"
file = "gone.obj"
)");
  const ParsedOptions parsed = parse({"--check-config", "--config", file.c_str()});
  EXPECT_EQ(parsed.exit_code, 2);
  EXPECT_NE(parsed.text.find("camwayd: " + file + ":7: scene 'room': " +
                             (folder_ / "gone.obj").string() + " cannot be read\n"),
            std::string::npos)
      << parsed.text;
  EXPECT_NE(parsed.text.find("camwayd: " + file + ":4: auth.key_file: /nonexistent/keys"),
            std::string::npos)
      << parsed.text;
  EXPECT_NE(parsed.text.find("camwayd: " + file +
                             ":2: metrics.address: 192.0.2.1 is no address of this machine\n"),
            std::string::npos)
      << parsed.text;
  EXPECT_TRUE(parse({"--config", file.c_str()}).options) << "a start says it when it comes to it";
}

TEST_F(DaemonOptionsFile, ABadFileEndsWithCode2AndEveryFaultInIt) {
  const std::string file = write("c.toml", "[queue]\nlenght = 7\nrequests = 0\n");
  const ParsedOptions parsed = parse({"--config", file.c_str(), "--scene", "a=b"});
  EXPECT_EQ(parsed.exit_code, 2);
  EXPECT_NE(parsed.text.find("c.toml:2: 'queue.lenght' is no setting"), std::string::npos);
  EXPECT_NE(parsed.text.find("c.toml:3: queue.requests: must be within"), std::string::npos);
}

TEST(DaemonOptions, HelpAndVersionEndWithCode0) {
  for (const char* flag : {"--help", "--version"}) {
    const ParsedOptions parsed = parse({flag});
    EXPECT_FALSE(parsed.options);
    EXPECT_EQ(parsed.exit_code, 0);
    EXPECT_NE(parsed.text.find("camwayd"), std::string::npos);
  }
}

}  // namespace
}  // namespace camway::service
