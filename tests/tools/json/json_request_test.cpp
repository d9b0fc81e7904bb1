// SPDX-License-Identifier: MIT
#include "tools/json/json_request.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "daemon/planning/request/validate.h"
#include "tests/support/random.h"

namespace camway::tools {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kGoodRequest = R"({
  "scene": "office.obj", "comment": "remarks may stand anywhere",
  "camera": {"fov_x_deg": 90, "fov_y_deg": 60, "near": 0.1},
  "keyframes": [
    {"time": 1.5, "position": [1, 2, 3], "orientation": [1, 0, 0, 0]},
    {"time": 2.5, "position": [4, 5, 6.25], "orientation": [0, 3, 0, 4], "_name": "door"}],
  "options": {"method": "keyframe_insertion", "deadline_s": 2.5, "clearance_m": 0.25, "chord_error_m": 0.01,
              "interval_tolerance_m": 0.001, "max_inserted_keyframes": 7}})";

/// Returns the valid request with `from` replaced by `to`.
std::string edited(const std::string& from, const std::string& to) {
  std::string text = kGoodRequest;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(JsonRequest, WritesWhatItReads) {
  for (const char* options :
       {R"({})", R"({"method": "keyframe_insertion", "objective": "safest", "seed": 7})",
        R"({"orientation": {"policy": "level", "up": [0, 0, 1], "max_turn_deg": 20.5}})",
        R"({"orientation": {"policy": "target", "target": [1, 2, 3], "cone_deg": 12.25}})",
        R"({"limits": {"speed_m_per_s": 2, "turn_rate_deg_per_s": 33, "retime": true}})",
        R"({"bounds": {"min": [null, -1, null], "max": [10, null, 3]}, "clearance_m": 0.02})"}) {
    for (const char* body : {R"({"type": "box", "size": [1, 2, 3], "center": [0, 0.5, 0]})",
                             R"({"type": "convex", "points": [[0, 0, 0], [1, 0, 0.1]]})",
                             R"({"type": "mesh", "solid": true, "triangles": [[0, 1, 2]],
                                 "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]]})",
                             R"({"type": "camera"})"}) {
      const std::string text = edited(
          R"("options": {"method": "keyframe_insertion", "deadline_s": 2.5, "clearance_m": 0.25, "chord_error_m": 0.01,
              "interval_tolerance_m": 0.001, "max_inserted_keyframes": 7})",
          std::string(R"("body": )") + body + R"(, "options": )" + options);
      const auto read = parse_as<RequestFile>(text, "R.json");
      ASSERT_TRUE(read) << read.error;
      const auto written = write_plan_request(*read);
      ASSERT_TRUE(written) << written.error;
      const auto again = parse_as<RequestFile>(*written, "again");
      ASSERT_TRUE(again) << again.error << *written;
      EXPECT_EQ(again->options, read->options) << *written;
      EXPECT_EQ(*write_plan_request(*again), *written);
      EXPECT_EQ(again->keyframes.back().time_s, read->keyframes.back().time_s);
    }
  }
  const auto read = parse_as<RequestFile>(kGoodRequest, "R.json");
  planning::PlanRequest endless = *read;
  endless.options.deadline_s = std::numeric_limits<double>::infinity();
  EXPECT_THAT(write_plan_request(endless).error, HasSubstr("options.deadline_s: is not finite"));
}

