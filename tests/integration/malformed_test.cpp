// SPDX-License-Identifier: MIT
#include <camway/authentication.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <string>

#include "tests/integration/fixture.h"

namespace camway::integration {
namespace {

using ::testing::HasSubstr;

class MalformedTest : public IntegrationTest {};

/// Only the answers are tested. The program also judges blocking and memory, which a machine that
/// is busy with other tests does not allow.
TEST_F(MalformedTest, ADaemonAnswersInTheMidstOfMalformedMessages) {
  start_daemon();
  Process flood({MALFORMED_FLOOD_BINARY, std::to_string(daemon().pid()), "20000"},
                file("flood.log"));
  EXPECT_NE(flood.wait().value_or(2), 2) << flood.output();
  EXPECT_THAT(flood.output(), HasSubstr("20000 counted by the daemon"));
  EXPECT_THAT(flood.output(), HasSubstr("0 unanswered"));
  EXPECT_TRUE(Client(patient()).plan(request_of("office-free-door", "office")).ok());
  EXPECT_THAT(daemon().output(), HasSubstr("lines left out kind=malformed"));
}

/// The daemon trusts none of 20,000 messages, including valid ones, and meanwhile serves a client
/// that has its key.
TEST_F(MalformedTest, ADaemonWithKeysAnswersItsClientsInTheMidstOfForgeries) {
  std::ofstream(file("keys")) << "1 " << std::string(64, '1') << '\n';
  ASSERT_EQ(chmod(file("keys").c_str(), 0600), 0);
  std::ofstream(file("camwayd.toml"))
      << "[auth]\nkey_file = \"" << file("keys") << "\"\n[[scene]]\nname = \"office\"\nfile = \""
      << scene_file("office") << "\"\n";
  start_daemon_with_scenes({}, {"--config", file("camwayd.toml")});
  ClientOptions options = patient();
  options.authentication = authentication_from(file("keys")).authentication;
  Client client(options);
  Process flood(
      {MALFORMED_FLOOD_BINARY, std::to_string(daemon().pid()), "20000", "1", file("keys")},
      file("flood.log"));
  PlanRequest request = request_of("office-free-door", "office");
  do {
    EXPECT_TRUE(client.plan(request).ok());
  } while (flood.running());
  EXPECT_NE(flood.wait().value_or(2), 2) << flood.output();
  EXPECT_THAT(flood.output(), HasSubstr("20000 counted by the daemon"));
  EXPECT_THAT(flood.output(), HasSubstr("0 unanswered"));
  EXPECT_THAT(daemon().output(), HasSubstr("lines left out kind=distrusted"));
  const DaemonStatus status = client.status();
  EXPECT_GT(status.malformed_messages, 1000) << "well signed";
  EXPECT_GT(status.unsigned_messages, 1000);
  EXPECT_GT(status.altered_messages, 1000);
  EXPECT_GT(status.unknown_key_messages, 1000);
  EXPECT_EQ(status.scene_changes, 0);
}

}  // namespace
}  // namespace camway::integration
