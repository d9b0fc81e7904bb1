// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <utility>

#include "tests/tools/camway/cli_runner.h"
#include "tools/json/json_response.h"

namespace camway::tools {
namespace {

using planning::Status;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class CliPlan : public ::testing::Test {
 protected:
  CliPlan() {
    scene_ = folder_.write("wall.obj", wall_obj());
    free_ =
        folder_.write("free.json", request_json({keyframe_json(1, 0, 1), keyframe_json(1, 0, -1)}));
  }

  TemporaryFolder folder_;
  std::string scene_;
  std::string free_;
};

TEST_F(CliPlan, WritesTheResponseToStandardOutput) {
  const CliRun run = run_camway({"plan", "--request", free_});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const auto response = parse_as<planning::PlanResult>(run.out, "stdout");
  ASSERT_TRUE(response) << response.error;
  EXPECT_EQ(response->status, Status::kOk);
  EXPECT_EQ(response->keyframes.size(), 2U);
  EXPECT_GT(response->timing.load_scene_ms, 0.0);
  EXPECT_THAT(run.err,
              HasSubstr("free.json: ok: no collision to correct; the path is proved free"));
}

TEST_F(CliPlan, SaysThatNothingBetterThanTheClosestPathWasFound) {
  const std::string request = folder_.write(
      "graze.json", request_json({keyframe_json(2.05, 0, 1), keyframe_json(2.05, 0, -1)}));
  const auto message_of = [&](const std::string& objective) {
    return run_camway({"plan", "--scene", scene_, "--request", request, "--objective", objective})
        .err;
  };
  EXPECT_THAT(message_of("closest"), Not(HasSubstr("none was found")));
  EXPECT_THAT(message_of("safest"), Not(HasSubstr("none was found")));
  EXPECT_THAT(message_of("shortest"),
              HasSubstr("; none was found that is shorter than the closest one"));
}

// The fin is nearer to the last keyframe than the safest path has to come anywhere else.
TEST_F(CliPlan, SaysWhatKeepsTheSafestPathFromMoreRoom) {
  const auto message_with_last = [&](double x) {
    const std::string request = folder_.write(
        "graze.json", request_json({keyframe_json(2.05, 0, 1), keyframe_json(x, 0, -0.3)}));
    return run_camway({"plan", "--scene", scene_, "--request", request, "--objective", "safest"})
        .err;
  };
  EXPECT_THAT(message_with_last(2.05), HasSubstr("m of keyframe 1, which stays"));
  EXPECT_THAT(message_with_last(4.0), Not(HasSubstr("which stays")));
}

TEST_F(CliPlan, CorrectsAPathThatClipsTheFin) {
  const std::string request = folder_.write(
      "graze.json", request_json({keyframe_json(2.05, 0, 1), keyframe_json(2.05, 0, -1)}));
  const std::string file = folder_.file("P.json");
  const CliRun run = run_camway({"plan", "--scene", scene_, "--request", request, "--response",
                                 file, "--method", "keyframe_insertion", "--deadline-s", "20"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.out, "");
  const auto response = read_as<planning::PlanResult>(file);
  ASSERT_TRUE(response) << response.error;
  EXPECT_EQ(response->status, Status::kOk);
  EXPECT_FALSE(response->collisions.empty());
  EXPECT_GT(response->keyframes.size(), 2U);
  EXPECT_TRUE(response->remaining_collisions.empty());
}

TEST_F(CliPlan, ReportsNoShiftThatWasNotMeasured) {
  const std::string request = folder_.write(
      "graze.json", request_json({keyframe_json(2.05, 0, 1), keyframe_json(2.05, 0, -1)}));
  const auto measures_of = [&](const std::string& method) {
    const CliRun run = run_camway({"plan", "--scene", scene_, "--request", request, "--method",
                                   method, "--deadline-s", "20"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return nlohmann::json::parse(run.out)["measures"];
  };
  const nlohmann::json inserted = measures_of("keyframe_insertion");
  EXPECT_GT(inserted["after"]["largest_deviation_m"], 0.01);
  EXPECT_FALSE(inserted["after"].contains("largest_shift_deg"));
  EXPECT_FALSE(inserted["after"].contains("mean_shift_deg"));
  EXPECT_EQ(inserted["before"]["largest_shift_deg"], 0.0);
  EXPECT_GT(measures_of("ladder")["after"]["largest_shift_deg"], 0.0);
}

TEST_F(CliPlan, ReadsTheMeshOfTheBodyFromAFileBesideTheRequest) {
  // A closed tetrahedron in centimetres.
  folder_.write("body.obj",
                "v -5 -5 0\nv 5 -5 0\nv 0 5 0\nv 0 0 5\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  const std::vector<std::string> keyframes = {keyframe_json(1, 0, 1), keyframe_json(1, 0, -1)};
  const auto planned = [&](const std::string& body) {
    std::string text = request_json(keyframes);
    text.insert(text.rfind('}'), ", \"body\": " + body);
    return run_camway({"plan", "--request", folder_.write("mesh.json", text)});
  };
  const CliRun solid =
      planned(R"({"type": "mesh", "file": "body.obj", "scale": 0.01, "solid": true})");
  EXPECT_EQ(solid.exit_code, 0) << solid.err;
  const CliRun missing = planned(R"({"type": "mesh", "file": "nobody.obj"})");
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_THAT(missing.err, HasSubstr("mesh.json: body.file: "));
  EXPECT_THAT(missing.err, HasSubstr("nobody.obj: there is no such file"));
  const CliRun open = planned(R"({"type": "mesh", "file": "wall.obj", "solid": true})");
  EXPECT_EQ(open.exit_code, 2);
  EXPECT_THAT(open.err, HasSubstr("wall.obj: triangles: are no closed surface: the edge between"));
  // Parts of a body are never left out in silence.
  const std::string corners = "v -5 -5 0\nv 5 -5 0\nv 0 5 0\nv 0 0 5\n";
  folder_.write("hole.obj", corners + "f 1 3 2\nf 1 2 9\n");
  folder_.write("spike.obj", corners + "f 1 3 2\nf 1 1 4\n");
  const CliRun hole = planned(R"({"type": "mesh", "file": "hole.obj", "scale": 0.01})");
  EXPECT_EQ(hole.exit_code, 2);
  EXPECT_THAT(hole.err, HasSubstr("hole.obj: the body would be without faces of its file: 1 with a "
                                  "vertex that does not exist"));
  const CliRun spike = planned(R"({"type": "mesh", "file": "spike.obj", "scale": 0.01})");
  EXPECT_EQ(spike.exit_code, 2);
  EXPECT_THAT(spike.err, HasSubstr("1 of zero area"));
}

TEST_F(CliPlan, EndsWithThreeWhereNoFreePathWasFound) {
  // A wall without end: there is no way around.
  folder_.write("wide.obj",
                "v -1e4 -1e4 0\nv 1e4 -1e4 0\nv 1e4 1e4 0\nv -1e4 1e4 0\nf 1 2 3\nf 1 3 4\n");
  const std::string request = folder_.write(
      "wide.json", request_json({keyframe_json(0, 0, 1), keyframe_json(0, 0, -1)}, "wide.obj"));
  const CliRun run = run_camway({"plan", "--request", request, "--deadline-s", "5"});
  EXPECT_EQ(run.exit_code, 3) << run.err;
  const auto response = parse_as<planning::PlanResult>(run.out, "stdout");
  ASSERT_TRUE(response) << response.error;
  EXPECT_NE(response->status, Status::kOk);
  EXPECT_FALSE(response->remaining_collisions.empty());
}

TEST_F(CliPlan, NamesFieldKeyframeOrFileOfInvalidInput) {
  const std::string a = keyframe_json(1, 0, 1);
  const std::string b = keyframe_json(1, 0, -1);
  const std::string in_wall = keyframe_json(0, 0, 0.1);
  const auto timed = [](double time, double z) {
    return "{\"time\": " + std::to_string(time) + ", " + keyframe_json(1, 0, z).substr(1);
  };
  folder_.write("broken.obj", "this is no scene\n");
  const struct {
    std::string request;
    const char* expected;
  } cases[] = {
      {"{\"keyframes\": [", "R.json: line 1, column"},
      {"", "R.json: is empty"},
      {request_json({a, R"({"position": [0, 0, NaN], "orientation": [1, 0, 0, 0]})"}),
       "R.json: line 6, column 25: syntax error"},
      {request_json({a, R"({"position": [0, 0, 1e999], "orientation": [1, 0, 0, 0]})"}),
       "number overflow"},
      {request_json({a, R"({"position": [0, 0, 1]})"}),
       "R.json: keyframes[1].orientation: is missing"},
      {request_json({R"({"position": [0, 0, 1], "orientation": [0, 0, 0, 0]})", a}),
       "R.json: keyframes[0].orientation: has length zero"},
      {request_json({timed(2, 1), timed(1, -1)}), "R.json: keyframes[1].time"},
      {request_json({timed(2, 1), timed(2, -1)}), "R.json: keyframes[1].time"},
      {request_json({a}), "R.json: keyframes: "},
      {request_json({}), "R.json: keyframes: "},
      {request_json({a, in_wall}), "R.json: keyframes[1]: "},
      {request_json({a, b}, "missing.obj"), "missing.obj"},
      {request_json({a, b}, "broken.obj"), "broken.obj"},
      {request_json({a, b}, ""), "R.json: scene: is missing, and there is no --scene"},
  };
  const std::string request = folder_.file("R.json");
  const std::string response = folder_.file("P.json");
  for (const auto& c : cases) {
    folder_.write("R.json", c.request);
    const CliRun run = run_camway({"plan", "--request", request, "--response", response});
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_THAT(run.err, StartsWith("camway: " + folder_.file("")));
    EXPECT_THAT(run.err, HasSubstr(c.expected));
    const auto written = read_as<planning::PlanResult>(response);
    ASSERT_TRUE(written) << written.error;
    EXPECT_EQ(written->status, Status::kInvalid);
    EXPECT_THAT(written->message, HasSubstr(c.expected));
    const CliRun bare = run_camway({"plan", "--request", request});
    EXPECT_EQ(bare.exit_code, 2);
    EXPECT_EQ(bare.out, "");
  }
}

TEST_F(CliPlan, NamesTheKeyframeInTheWallInTheResponseToo) {
  const std::string request =
      folder_.write("R.json", request_json({keyframe_json(1, 0, 1), keyframe_json(0, 0, 0.1)}));
  const std::string file = folder_.file("P.json");
  EXPECT_EQ(run_camway({"plan", "--request", request, "--response", file}).exit_code, 2);
  const auto response = read_as<planning::PlanResult>(file);
  ASSERT_TRUE(response) << response.error;
  EXPECT_EQ(response->keyframe, std::optional<std::size_t>(1));
}

TEST_F(CliPlan, PlansForAnyBodyWithClearance) {
  // The wall ends at x = 0.2 and the fin begins at x = 2: between them is a gap of 1.8 m. The
  // paper's method corrects cameras only, so other bodies get the interpolated path.
  const auto planned = [&](const std::string& body, double clearance) {
    std::string text = request_json({keyframe_json(1.1, 0, 1), keyframe_json(1.1, 0, -1)});
    const std::string camera = R"("camera": {"fov_x_deg": 70, "fov_y_deg": 50, "near": 0.1},)";
    text.replace(text.find(camera), camera.size(),
                 "\"body\": " + body +
                     ", \"options\": {\"method\": \"keyframe_insertion\", \"clearance_m\": " +
                     std::to_string(clearance) + "},");
    const CliRun run = run_camway({"plan", "--request", folder_.write("R.json", text)});
    EXPECT_EQ(run.exit_code == 0,
              parse_as<planning::PlanResult>(run.out, "stdout").value.has_value() &&
                  run.err.find(": ok: ") != std::string::npos)
        << run.err;
    return run.exit_code;
  };
  EXPECT_EQ(planned(R"({"type": "sphere", "radius_m": 0.8})", 0.0), 0);
  EXPECT_EQ(planned(R"({"type": "sphere", "radius_m": 0.8})", 0.05), 0);
  EXPECT_EQ(planned(R"({"type": "sphere", "radius_m": 0.8})", 0.15), 3);
  EXPECT_EQ(planned(R"({"type": "sphere", "radius_m": 0.95})", 0.0), 3);
  EXPECT_EQ(planned(R"({"type": "box", "size": [1.7, 0.5, 0.5]})", 0.0), 0);
  EXPECT_EQ(planned(R"({"type": "box", "size": [1.9, 0.5, 0.5]})", 0.0), 3);
}

TEST_F(CliPlan, NamesTheFieldOfABodyAtFault) {
  std::string text = request_json({keyframe_json(1.1, 0, 1), keyframe_json(1.1, 0, -1)});
  text.replace(text.find("\"camera\""), 0, R"("body": {"type": "box", "size": [1, -1, 1]}, )");
  const CliRun run = run_camway({"plan", "--request", folder_.write("R.json", text)});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("R.json: body.size[1]: is -1 m; it must be above 0"));
}

TEST_F(CliPlan, WitnessesSayWhatCollides) {
  const std::string request = folder_.write(
      "graze.json", request_json({keyframe_json(2.05, 0, 1), keyframe_json(2.05, 0, -1)}));
  const CliRun run = run_camway({"plan", "--request", request});
  const auto response = parse_as<planning::PlanResult>(run.out, "stdout");
  ASSERT_TRUE(response) << response.error;
  ASSERT_EQ(response->collisions.size(), 1U);
  ASSERT_TRUE(response->collisions[0].witness);
  EXPECT_EQ(response->collision_names.at(0).object, "fin");
  EXPECT_NE(response->collision_names.at(0).feature, "");
  EXPECT_GT(response->collisions[0].witness->depth_m, 0.0);
}

TEST_F(CliPlan, SaysWhatEachCorrectionDid) {
  const std::string request = folder_.write(
      "graze.json", request_json({keyframe_json(2.05, 0, 1), keyframe_json(2.05, 0, -1)}));
  const CliRun run = run_camway({"plan", "--request", request, "--objective", "smoothest",
                                 "--max-turn-deg", "90", "--seed", "3", "--repair-keyframes",
                                 "--max-shrink", "0.5", "--method", "ladder"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const auto response = parse_as<planning::PlanResult>(run.out, "stdout");
  ASSERT_TRUE(response) << response.error;
  ASSERT_EQ(response->corrections.size(), response->collisions.size());
  EXPECT_NE(response->corrections.at(0).kind, correction::CorrectionKind::kNone);
  EXPECT_TRUE(response->measures_before);
  EXPECT_TRUE(response->measures);
  EXPECT_THAT(run.err, HasSubstr("\n  0."));
  EXPECT_THAT(run.err, HasSubstr(" s: collides with fin; moved up to "));
}

// The response names its bounds, and `check` proves the path within them again.
TEST_F(CliPlan, KeepsWithinBounds) {
  std::string text = request_json({keyframe_json(2.05, 0, 1), keyframe_json(2.05, 0, -1)});
  text.replace(text.find("\"camera\""), 0,
               R"("options": {"bounds": {"min": [null, -1.5, null], "max": [3, 1.5, null]}}, )");
  const std::string request = folder_.write("R.json", text);
  const std::string response = folder_.file("P.json");
  const CliRun run = run_camway({"plan", "--request", request, "--response", response});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const auto read = read_as<planning::PlanResult>(response);
  ASSERT_TRUE(read) << read.error;
  EXPECT_EQ(read->bounds.min_W.y(), -1.5);
  EXPECT_EQ(read->bounds.max_W.head<2>(), Eigen::Vector2d(3.0, 1.5));
  EXPECT_FALSE(std::isfinite(read->bounds.max_W.z()));

  // A request with bounds that the path leaves.
  text.replace(text.find("[3, 1.5, null]"), 14, "[2.05, 1.5, null]");
  const CliRun refused = run_camway({"plan", "--request", folder_.write("S.json", text)});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("keyframes[0]: the near quadrilateral leaves the bounds"));
}

TEST_F(CliPlan, FlagsGoBeforeTheRequestsOptions) {
  std::string text = request_json({keyframe_json(1.1, 0, 1), keyframe_json(1.1, 0, -1)});
  text.replace(text.find("\"camera\""), 0,
               R"("body": {"type": "sphere", "radius_m": 0.8},
                  "options": {"method": "keyframe_insertion", "clearance_m": 0.15}, )");
  const std::string request = folder_.write("R.json", text);
  EXPECT_EQ(run_camway({"plan", "--request", request}).exit_code, 3);
  EXPECT_EQ(run_camway({"plan", "--request", request, "--clearance-m", "0.05"}).exit_code, 0);
  EXPECT_EQ(run_camway({"plan", "--request", request, "--method", "ladder"}).exit_code, 0);
  const CliRun run = run_camway({"plan", "--request", request, "--max-shrink", "0.5"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("R.json: --max-shrink: is 0.5, but the body is no camera"));
}

TEST_F(CliPlan, NamesTheOptionAtFault) {
  const auto error_of = [&](const std::string& options) {
    std::string text = request_json({keyframe_json(1, 0, 1), keyframe_json(1, 0, -1)});
    text.replace(text.find("\"camera\""), 0, "\"options\": " + options + ", ");
    const CliRun run = run_camway({"plan", "--request", folder_.write("R.json", text)});
    EXPECT_EQ(run.exit_code, 2);
    return run.err;
  };
  EXPECT_THAT(error_of(R"({"orientation": {"policy": "level", "up": [0, 0, 0]}})"),
              HasSubstr("R.json: options.orientation.up: has length 0, which is no direction"));
  EXPECT_THAT(error_of(R"({"orientation": {"policy": "target"}})"),
              HasSubstr("R.json: options.orientation.target: is missing"));
  EXPECT_THAT(error_of(R"({"limits": {"turn_rate_deg_per_s": 0}})"),
              HasSubstr("R.json: options.limits.turn_rate_deg_per_s: is 0; it must be above 0"));
  EXPECT_THAT(error_of(R"({"max_shrink": 1})"),
              HasSubstr("R.json: options.max_shrink: is 1; it must be at least 0 and below 1"));
  EXPECT_THAT(error_of(R"({"objectiv": "closest"})"), HasSubstr("options.objectiv: is unknown"));
}

TEST_F(CliPlan, NamesTheAngleAsItWasWritten) {
  std::string text = request_json({keyframe_json(1, 0, 1), keyframe_json(1, 0, -1)});
  text.replace(text.find("\"fov_x_deg\": 70"), 15, "\"fov_x_deg\": 180");
  const CliRun run = run_camway({"plan", "--request", folder_.write("R.json", text)});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("R.json: camera.fov_x_deg: is 180 degrees"));
}

// Upright cameras whose quaternions are written x, y, z, w: read as w, x, y, z they hang upside
// down.
TEST_F(CliPlan, WarnsOfQuaternionsThatLookXyzw) {
  const auto keyframe = [](double z, const char* orientation) {
    return "{\"position\": [1, 0, " + std::to_string(z) + "], " + orientation + "}";
  };
  const auto run_with = [&](const char* orientation) {
    const std::string request = folder_.write(
        "R.json", request_json({keyframe(1, orientation), keyframe(-1, orientation)}));
    return run_camway({"plan", "--request", request, "--response", folder_.file("P.json")});
  };
  const CliRun wrong = run_with(R"("orientation": [0, 0, 0, 1])");
  EXPECT_EQ(wrong.exit_code, 0);
  EXPECT_THAT(wrong.err, HasSubstr("R.json: keyframes[].orientation: all cameras look rolled"));
  EXPECT_THAT(read_all(folder_.file("P.json")),
              HasSubstr("orientation_xyzw takes the other order"));
  const CliRun right = run_with(R"("orientation_xyzw": [0, 0, 0, 1])");
  EXPECT_EQ(right.exit_code, 0);
  EXPECT_THAT(right.err, Not(HasSubstr("warning")));
  const auto imported_from = [&](const std::string& format) {
    std::string text = request_json({keyframe(1, R"("orientation": [0, 0, 0, 1])"),
                                     keyframe(-1, R"("orientation": [0, 0, 0, 1])")});
    text.insert(text.find('{') + 1, R"("_camera": {"format": ")" + format + "\"}, ");
    return run_camway({"plan", "--request", folder_.write("R.json", text)}).err;
  };
  EXPECT_THAT(imported_from("colmap"), Not(HasSubstr("warning")));
  EXPECT_THAT(imported_from("lcm"), HasSubstr("all cameras look rolled"));
  const CliRun reversed = run_with(R"("orientation_xyzw": [0, 0, 1, 0])");
  EXPECT_THAT(reversed.err, HasSubstr("they are read as x, y, z, w; orientation takes the other"));
}

// Otherwise the result of planning would be lost.
TEST_F(CliPlan, NoticesBeforePlanningThatTheResponseCannotBeWritten) {
  for (const std::vector<std::string>& flags :
       {std::vector<std::string>{"--response", "/nonexistent/P.json"},
        {"--response", folder_.file("")},
        {"--response-dir", scene_}}) {
    std::vector<std::string> arguments{"plan", "--request", free_};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    const CliRun run = run_camway(arguments);
    EXPECT_EQ(run.exit_code, 2) << flags[1];
    EXPECT_THAT(run.err, HasSubstr(flags[1]));
    EXPECT_THAT(run.err, Not(HasSubstr("ok: ")));
    EXPECT_EQ(run.out, "");
  }
}

TEST_F(CliPlan, TimesAreDerivedAtTheSpeedThatIsAskedFor) {
  std::string text = request_json({keyframe_json(1, 0, 1), keyframe_json(1, 0, -1)});
  text.replace(text.find("\"camera\""), 0, R"("options": {"default_speed_m_per_s": 0.5}, )");
  const CliRun run = run_camway({"plan", "--request", folder_.write("R.json", text)});
  EXPECT_EQ(parse_as<planning::PlanResult>(run.out, "stdout")->keyframes[1].time_s, 4.0) << run.err;
}

TEST_F(CliPlan, HelpNamesBodyAndClearance) {
  const CliRun run = run_camway({"plan", "--help"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.out, HasSubstr("options.clearance_m"));
  EXPECT_THAT(run.out, HasSubstr("\"body\""));
  for (const char* flag : {"--method", "--deadline-s", "--clearance-m", "--objective",
                           "--max-turn-deg", "--max-shrink", "--seed", "--repair-keyframes"}) {
    EXPECT_THAT(run.out, HasSubstr(flag));
  }
}

TEST_F(CliPlan, ReadsStandardInput) {
  const CliRun run = run_camway({"plan", "--scene", scene_, "--request", "-"}, free_);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, StartsWith("camway: standard input: ok: "));
}

TEST_F(CliPlan, CallsStandardInputByItsName) {
  std::string no_scene = request_json({keyframe_json(1, 0, 1), keyframe_json(1, 0, -1)});
  no_scene.replace(no_scene.find("\"scene\""), 7, "\"_scene\"");
  std::string below_0 = request_json({keyframe_json(1, 0, 1), keyframe_json(1, 0, -1)});
  below_0.replace(below_0.find("\"camera\""), 0, R"("options": {"clearance_m": -1}, )");
  const std::pair<std::string, std::string> kFaults[] = {
      {no_scene, "camway: standard input: scene: is missing"},
      {below_0, "camway: standard input: options.clearance_m: is -1"},
      {"{", "camway: standard input: line 1, column 1: "},
  };
  for (const auto& [text, said] : kFaults) {
    const std::string file = folder_.write("in.json", text);
    EXPECT_THAT(run_camway({"plan", "--request", "-"}, file).err, StartsWith(said));
  }
  const std::string file = folder_.write("in.json", below_0);
  EXPECT_THAT(run_camway({"check", "--request", "-", "--response", free_}, file).err,
              StartsWith("camway: standard input: options.clearance_m: is -1"));
}

TEST_F(CliPlan, AFlagWithoutItsValueMakesNoFile) {
  const CliRun run = run_camway({"plan", "--request", free_, "--response", "--no-timing"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("camway: --response: needs a value; '--no-timing' is a flag"));
  const CliRun taken = run_camway(
      {"plan", "--request", free_, "--clearance-m", "--response", folder_.file("x.json")});
  EXPECT_THAT(taken.err, HasSubstr("camway: --clearance-m: needs a value; '--response' is a flag"));
}

TEST_F(CliPlan, NamesTheDeadlineThatWasReached) {
  const CliRun run = run_camway({"plan", "--request", free_, "--deadline-s", "1e-9"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, HasSubstr("timeout: the deadline of 1e-09 s was reached before "));
}

TEST_F(CliPlan, SaysWhichFilesCannotBeUsed) {
  CliRun run = run_camway({"plan", "--request", "/nonexistent/R.json"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("camway: /nonexistent/R.json: cannot be opened"));
  run = run_camway({"plan", "--request", free_, "--response", "/nonexistent/P.json"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("/nonexistent/P.json: cannot be written: No such file"));
}

TEST_F(CliPlan, ScalesAndTurnsTheScene) {
  // At 10 m per unit the wall ends at x = 2 m and is in the way; rotated to Y up it is horizontal.
  CliRun run = run_camway({"plan", "--request", free_, "--scale", "10", "--deadline-s", "5"});
  ASSERT_TRUE(parse_as<planning::PlanResult>(run.out, "stdout")) << run.err;
  EXPECT_FALSE(parse_as<planning::PlanResult>(run.out, "stdout")->collisions.empty());
  const std::string through = folder_.write(
      "through.json", request_json({keyframe_json(0, 0.5, 1.5), keyframe_json(0, 0.5, -1.5)}));
  run = run_camway({"plan", "--request", through, "--deadline-s", "5"});
  ASSERT_TRUE(parse_as<planning::PlanResult>(run.out, "stdout")) << run.err;
  EXPECT_FALSE(parse_as<planning::PlanResult>(run.out, "stdout")->collisions.empty());
  run = run_camway({"plan", "--request", through, "--up", "z-to-y"});
  ASSERT_TRUE(parse_as<planning::PlanResult>(run.out, "stdout")) << run.err;
  EXPECT_TRUE(parse_as<planning::PlanResult>(run.out, "stdout")->collisions.empty());
}

TEST_F(CliPlan, TheRequestSaysHowToReadItsSceneAndFlagsGoBefore) {
  const auto digest_with = [&](const std::string& reading, std::vector<std::string> flags) {
    std::string text = request_json({keyframe_json(1, 0, 1), keyframe_json(1, 0, -1)});
    text.replace(text.find("\"camera\""), 0, reading);
    std::vector<std::string> arguments{"plan", "--deadline-s", "5", "--request",
                                       folder_.write("R.json", text)};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    const CliRun run = run_camway(arguments);
    const auto path = parse_as<PathFile>(run.out, "stdout");
    EXPECT_TRUE(path) << run.err;
    return path.value ? path->scene_digest : "";
  };
  const std::string large = digest_with("", {"--scale", "10"});
  EXPECT_EQ(digest_with(R"("scale": 10, )", {}), large);
  EXPECT_NE(digest_with("", {}), large);
  EXPECT_EQ(digest_with(R"("scale": 7, )", {"--scale", "10"}), large);
  const std::string turned = digest_with("", {"--up", "z-to-y"});
  EXPECT_EQ(digest_with(R"("up": "z-to-y", )", {}), turned);
  EXPECT_EQ(digest_with(R"("up": "y-to-z", )", {"--up", "z-to-y"}), turned);
}

TEST_F(CliPlan, PlansASetWithATable) {
  const std::string bad = folder_.write("bad.json", "{");
  const std::string dir = folder_.file("answers");
  const CliRun run =
      run_camway({"plan", "--request", free_, bad, "--response-dir", dir, "--no-timing"});
  EXPECT_EQ(run.exit_code, 2) << run.err;
  EXPECT_THAT(run.out, HasSubstr("1 of 2 requests ok"));
  EXPECT_THAT(run.out, HasSubstr(free_));
  EXPECT_EQ(read_as<planning::PlanResult>(dir + "/free.json")->status, Status::kOk);
  EXPECT_EQ(read_as<planning::PlanResult>(dir + "/bad.json")->status, Status::kInvalid);
  const std::string first = read_all(dir + "/free.json");
  EXPECT_EQ(
      run_camway({"plan", "--request", free_, "--response-dir", dir, "--no-timing"}).exit_code, 0);
  EXPECT_EQ(read_all(dir + "/free.json"), first);
  EXPECT_THAT(first, Not(HasSubstr("timing_ms")));
}

TEST_F(CliPlan, SaysWhatAFlagMustBeInWords) {
  const std::pair<std::vector<std::string>, const char*> kCases[] = {
      {{"--up", "zup"}, "--up: must be one of as-in-file, z-to-y, y-to-z, not 'zup'"},
      {{"--deadline-s", "-1"}, "--deadline-s: must be a number above 0 and finite, not '-1'"},
      {{"--chord-error-m", "0"}, "must be a number at least 1e-05 and finite, not '0'"},
      {{"--max-shrink", "1"}, "--max-shrink: must be a number at least 0 and below 1, not '1'"},
      {{"--seed", "18446744073709551615"},
       "--seed: must be a whole number, 1 to 9223372036854775807"},
      {{"--objective", "savest"}, "did you mean safest? (see camway plan --help)"},
      {{"--respons", "P.json"}, "'--respons' is no flag of camway plan; did you mean --response?"},
  };
  for (const auto& [flags, expected] : kCases) {
    std::vector<std::string> arguments{"plan", "--request", free_};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    const CliRun run = run_camway(arguments);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.err, HasSubstr(expected));
    EXPECT_LT(run.err.size(), 200U) << "no number of 309 digits";
  }
}

TEST_F(CliPlan, RefusesBadFlags) {
  const std::vector<std::vector<std::string>> cases = {
      {"plan"},
      {"plan", "--request", free_, "--scale", "0"},
      {"plan", "--request", free_, "--scale", "-1"},
      {"plan", "--request", free_, "--up", "sideways"},
      {"plan", "--request", free_, "--up", "7"},
      {"plan", "--request", free_, "--method", "magic"},
      {"plan", "--request", free_, "--deadline-s", "0"},
      {"plan", "--request", free_, "--clearance-m", "-1"},
      {"plan", "--request", free_, "--clearance", "-1"},
      {"plan", "--request", free_, "--clearance", "1", "--clearance-m", "1"},
      {"plan", "--request", free_, "--objective", "cheapest"},
      {"plan", "--request", free_, "--max-turn-deg", "181"},
      {"plan", "--request", free_, "--max-shrink", "1"},
      {"plan", "--request", free_, "--seed", "0"},
      {"plan", "--request", free_, free_},
      {"plan", "--request", free_, "--nonsense"},
      {"fly"},
      {},
  };
  for (const auto& arguments : cases) {
    const CliRun run = run_camway(arguments);
    EXPECT_EQ(run.exit_code, 2) << ::testing::PrintToString(arguments) << run.err;
    EXPECT_THAT(run.err, StartsWith("camway: "));
  }
}

}  // namespace
}  // namespace camway::tools