TEST(JsonRequest, ReadsEveryField) {
  const auto parsed = parse_as<RequestFile>(kGoodRequest, "R.json");
  ASSERT_TRUE(parsed.value) << parsed.error;
  const planning::PlanRequest& request = *parsed.value;
  EXPECT_EQ(request.scene, "office.obj");
  EXPECT_DOUBLE_EQ(request.camera.fov_x_rad, std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ(request.camera.fov_y_rad, std::numbers::pi / 3);
  EXPECT_EQ(request.camera.near_m, 0.1);
  ASSERT_EQ(request.keyframes.size(), 2U);
  EXPECT_TRUE(request.has_times);
  EXPECT_EQ(request.keyframes[1].time_s, 2.5);
  EXPECT_EQ(request.keyframes[1].pose.position, geometry::Vec3(4, 5, 6.25));
  EXPECT_NEAR(
      (geometry::wxyz(request.keyframes[1].pose.orientation) - geometry::Vec4(0, 0.6, 0, 0.8))
          .norm(),
      0.0, planning::kUnitLengthError);
  EXPECT_EQ(request.options.deadline_s, 2.5);
  EXPECT_EQ(request.options.clearance_m, 0.25);
  EXPECT_FALSE(request.body);
  EXPECT_EQ(request.options.chord_error_m, 0.01);
  EXPECT_EQ(request.options.interval_tolerance_m, 0.001);
  EXPECT_EQ(request.options.max_inserted_keyframes, 7);
  EXPECT_FALSE(planning::validate(request));
}

TEST(JsonRequest, HasDefaultsForAllThatMayBeMissing) {
  const auto parsed = parse_as<RequestFile>(
      R"({"camera": {"fov_x_deg": 90, "fov_y_deg": 60, "near": 0.1},
          "keyframes": [{"position": [0, 0, 0], "orientation": [1, 0, 0, 0]},
                        {"position": [0, 0, 1], "orientation": [1, 0, 0, 0]}]})",
      "R.json");
  ASSERT_TRUE(parsed.value) << parsed.error;
  EXPECT_EQ(parsed.value->scene, "");
  EXPECT_FALSE(parsed.value->has_times);
  EXPECT_EQ(parsed.value->options, planning::PlanOptions{});
}

TEST(JsonRequest, NamesTheFieldAtFault) {
  const struct {
    const char* from;
    const char* to;
    const char* expected;
  } cases[] = {
      {R"("camera": {)", R"("_camera": {)", "camera: is missing"},
      {R"("near": 0.1)", R"("_near": 0.1)", "camera.near: is missing"},
      {R"("camera": {)", R"("kamera": {)",
       "kamera: is unknown; a request has scene, scale, up, unknown, voxel_m, camera, body, "
       "keyframes, "
       "frame, options, and for remarks comment or _..."},
      {R"("near": 0.1)", R"("near": 0.1, "far": 9)",
       "camera.far: is unknown; camera has fov_x_deg, fov_y_deg, near"},
      {R"("_name": "door")", R"("name": "door")",
       "keyframes[1].name: is unknown; keyframes[1] has time, position, orientation, "
       "orientation_xyzw, origin, repaired, image"},
      {R"("fov_x_deg": 90)", R"("fov_x_deg": "90")",
       "camera.fov_x_deg: must be a number, not a string"},
      {R"("keyframes": [)", R"("keyframes": 5, "_old": [)",
       "keyframes: must be an array, not a number"},
      {"[4, 5, 6.25]", "[4, 5]",
       "keyframes[1].position: must be an array of 3 numbers, not an array of 2"},
      {"[4, 5, 6.25]", "[4, null, 6]", "keyframes[1].position[1]: must be a number, not null"},
      {"[4, 5, 6.25]", "{}", "keyframes[1].position: must be an array of 3 numbers, not an object"},
      {"[0, 3, 0, 4]", "[0, 0, 0, 0]", "keyframes[1].orientation: has length zero"},
      {"[0, 3, 0, 4]", "[0, -0.0, 0, 0e5]", "keyframes[1].orientation: has length zero"},
      {"[0, 3, 0, 4]", "[0, 3, 0, 4, 5]", "keyframes[1].orientation: must be an array of 4"},
      {R"("orientation": [0, 3, 0, 4])",
       R"("orientation": [0, 3, 0, 4], "orientation_xyzw": [3, 0, 4, 0])",
       "keyframes[1]: has both orientation and orientation_xyzw"},
      {R"("orientation": [0, 3, 0, 4])", R"("orientation_xyzw": [0, 0, 0, 0])",
       "keyframes[1].orientation_xyzw: has length zero"},
      {R"("orientation": [0, 3, 0, 4])", R"("_orientation": [0, 3, 0, 4])",
       "keyframes[1].orientation: is missing"},
      {R"("scene": "office.obj")", R"("scale": 0)", "scale: is 0; it must be above 0"},
      {R"("scene": "office.obj")", R"("scale": -2.5)", "scale: is -2.5; it must be above 0"},
      {R"("scene": "office.obj")", R"("scale": "inch")", "scale: must be a number"},
      {R"("scene": "office.obj")", R"("up": "zup")",
       "up: 'zup' is unknown; there are as-in-file, z-to-y, y-to-z"},
      {R"("scene": "office.obj")", R"("unknown": true)", "unknown: must be a string"},
      {R"("time": 2.5, )", "", "keyframes[1]: has no time and keyframe 0 has one"},
      {R"("time": 1.5, )", "", "keyframes[1]: has a time and keyframe 0 has none"},
      {R"("time": 2.5)", R"("time": null)", "keyframes[1].time: must be a number, not null"},
      {R"("method": "keyframe_insertion")", R"("method": "magic")",
       "options.method: 'magic' is unknown; there are ladder, keyframe_insertion"},
      {R"("deadline_s": 2.5)", R"("dead_line_s": 2.5)",
       "options.dead_line_s: is unknown; options has method, deadline_s, clearance_m, "
       "chord_error_m"},
      {R"("clearance_m": 0.25)", R"("clearance_m": "wide")",
       "options.clearance_m: must be a number, not a string"},
      {R"("max_inserted_keyframes": 7)", R"("max_inserted_keyframes": 7.5)",
       "options.max_inserted_keyframes: is 7.5; it must be a whole number from 0 to 2147483647, "
       "without a decimal point or exponent"},
      {R"("max_inserted_keyframes": 7)", R"("max_inserted_keyframes": -1)",
       "options.max_inserted_keyframes: is -1; it must be a whole number from 0 to 2147483647"},
      {R"("max_inserted_keyframes": 7)", R"("max_inserted_keyframes": 2147483648)",
       "options.max_inserted_keyframes: is 2147483648; it must be a whole number from 0"},
      {R"("max_inserted_keyframes": 7)", R"("max_inserted_keyframes": "3")",
       "options.max_inserted_keyframes: must be a whole number from 0 to 2147483647, not a string"},
      {R"("clearance_m": 0.25)", R"("seed": 1e30)",
       "options.seed: is 1e+30; it must be a whole number from 1 to 9223372036854775807, without"},
      {R"("clearance_m": 0.25)", R"("seed": 0)", "options.seed: is 0; it must be a whole number"},
      {R"("clearance_m": 0.25)", R"("seed": 18446744073709551615)",
       "options.seed: is 18446744073709551615; it must be a whole number from 1"},
      {R"("clearance_m": 0.25)", R"("seed": null)",
       "options.seed: must be a whole number from 1 to 9223372036854775807, not null"},
      {R"("scene": "office.obj")", R"("scene": 3)", "scene: must be a string, not a number"},
      {R"("options": {)", R"("options": [{}], "_more": {)", "options: must be an object"},
  };
  for (const auto& c : cases) {
    const auto parsed = parse_as<RequestFile>(edited(c.from, c.to), "dir/R.json");
    EXPECT_FALSE(parsed.value) << c.to;
    EXPECT_THAT(parsed.error, StartsWith(std::string("dir/R.json: ") + c.expected));
  }
  EXPECT_THAT(parse_as<RequestFile>("[]", "R.json").error,
              HasSubstr("R.json: must be an object, not an array"));
}

