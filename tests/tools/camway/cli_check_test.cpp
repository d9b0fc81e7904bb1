// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include <nlohmann/json.hpp>

#include "tests/tools/camway/cli_runner.h"
#include "tools/json/json_response.h"

namespace camway::tools {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Returns a segment along z that looks along -Z, as JSON.
nlohmann::json segment_json(double t0_s, double t1_s, double z0_m, double z1_m,
                            const std::array<double, 7>& w = {1, 1, 1, 1, 1, 1, 1}) {
  nlohmann::json segment{{"t0", t0_s}, {"t1", t1_s}};
  for (int i = 0; i < 4; ++i) {
    segment["position"].push_back(nlohmann::json::array({0, 0, z0_m + (z1_m - z0_m) * i / 3}));
  }
  for (const double weight : w)
    segment["orientation"].push_back(nlohmann::json::array({weight, 0, 0, 0}));
  return segment;
}

class CliCheck : public ::testing::Test {
 protected:
  /// Returns the response of a plan along x, which ends before or beyond the wall.
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
  // The path of one request, in a scene that blocks it.
  const std::string response = planned("free", 1);
  scene_ = folder_.write("across.obj", "o barrier\nv -9 -9 0\nv 9 -9 0\nv 0 9 0\nf 1 2 3\n");
  const CliRun run = check(response);
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_THAT(run.out, StartsWith("collides from "));
  EXPECT_THAT(run.out, HasSubstr("barrier"));
}

// Bounds of the request, or of the response, which names those of its scene.
TEST_F(CliCheck, ListsWhereAPathLeavesItsBounds) {
  const std::string file = planned("free", 1);
  auto response = read_as<planning::PlanResult>(file);
  ASSERT_TRUE(response) << response.error;
  response->bounds.max_W.x() = 1.0;
  const std::string bounded = folder_.write("P.json", *write_plan_response(*response));
  const CliRun run = check(bounded);
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_THAT(run.out, HasSubstr("bounds.max.x"));
  EXPECT_THAT(run.out, HasSubstr("beyond it at"));

  std::string text = request_json({keyframe_json(1, 0, 1), keyframe_json(1, 0, -1)});
  text.replace(text.find("\"camera\""), 0, R"("options": {"bounds": {"max": [1, null, null]}}, )");
  request_ = folder_.write("R.json", text);
  EXPECT_THAT(check(file).out, HasSubstr("bounds.max.x"));
  text.replace(text.find("[1, null"), 2, "[9");
  request_ = folder_.write("S.json", text);
  EXPECT_EQ(check(file).exit_code, 0);
}

TEST_F(CliCheck, RefusesAPathThatJumps) {
  const std::string file = planned("free", 1);
  auto response = read_as<planning::PlanResult>(file);
  ASSERT_TRUE(response) << response.error;
  motion::Segment first = response->path.segments()[0];
  motion::Segment second = first;
  second.t0_s = first.t1_s;
  second.t1_s = first.t1_s + 1.0;
  response->path = motion::Path({first, second});
  const auto text = write_plan_response(*response);
  ASSERT_TRUE(text) << text.error;
  const CliRun run = check(folder_.write("jump.json", *text));
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("segments[1]"));
}

// A search that skips a segment, or cannot evaluate it, would call each of these free.
class CliCheckForeign : public CliCheck {
 protected:
  CliRun check_segments(const std::vector<nlohmann::json>& segments) {
    scene_ = folder_.write("across.obj", "o barrier\nv -9 -9 0\nv 9 -9 0\nv 0 9 0\nf 1 2 3\n");
    request_ = folder_.write("request.json",
                             request_json({keyframe_json(0, 0, 2), keyframe_json(0, 0, -1)}));
    return check(folder_.write("response.json",
                               nlohmann::json{{"status", "ok"}, {"segments", segments}}.dump()));
  }

  void expect_refused(const std::vector<nlohmann::json>& segments, const std::string& field) {
    const CliRun run = check_segments(segments);
    EXPECT_EQ(run.exit_code, 2) << field << "\n" << run.out;
    EXPECT_THAT(run.err, HasSubstr("response.json: " + field));
    EXPECT_EQ(run.out, "");
  }
};

