// SPDX-License-Identifier: MIT
#include "daemon/process/settings/daemon_command_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace camway::process {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

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
  EXPECT_EQ(parsed.options->log_level, service::LogLevel::kInfo);
}

TEST(DaemonOptions, TheEnvironmentNamesTheUrlUnlessTheCommandLineDoes) {
  setenv("LCM_DEFAULT_URL", "memq://", 1);
  EXPECT_EQ(parse({"--scene", "a=b"}).options->lcm_url, "memq://");
  EXPECT_EQ(parse({"--scene", "a=b", "--url", "udpm://"}).options->lcm_url, "udpm://");
  setenv("LCM_DEFAULT_URL", "bogus://", 1);
  EXPECT_THAT(parse({"--scene", "a=b"}).faults,
              ElementsAre(StartsWith("LCM_DEFAULT_URL: must begin with")));
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
  EXPECT_EQ(options.log_level, service::LogLevel::kWarn);
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
      {{"--scene", "a=b", "--deadline-s", "61"}, "--deadline-s: is 61, but"},
      {{"--scene", "a=b", "--max-deadline-s", "9"}, "--max-deadline-s: is 9, but"},
      {{"--scene", "a=b", "--log-level", "loud"}, "--log-level: must be one of trace, "},
      {{"--scene", "a=b", "--log-format", "xml"}, "--log-format: must be one of text, json"},
      {{"--scene", "a=b", "--colour"}, "--colour"},
  };
  for (const auto& [arguments, reason] : table) {
    const ParsedOptions parsed = parse(arguments);
    EXPECT_FALSE(parsed.options) << reason;
    EXPECT_THAT(parsed.faults, ElementsAre(HasSubstr(reason)));
  }
}

/// A configuration file and a scene file beside it, which the destructor removes.
class DaemonOptionsFile : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const {
    return temporary_.write(name, text);
  }

  testing::TemporaryFolder temporary_;
  const std::filesystem::path& folder_ = temporary_.path();
  std::string room_ = write("room.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
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
  ASSERT_TRUE(parsed.options) << ::testing::PrintToString(parsed.faults);
  const DaemonOptions& options = *parsed.options;
  EXPECT_EQ(options.config_file, file);
  EXPECT_EQ(options.service.prefix, "FILE");
  EXPECT_EQ(options.service.queue.jobs, 9U);
  EXPECT_EQ(options.log_level, service::LogLevel::kError);
  EXPECT_EQ(options.service.deadline.default_s, 10.0);
  EXPECT_GE(options.service.workers, 1);
  ASSERT_EQ(options.scenes.size(), 3U);
  EXPECT_EQ(options.scenes[0].file, folder_ / "room.obj");
  EXPECT_EQ(options.scenes[1].file, "other.obj");
  EXPECT_EQ(options.scenes[2].file, "attic.obj");

  const auto flags =
      parse({"--config", file.c_str(), "--log-level", "warn", "--log-format", "json"});
  EXPECT_EQ(flags.options->log_level, service::LogLevel::kWarn);
  EXPECT_EQ(flags.options->log_format, service::LogFormat::kJson);
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
  EXPECT_THAT(good.faults, ElementsAre());
  EXPECT_EQ(good.text, "camwayd: the configuration is right\nscene 'room': 1 triangles from " +
                           (folder_ / "room.obj").string() +
                           "\nqueue.requests = 7 (default 256)\n");
}

/// All faults are reported at once, whatever their kind.
TEST_F(DaemonOptionsFile, ChecksScenesAsAStartWouldReadThem) {
  write("rubbish.obj", "f 1 2 3\n");
  const std::string file = write("c.toml", R"([planning]
deadline_s = 100
[scenes]
triangles = 1
[[scene]]
name = "room"
file = "room.obj"
[[scene]]
name = "again"
file = "room.obj"
[[scene]]
name = "rubbish"
file = "rubbish.obj"
)");
  const ParsedOptions parsed =
      parse({"--check-config", "--config", file.c_str(), "--scene", "hall=/nowhere.obj"});
  EXPECT_THAT(parsed.faults,
              ElementsAre(StartsWith(file + ":2: planning.deadline_s: is 100, but must be"),
                          HasSubstr("c.toml:10: scene 'again': "),
                          HasSubstr("c.toml:13: scene 'rubbish': "),
                          HasSubstr("--scene: scene 'hall': /nowhere.obj")));
  EXPECT_THAT(parsed.faults[1], HasSubstr("scenes.triangles"));
}

TEST_F(DaemonOptionsFile, ThatNoSceneIsNamedHidesNothingElse) {
  const std::string file = write("c.toml", "[planning]\ndeadline_s = 100\n");
  EXPECT_THAT(parse({"--config", file.c_str()}).faults,
              ElementsAre(HasSubstr("c.toml:2: "), HasSubstr("no scene is named")));
}