constexpr const char* kFrame =
    R"("frame": {"reference": [1, 2, 3, 4],
                 "begin": {"velocity_m_per_s": [5, 6, 7], "image_rate_per_s": [8, 9, 10, 11]},
                 "end": {"velocity_m_per_s": [12, 13, 14], "image_rate_per_s": [15, 16, 17, 18]}},
       "scene": "office.obj")";

TEST(JsonRequest, ReadsKeyframesAndFrameOfAnAnswer) {
  std::string text = edited(R"("scene": "office.obj")", kFrame);
  const std::string copied = R"("origin": "inserted", "repaired": true, "image": [0, 1, 0, 2])";
  text.replace(text.find(R"("_name": "door")"), 15, copied);
  const auto parsed = parse_as<RequestFile>(text, "R.json");
  ASSERT_TRUE(parsed.value) << parsed.error;
  EXPECT_EQ(parsed.value->keyframes[0].image, geometry::Vec4::Zero());
  EXPECT_EQ(parsed.value->keyframes[1].image, geometry::Vec4(0, 1, 0, 2));
  const motion::PathFrame frame{
      {1, 2, 3, 4}, {{5, 6, 7}, {8, 9, 10, 11}}, {{12, 13, 14}, {15, 16, 17, 18}}};
  EXPECT_EQ(parsed.value->frame, frame);
}