TEST_F(CliCheckForeign, FindsTheWallThatTheOthersHide) {
  const CliRun run = check_segments({segment_json(0, 1, 2, -1)});
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_THAT(run.out, HasSubstr("barrier"));
}

TEST_F(CliCheckForeign, RefusesTimesThatSkipASegment) {
  expect_refused({segment_json(0, 0, 2, -1)}, "segments[0].t1: ");
  expect_refused({segment_json(0, 0, 2, -1), segment_json(0, 1, -1, -2)}, "segments[0].t1: ");
  expect_refused({segment_json(1, 0, 2, -1)}, "segments[0].t1: ");
  expect_refused({segment_json(0, 1, 2, 1), segment_json(0.5, 1.5, 1, -1)}, "segments[1].t0: ");
  expect_refused({segment_json(0, 1, 2, 1), segment_json(1.5, 2.5, 1, -1)}, "segments[1].t0: ");
  expect_refused({segment_json(-1.5e308, 1.5e308, 2, -1)}, "segments[0].t0: ");
  expect_refused({}, "segments: ");
}

TEST_F(CliCheckForeign, RefusesNumbersThatDoublesCannotSquare) {
  for (const double w : {0.0, 1e-200, 1e200}) {
    expect_refused({segment_json(0, 1, 2, -1, {w, w, w, w, w, w, w})},
                   "segments[0].orientation[0]: ");
  }
  expect_refused({segment_json(0, 1, 2, -1, {1, 1, 1, 1, 1, 1, 0})},
                 "segments[0].orientation[6]: ");
  nlohmann::json segment = segment_json(0, 1, 2, -1);
  segment["position"][1][0] = 1e200;
  segment["position"][2][0] = -1e200;
  expect_refused({segment}, "segments[0].position[1]: ");
}

TEST_F(CliCheckForeign, CountsAsCollidingWhereAnOrientationThatVanishesMatters) {
  // The numerator is zero at u = 1/2, on the way through the wall and where it could touch it.
  const std::array<double, 7> through_zero{1, 1, 1, 0, -1, -1, -1};
  for (const double end_m : {-1.0, 0.12}) {
    const CliRun run =
        check_segments({segment_json(0, 1, end_m > 0 ? 0.12 : 2, end_m, through_zero)});
    EXPECT_EQ(run.exit_code, 3) << run.err << run.out;
    EXPECT_THAT(run.out, StartsWith("collides from "));
  }
  // Far from it the answer does not depend on the orientation, and does not take until the
  // deadline.
  EXPECT_EQ(check_segments({segment_json(0, 1, 7, 4, through_zero)}).err, "");
}

TEST_F(CliCheckForeign, FindsAWallInTheGapOfAJoin) {
  // Both ends stand still on either side of the wall, nearer than the tolerance of a join.
  const double far_m = 0.1 + 1e-11;  // the quadrilateral is 0.1 m before the eye
  const double near_m = 0.1 - 1e-11;
  const CliRun run =
      check_segments({segment_json(0, 1, far_m, far_m), segment_json(1, 2, near_m, near_m)});
  EXPECT_EQ(run.exit_code, 3) << run.err << run.out;
  EXPECT_THAT(run.out, StartsWith("collides from 1.000000 to 1.000000 s"));
}

TEST_F(CliCheck, SaysWhichKeyframesThePathMeets) {
  const std::string response = planned("free", 1);
  EXPECT_THAT(check(response).out, HasSubstr("\nkeyframes met: 2 of 2, largest miss "));
  // The path of one request checked for another: it is free, but misses the keyframes.
  request_ = folder_.write("other.json",
                           request_json({keyframe_json(1, 0, 1), keyframe_json(1.5, 0, -1)}));
  const CliRun run = check(response);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("\nkeyframes met: 1 of 2, largest miss 0.5 m\n"));
  EXPECT_THAT(run.out, HasSubstr("keyframe 1 (at "));
  EXPECT_THAT(run.out, HasSubstr(") is missed by 0.5 m\n"));
  const CliRun json = run_camway(
      {"check", "--scene", scene_, "--request", request_, "--response", response, "--json"});
  const nlohmann::json keyframes = nlohmann::json::parse(json.out)["keyframes"];
  EXPECT_EQ(keyframes["count"], 2);
  EXPECT_EQ(keyframes["met"], 1);
  EXPECT_NEAR(keyframes["largest_miss_m"].get<double>(), 0.5, 1e-12);
  EXPECT_EQ(keyframes["missed"][0]["keyframe"], 1);
}