TEST_F(DaemonOptionsFile, FaultsOfMoreThanOneValueNameFileAndLine) {
  const std::string file = write("c.toml", R"([planning]
max_deadline_s = 5
[scenes]
roots = "/nonexistent"
)");
  EXPECT_THAT(
      parse({"--config", file.c_str()}).faults,
      ElementsAre(
          file + ":2: planning.max_deadline_s: is 5, but must be at least planning.deadline_s, "
                 "which is 10",
          file + ":4: scenes.roots: scene root '/nonexistent' is not a folder that can be read"));
  EXPECT_TRUE(parse({"--config", file.c_str(), "--deadline-s", "4", "--scene-roots", "/"}).options);
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
  EXPECT_THAT(parse({"--config", file.c_str()}).faults,
              ElementsAre(file + ":5: scenes.upload_bytes: is 500000000, but must be at most "
                                 "scenes.all_uploads_bytes, which is 268435456",
                          file + ":8: watch.paths_of_a_client: is 20, but must be at most "
                                 "watch.paths, which is 10"))
      << "who wants fewer requests than a client may usually have means them all";
}

TEST_F(DaemonOptionsFile, RolesOfAFleetNeedAndRefuseSettings) {
  EXPECT_THAT(parse({"--role", "front"}).faults,
              ElementsAre(HasSubstr("--role: needs the servers of NATS")));
  EXPECT_THAT(parse({"--scene", "a=x.obj", "--fleet", "nats://a:4222"}).faults,
              ElementsAre(HasSubstr("--fleet: has no effect without a role")));
  EXPECT_THAT(parse({"--scene", "a=x.obj", "--fleet-drop", "a"}).faults,
              ElementsAre(HasSubstr("--fleet-drop: has no effect but on a front")));
  EXPECT_THAT(parse({"--role", "front", "--fleet", "a:4222"}).faults,
              ElementsAre(AllOf(HasSubstr("--fleet"), HasSubstr("'a:4222'"))));
  for (const auto& [server, fault] : std::vector<std::pair<std::string, std::string>>{
           {"nats://a:99999", "must have a port within 1 to 65535"},
           {"nats://a:0", "must have a port within 1 to 65535"},
           {"tls://a:", "must have a port within 1 to 65535"},
           {"tls://[::1]:x", "must have a port within 1 to 65535"},
           {"nats://user:secret@:4222", "'nats://:4222' names no host"},
           {"nats://", "names no host"},
           {"nats://a b:4222", "must be nats://HOST:PORT"},
           {"nats://a:4222/path", "must be nats://HOST:PORT"},
           {"nats://[::1:4222", "must be nats://HOST:PORT"}}) {
    const std::string list = "nats://good:4222," + server;
    EXPECT_THAT(parse({"--role", "front", "--fleet", list.c_str()}).faults,
                ElementsAre(AllOf(HasSubstr("--fleet"), HasSubstr(fault))))
        << server;
  }
  for (const char* const server :
       {"nats://a", "tls://a.b-c_d:65535", "nats://[::1]:4222", "nats://[fe80::1]",
        "nats://user:pass@a:1", "nats://token@a", "nats://10.0.0.1:4222/"}) {
    EXPECT_THAT(parse({"--role", "front", "--fleet", server}).faults, ::testing::IsEmpty())
        << server;
  }
  EXPECT_THAT(parse({"--role", "planner", "--fleet", "nats://a", "--scene", "a=x.obj", "--state",
                     "folder", "--prefix", "OTHER"})
                  .faults,
              ElementsAre(HasSubstr("--state: has no effect in a fleet"),
                          HasSubstr("--prefix: has no effect on a planner"),
                          HasSubstr("--scene: scene 'a': a planner has the scenes of its fleet")));
  const std::string file = write("c.toml", R"([fleet]
role = "front"
servers = "nats://a:4222, tls://b"
id = "front one"
replicas = 2
key_file = "key.pem"
)");
  EXPECT_THAT(parse({"--config", file.c_str()}).faults,
              ElementsAre(AllOf(HasSubstr("c.toml:4: fleet.id"), HasSubstr("'front one'"))));
  const std::string other = write("d.toml", R"([fleet]
role = "front"
servers = "nats://a:4222, tls://b"
replicas = 2
key_file = "key.pem"
)");
  EXPECT_THAT(parse({"--config", other.c_str()}).faults,
              ElementsAre(HasSubstr("d.toml:5: fleet.key_file: a certificate and its key"),
                          HasSubstr("d.toml:4: fleet.replicas: must be 1, 3 or 5")));
}