TEST(JsonRequest, NamesTheFieldOfAFrameAtFault) {
  const std::pair<const char*, const char*> kFaults[] = {
      {R"("reference": [1, 2, 3, 4],)", "frame.reference: is missing"},
      {R"(,
                 "end": {"velocity_m_per_s": [12, 13, 14], "image_rate_per_s": [15, 16, 17, 18]})",
       "frame.end: is missing"},
      {"13, ", "frame.end.velocity_m_per_s: must be an array of 3 numbers"},
      {R"("velocity_m_per_s": [5, 6, 7], )", "frame.begin.velocity_m_per_s: is missing"},
  };
  for (const auto& [gone, message] : kFaults) {
    std::string frame = kFrame;
    frame.erase(frame.find(gone), std::string(gone).size());
    const auto parsed = parse_as<RequestFile>(edited(R"("scene": "office.obj")", frame), "R.json");
    EXPECT_THAT(parsed.error, HasSubstr(message));
    EXPECT_FALSE(parsed.value) << gone;
  }
  std::string more = kFrame;
  more.replace(more.find("reference"), 0, R"(far": 1, ")");
  EXPECT_THAT(parse_as<RequestFile>(edited(R"("scene": "office.obj")", more), "R.json").error,
              HasSubstr("frame.far: is unknown; frame has reference, begin, end"));
}

TEST(JsonRequest, LeavesRangesToValidationWhoseMessagesNameTheField) {
  const auto fault_of = [](const std::string& text) {
    const auto parsed = parse_as<RequestFile>(text, "R.json");
    EXPECT_TRUE(parsed.value) << parsed.error;
    if (!parsed.value) return std::string();
    const auto fault = planning::validate(*parsed.value);
    return fault ? fault->message : std::string();
  };
  EXPECT_THAT(fault_of(edited(R"("time": 2.5)", R"("time": 1.5)")), HasSubstr("keyframes[1].time"));
  EXPECT_THAT(fault_of(edited(R"("near": 0.1)", R"("near": -0.1)")), HasSubstr("camera.near"));
  EXPECT_THAT(fault_of(edited(R"("fov_x_deg": 90)", R"("fov_x_deg": 180)")),
              StartsWith("camera.fov_x_deg: "));
  EXPECT_THAT(fault_of(edited(R"("deadline_s": 2.5)", R"("deadline_s": 0)")),
              HasSubstr("options.deadline_s"));
}

// Every field that validation names is in the request with that name.
TEST(JsonRequest, ValidationNamesFieldsAsTheFileDoes) {
  const std::pair<const char*, const char*> kFaults[] = {
      {R"("fov_y_deg": 60)", R"("fov_y_deg": 0)"},
      {R"("near": 0.1)", R"("near": 1e300)"},
      {R"("time": 2.5)", R"("time": 1)"},
      {"[4, 5, 6.25]", "[4, 5, 6e25]"},
      {R"("clearance_m": 0.25)", R"("clearance_m": -1)"},
      {R"("clearance_m": 0.25)", R"("clearance": -1)"},
      {R"("clearance_m": 0.25)", R"("default_speed_m_per_s": 0)"},
      {R"("clearance_m": 0.25)", R"("default_speed_m_per_s": 1)"},
      {R"("clearance_m": 0.25)", R"("max_shrink": 2)"},
      {R"("clearance_m": 0.25)", R"("limits": {"speed_m_per_s": -1})"},
      {R"("clearance_m": 0.25)", R"("limits": {"speed": -1})"},
      {R"("clearance_m": 0.25)", R"("limits": {"acceleration_m_per_s2": -1})"},
      {R"("clearance_m": 0.25)", R"("limits": {"acceleration": -1})"},
      {R"("clearance_m": 0.25)", R"("limits": {"turn_rate_deg_per_s": -1})"},
      {R"("clearance_m": 0.25)", R"("limits": {"turn_rate_deg": -1})"},
      {R"("clearance_m": 0.25)", R"("orientation": {"max_turn_deg": -1})"},
      {R"("clearance_m": 0.25)", R"("orientation": {"policy": "level", "up": [0, 0, 0]})"},
      {R"("clearance_m": 0.25)",
       R"("orientation": {"policy": "target", "target": [0, 0, 1], "cone_deg": 0})"},
      {R"("clearance_m": 0.25)", R"("orientation": {"policy": "target", "target": [0, 0, 1e20]})"},
      {R"("camera": {)", R"("body": {"type": "sphere", "radius_m": -1}, "camera": {)"},
      {R"("camera": {)", R"("body": {"type": "sphere", "radius": -1}, "camera": {)"},
      {R"("camera": {)", R"("body": {"type": "box", "size": [1, 1e20, 1]}, "camera": {)"},
  };
  for (const auto& [from, to] : kFaults) {
    const std::string text = edited(from, to);
    const auto parsed = parse_as<RequestFile>(text, "R.json");
    ASSERT_TRUE(parsed.value) << parsed.error;
    const auto fault = planning::validate(*parsed.value);
    ASSERT_TRUE(fault) << to;
    std::string pointer = "/" + fault->message.substr(0, fault->message.find(": "));
    std::ranges::replace(pointer, '.', '/');
    std::ranges::replace(pointer, '[', '/');
    std::erase(pointer, ']');
    EXPECT_TRUE(nlohmann::json::parse(text).contains(nlohmann::json::json_pointer(pointer)))
        << fault->message;
  }
}

