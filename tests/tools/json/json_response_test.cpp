// SPDX-License-Identifier: MIT
#include "tools/json/json_response.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <utility>

#include "daemon/collision/obstacles.h"
#include "daemon/messages/plan.h"
#include "tests/support/random.h"
#include "tools/camway/replay/compare/difference.h"
#include "tools/json/json_angle.h"

namespace camway::tools {
namespace {

using ::testing::HasSubstr;

/// Returns any finite double, with every exponent equally likely.
double any_double(testing::Random& random) {
  for (;;) {
    const double value = std::bit_cast<double>(random());
    if (std::isfinite(value)) return value;
  }
}

/// Returns an angle that reads back as the same bits from degrees.
double any_angle(testing::Random& random) {
  return radians(std::uniform_real_distribution<double>(0, 180)(random));
}

motion::PathMeasures any_measures(testing::Random& random) {
  const auto number = [&] { return any_double(random); };
  const auto angle = [&] { return any_angle(random); };
  return {.length_m = number(),
          .largest_deviation_m = number(),
          .largest_shift_rad = angle(),
          .mean_shift_rad = angle(),
          .bending_energy_m2_per_s3 = number(),
          .largest_speed_m_per_s = number(),
          .largest_acceleration_m_per_s2 = number(),
          .largest_turn_rate_rad_per_s = angle(),
          .largest_turn_acceleration_rad_per_s2 = angle(),
          .clearance_lower_bound_m = number()};
}

/// Adds a random subset of the fields about correction.
void add_any_report(planning::PlanResult& result, testing::Random& random) {
  const auto number = [&] { return any_double(random); };
  result.corrections.resize(random() % 4);
  for (correction::Correction& correction : result.corrections) {
    correction.interval = {number(), number()};
    correction.kind = static_cast<correction::CorrectionKind>(random() % 5);
    correction.t_begin_s = number();
    correction.t_end_s = number();
    correction.moved_m = number();
    correction.turned_rad = any_angle(random);
    correction.shift = {any_angle(random), any_angle(random)};
    const auto count = [&] { return static_cast<std::int32_t>(random() >> 33); };
    if (correction.kind == correction::CorrectionKind::kNone) {
      correction.tried = {count(), count(), count(), count()};
    }
  }
  if (random() % 2 == 0) {
    const auto end = [&]() -> motion::PathEnd {
      return {{number(), number(), number()}, {number(), number(), number(), number()}};
    };
    result.frame = {{number(), number(), number(), number()}, end(), end()};
  }
  if (random() % 2 == 0) result.measures_before = any_measures(random);
  if (random() % 2 == 0) result.measures = any_measures(random);
  if (random() % 2 == 0) result.viewing_distance_m = number();
  if (random() % 2 == 0) result.near_scale = number();
  if (random() % 2 == 0) result.time_scale = number();
  result.slowed.resize(random() % 3);
  for (planning::SlowedStretch& stretch : result.slowed)
    stretch = {number(), number(), number(), number()};
  result.clearance_profile.resize(random() % 3);
  for (collision::ClearanceStretch& stretch : result.clearance_profile)
    stretch = {number(), number(), number()};
  result.keyframe_faults.resize(random() % 3);
  for (planning::KeyframeFault& fault : result.keyframe_faults) {
    fault.keyframe = random() % 1000;
    fault.depth_m = number();
    if (random() % 2 == 0) continue;
    motion::Pose& pose = fault.free_pose.emplace();
    pose.position = {number(), number(), number()};
    pose.orientation = geometry::from_wxyz({number(), number(), number(), number()});
  }
  if (random() % 2 == 0) return;
  planning::Infeasibility& proof = result.infeasibility.emplace();
  proof.keyframe_inside = random() % 1000;
  proof.keyframe_outside = random() % 1000;
  proof.triangles.resize(random() % 20);
  for (std::uint32_t& triangle : proof.triangles) triangle = static_cast<std::uint32_t>(random());
}

planning::PlanResult any_result(testing::Random& random) {
  const auto number = [&] { return any_double(random); };
  planning::PlanResult result;
  result.status = static_cast<planning::Status>(random() % 7);
  result.message = "quotes \" and \\ and \n, \xc3\xa9";
  if (random() % 2 == 0) result.keyframe = random() % 1000;
  std::vector<motion::Segment> segments(random() % 5);
  double time_s = -5.0;
  for (motion::Segment& segment : segments) {
    segment.t0_s = time_s;
    segment.t1_s = time_s += std::ldexp(1.0 + static_cast<double>(random() % 1000), -7);
    for (geometry::Vec3& p : segment.position) p = {number(), number(), number()};
    for (geometry::Vec4& q : segment.orientation) q = {number(), number(), number(), number()};
  }
  result.path = motion::Path(std::move(segments));
  result.keyframes.resize(random() % 5);
  for (motion::Keyframe& keyframe : result.keyframes) {
    keyframe.time_s = number();
    keyframe.pose.position = {number(), number(), number()};
    keyframe.pose.orientation = geometry::from_wxyz({number(), number(), number(), number()});
    keyframe.origin = static_cast<motion::KeyframeOrigin>(random() % 2);
    keyframe.is_repaired = random() % 2 == 0;
    if (random() % 2 == 0) keyframe.image = {number(), number(), number(), number()};
  }
  for (auto* list : {&result.collisions, &result.remaining_collisions}) {
    list->resize(random() % 4);
    for (collision::CollisionInterval& interval : *list) {
      interval = {number(), number()};
      if (random() % 2 == 0) continue;
      interval.witness = {.time_s = number(),
                          .triangle = static_cast<std::uint32_t>(random()),
                          .depth_m = number(),
                          .point_W = {number(), number(), number()}};
    }
  }
  for (const auto& interval : result.collisions) {
    result.collision_names.emplace_back();
    if (interval.witness) result.collision_names.back() = {"a \"table\"", "edge 3"};
  }
  for (const auto& interval : result.remaining_collisions) {
    result.remaining_names.emplace_back();
    if (interval.witness) result.remaining_names.back() = {"", "face 11"};
  }
  result.certificate = {random() % 2 == 0, number()};
  result.timing = {number(), number(), number(), number(), number(), number()};
  add_any_report(result, random);
  return result;
}

TEST(JsonResponse, IsReadBackBitForBit) {
  testing::Random random(42);
  for (int i = 0; i < 2000; ++i) {
    const planning::PlanResult result = any_result(random);
    const auto text = write_plan_response(result);
    ASSERT_TRUE(text.value) << text.error;
    const auto read = parse_as<planning::PlanResult>(*text.value, "P.json");
    ASSERT_TRUE(read.value) << read.error;
    EXPECT_EQ(read.value->message, result.message);
    EXPECT_EQ(difference_of(messages::to_wire(result, {}), messages::to_wire(*read.value, {}),
                            {motion::Body(motion::Camera{}), 1.0})
                  .what(),
              "");
    EXPECT_EQ(std::bit_cast<std::uint64_t>(read.value->timing.certify_ms),
              std::bit_cast<std::uint64_t>(result.timing.certify_ms));
    EXPECT_EQ(write_plan_response(*read.value).value, text.value);
  }
}

TEST(JsonResponse, KeepsTheSignOfZeroAndTheEndsOfTheRange) {
  planning::PlanResult result;
  result.collisions = {
      {-0.0, 0.0},
      {std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::max()},
      {-std::numeric_limits<double>::max(), 9007199254740993.0}};
  const auto read = parse_as<planning::PlanResult>(*write_plan_response(result).value, "P.json");
  ASSERT_TRUE(read.value) << read.error;
  EXPECT_EQ(difference_of(messages::to_wire(result, {}), messages::to_wire(*read.value, {}),
                          {motion::Body(motion::Camera{}), 1.0})
                .what(),
            "");
  EXPECT_TRUE(std::signbit(read.value->collisions[0].t_begin_s));
}

TEST(JsonResponse, HasTheKeysOfTheFormatInAFixedOrder) {
  ResponseFormat format;
  format.scene = "office.obj";
  format.scene_digest = "00ff";
  const std::string text = *write_plan_response({}, format).value;
  std::size_t at = 0;
  for (const char* key :
       {"status", "message", "scene", "scene_digest", "segments", "keyframes", "collisions",
        "remaining_collisions", "certificate", "certified", "clearance_lower_bound", "corrections",
        "timing_ms", "load_scene", "motion", "detect", "correct", "certify", "total"}) {
    const std::size_t found = text.find('"' + std::string(key) + "\":");
    ASSERT_NE(found, std::string::npos) << key;
    EXPECT_GE(found, at) << key;
    at = found;
  }
  format.has_timing = false;
  EXPECT_EQ(write_plan_response({}, format).value->find("timing_ms"), std::string::npos);
}

/// A response says how its scene is to be read, and a response of an earlier release need not.
TEST(JsonResponse, ItsSceneReadsBack) {
  ResponseFormat format;
  format.scene_digest = "00ff";
  format.scene_reading = scene::ImportOptions{.scale = 0.0254,
                                              .up = scene::UpAxis::kZToY,
                                              .unknown = scene::UnknownSpace::kOccupied,
                                              .voxel_m = 0.1};
  format.vertical_axis = scene::VerticalAxis::kZ;
  const auto read = parse_as<ResponseFile>(*write_plan_response({}, format).value, "P.json");
  ASSERT_TRUE(read.value) << read.error;
  EXPECT_EQ(read->scene_digest, "00ff");
  EXPECT_EQ(read->scene_reading.scale, 0.0254);
  EXPECT_EQ(read->scene_reading.up, scene::UpAxis::kZToY);
  EXPECT_EQ(read->scene_reading.unknown, scene::UnknownSpace::kOccupied);
  EXPECT_EQ(read->scene_reading.voxel_m, 0.1);
  EXPECT_EQ(read->vertical_axis, scene::VerticalAxis::kZ);
  const auto old = parse_as<ResponseFile>(*write_plan_response({}).value, "P.json");
  ASSERT_TRUE(old.value) << old.error;
  EXPECT_FALSE(old->scene_reading.scale || old->scene_reading.up || old->vertical_axis);
  const auto wrong = parse_as<ResponseFile>(R"({"status": "ok", "vertical_axis": "x"})", "P.json");
  EXPECT_THAT(wrong.error, HasSubstr("vertical_axis"));
}

TEST(JsonResponse, RefusesToWriteWhatJsonCannotHold) {
  planning::PlanResult result;
  result.keyframes.resize(1);
  result.keyframes[0].pose.position.y() = std::numeric_limits<double>::quiet_NaN();
  const auto text = write_plan_response(result);
  EXPECT_FALSE(text.value);
  EXPECT_EQ(text.error, "keyframes[].position: is not finite");
}

TEST(JsonResponse, NamesTheFieldAtFaultWhenRead) {
  testing::Random random(7);
  planning::PlanResult result = any_result(random);
  while (result.path.segments().size() < 2 || result.keyframes.empty()) result = any_result(random);
  result.keyframes[0].origin = motion::KeyframeOrigin::kGiven;
  const std::string good = *write_plan_response(result).value;
  const auto error_of = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    return parse_as<planning::PlanResult>(text, "P.json").error;
  };
  EXPECT_THAT(error_of("\"status\": \"", "\"status\": \"not_"), HasSubstr("P.json: status: 'not_"));
  EXPECT_THAT(error_of("\"t0\": -5.0", "\"t0\": 1e9"),
              HasSubstr("segments[0].t1: must be above t0"));
  EXPECT_THAT(error_of("\"orientation\": [[", "\"orientation\": [[], ["),
              HasSubstr("segments[0].orientation: must be an array of 7, not of 8"));
  EXPECT_THAT(error_of("\"origin\": \"", "\"origin\": \"re"),
              HasSubstr("keyframes[0].origin: 'regiven' is unknown; there are given, inserted"));
}

TEST(JsonResponse, RefusesSegmentsThatDoNotFollowEachOther) {
  planning::PlanResult result;
  std::vector<motion::Segment> segments(2);
  segments[0] = {0.0, 1.0, {}, {}};
  segments[1] = {1.0, 2.0, {}, {}};
  for (motion::Segment& segment : segments) {
    segment.position.fill(geometry::Vec3::Zero());
    segment.orientation.fill(geometry::Vec4::UnitX());
  }
  result.path = motion::Path(segments);
  std::string text = *write_plan_response(result).value;
  ASSERT_TRUE(parse_as<planning::PlanResult>(text, "P.json").value);
  text.replace(text.find("\"t0\": 1.0"), 9, "\"t0\": 1.1");
  EXPECT_THAT(parse_as<planning::PlanResult>(text, "P.json").error,
              HasSubstr("segments[1].t0: must equal t1 of the segment before"));
}

TEST(JsonResponse, WitnessesStandInTheirIntervals) {
  planning::PlanResult result;
  result.collisions = {{0.5, 1.5, collision::Witness{1.25, 12, 3, 0.0625, {1, -2, 0.5}}},
                       {2.5, 3.0}};
  result.collision_names = {{"table", "edge 2"}, {"", ""}};
  const std::string text = *write_plan_response(result).value;
  EXPECT_THAT(text, HasSubstr(R"("collisions": [
    {"t_begin": 0.5, "t_end": 1.5,
     "witness": {"time": 1.25, "object": "table", "triangle": 12, "feature": "edge 2", "depth_m": 0.0625, "point": [1.0, -2.0, 0.5]}},
    {"t_begin": 2.5, "t_end": 3.0}
  ],)"));
  const auto read = parse_as<planning::PlanResult>(text, "P.json");
  ASSERT_TRUE(read.value) << read.error;
  EXPECT_EQ(read.value->collision_names, result.collision_names);
  EXPECT_EQ(read.value->collisions[0].witness->triangle, 12U);
  EXPECT_FALSE(read.value->collisions[1].witness);
}

TEST(JsonResponse, SaysWhichBoundsThereWereAndWhereTheyWereLeft) {
  planning::PlanResult result;
  EXPECT_THAT(*write_plan_response(result).value, ::testing::Not(HasSubstr("bounds\"")));
  result.bounds.min_W.y() = -0.5;
  const std::uint32_t min_y = collision::Obstacles::number_of_side(1);
  result.collisions = {{0.5, 1.5, collision::Witness{1.25, min_y, 5, 0.0625, {1, -0.5, 0.5}}}};
  result.collision_names = {{"bounds.min.y", "corner 0"}};
  const std::string text = *write_plan_response(result).value;
  EXPECT_THAT(text,
              HasSubstr(R"("bounds": {"min": [null, -0.5, null], "max": [null, null, null]})"));
  EXPECT_THAT(text, HasSubstr(R"("object": "bounds.min.y", "triangle": -2, )"));
  const auto read = parse_as<planning::PlanResult>(text, "P.json");
  ASSERT_TRUE(read.value) << read.error;
  EXPECT_EQ(read.value->bounds, result.bounds);
  EXPECT_EQ(read.value->collisions[0].witness->triangle, min_y);
}

TEST(JsonResponse, SaysWhatCorrectionDid) {
  planning::PlanResult result;
  correction::Correction correction;
  correction.interval = {2.25, 2.75, collision::Witness{}};
  correction.kind = correction::CorrectionKind::kGoRound;
  correction.t_begin_s = 2.0;
  correction.t_end_s = 3.0;
  correction.moved_m = 0.125;
  correction.turned_rad = std::numbers::pi / 2;
  correction.shift = {std::numbers::pi, std::numbers::pi / 4};
  result.corrections = {correction};
  motion::PathMeasures measures;
  measures.length_m = 4.0;
  measures.largest_turn_rate_rad_per_s = std::numbers::pi;
  result.measures_before = measures;
  measures.length_m = 5.0;
  result.measures = measures;
  result.viewing_distance_m = 4.5;
  result.near_scale = 0.75;
  result.time_scale = 1.5;
  result.deadline_reached = true;
  result.slowed = {{2.0, 4.0, 1.5, 2.5}};
  const std::string text = *write_plan_response(result).value;
  EXPECT_THAT(text, HasSubstr(R"("corrections": [
    {"t_begin": 2.25, "t_end": 2.75, "kind": "go_round", "changed": [2.0, 3.0], "moved_m": 0.125, "turned_deg": 90.0, "largest_shift_deg": 180.0, "mean_shift_deg": 45.0}
  ],
  "measures": {
    "before": {"length_m": 4.0, "largest_deviation_m": 0.0, "largest_shift_deg": 0.0, "mean_shift_deg": 0.0, "bending_energy_m2_per_s3": 0.0, "largest_speed_m_per_s": 0.0, "largest_acceleration_m_per_s2": 0.0, "largest_turn_rate_deg_per_s": 180.0, "largest_turn_acceleration_deg_per_s2": 0.0, "clearance_lower_bound_m": 0.0},
    "after": {"length_m": 5.0,)"));
  EXPECT_THAT(text, HasSubstr(R"("viewing_distance_m": 4.5,
  "near_scale": 0.75,
  "time_scale": 1.5,
  "deadline_reached": true,
  "slowed": [
    {"t_begin": 2.0, "t_end": 4.0, "given": [1.5, 2.5]}
  ])"));
  const auto read = parse_as<planning::PlanResult>(text, "P.json");
  ASSERT_TRUE(read.value) << read.error;
  EXPECT_EQ(read.value->corrections[0].turned_rad, std::numbers::pi / 2);
  EXPECT_EQ(read.value->measures, result.measures);
  EXPECT_EQ(read.value->viewing_distance_m, 4.5);
  EXPECT_TRUE(read.value->deadline_reached);
  EXPECT_EQ(read.value->slowed, result.slowed);
}

TEST(JsonResponse, SaysWhyThereIsNoPath) {
  planning::PlanResult result;
  result.status = planning::Status::kInfeasible;
  result.infeasibility = planning::Infeasibility{2, 0, {3, 5, 8}};
  planning::KeyframeFault fault;
  fault.keyframe = 1;
  fault.depth_m = 0.5;
  result.keyframe_faults = {fault};
  fault.free_pose = motion::Pose{{1, 2, 3}, geometry::Quat(1, 0, 0, 0)};
  result.keyframe_faults.push_back(fault);
  const std::string text = *write_plan_response(result).value;
  EXPECT_THAT(text, HasSubstr(R"("keyframe_faults": [
    {"keyframe": 1, "depth_m": 0.5},
    {"keyframe": 1, "depth_m": 0.5, "free_pose": {"position": [1.0, 2.0, 3.0], "orientation": [1.0, 0.0, 0.0, 0.0]}}
  ],
  "infeasibility": {"keyframe_inside": 2, "keyframe_outside": 0,
    "triangles": [3, 5, 8]})"));
}

TEST(JsonResponse, ShowsTheCageThatLeavesNoPath) {
  planning::PlanResult result;
  result.status = planning::Status::kInfeasible;
  correction::CageBox cage{.box = {geometry::Vec3(0, 1, 2), geometry::Vec3(3, 4, 5)},
                           .orientation = geometry::Quat(0.6, 0, 0, 0.8),
                           .widest_hole_m = 0.0625,
                           .shortest_chord_m = 0.25};
  result.infeasibility = planning::Infeasibility{2, 0, {3, 5, 8}, cage};
  const std::string text = *write_plan_response(result).value;
  EXPECT_THAT(text, HasSubstr(R"(
  "infeasibility": {"keyframe_inside": 2, "keyframe_outside": 0,
    "cage": {"orientation": [0.6, 0.0, 0.0, 0.8], "min": [0.0, 1.0, 2.0], "max": [3.0, 4.0, 5.0],
      "widest_hole_m": 0.0625, "shortest_chord_m": 0.25},
    "triangles": [3, 5, 8]})"));
  const auto read = parse_as<planning::PlanResult>(text, "P.json");
  ASSERT_TRUE(read.value) << read.error;
  ASSERT_TRUE(read.value->infeasibility && read.value->infeasibility->cage);
  const correction::CageBox& back = *read.value->infeasibility->cage;
  EXPECT_EQ(back.box.min(), cage.box.min());
  EXPECT_EQ(back.box.max(), cage.box.max());
  EXPECT_EQ(back.orientation.coeffs(), cage.orientation.coeffs());
  EXPECT_EQ(back.widest_hole_m, 0.0625);
  EXPECT_EQ(back.shortest_chord_m, 0.25);
  std::string broken = text;
  broken.replace(broken.find("widest_hole_m"), 13, "widest");
  EXPECT_EQ(parse_as<planning::PlanResult>(broken, "P.json").error,
            "P.json: infeasibility.cage.widest_hole_m: is missing");
}

/// Returns an answer with every member that has an old name.
std::string answer_with_renamed_members() {
  planning::PlanResult result;
  result.collisions = {{0.5, 1.5, collision::Witness{1.25, 12, 3, 0.0625, {1, -2, 0.5}}}};
  result.collision_names = {{"table", "edge 2"}};
  result.corrections.resize(1);
  result.corrections[0].kind = correction::CorrectionKind::kTurn;
  planning::KeyframeFault fault;
  fault.keyframe = 1;
  fault.depth_m = 0.5;
  result.keyframe_faults = {fault};
  return *write_plan_response(result).value;
}

constexpr std::pair<const char*, const char*> kOldNamesOfAnswers[] = {
    {R"("depth_m": 0.0625)", R"("depth": 0.0625)"},
    {R"("kind": "turn")", R"("method": "turn")"},
    {R"("depth_m": 0.5)", R"("depth": 0.5)"},
};

TEST(JsonResponse, OfEarlierVersionsHasOldNames) {
  const std::string text = answer_with_renamed_members();
  std::string old_text = text;
  for (const auto& [member, old_member] : kOldNamesOfAnswers) {
    const std::size_t at = old_text.find(member);
    ASSERT_NE(at, std::string::npos) << member;
    old_text.replace(at, std::string(member).size(), old_member);
  }
  const auto read = parse_as<planning::PlanResult>(old_text, "P.json");
  ASSERT_TRUE(read.value) << read.error;
  EXPECT_EQ(read.value->collisions[0].witness->depth_m, 0.0625);
  EXPECT_EQ(read.value->corrections[0].kind, correction::CorrectionKind::kTurn);
  EXPECT_EQ(read.value->keyframe_faults[0].depth_m, 0.5);
  EXPECT_EQ(*write_plan_response(*read.value).value,
            *write_plan_response(*parse_as<planning::PlanResult>(text, "P.json").value).value);
}

TEST(JsonResponse, OfEarlierVersionsLacksShifts) {
  planning::PlanResult result;
  result.corrections.resize(1);
  result.corrections[0].moved_m = 0.25;
  result.measures.emplace().largest_deviation_m = 0.25;
  result.measures_before = motion::PathMeasures{};
  std::string text = *write_plan_response(result).value;
  const std::string shifts = R"(, "largest_shift_deg": 0.0, "mean_shift_deg": 0.0)";
  for (std::size_t at = 0; (at = text.find(shifts)) != std::string::npos;) {
    text.erase(at, shifts.size());
  }
  ASSERT_EQ(text.find("shift"), std::string::npos) << text;
  const auto read = parse_as<planning::PlanResult>(text, "P.json");
  ASSERT_TRUE(read.value) << read.error;
  EXPECT_EQ(read.value->corrections.at(0).moved_m, 0.25);
  EXPECT_EQ(read.value->corrections[0].shift, correction::Shift{});
  EXPECT_EQ(read.value->measures, result.measures);
}

TEST(JsonResponse, AMemberByBothOfItsNamesIsRefused) {
  const char* const expected[] = {
      "P.json: collisions[0].witness: has both depth_m and depth, its old name; leave one out",
      "P.json: corrections[0]: has both kind and method, its old name; leave one out",
      "P.json: keyframe_faults[0]: has both depth_m and depth, its old name; leave one out",
  };
  std::size_t i = 0;
  for (const auto& [member, old_member] : kOldNamesOfAnswers) {
    std::string text = answer_with_renamed_members();
    text.insert(text.find(member), std::string(old_member) + ", ");
    EXPECT_EQ(parse_as<planning::PlanResult>(text, "P.json").error, expected[i++]);
  }
}

TEST(JsonResponse, LeavesOutWhatThereIsNothingToSayOf) {
  const std::string text = *write_plan_response({}).value;
  for (const char* key : {"measures", "viewing_distance_m", "near_scale", "time_scale",
                          "deadline_reached", "slowed", "keyframe_faults", "infeasibility"}) {
    EXPECT_EQ(text.find(key), std::string::npos) << key;
  }
}

TEST(JsonResponse, NamesTheFieldOfAReportAtFault) {
  planning::PlanResult result;
  result.corrections.resize(2);
  result.infeasibility = planning::Infeasibility{2, 0, {3, 5, 8}};
  result.measures = motion::PathMeasures{};
  const std::string good = *write_plan_response(result).value;
  const auto error_of = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.rfind(from), from.size(), to);
    return parse_as<planning::PlanResult>(text, "P.json").error;
  };
  EXPECT_THAT(
      error_of("\"none\"", "\"fly\""),
      HasSubstr("corrections[1].kind: 'fly' is unknown; there are none, move, turn, go_round"));
  EXPECT_EQ(error_of("\"moved_m\"", "\"moved\""), "P.json: corrections[1].moved_m: is missing");
  EXPECT_THAT(error_of("[3, 5, 8]", "[3, -5]"),
              HasSubstr("infeasibility.triangles[1]: is -5; it must be a whole number from 0"));
  EXPECT_EQ(error_of("\"length_m\"", "\"length\""), "P.json: measures.after.length_m: is missing");
}

// A written angle reads back as the same bits if degrees can express it, and otherwise within a
// rounding of each of the two factors. In any case it is written as the same text again.
TEST(JsonAngle, DegreesReadBack) {
  constexpr unsigned kSeed = 11;
  testing::Random random(kSeed);
  std::uniform_real_distribution<double> angle(0, std::numbers::pi);
  int exact = 0;
  for (int i = 0; i < 100'000; ++i) {
    const double given = angle(random);
    const double read = radians(degrees(given));
    ASSERT_NEAR(read, given, 2 * std::numeric_limits<double>::epsilon() * given);
    ASSERT_EQ(degrees(read), degrees(given)) << given;
    exact += read == given ? 1 : 0;
    const double from_degrees = any_angle(random);
    ASSERT_EQ(radians(degrees(from_degrees)), from_degrees);
  }
  EXPECT_GT(exact, 50'000);
}

TEST(JsonResponse, OfLaterVersionsMaySayMore) {
  std::string text = *write_plan_response({}).value;
  text.replace(text.find("\"status\""), 0, "\"mood\": \"sunny\", ");
  EXPECT_TRUE(parse_as<planning::PlanResult>(text, "P.json").value);
}

}  // namespace
}  // namespace camway::tools
