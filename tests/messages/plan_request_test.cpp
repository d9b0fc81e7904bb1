// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <utility>

#include "daemon/messages/plan.h"
#include "daemon/planning/request/body_members.h"
#include "daemon/planning/request/validate.h"
#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/pages.h"
#include "tests/messages/plan_samples.h"
#include "tests/messages/request_on_wire.h"
#include "tests/support/random.h"

namespace camway::messages {
namespace {

using testing::kSeed;
using testing::Random;
using testing::sample_request;
using ::testing::StartsWith;

const RequestIds kRequestIds{"tester", -3, 1'000'000};

plan_request_t minimal_request() {
  plan_request_t wire{};
  wire.client_id = "tester";
  wire.num_pages = 1;
  return wire;
}

// Compares bytes: every bit of every number counts, NaN and -0 included.
TEST(WireRequest, RequestSurvivesTheWayThereAndBack) {
  Random random(kSeed);
  for (const std::size_t keyframes : {0U, 1U, 2U, 50U}) {
    const plan_request_t wire = to_wire(sample_request(keyframes, random), kRequestIds);
    EXPECT_EQ(wire.client_id, kRequestIds.client_id);
    EXPECT_EQ(wire.request_id, kRequestIds.request_id);
    EXPECT_EQ(wire.num_keyframes, static_cast<std::int32_t>(keyframes));
    const auto back = from_wire(wire);
    ASSERT_TRUE(back) << back.error;
    EXPECT_EQ(wire::encode(to_wire(*back, kRequestIds)), wire::encode(wire));
  }
}

TEST(WireRequest, AFrameSurvivesTheWayThereAndBack) {
  Random random(kSeed);
  int framed = 0;
  for (int trial = 0; trial < 50; ++trial) {
    const planning::PlanRequest request = sample_request(5, random);
    const auto back = from_wire(to_wire(request, kRequestIds));
    ASSERT_TRUE(back) << back.error;
    EXPECT_EQ(back->frame, request.frame);
    for (std::size_t i = 0; i < 5; ++i)
      EXPECT_EQ(back->keyframes[i].image, request.keyframes[i].image);
    framed += request.frame ? 1 : 0;
  }
  EXPECT_GT(framed, 0);
}

TEST(WireRequest, AFrameHasItsNumbersWhereTheTypesSayTheyAre) {
  planning::PlanRequest request;
  request.frame = {{1, 2, 3, 4}, {{5, 6, 7}, {8, 9, 10, 11}}, {{12, 13, 14}, {15, 16, 17, 18}}};
  const plan_request_t wire = to_wire(request, kRequestIds);
  EXPECT_EQ(wire.has_frame, 1);
  EXPECT_EQ(wire.frame.reference_wxyz[3], 4.0);
  EXPECT_EQ(wire.frame.begin.velocity_m_per_s[0], 5.0);
  EXPECT_EQ(wire.frame.begin.image_rate_per_s[3], 11.0);
  EXPECT_EQ(wire.frame.end.velocity_m_per_s[2], 14.0);
  EXPECT_EQ(wire.frame.end.image_rate_per_s[0], 15.0);
}

TEST(WireRequest, EveryOptionSurvivesTheWayThereAndBack) {
  Random random(kSeed);
  for (int trial = 0; trial < 200; ++trial) {
    SCOPED_TRACE(::testing::Message() << "trial " << trial);
    planning::PlanRequest request = sample_request(2, random);
    request.options = testing::sample_options(random);
    const auto back = from_wire(to_wire(request, kRequestIds));
    ASSERT_TRUE(back) << back.error;
    EXPECT_EQ(back->options, request.options);
  }
}

TEST(WireRequest, OptionsHaveTheirNumbersWhereTheTypesSayTheyAre) {
  planning::PlanRequest request;
  planning::PlanOptions& options = request.options;
  options.objective = correction::Objective::kSafest;
  options.orientation.rule = correction::OrientationRule::kTarget;
  options.orientation.target_W = {1, 2, 3};
  options.orientation.cone_rad = 0.5;
  options.orientation.max_turn_rad = 0.25;
  options.limits.turn_rate_rad_per_s = 1.5;
  options.limits.may_retime = true;
  options.bounds.min_W.y() = -0.5;
  options.bounds.max_W.z() = 0.0;
  options.seed = 99;
  const plan_request_t wire = to_wire(request, kRequestIds);
  EXPECT_EQ(wire.objective, 3);
  EXPECT_EQ(wire.orientation.policy, 3);
  EXPECT_EQ(wire.orientation.target_m[1], 2.0);
  EXPECT_EQ(wire.orientation.cone_rad, 0.5);
  EXPECT_EQ(wire.orientation.has_max_turn, 1);
  EXPECT_EQ(wire.orientation.max_turn_rad, 0.25);
  EXPECT_EQ(wire.limits.turn_rate_rad_per_s, 1.5);
  EXPECT_EQ(wire.limits.may_retime, 1);
  EXPECT_EQ(wire.bounds.has_min[1], 1);
  EXPECT_EQ(wire.bounds.min_m[1], -0.5);
  EXPECT_EQ(wire.bounds.has_max[2], 1);
  EXPECT_EQ(wire.bounds.has_min[0] + wire.bounds.has_min[2] + wire.bounds.has_max[0] +
                wire.bounds.has_max[1],
            0);
  EXPECT_EQ(from_wire(wire)->options.bounds, options.bounds);
  EXPECT_FALSE(from_wire(minimal_request())->options.bounds.any());
  EXPECT_EQ(wire.seed, 99);
}

TEST(WireRequest, DirectionsNeedNotBeOfUnitLength) {
  plan_request_t wire = minimal_request();
  wire.orientation.policy = orientation_t::LEVEL;
  EXPECT_EQ(from_wire(wire)->options.orientation.up_W, geometry::Vec3::UnitY()) << "the default";
  wire.orientation.up[2] = 1e200;
  EXPECT_EQ(from_wire(wire)->options.orientation.up_W, geometry::Vec3::UnitZ());
  wire.orientation.up[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(from_wire(wire)->options.orientation.up_W.y()))
      << "for planning::validate to refuse";
}

TEST(WireRequest, UnknownObjectivesAndPoliciesAreErrors) {
  plan_request_t wire = minimal_request();
  wire.objective = 4;
  EXPECT_EQ(from_wire(wire).error,
            "objective: 4 is unknown; the values are 0 (closest), 1 (shortest), 2 (smoothest), 3 "
            "(safest)");
  wire = minimal_request();
  wire.orientation.policy = -1;
  EXPECT_EQ(from_wire(wire).error,
            "orientation.policy: -1 is unknown; the values are 0 (free), 1 (keep), 2 (level), 3 "
            "(target)");
}

// A program that does not know an option leaves it zero.
TEST(WireRequest, AZeroMessageAsksForEveryDefault) {
  const auto read = from_wire(minimal_request());
  ASSERT_TRUE(read) << read.error;
  planning::PlanOptions defaults;
  defaults.deadline_s = DeadlineLimits{}.default_s;
  EXPECT_EQ(read->options, defaults);
  EXPECT_FALSE(read->body);
  EXPECT_FALSE(read->has_times);
}

TEST(WireRequest, NothingIsCorrectedOnlyWhereItIsAskedFor) {
  plan_request_t wire = minimal_request();
  wire.correct_nothing = 1;
  EXPECT_EQ(from_wire(wire)->options.max_inserted_keyframes, 0);
  wire.max_inserted_keyframes = 7;
  EXPECT_THAT(from_wire(wire).error,
              StartsWith("max_inserted_keyframes: is 7, which does not count"));
  wire.correct_nothing = 0;
  EXPECT_EQ(from_wire(wire)->options.max_inserted_keyframes, 7);
  planning::PlanRequest none;
  none.options.max_inserted_keyframes = 0;
  EXPECT_EQ(to_wire(none, kRequestIds).correct_nothing, 1);
}

TEST(WireRequest, WhatWouldNotCountIsRefusedByName) {
  using Change = void (*)(plan_request_t&);
  const std::pair<const char*, Change> kIdle[] = {
      {"keyframes[1].time_s: ", [](plan_request_t& r) { r.keyframes[1].time_s = 0.5; }},
      {"keyframes[0].time_s: ",
       [](plan_request_t& r) { r.keyframes[0].time_s = std::numeric_limits<double>::quiet_NaN(); }},
      {"frame: ", [](plan_request_t& r) { r.frame.end.image_rate_per_s[3] = 0.5; }},
      {"bounds.min_m[0]: ", [](plan_request_t& r) { r.bounds.min_m[0] = 14.0; }},
      {"bounds.max_m[2]: ",
       [](plan_request_t& r) { r.bounds.max_m[2] = std::numeric_limits<double>::quiet_NaN(); }},
      {"seed: is -1; it must be at least 0", [](plan_request_t& r) { r.seed = -1; }},
      {"orientation.up: ", [](plan_request_t& r) { r.orientation.up[2] = 1.0; }},
      {"orientation.up: ",
       [](plan_request_t& r) {
         r.orientation.policy = orientation_t::TARGET;
         r.orientation.up[2] = 1.0;
       }},
      {"orientation.target_m: ", [](plan_request_t& r) { r.orientation.target_m[0] = 1.0; }},
      {"orientation.cone_rad: ", [](plan_request_t& r) { r.orientation.cone_rad = 0.25; }},
      {"orientation.max_turn_rad: ", [](plan_request_t& r) { r.orientation.max_turn_rad = 0.25; }},
      {"body.size_m: ", [](plan_request_t& r) { r.body.size_m[1] = 1.0; }},
      {"body.center_m: ", [](plan_request_t& r) { r.body.center_m[1] = 1.0; }},
      {"body.radius_m: ",
       [](plan_request_t& r) {
         r.body.type = body_t::BOX;
         r.body.radius_m = 0.5;
       }},
      {"body.points_m: ",
       [](plan_request_t& r) {
         r.body.type = body_t::SPHERE;
         r.body.points_m = {{0, 0, 0}};
       }},
      {"body.triangles: ",
       [](plan_request_t& r) {
         r.body.type = body_t::CONVEX;
         r.body.triangles = {{0, 1, 2}};
       }},
      {"body.piece_sizes: ",
       [](plan_request_t& r) {
         r.body.type = body_t::MESH;
         r.body.piece_sizes = {3};
       }},
  };
  plan_request_t good = minimal_request();
  good.keyframes.resize(2);
  ASSERT_TRUE(from_wire(good));
  for (const auto& [field, change] : kIdle) {
    plan_request_t wire = good;
    change(wire);
    const auto read = from_wire(wire);
    EXPECT_FALSE(read) << field;
    EXPECT_THAT(read.error, StartsWith(field));
  }
}

// Every member that `planning::validate` can name has the name that users of lcm-gen see.
TEST(WireRequest, MessagesNameMembersAsTheWireDoes) {
  const std::pair<const char*, const char*> kNames[] = {
      {"camera.fov_x", "camera.fov_x_rad"},
      {"camera.fov_y", "camera.fov_y_rad"},
      {"camera.near", "camera.near_m"},
      {"camera", "camera"},
      {"keyframes", "keyframes"},
      {"keyframes[3].time", "keyframes[3].time_s"},
      {"keyframes[12].position", "keyframes[12].position_m"},
      {"keyframes[0].orientation", "keyframes[0].orientation_wxyz"},
      {"keyframes[1].image", "keyframes[1].image"},
      {"frame", "frame"},
      {"frame.reference", "frame.reference_wxyz"},
      {"frame.end.velocity_m_per_s", "frame.end.velocity_m_per_s"},
      {"body.size[2]", "body.size_m[2]"},
      {"body.center", "body.center_m"},
      {"body.radius_m", "body.radius_m"},
      {"body.points[5]", "body.points_m[5]"},
      {"body.pieces[2]", "body.piece_sizes[2]"},
      {"body.pieces[2][7]", "body.points_m (point 7 of piece 2)"},
      {"body.vertices[4]", "body.points_m[4]"},
      {"body.triangles[1][2]", "body.triangles[1][2]"},
      {"options.deadline_s", "deadline_s"},
      {"options.clearance_m", "clearance_m"},
      {"options.max_inserted_keyframes", "max_inserted_keyframes"},
      {"options.default_speed_m_per_s", "default_speed_m_per_s"},
      {"options.orientation.up", "orientation.up"},
      {"options.orientation.target", "orientation.target_m"},
      {"options.orientation.cone", "orientation.cone_rad"},
      {"options.orientation.max_turn", "orientation.max_turn_rad"},
      {"options.limits", "limits"},
      {"options.limits.speed_m_per_s", "limits.speed_m_per_s"},
      {"options.limits.acceleration_m_per_s2", "limits.acceleration_m_per_s2"},
      {"options.limits.turn_rate", "limits.turn_rate_rad_per_s"},
      {"options.limits.retime", "limits.may_retime"},
  };
  plan_request_t wire = minimal_request();
  const planning::PlanRequest request = *from_wire(wire);
  for (const auto& [path, name] : kNames) EXPECT_EQ(request.name_of(path), name);
  wire.correct_nothing = 1;
  EXPECT_EQ(from_wire(wire)->name_of("options.max_inserted_keyframes"), "correct_nothing");
}

TEST(WireRequest, EveryBodySurvivesTheWayThereAndBack) {
  Random random(kSeed);
  std::vector<std::optional<motion::BodyShape>> bodies = testing::sample_bodies(random);
  bodies.emplace_back(testing::largest_body(random));
  for (const auto& body : bodies) {
    SCOPED_TRACE(body ? body->index() : 99);
    planning::PlanRequest request = sample_request(2, random);
    request.body = body;
    const plan_request_t wire = to_wire(request, kRequestIds);
    for (const wire::Bytes& page : wire::encode_pages(wire)) {
      ASSERT_FALSE(wire::check(wire::layout_of<plan_request_t>(), page));
    }
    const auto back = from_wire(wire);
    ASSERT_TRUE(back) << back.error;
    ASSERT_EQ(back->body.has_value(), body.has_value());
    if (body) {
      EXPECT_EQ(planning::number_of(*back->body), planning::number_of(*body));
    }
    EXPECT_EQ(back->options.clearance_m, 0.0625);
    EXPECT_EQ(wire::encode(to_wire(*back, kRequestIds)), wire::encode(wire));
  }
}

TEST(WireRequest, ABodyHasItsNumbersWhereTheTypeSaysTheyAre) {
  planning::PlanRequest request;
  // Not assigned: with sanitizers, GCC 12 warns of the variant in the empty optional, which
  // assignment never reads.
  request.body.emplace(motion::BoxShape{{1, 2, 3}, {4, 5, 6}});
  plan_request_t wire = to_wire(request, kRequestIds);
  EXPECT_EQ(wire.body.type, body_t::BOX);
  EXPECT_EQ(wire.body.center_m[1], 2.0);
  EXPECT_EQ(wire.body.size_m[2], 6.0);
  request.body = motion::ConvexShape{{{{1, 2, 3}}, {{4, 5, 6}, {7, 8, 9}}}};
  wire = to_wire(request, kRequestIds);
  EXPECT_EQ(wire.body.piece_sizes, (std::vector<std::int32_t>{1, 2}));
  EXPECT_EQ(wire.body.points_m[2], (std::vector<double>{7, 8, 9}));
  const auto convex = from_wire(wire);
  EXPECT_EQ(std::get<motion::ConvexShape>(*convex->body).pieces_C[1][0], geometry::Vec3(4, 5, 6));
  request.body = motion::MeshShape{{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}, {{2, 0, 1}}};
  wire = to_wire(request, kRequestIds);
  EXPECT_EQ(wire.body.triangles[0], (std::vector<std::int32_t>{2, 0, 1}));
  request.body = motion::Camera{1.0, 0.5, 0.25};
  wire = to_wire(request, kRequestIds);
  EXPECT_EQ(wire.camera.near_m, 0.25) << "goes as the camera";
  EXPECT_FALSE(from_wire(wire)->body);
}

TEST(WireRequest, BodiesThatCannotBeAreErrorsThatNameTheField) {
  const auto error_of = [](const auto& edit) {
    plan_request_t wire = minimal_request();
    wire.body.type = body_t::CONVEX;
    wire.body.points_m = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
    wire.body.piece_sizes = {1, 2};
    edit(wire.body);
    return from_wire(wire).error;
  };
  EXPECT_EQ(error_of([](body_t&) {}), "");
  EXPECT_EQ(error_of([](body_t& b) { b.type = 9; }),
            "body.type: 9 is unknown; the values are 0 (camera), 1 (box), 2 (sphere), 3 (convex), "
            "4 (mesh), 5 (solid mesh)");
  EXPECT_EQ(error_of([](body_t& b) { b.type = -1; }),
            "body.type: -1 is unknown; the values are 0 (camera), 1 (box), 2 (sphere), 3 (convex), "
            "4 (mesh), 5 (solid mesh)");
  EXPECT_EQ(error_of([](body_t& b) { b.piece_sizes = {1}; }),
            "body.piece_sizes: 2 points belong to no piece");
  EXPECT_EQ(error_of([](body_t& b) {
              b.piece_sizes = {1, 3};
            }),
            "body.piece_sizes[1]: is 3, and 2 points are left");
  EXPECT_EQ(error_of([](body_t& b) {
              b.piece_sizes = {4, -1};
            }),
            "body.piece_sizes[0]: is 4, and 3 points are left");
  EXPECT_EQ(error_of([](body_t& b) {
              b.piece_sizes = {3, -1};
            }),
            "body.piece_sizes[1]: is -1, and 0 points are left");
  const auto mesh = [](body_t& b) {
    b.type = body_t::MESH;
    b.piece_sizes = {};
    b.triangles = {{0, 1, 2}, {0, -2, 1}};
  };
  EXPECT_EQ(error_of(mesh), "body.triangles[1][1]: is -2; it must be at least 0");
}

TEST(WireRequest, ZerosAskForDefaults) {
  const planning::PlanOptions defaults;
  const auto converted = from_wire(minimal_request(), {.default_s = 4.0, .max_s = 8.0});
  ASSERT_TRUE(converted);
  planning::PlanOptions expected = defaults;
  expected.deadline_s = 4.0;
  EXPECT_EQ(converted->options, expected);
}

TEST(WireRequest, DeadlinesAreCutToTheMaximum) {
  const auto deadline_of = [](double wire_s) {
    plan_request_t wire = minimal_request();
    wire.deadline_s = wire_s;
    return from_wire(wire, {.default_s = 4.0, .max_s = 8.0})->options.deadline_s;
  };
  EXPECT_EQ(deadline_of(7.5), 7.5);
  EXPECT_EQ(deadline_of(8.5), 8.0);
  EXPECT_EQ(deadline_of(std::numeric_limits<double>::infinity()), 8.0);
  // planning::validate refuses these.
  EXPECT_EQ(deadline_of(-1.0), -1.0);
  EXPECT_TRUE(std::isnan(deadline_of(std::numeric_limits<double>::quiet_NaN())));
}

TEST(WireRequest, ValuesAreLeftToValidation) {
  plan_request_t wire = minimal_request();
  wire.chord_error_m = -1.0;
  wire.keyframes.resize(1);
  wire.keyframes[0].position_m[1] = std::numeric_limits<double>::quiet_NaN();
  wire.keyframes[0].origin = keyframe_t::ORIGIN_INSERTED;
  EXPECT_TRUE(from_wire(wire));
  wire.keyframes[0].origin = 9;
  const auto converted = from_wire(wire);
  ASSERT_TRUE(converted);
  EXPECT_EQ(converted->options.chord_error_m, -1.0);
  EXPECT_TRUE(std::isnan(converted->keyframes[0].pose.position.y()));
  EXPECT_EQ(converted->keyframes[0].origin, motion::KeyframeOrigin::kGiven);
  EXPECT_TRUE(planning::validate(*converted));
}

TEST(WireRequest, UnknownMethodIsAnErrorThatNamesIt) {
  plan_request_t wire = minimal_request();
  wire.method = "magic";
  EXPECT_EQ(from_wire(wire).error,
            "method: 'magic' is unknown; the values are ladder, keyframe_insertion");
}

}  // namespace
}  // namespace camway::messages
