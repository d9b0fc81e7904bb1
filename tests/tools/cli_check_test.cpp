// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/tools/cli_runner.h"
#include "tools/json_io.h"

namespace camway::tools {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class CliCheck : public ::testing::Test {
 protected:
  /// The response of a plan along x, which ends before or beyond the wall.
  std::string planned(const std::string& name, double x) {
    request_ = folder_.write(name + ".json",
                             request_json({keyframe_json(x, 0, 1), keyframe_json(x, 0, -1)}));
    const std::string response = folder_.file(name + "-response.json");
    run_camway({"plan", "--request", request_, "--response", response});
    return response;
  }

  CliRun check(const std::string& response) {
    return run_camway({"check", "--scene", scene_, "--request", request_, "--response", response});
  }

  TemporaryFolder folder_;
  std::string scene_ = folder_.write("wall.obj", wall_obj());
  std::string request_;
};

TEST_F(CliCheck, ProvesAFreePathWithTheClearanceOfThePlan) {
  const std::string response = planned("free", 1);
  const CliRun run = check(response);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, StartsWith("free: proved"));
}

TEST_F(CliCheck, ListsWhereAndWithWhatAPathCollides) {
  // The path of one request against a scene that stands in its way.
  const std::string response = planned("free", 1);
  scene_ = folder_.write("across.obj", "o barrier\nv -9 -9 0\nv 9 -9 0\nv 0 9 0\nf 1 2 3\n");
  const CliRun run = check(response);
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_THAT(run.out, StartsWith("collides from "));
  EXPECT_THAT(run.out, HasSubstr("barrier"));
}

TEST_F(CliCheck, RefusesAPathThatJumps) {
  const std::string file = planned("free", 1);
  auto response = read_plan_response(file);
  ASSERT_TRUE(response.value) << response.error;
  motion::Segment first = response.value->path.segments()[0];
  motion::Segment second = first;
  second.t0_s = first.t1_s;
  second.t1_s = first.t1_s + 1.0;
  response.value->path = motion::Path({first, second});
  const auto text = write_plan_response(*response.value);
  ASSERT_TRUE(text.value) << text.error;
  const CliRun run = check(folder_.write("jump.json", *text.value));
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("segments[1]"));
}

TEST_F(CliCheck, NamesTheFileAtFault) {
  const std::string response = planned("free", 1);
  const CliRun missing = run_camway(
      {"check", "--scene", scene_, "--request", request_, "--response", folder_.file("none.json")});
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_THAT(missing.err, HasSubstr("none.json"));
  const CliRun scene = run_camway({"check", "--scene", folder_.file("none.obj"), "--request",
                                   request_, "--response", response});
  EXPECT_EQ(scene.exit_code, 2);
  EXPECT_THAT(scene.err, HasSubstr("none.obj"));
}

}  // namespace
}  // namespace camway::tools
