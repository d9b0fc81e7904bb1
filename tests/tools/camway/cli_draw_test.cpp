// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "tests/tools/camway/cli_runner.h"

namespace camway::tools {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string read(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

class CliDraw : public ::testing::Test {
 protected:
  CliRun draw(const std::string& picture) {
    return run_camway({"draw", "--scene", scene_, "--request", request_, "--response", response_,
                       "--picture", picture});
  }
  void plan(double x) {
    request_ =
        folder_.write("r.json", request_json({keyframe_json(x, 0, 1), keyframe_json(x, 0, -1)}));
    run_camway({"plan", "--request", request_, "--response", response_});
  }

  TemporaryFolder folder_;
  std::string scene_ = folder_.write("wall.obj", wall_obj());
  std::string request_;
  std::string response_ = folder_.file("answer.json");
};

TEST_F(CliDraw, DrawsWhatThePictureIsNamedFor) {
  plan(0.5);
  const std::string svg = folder_.file("answer.svg");
  const CliRun run = draw(svg);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(read(svg), HasSubstr("<svg"));
  const std::string png = folder_.file("answer.png");
  EXPECT_EQ(draw(png).exit_code, 0);
  EXPECT_THAT(read(png), StartsWith("\x89PNG"));
}

TEST_F(CliDraw, DrawsTwoPlansSideBySide) {
  plan(0.5);
  const std::string svg = folder_.file("two.svg");
  const CliRun run = run_camway({"draw", "--scene", scene_, "--request", request_, "--response",
                                 response_, "--side-by-side", "--picture", svg});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(read(svg), HasSubstr(R"(width="920pt")"));
}

TEST_F(CliDraw, RefusesOtherPicturesAndAnswersWithoutAPath) {
  plan(0.5);
  const CliRun other = draw(folder_.file("answer.jpg"));
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, HasSubstr("neither .svg nor .png"));
  folder_.write("answer.json", R"({"status": "invalid", "message": "no"})");
  const CliRun none = draw(folder_.file("answer.svg"));
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.err, HasSubstr("answer.json"));
}

TEST_F(CliDraw, TakesTheSceneOfTheRequestAndWarnsOfAnother) {
  plan(0.5);
  const std::string picture = folder_.file("answer.svg");
  const std::vector<std::string> arguments{"draw",    "--request", request_, "--response",
                                           response_, "--picture", picture};
  const CliRun run = run_camway(arguments);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err, "");
  const std::string own = read(picture);
  draw(picture);
  EXPECT_EQ(read(picture), own);
  folder_.write("wall.obj", wall_obj() + "v 9 9 9\nv 9 9 8\nv 9 8 8\nf -1 -2 -3\n");
  const CliRun other = run_camway(arguments);
  EXPECT_EQ(other.exit_code, 0);
  EXPECT_THAT(other.err, HasSubstr("answer.json: was made for another scene"));
}

TEST_F(CliDraw, NamesTheFileThatCannotBeWritten) {
  plan(0.5);
  const CliRun run = draw(folder_.file("no/such/folder.svg"));
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("folder.svg"));
}

}  // namespace
}  // namespace camway::tools
