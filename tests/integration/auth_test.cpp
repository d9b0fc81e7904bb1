// SPDX-License-Identifier: MIT
#include <camway/authentication.h>
#include <camway/camway.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <atomic>
#include <csignal>
#include <fstream>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include "lcmtypes/wire/channels.h"
#include "tests/integration/fixture.h"

namespace camway::integration {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;

const std::string kOld = "1 " + std::string(64, '1') + "\n";
const std::string kNew = "2 " + std::string(64, '2') + "\n";

/// A daemon that accepts only messages signed with its keys.
class AuthTest : public IntegrationTest {
 protected:
  /// Writes a key file, which is good to use.
  std::string write_keys(const std::string& name, const std::string& text) const {
    std::ofstream(file(name)) << text;
    EXPECT_EQ(chmod(file(name).c_str(), 0600), 0);
    return file(name);
  }
  void start_daemon_with_keys(const std::string& text, const std::string& more = {}) {
    write_keys("keys", text);
    std::ofstream(file("camwayd.toml"))
        << "[auth]\nkey_file = \"keys\"\n"  // beside it, wherever the daemon is started
        << more << "[[scene]]\nname = \"office\"\nfile = \"" << scene_file("office") << "\"\n";
    start_daemon_with_scenes({}, {"--config", file("camwayd.toml")});
  }
  /// A client's options with the keys of a file of their own.
  ClientOptions with_keys(const std::string& name, const std::string& text) const {
    ClientOptions options = patient();
    LoadedAuthentication loaded = authentication_from(write_keys(name, text));
    EXPECT_EQ(loaded.error, "");
    options.authentication = loaded.authentication;
    return options;
  }
  static ClientOptions impatient(ClientOptions options) {
    options.deadline_s = 1.0;
    options.retries = 1;
    return options;
  }
  static Status plan_with(const ClientOptions& options) {
    PlanRequest request = request_of("office-free-door", "office");
    request.deadline_s = 0.5;
    return Client(options).plan(request).status;
  }
  /// Waits until the daemon's status counts at least this many dropped messages.
  static bool eventually_counted(std::int64_t DaemonStatus::*counter, std::int64_t least) {
    return eventually([&] { return Client().status().*counter >= least; });
  }
  int camway(std::vector<std::string> arguments, std::string& output) {
    arguments.insert(arguments.begin(), CAMWAY_BINARY);
    Process process(arguments, file("camway.log"));
    const std::optional<int> code = process.wait();
    output = process.output();
    return code.value_or(-1);
  }
};

TEST_F(AuthTest, ListensToThoseWithItsKeysOnly) {
  start_daemon_with_keys(kOld);
  EXPECT_EQ(plan_with(with_keys("mine", kOld)), Status::kOk);
  EXPECT_THAT(plan_with(impatient(patient())), AnyOf(Status::kNoAnswer, Status::kNoDaemon));
  EXPECT_TRUE(eventually_counted(&DaemonStatus::unsigned_messages, 1));
  EXPECT_EQ(plan_with(impatient(with_keys("other", kNew))), Status::kNoDaemon)
      << "nor does that client believe the daemon";
  EXPECT_TRUE(eventually_counted(&DaemonStatus::unknown_key_messages, 1));
  EXPECT_EQ(plan_with(impatient(with_keys("forged", "1 " + std::string(64, '3')))),
            Status::kNoDaemon);
  EXPECT_TRUE(eventually_counted(&DaemonStatus::altered_messages, 1));
  EXPECT_THAT(daemon().output(), HasSubstr("reason=wrong_key_or_altered"));

  std::string said;
  EXPECT_EQ(camway({"status", "--key-file", file("mine")}, said), 0) << said;
  EXPECT_EQ(camway({"status", "--key-file", file("other"), "--timeout-s", "1.5"}, said), 4) << said;
  EXPECT_THAT(said, HasSubstr("its keys are others"));
  EXPECT_EQ(camway({"scene", "list", "--key-file", file("mine")}, said), 0) << said;
  EXPECT_EQ(camway({"scene", "list"}, said), 4) << said;
  EXPECT_THAT(said, HasSubstr("the daemon has keys (auth.key_file) and drops what is not signed"));
  EXPECT_THAT(said, HasSubstr("--key-file"));
  EXPECT_EQ(camway({"doctor"}, said), 3) << said;
  EXPECT_THAT(said, HasSubstr("drops in silence what is not signed"));
  EXPECT_THAT(said, HasSubstr("Camway does not work here yet."));
  EXPECT_EQ(camway({"doctor", "--key-file", file("mine")}, said), 0) << said;
  EXPECT_EQ(camway({"doctor", "--key-file", file("other")}, said), 3) << said;
  EXPECT_THAT(said, HasSubstr("not signed with a key of --key-file"));
  EXPECT_EQ(camway({"watch", "office", "--request", request_file("office-free-door"), "--count",
                    "1", "--key-file", file("mine")},
                   said),
            0)
      << said;
  chmod(file("mine").c_str(), 0644);
  EXPECT_EQ(camway({"status", "--key-file", file("mine")}, said), 2) << said;
  EXPECT_THAT(said, HasSubstr("chmod 600"));
}

TEST_F(AuthTest, TheInterfaceInCSigns) {
  start_daemon_with_keys(kOld);
  const std::string mine = write_keys("mine", kOld);
  const std::string url = patient().url;
  camway_client_options options;
  ASSERT_EQ(camway_client_options_init(&options, sizeof options), CAMWAY_OK);
  options.url = url.c_str();
  options.key_file = mine.c_str();
  camway_client* client = nullptr;
  ASSERT_EQ(camway_client_create(&options, &client), CAMWAY_OK) << camway_last_error();
  EXPECT_EQ(camway_scene_list(client, nullptr), CAMWAY_OK) << camway_last_error();
  camway_client_free(client);
  options.key_window_s = -1.0;
  EXPECT_EQ(camway_client_create(&options, &client), CAMWAY_INVALID);
  EXPECT_THAT(camway_last_error(), HasSubstr("window_s"));
}

TEST_F(AuthTest, WhatWasHeardIsNotTakenAgain) {
  start_daemon_with_keys(kOld);
  // An attacker on the network records a request and replays it.
  lcm::LCM lcm(patient().url.empty() ? "udpm://239.255.76.67:7667?ttl=0" : patient().url);
  std::vector<std::uint8_t> recorded;
  lcm.subscribeFunction(
      wire::Channels{}.plan_request(),
      +[](const lcm::ReceiveBuffer* buffer, const std::string&, std::vector<std::uint8_t>* copy) {
        const auto* const data = static_cast<const std::uint8_t*>(buffer->data);
        copy->assign(data, data + buffer->data_size);
      },
      &recorded);
  EXPECT_EQ(plan_with(with_keys("mine", kOld)), Status::kOk);
  ASSERT_TRUE(eventually([&] { return lcm.handleTimeout(100) > 0 && !recorded.empty(); }));
  const auto say = [&](const std::string& channel) {
    return lcm.publish(channel, recorded.data(), static_cast<unsigned>(recorded.size()));
  };
  EXPECT_EQ(say(wire::Channels{}.plan_request()), 0);
  EXPECT_TRUE(eventually_counted(&DaemonStatus::replayed_messages, 1));
  EXPECT_EQ(say(wire::Channels{}.scene_request()), 0);
  EXPECT_TRUE(eventually_counted(&DaemonStatus::altered_messages, 1));
}

TEST_F(AuthTest, UnsignedMessagesPassWhereTheConfigurationSaysSo) {
  start_daemon_with_keys(kOld, "required = false\n");
  EXPECT_EQ(plan_with(patient()), Status::kOk);
  std::string said;
  EXPECT_EQ(camway({"doctor"}, said), 0) << said;
  EXPECT_THAT(said, HasSubstr("takes what is not signed as well"));
  EXPECT_EQ(plan_with(with_keys("mine", kOld)), Status::kOk);
}

TEST_F(AuthTest, KeysAreChangedWithoutAStop) {
  start_daemon_with_keys(kOld);
  const ClientOptions new_client = with_keys("new", kNew + kOld);
  EXPECT_THAT(plan_with(impatient(new_client)), AnyOf(Status::kNoAnswer, Status::kNoDaemon));
  const auto reload = [&](const std::string& keys, const std::string& said) {
    write_keys("keys", keys);
    daemon().signal(SIGHUP);
    EXPECT_TRUE(eventually([&] { return daemon().output().find(said) != std::string::npos; }))
        << daemon().output();
  };
  reload(kNew + kOld, "ids=2,1");
  EXPECT_EQ(plan_with(new_client), Status::kOk);
  EXPECT_EQ(plan_with(with_keys("both", kOld + kNew)), Status::kOk) << "signs with the old one";
  reload("nonsense", "all stays as it was");
  EXPECT_EQ(plan_with(new_client), Status::kOk);
  Client watcher(new_client);
  EXPECT_TRUE(eventually([&] { return watcher.status().reload_failed; }));
  std::string said;
  EXPECT_EQ(camway({"status", "--key-file", file("new")}, said), 0) << said;
  EXPECT_THAT(said, HasSubstr("reload       FAILED at "));
  EXPECT_THAT(said, HasSubstr(":2: auth.key_file: "));
  reload(kNew, "ids=2\n");
  EXPECT_TRUE(eventually([&] { return !watcher.status().reload_failed; }));
  EXPECT_EQ(watcher.status().failed_reloads, 1);
}

TEST_F(AuthTest, ABadKeyFileEndsTheStart) {
  write_keys("keys", kOld);
  chmod(file("keys").c_str(), 0644);
  std::ofstream(file("camwayd.toml"))
      << "[auth]\nkey_file = \"" << file("keys") << "\"\n[scenes]\nroots = \"/tmp\"\n";
  for (const bool check : {false, true}) {
    std::vector<std::string> arguments{CAMWAYD_BINARY, "--config", file("camwayd.toml")};
    if (check) arguments.emplace_back("--check-config");
    Process daemon(arguments, file("bad.log"));
    EXPECT_EQ(daemon.wait(), 2);
    EXPECT_THAT(daemon.output(), HasSubstr("/keys: may be used by others than"));
  }
}

TEST_F(AuthTest, ARecordingIsReplayedByItsSignaturesWhateverItsAge) {
  start_daemon_with_keys(kOld);
  const std::string log = file("session.lcmlog");
  Process logger({LCM_LOGGER_BINARY, "--quiet", "--force", "--flush-interval=50", log},
                 file("logger.log"));
  ASSERT_TRUE(eventually([&] { return !read_file(log).empty(); })) << logger.output();
  ClientOptions options = with_keys("mine", kOld);
  options.client_id = "recorded";
  ASSERT_EQ(plan_with(options), Status::kOk);
  ASSERT_TRUE(eventually(
      [&] { return read_file(log).find("CAMWAY_PLAN_RESPONSE_recorded") != std::string::npos; }));
  logger.signal(SIGTERM);
  ASSERT_TRUE(logger.wait());

  const std::string scene = "office=" + scene_file("office");
  std::string said;
  EXPECT_EQ(camway({"replay", log, "--scene", scene}, said), 0) << said;
  EXPECT_EQ(camway({"replay", log, "--scene", scene, "--key-file", file("mine")}, said), 0) << said;
  write_keys("other", kNew);
  EXPECT_EQ(camway({"replay", log, "--scene", scene, "--key-file", file("other")}, said), 2);
  EXPECT_THAT(said, HasSubstr("are not signed with a key of"));

  // Repeated requests are signed anew; otherwise the daemon would drop them.
  EXPECT_EQ(camway({"replay", log, "--publish", "--speed", "0", "--wait-s", "1"}, said), 3) << said;
  EXPECT_EQ(camway({"replay", log, "--publish", "--speed", "0", "--key-file", file("mine")}, said),
            0)
      << said;
}

}  // namespace
}  // namespace camway::integration
