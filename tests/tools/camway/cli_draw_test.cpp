// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/camway/cli_runner.h"

namespace camway::tools {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
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
  void plan(double x) { plan(request_json({keyframe_json(x, 0, 1), keyframe_json(x, 0, -1)})); }
  void plan(const std::string& request) {
    request_ = folder_.write("r.json", request);
    run_camway({"plan", "--request", request_, "--response", response_});
  }
  /// The picture of the answer, drawn with more flags.
  std::string picture_with(const std::vector<std::string>& more) {
    const std::string picture = folder_.file("axis.svg");
    std::vector<std::string> arguments{"draw",    "--request", request_, "--response",
                                       response_, "-o",        picture};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CliRun run = run_camway(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return read(picture);
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

/// A flag that a page does not follow is not passed over in silence.
TEST_F(CliDraw, RefusesFlagsOfPlansForAPage) {
  plan(0.5);
  const std::string page = folder_.file("answer.html");
  for (const std::vector<std::string>& flag :
       {std::vector<std::string>{"--side-by-side"}, {"--vertical", "z"}}) {
    std::vector<std::string> arguments{"draw",    "--request", request_, "--response",
                                       response_, "-o",        page};
    arguments.insert(arguments.end(), flag.begin(), flag.end());
    const CliRun run = run_camway(arguments);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.err, HasSubstr(flag.front() + ": is for plans, .svg or .png"));
    EXPECT_FALSE(std::filesystem::exists(page));
  }
}

TEST_F(CliDraw, TakesTheSceneOfTheRequestAndRefusesAnother) {
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
  const std::string refused = folder_.file("refused.svg");
  const CliRun other = draw(refused);
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, HasSubstr("answer.json: was made for another scene: its scene_digest is"));
  EXPECT_FALSE(std::filesystem::exists(refused));
  // `camway check` warns of the same in the same words.
  const CliRun check = run_camway({"check", "--request", request_, "--response", response_});
  const std::string sentence = other.err.substr(other.err.find("answer.json: was"));
  EXPECT_THAT(check.err, HasSubstr(sentence.substr(0, sentence.find('\n'))));
}

/// The response says how its scene is read: flags need not be said again, and cannot contradict.
TEST_F(CliDraw, ReadsTheSceneAsTheResponseNames) {
  request_ =
      folder_.write("r.json", request_json({keyframe_json(0.5, 0, 1), keyframe_json(0.5, 0, -1)}));
  run_camway(
      {"plan", "--request", request_, "--response", response_, "--up", "z-to-y", "--scale", "2"});
  const std::string picture = folder_.file("answer.svg");
  const CliRun run = draw(picture);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const auto with = [&](const std::string& flag, const std::string& value) {
    return run_camway(
        {"draw", "--request", request_, "--response", response_, "-o", picture, flag, value});
  };
  EXPECT_EQ(with("--scale", "2").exit_code, 0);
  const CliRun scale = with("--scale", "1");
  EXPECT_EQ(scale.exit_code, 2);
  EXPECT_THAT(scale.err, HasSubstr("--scale: is 1, but"));
  EXPECT_THAT(scale.err, HasSubstr("was planned in the scene read with 2; leave it out"));
  const CliRun up = with("--up", "as-in-file");
  EXPECT_EQ(up.exit_code, 2);
  EXPECT_THAT(up.err, HasSubstr("--up: is as-in-file, but"));
}

/// The picture has the axis of the response; a flag turns it, and an older response has its own
/// from the request.
TEST_F(CliDraw, VerticalAxisFollowsTheResponse) {
  plan(0.5);
  const std::string y = picture_with({"--vertical", "y"});
  const std::string z = picture_with({"--vertical", "z"});
  EXPECT_NE(y, z);
  EXPECT_EQ(picture_with({}), y);
  std::string answer = read(response_);
  const std::string member = "\"vertical_axis\": \"y\",";
  const std::size_t at = answer.find(member);
  ASSERT_NE(at, std::string::npos);
  folder_.write("answer.json", std::string(answer).replace(at, member.size(), ""));
  EXPECT_EQ(picture_with({}), y);
  folder_.write("answer.json", answer.replace(at, member.size(), "\"vertical_axis\": \"z\","));
  EXPECT_EQ(picture_with({}), z);
}

/// A robot does not show which axis points up, so the picture has the axis of the scene's faces:
/// this wall lies across z.
TEST_F(CliDraw, VerticalAxisOfARobotFollowsTheScene) {
  std::string request = request_json({keyframe_json(5, 0, 1), keyframe_json(5, 0, -1)});
  const std::size_t at = request.find("\"keyframes\"");
  plan(request.insert(at, R"("body": {"type": "box", "size": [0.1, 0.1, 0.1]}, )"));
  EXPECT_THAT(read(response_), Not(HasSubstr("vertical_axis")));
  const std::string own = picture_with({});
  EXPECT_EQ(own, picture_with({"--vertical", "z"}));
  EXPECT_NE(own, picture_with({"--vertical", "y"}));
}

TEST_F(CliDraw, DrawsASceneAlone) {
  const std::string picture = folder_.file("plan.svg");
  const CliRun run = run_camway({"draw", "--scene", scene_, "-o", picture});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(read(picture), HasSubstr("<svg"));
  const CliRun no_scene = run_camway({"draw", "-o", picture});
  EXPECT_EQ(no_scene.exit_code, 2);
  EXPECT_THAT(no_scene.err, HasSubstr("--scene or --request is required"));
  const CliRun half = run_camway({"draw", "--scene", scene_, "--request", "r.json", "-o", picture});
  EXPECT_EQ(half.exit_code, 2);
  EXPECT_THAT(half.err, HasSubstr("--response"));
}

TEST_F(CliDraw, NamesTheFileThatCannotBeWritten) {
  plan(0.5);
  const CliRun run = draw(folder_.file("no/such/folder.svg"));
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("folder.svg"));
}

}  // namespace
}  // namespace camway::tools