TEST(JsonRequest, QuaternionsMayBeWrittenXyzw) {
  const auto wxyz = parse_as<RequestFile>(kGoodRequest, "R.json");
  const auto xyzw = parse_as<RequestFile>(
      edited(R"("orientation": [0, 3, 0, 4])", R"("orientation_xyzw": [3, 0, 4, 0])"), "R.json");
  ASSERT_TRUE(xyzw.value) << xyzw.error;
  EXPECT_EQ(xyzw.value->keyframes[1].pose.orientation.coeffs(),
            wxyz.value->keyframes[1].pose.orientation.coeffs());
  EXPECT_TRUE(xyzw.value->says_xyzw);
  EXPECT_FALSE(wxyz.value->says_xyzw);
}

TEST(JsonRequest, SaysHowToReadTheScene) {
  const auto said = parse_as<RequestFile>(
      edited(R"("scene": "office.obj")",
             R"("scene": "office.obj", "scale": 0.0254, "up": "z-to-y", "unknown": "occupied",
              "voxel_m": 0.02)"),
      "R.json");
  ASSERT_TRUE(said.value) << said.error;
  EXPECT_EQ(said.value->reading.scale, 0.0254);
  EXPECT_EQ(said.value->reading.up, scene::UpAxis::kZToY);
  EXPECT_EQ(said.value->reading.unknown, scene::UnknownSpace::kOccupied);
  EXPECT_EQ(said.value->reading.voxel_m, 0.02);
  const auto tiny = parse_as<RequestFile>(
      edited(R"("scene": "office.obj")", R"("scene": "office.obj", "voxel_m": 1e-10)"), "R.json");
  EXPECT_THAT(tiny.error,
              ::testing::HasSubstr("voxel_m: is 1e-10; it must be from 1e-09 to 1e+09"));
  const auto silent = parse_as<RequestFile>(kGoodRequest, "R.json");
  EXPECT_FALSE(silent.value->reading.scale || silent.value->reading.up ||
               silent.value->reading.unknown || silent.value->reading.voxel_m);
}

TEST(JsonRequest, NormalisesQuaternionsOfAnyLengthAndKeepsTheBitsOfUnitOnes) {
  testing::Random random(20260801);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> exponent(-300, 300);
  for (int i = 0; i < 2000; ++i) {
    const geometry::Vec4 unit =
        geometry::Vec4(normal(random), normal(random), normal(random), normal(random)).normalized();
    const double length = i % 2 == 0 ? 1.0 : std::pow(10.0, exponent(random));
    const geometry::Vec4 q = unit * length;
    const auto parsed = parse_as<RequestFile>(
        edited("[0, 3, 0, 4]", fmt::format("[{}, {}, {}, {}]", q[0], q[1], q[2], q[3])), "R.json");
    ASSERT_TRUE(parsed.value) << parsed.error;
    const geometry::Vec4 read = geometry::wxyz(parsed.value->keyframes[1].pose.orientation);
    // Each coefficient: one rounding of `unit * length`, two divisions, the length's own error.
    EXPECT_LE((read - unit).cwiseAbs().maxCoeff(), 8 * std::numeric_limits<double>::epsilon());
    if (length == 1.0) {
      EXPECT_EQ(read, q);
    }
  }
}

}  // namespace
}  // namespace camway::tools