// A slowed path meets the keyframes at its own times, not at those of the request.
TEST_F(CliCheck, TakesTheTimesOfASlowedPath) {
  auto request = nlohmann::json::parse(
      request_json({keyframe_json(1, 0, 1), keyframe_json(1.5, 0, 0), keyframe_json(1, 0, -1)}));
  double time_s = 1.76e9;
  for (nlohmann::json& keyframe : request["keyframes"]) keyframe["time"] = time_s++;
  request["options"]["limits"] = {{"speed_m_per_s", 0.25}, {"retime", true}};
  request_ = folder_.write("slowed.json", request.dump());
  const std::string response = folder_.file("slowed-response.json");
  ASSERT_EQ(run_camway({"plan", "--scene", scene_, "--request", request_, "--response", response})
                .exit_code,
            0);
  EXPECT_THAT(check(response).out, HasSubstr("\nkeyframes met: 3 of 3, largest miss "));
}

TEST_F(CliCheck, DoesNotGuessWhenKeyframesAreToBeMet) {
  auto response = nlohmann::json::parse(read_all(planned("free", 1)));
  for (const bool reversed : {false, true}) {
    if (reversed) {
      std::swap(response["keyframes"][0]["time"], response["keyframes"][1]["time"]);
    } else {
      response.erase("keyframes");
    }
    const CliRun run = check(folder_.write("untimed.json", response.dump()));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("keyframes met: not known"));
    response = nlohmann::json::parse(read_all(planned("free", 1)));
  }
}

TEST_F(CliCheck, AcceptsABarePathWithRemarks) {
  request_ = folder_.write("request.json",
                           request_json({keyframe_json(1, 0, 1), keyframe_json(1, 0, -1)}));
  nlohmann::json segment = segment_json(0, 1, 1, -1);
  for (nlohmann::json& point : segment["position"]) point[0] = 1;
  segment["_id"] = 7;
  segment["comment"] = "the only one";
  nlohmann::json path{{"segments", {segment}}, {"fps", 25}, {"status", 200}, {"comment", "mine"}};
  const CliRun run = check(folder_.write("path.json", path.dump()));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err, "");
  EXPECT_THAT(run.out, HasSubstr("keyframes met: not known"));
  // Keyframes with nothing but a time.
  path["keyframes"] = {{{"time", 0}}, {{"time", 1}}};
  EXPECT_THAT(check(folder_.write("path.json", path.dump())).out,
              HasSubstr("keyframes met: 2 of 2"));
  // Fields that could change the path are not ignored.
  path["segments"][0]["weights"] = {1, 2, 2, 1};
  const CliRun refused = check(folder_.write("path.json", path.dump()));
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("path.json: segments[0].weights: is unknown"));
}

