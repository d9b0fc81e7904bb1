// SPDX-License-Identifier: MIT
//
// Processes that a fleet refuses, and those that do not reach it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <string>
#include <vector>

#include "tests/integration/fleet_fixture.h"

namespace camway::integration {
namespace {

using ::testing::HasSubstr;

TEST_F(FleetTest, AFrontThatIsRefusedChangesNoScene) {
  start_front();
  Process second({CAMWAYD_BINARY, "--role", "front", "--fleet", server_.url(), "--scene",
                  "office=" + scene_file("office") + ",occupancy=0.5", "--scene",
                  "maze=" + scene_file("maze")},
                 file("second.log"));
  EXPECT_EQ(second.wait(), 1);
  EXPECT_THAT(second.output(), HasSubstr("another daemon serves with this prefix"));
  Client client(patient());
  EXPECT_EQ(client.describe_scene("office").scene.revision, 1);
  EXPECT_EQ(client.describe_scene("maze").status, Status::kUnknownScene);
}

TEST_F(FleetTest, AFrontWhoseIdAnotherOneHasChangesNoScene) {
  write_file(file("front.toml"), "[fleet]\nid = \"same\"\n");
  const std::vector<std::string> same{CAMWAYD_BINARY, "--config", file("front.toml"), "--role",
                                      "front",        "--fleet",  server_.url(),      "--prefix"};
  std::vector<std::string> first = same;
  first.insert(first.end(), {"ONE", "--scene", "office=" + scene_file("office")});
  Process one(first, file("one.log"));
  Client client(of_prefix("ONE"));
  ASSERT_TRUE(eventually([&] { return client.describe_scene("office").ok(); }));
  std::vector<std::string> second = same;
  second.insert(second.end(), {"TWO", "--scene", "maze=" + scene_file("maze")});
  Process two(second, file("two.log"));
  EXPECT_EQ(two.wait(), 1);
  EXPECT_THAT(two.output(), HasSubstr("another front of the fleet has this id"));
  EXPECT_TRUE(client.describe_scene("office").ok());
  EXPECT_EQ(client.describe_scene("maze").status, Status::kUnknownScene);
  // The next one may take the id once the first one ends.
  one.signal(SIGTERM);
  EXPECT_EQ(one.wait(), 0);
  Process three(second, file("three.log"));
  Client other(of_prefix("TWO"));
  EXPECT_TRUE(eventually([&] { return other.describe_scene("maze").ok(); }));
  three.signal(SIGTERM);
  EXPECT_EQ(three.wait(), 0);
}

TEST_F(FleetTest, SaysWhyThereIsNoWayIntoTheFleet) {
  server_.kill();
  write_file(file("planner.toml"), "[fleet]\npatience_s = 0.5\n");
  Process planner({CAMWAYD_BINARY, "--config", file("planner.toml"), "--role", "planner", "--fleet",
                   server_.url()},
                  file("planner.log"));
  EXPECT_EQ(planner.wait(), 1);
  EXPECT_THAT(planner.output(), HasSubstr(server_.url()));
  EXPECT_THAT(planner.output(), HasSubstr("refused"));
  server_.start();
}

}  // namespace
}  // namespace camway::integration
