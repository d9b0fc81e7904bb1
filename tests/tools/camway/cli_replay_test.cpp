// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/wire/check.h"
#include "tests/tools/camway/cli_runner.h"

namespace camway::tools {
namespace {

using ::testing::HasSubstr;

TEST(CliReplayLog, SaysThatALogIsOfAnotherVersion) {
  std::vector<std::uint8_t> older =
      wire::encode(messages::to_wire(simple_request({{1, 0, 1}, {1, 0, -1}}), {"c", 1, 0}));
  older[3] ^= 1;  // within the fingerprint
  LogBuilder log;
  log.add_event("CAMWAY_PLAN_REQUEST", older);
  log.add_event("CAMWAY_PLAN_REQUEST", older);
  const TemporaryFolder folder;
  const std::string file = folder.write("log", log.bytes());
  const CliRun run = run_camway({"replay", file});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr(file + ": its 2 messages on CAMWAY_* are of another version of "
                                        "the wire types: replay it with the camway"));
}

TEST(CliReplayLog, ShowsABodyAndItsWitnesses) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("wall.obj", wall_obj());
  planning::PlanRequest request = simple_request({{0, 0, 1}, {0, 0, -1}});
  request.camera = {};
  request.body = motion::SphereShape{{0, 0, 0}, 0.25};
  request.options.clearance_m = 0.125;
  LogBuilder log;
  log.add_request(request, {"c", 1, 0});
  const std::string file = folder.write("log", log.bytes());
  const std::string responses = folder.file("responses");
  const CliRun run =
      run_camway({"replay", file, "--scene", "wall=" + scene, "--responses", responses});
  EXPECT_THAT(run.out, HasSubstr("no answer in the log"));
  const std::string text = read_all(responses + "/0000_c_1.json");
  EXPECT_THAT(text, HasSubstr("\"object\": \"wall\""));
  EXPECT_THAT(text, HasSubstr("\"feature\": \"surface\""));
}

}  // namespace
}  // namespace camway::tools