TEST_F(CliCheck, WarnsOfAResponseForAnotherScene) {
  const std::string response = planned("free", 1);
  const auto json_of = [&] {
    const CliRun run = run_camway(
        {"check", "--scene", scene_, "--request", request_, "--response", response, "--json"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return nlohmann::json::parse(run.out);
  };
  EXPECT_EQ(check(response).err, "");
  EXPECT_EQ(json_of()["same_scene"], true);
  scene_ = folder_.write("other.obj", wall_obj() + "v 8 8 8\nv 9 8 8\nv 8 9 8\nf -3 -2 -1\n");
  const CliRun run = check(response);
  EXPECT_EQ(run.exit_code, 0) << "the scene that was given decides";
  EXPECT_THAT(run.err, HasSubstr("warning: " + response + ": was made for another scene: "));
  EXPECT_THAT(run.err, HasSubstr("that of " + scene_ + " is "));
  const nlohmann::json json = json_of();
  EXPECT_EQ(json["same_scene"], false);
  EXPECT_THAT(json["warnings"][0].get<std::string>(), HasSubstr("another scene"));
  const auto made_for = nlohmann::json::parse(read_all(response))["scene_digest"];
  EXPECT_NE(json["scene_digest"], made_for);
  EXPECT_THAT(run.err, HasSubstr(made_for.get<std::string>()));
}

TEST_F(CliCheck, DoesNotMeetAKeyframeAtATimeThatThePathDoesNotHave) {
  const std::string file = planned("free", 1);
  // The path stands still after its end, where keyframe 1 is.
  auto request = nlohmann::json::parse(read_all(request_));
  const auto response = nlohmann::json::parse(read_all(file));
  const double end_s = response["keyframes"][1]["time"];
  request["keyframes"][0]["time"] = response["keyframes"][0]["time"];
  request["keyframes"][1]["time"] = end_s + 1.0;
  request_ = folder_.write("later.json", request.dump());
  const CliRun run = check(file);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("keyframes met: 1 of 2, largest miss 0 m, 1 outside the path's "
                                 "time\nkeyframe 1 (at "));
  EXPECT_THAT(run.out, HasSubstr(") is missed: the path is from 0.000000 to "));
  const CliRun json =
      run_camway({"check", "--scene", scene_, "--request", request_, "--response", file, "--json"});
  const nlohmann::json keyframes = nlohmann::json::parse(json.out)["keyframes"];
  EXPECT_EQ(keyframes["met"], 1);
  EXPECT_EQ(keyframes["outside"], 1);
  EXPECT_EQ(keyframes["missed"][0]["keyframe"], 1);
  EXPECT_TRUE(keyframes["missed"][0]["miss_m"].is_null());
  // Ten digits of the time are enough.
  request["keyframes"][1]["time"] = end_s * (1 + 1e-10);
  request_ = folder_.write("later.json", request.dump());
  EXPECT_THAT(check(file).out, HasSubstr("keyframes met: 2 of 2"));
}

TEST_F(CliCheck, GivesAVerdictWhenTimeRanOut) {
  const std::string response = planned("free", 1);
  auto request = nlohmann::json::parse(read_all(request_));
  request["options"] = {{"deadline_s", 1e-9}};
  request_ = folder_.write("hurried.json", request.dump());
  const CliRun json = run_camway(
      {"check", "--scene", scene_, "--request", request_, "--response", response, "--json"});
  EXPECT_EQ(json.exit_code, 3);
  EXPECT_THAT(
      json.err,
      HasSubstr(response +
                ": the deadline of 1e-09 s was reached before the whole path was searched"));
  const nlohmann::json found = nlohmann::json::parse(json.out);
  EXPECT_EQ(found["verdict"], "timeout");
  EXPECT_EQ(found["certified"], false);
  EXPECT_EQ(found["searched_until"], 0.0);
  EXPECT_EQ(found["keyframes"]["met"], 2);
  const CliRun text = check(response);
  EXPECT_EQ(text.exit_code, 3);
  EXPECT_THAT(text.out, StartsWith("time ran out: nothing is known from 0.000000 to "));
}

TEST_F(CliCheck, SaysOnceWhereOnTheBodyAContactIs) {
  // Only the end of a thin rod is in the quadrilateral, and no edge of it is touched.
  const std::string response = planned("free", 1);
  scene_ = folder_.write("rod.obj", "o rod\nv 1 0 -9\nv 1.001 0 -9\nv 1 0 0\nf 1 2 3\n");
  const CliRun run = check(response);
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_THAT(run.out, HasSubstr("with rod (triangle 0) inside the near quadrilateral, "));
}

TEST_F(CliCheck, TakesTheSceneOfTheRequest) {
  const std::string response = planned("free", 1);
  const CliRun run = run_camway({"check", "--request", request_, "--response", response});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.out, check(response).out);
  // With the request's scale the scene is ten times as large, and the wall is in the way.
  std::string text = read_all(request_);
  text.replace(text.find("\"camera\""), 0, R"("scale": 10, )");
  const std::string larger = folder_.write("larger.json", text);
  const CliRun other = run_camway({"check", "--request", larger, "--response", response});
  EXPECT_EQ(other.exit_code, 3) << other.err;
  EXPECT_THAT(other.err, HasSubstr("was made for another scene"));
  const std::string nowhere = folder_.write(
      "nowhere.json", request_json({keyframe_json(1, 0, 1), keyframe_json(1, 0, -1)}, ""));
  const CliRun none = run_camway({"check", "--request", nowhere, "--response", response});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.err, HasSubstr("nowhere.json: scene: is missing, and there is no --scene"));
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
