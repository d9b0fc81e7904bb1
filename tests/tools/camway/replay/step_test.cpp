// SPDX-License-Identifier: MIT
#include "tools/camway/replay/step.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "tests/tools/camway/replay/log_builder.h"

namespace camway::tools {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A session of three requests, the answers of which are of another planner.
class StepTest : public ::testing::Test {
 protected:
  StepTest() {
    LogBuilder log;
    for (int i = 1; i <= 3; ++i) {
      log.add_request(simple_request({{1.0 * i, 0, 1}, {1.0 * i, 0, -1}}), {"client", i, 0});
      planning::PlanResult result;
      result.status = planning::Status::kPartial;
      log.add_answer(result, {{"client", i, 0}, "wall", 1, ""});
    }
    session_ = read_session(folder_.write("log", log.bytes()), "CAMWAY");
  }

  std::vector<ComparedRequest> step(const std::string& typed) {
    std::istringstream in(typed);
    std::ostringstream out;
    NamedScenes scenes({{"wall", scene::make_snapshot("wall", wall_mesh()).snapshot}});
    auto seen = step_through(session_, scenes, {},
                             {in, out, [&](const std::string& file, const std::string& svg) {
                                EXPECT_THAT(svg, HasSubstr("<svg"));
                                written_.push_back(file);
                                return std::string();
                              }});
    out_ = out.str();
    return seen;
  }

  TemporaryFolder folder_;
  Session session_;
  std::string out_;
  std::vector<std::string> written_;
};

TEST_F(StepTest, ShowsOneRequestAfterTheOther) {
  EXPECT_EQ(step("\nn\n\n").size(), 3U);
  EXPECT_THAT(out_, HasSubstr("1 of 3, 0.000 s"));
  EXPECT_THAT(out_, HasSubstr("3 of 3"));
  EXPECT_THAT(out_, HasSubstr("BETTER: status partial -> ok"));
  EXPECT_THAT(out_, HasSubstr("verdict: BETTER: 3 requests"));
}

TEST_F(StepTest, StopsWhenAskedOrWhenTheInputEnds) {
  EXPECT_EQ(step("\nq\n").size(), 2U);
  EXPECT_THAT(out_, Not(HasSubstr("3 of 3")));
  EXPECT_EQ(step("").size(), 1U);
}

TEST_F(StepTest, DrawsBothPaths) {
  EXPECT_EQ(step("d\nwhat\nq\n").size(), 1U);
  EXPECT_THAT(written_, ::testing::ElementsAre("replay_client_1.svg"));
  EXPECT_THAT(out_, HasSubstr("wrote replay_client_1.svg"));
  EXPECT_THAT(out_, HasSubstr("type Enter, d or q"));
}

}  // namespace
}  // namespace camway::tools