TEST_F(DaemonOptionsFile, FilesForTheWayIntoAFleetHaveToBeUsable) {
  for (const char* const key : {"credentials_file", "ca_file"}) {
    const std::string missing =
        write("e.toml", std::string("[fleet]\nrole = \"planner\"\n") + "servers = \"nats://a\"\n" +
                            key + " = \"none.pem\"\n");
    for (const bool only_check : {false, true}) {
      std::vector<const char*> arguments{"--config", missing.c_str()};
      if (only_check) arguments.push_back("--check-config");
      EXPECT_THAT(parse(arguments).faults,
                  ElementsAre(AllOf(HasSubstr(std::string("e.toml:4: fleet.") + key + ": "),
                                    HasSubstr("none.pem cannot be read: No such file"))))
          << key;
    }
  }
  const std::string pair = write("f.toml",
                                 "[fleet]\nrole = \"front\"\nservers = \"nats://a\"\n"
                                 "certificate_file = \"here.pem\"\nkey_file = \".\"\n");
  write("here.pem", "text");
  EXPECT_THAT(parse({"--config", pair.c_str()}).faults,
              ElementsAre(AllOf(HasSubstr("f.toml:4: fleet.certificate_file: "),
                                HasSubstr("here.pem has no certificate in PEM that can be read")),
                          AllOf(HasSubstr("f.toml:5: fleet.key_file: "),
                                HasSubstr("cannot be read: Is a directory"))));
}

TEST(DaemonOptions, ServersOfAFleetAreAList) {
  EXPECT_THAT(servers_of(" nats://a:1 ,,tls://b "), ElementsAre("nats://a:1", "tls://b"));
  EXPECT_TRUE(servers_of(" , ").empty());
  const DaemonOptions options =
      *parse({"--role", "planner", "--fleet", "nats://a", "--fleet-name", "studio"}).options;
  EXPECT_EQ(options.fleet.role, FleetRole::kPlanner);
  EXPECT_EQ(options.fleet.name, "studio");
}

TEST(DaemonOptions, APasswordOfTheFleetIsNotShown) {
  const ParsedOptions parsed = parse(
      {"--role", "planner", "--fleet", "nats://user:secret@a:4222,nats://b", "--check-config"});
  EXPECT_THAT(parsed.text, HasSubstr("fleet.servers = \"nats://a:4222,nats://b\""));
}

TEST(DaemonOptions, AStateThatIsNamedIsAFolder) {
  EXPECT_THAT(parse({"--scene", "a=x.obj", "--state", ""}).faults,
              ElementsAre("--state: must name a folder"));
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
  EXPECT_THAT(
      parsed.faults,
      ElementsAre(StartsWith(file + ":4: auth.key_file: /nonexistent/keys"),
                  file + ":2: metrics.address: 192.0.2.1 is no address of this machine",
                  StartsWith(file + ":7: scene 'room': " + (folder_ / "gone.obj").string())));
  EXPECT_TRUE(parse({"--config", file.c_str()}).options) << "a start says it when it comes to it";
}

TEST_F(DaemonOptionsFile, ChecksThatRecordingsHaveAFolder) {
  const std::string folder = (folder_ / "a" / "b").string();
  const std::string file = write("c.toml", "");
  const auto faults_of = [&](const std::string& record) {
    return parse({"--check-config", "--scene-roots", "/", "--record", record.c_str()}).faults;
  };
  EXPECT_THAT(faults_of(folder), ElementsAre());
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a")) << "a check makes nothing";
  EXPECT_THAT(faults_of(file + "/b"),
              ElementsAre("--record: " + file + "/b cannot be made: " + file + " is no folder"));
  EXPECT_THAT(faults_of(file),
              ElementsAre("--record: " + file + " cannot be written: " + file + " is no folder"));
}

TEST_F(DaemonOptionsFile, ABadFileGivesEveryFaultInIt) {
  const std::string file = write("c.toml", "[queue]\nlenght = 7\nrequests = 0\n");
  const ParsedOptions parsed = parse({"--config", file.c_str(), "--scene", "a=b"});
  EXPECT_FALSE(parsed.options);
  EXPECT_THAT(parsed.faults, ElementsAre(HasSubstr("c.toml:2: 'queue.lenght' is no setting"),
                                         HasSubstr("c.toml:3: queue.requests: must be within")));
}

TEST(DaemonOptions, HelpAndVersionHaveNoFaults) {
  for (const char* flag : {"--help", "--version"}) {
    const ParsedOptions parsed = parse({flag});
    EXPECT_FALSE(parsed.options);
    EXPECT_THAT(parsed.faults, ElementsAre());
    EXPECT_THAT(parsed.text, HasSubstr("camwayd"));
  }
}

}  // namespace
}  // namespace camway::process
