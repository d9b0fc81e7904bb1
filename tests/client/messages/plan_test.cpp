// SPDX-License-Identifier: MIT
#include "client/messages/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "client/messages/plan_faults.h"
#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/layout.h"

namespace camway {
namespace {

using ::testing::HasSubstr;
using wire::Bytes;

PlanRequest request_with(std::size_t keyframes) {
  PlanRequest request;
  request.scene = "office";
  request.keyframes.resize(keyframes);
  for (std::size_t i = 0; i < keyframes; ++i) {
    request.keyframes[i].time_s = static_cast<double>(i);
    request.keyframes[i].position_m = {double(i), 0.25, -1e-300};
    request.keyframes[i].orientation_wxyz = {0.5, 0.5, -0.5, 0.5};
  }
  return request;
}

TEST(PlanPages, HoldEveryKeyframeOnceInOrderAndFitAMessage) {
  for (const std::size_t count : {0u, 1u, 2u, 917u, 918u, 919u, 5000u, 100'000u}) {
    const PlanRequest request = request_with(count);
    ASSERT_EQ(fault_in_form(request), std::nullopt);
    const std::vector<Bytes> pages = to_pages(request, "me", 7);
    std::size_t next = 0;
    for (std::size_t i = 0; i < pages.size(); ++i) {
      ASSERT_LE(pages[i].size(), wire::kMaxMessageBytes);
      const auto decoded = wire::decode<plan_request_t>(pages[i]);
      ASSERT_TRUE(decoded.message) << decoded.fault.text("plan_request_t");
      EXPECT_EQ(decoded.message->page, static_cast<int>(i));
      EXPECT_EQ(decoded.message->num_pages, static_cast<int>(pages.size()));
      EXPECT_EQ(decoded.message->scene, "office");
      for (const keyframe_t& keyframe : decoded.message->keyframes) {
        ASSERT_EQ(keyframe.time_s, double(next));
        ASSERT_EQ(keyframe.position_m[2], -1e-300);
        ++next;
      }
    }
    EXPECT_EQ(next, count);
    EXPECT_LE(pages.size(), std::size_t(wire::kMaxRequestPages));
  }
}

TEST(PlanPages, LongestTextsStillFit) {
  PlanRequest request = request_with(10'000);
  request.scene = std::string(wire::kMaxSceneNameBytes, 's');
  request.method = std::string(wire::kMaxMethodBytes, 'm');
  ASSERT_EQ(fault_in_form(request), std::nullopt);
  for (const Bytes& page : to_pages(request, std::string(32, 'c'), INT64_MAX)) {
    EXPECT_LE(page.size(), wire::kMaxMessageBytes);
    EXPECT_EQ(wire::check(wire::layout_of<plan_request_t>(), page), std::nullopt);
  }
}

TEST(PlanPages, TheLargestBodyGoesOnPageZero) {
  PlanRequest request = request_with(100'000);
  std::vector<std::vector<Body::Point>> pieces;
  for (std::size_t i = 0; i < wire::kMaxBodyPoints; ++i) pieces.push_back({{double(i), 1, 2}});
  request.body = Body::convex(pieces);
  request.clearance_m = 0.125;
  ASSERT_EQ(fault_in_form(request), std::nullopt);
  const std::vector<Bytes> pages = to_pages(request, "me", 7);
  EXPECT_LE(pages.size(), std::size_t(wire::kMaxRequestPages));
  std::size_t keyframes = 0;
  for (std::size_t i = 0; i < pages.size(); ++i) {
    ASSERT_LE(pages[i].size(), wire::kMaxMessageBytes);
    const auto page = wire::decode<plan_request_t>(pages[i]).message;
    ASSERT_TRUE(page);
    EXPECT_EQ(page->clearance_m, 0.125);
    EXPECT_EQ(page->body.points_m.size(), i == 0 ? pieces.size() : 0);
    if (i == 0) {
      EXPECT_EQ(page->body.points_m[300][0], 300.0);
    }
    keyframes += page->keyframes.size();
  }
  EXPECT_EQ(keyframes, 100'000u);
}

TEST(PlanPages, EveryBodyHasItsForm) {
  const auto sent = [](const Body& body) {
    PlanRequest request = request_with(2);
    request.body = body;
    const auto page = wire::decode<plan_request_t>(to_pages(request, "me", 7).at(0)).message;
    return page ? page->body : body_t{};
  };
  EXPECT_EQ(sent({}).type, body_t::CAMERA);
  const body_t box = sent(Body::box({1, 2, 3}, {4, 5, 6}));
  EXPECT_EQ(box.type, body_t::BOX);
  EXPECT_EQ(box.size_m[1], 2.0);
  EXPECT_EQ(box.center_m[2], 6.0);
  const body_t ball = sent(Body::sphere(0.5));
  EXPECT_EQ(ball.type, body_t::SPHERE);
  EXPECT_EQ(ball.radius_m, 0.5);
  const body_t hulls = sent(Body::convex({{{1, 2, 3}}, {{4, 5, 6}, {7, 8, 9}}}));
  EXPECT_EQ(hulls.type, body_t::CONVEX);
  EXPECT_EQ(hulls.piece_sizes, (std::vector<std::int32_t>{1, 2}));
  EXPECT_EQ(hulls.points_m[1], (std::vector<double>{4, 5, 6}));
  const body_t mesh = sent(Body::mesh({{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}, {{2, 1, 0}}));
  EXPECT_EQ(mesh.type, body_t::MESH);
  EXPECT_EQ(mesh.num_points, 3);
  EXPECT_EQ(mesh.triangles[0], (std::vector<std::int32_t>{2, 1, 0}));
}

TEST(PlanPages, HoldTheOptionsOfCorrectionOnEveryPage) {
  PlanRequest request = request_with(2000);
  request.objective = Objective::kSmoothest;
  request.orientation = Orientation::target({1, 2, 3}, 0.5);
  request.orientation.max_turn_rad = 0.0;
  request.limits.acceleration_m_per_s2 = 2.5;
  request.limits.may_retime = true;
  request.bounds.min_m[1] = -0.5;
  request.max_shrink = 0.25;
  request.repair_keyframes = true;
  request.clearance_profile = true;
  request.seed = 99;
  const std::vector<Bytes> pages = to_pages(request, "me", 7);
  ASSERT_GT(pages.size(), 1u);
  for (const Bytes& bytes : pages) {
    const auto page = wire::decode<plan_request_t>(bytes).message;
    ASSERT_TRUE(page);
    EXPECT_EQ(page->objective, plan_request_t::SMOOTHEST);
    EXPECT_EQ(page->orientation.policy, orientation_t::TARGET);
    EXPECT_EQ(page->orientation.target_m[2], 3.0);
    EXPECT_EQ(page->orientation.cone_rad, 0.5);
    EXPECT_EQ(page->orientation.has_max_turn, 1);
    EXPECT_EQ(page->orientation.max_turn_rad, 0.0);
    EXPECT_EQ(page->limits.acceleration_m_per_s2, 2.5);
    EXPECT_EQ(page->limits.speed_m_per_s, 0.0);
    EXPECT_EQ(page->limits.may_retime, 1);
    EXPECT_EQ(page->bounds.has_min[1], 1);
    EXPECT_EQ(page->bounds.min_m[1], -0.5);
    EXPECT_EQ(page->bounds.has_min[0] + page->bounds.has_max[1], 0);
    EXPECT_EQ(page->max_shrink, 0.25);
    EXPECT_EQ(page->repair_keyframes, 1);
    EXPECT_EQ(page->clearance_profile, 1);
    EXPECT_EQ(page->seed, 99);
  }
}

// An unset value means the daemon's default and 0 means 0; the wire has two members for that.
TEST(PlanPages, NothingIsCorrectedOnlyWhereItIsAskedFor) {
  const auto sent = [](std::optional<std::int32_t> most) {
    PlanRequest request = request_with(2);
    request.max_inserted_keyframes = most;
    return *wire::decode<plan_request_t>(to_pages(request, "me", 7).at(0)).message;
  };
  EXPECT_EQ(sent(std::nullopt).max_inserted_keyframes, 0);
  EXPECT_EQ(sent(std::nullopt).correct_nothing, 0);
  EXPECT_EQ(sent(0).max_inserted_keyframes, 0);
  EXPECT_EQ(sent(0).correct_nothing, 1);
  EXPECT_EQ(sent(17).max_inserted_keyframes, 17);
  EXPECT_EQ(sent(17).correct_nothing, 0);
}

TEST(PlanPages, TimesCountWhereTheyAreSet) {
  PlanRequest request = request_with(3);
  request.default_speed_m_per_s = 2.5;
  auto page = wire::decode<plan_request_t>(to_pages(request, "me", 7).at(0)).message;
  EXPECT_EQ(page->has_times, 1);
  EXPECT_EQ(page->default_speed_m_per_s, 2.5);
  for (Keyframe& keyframe : request.keyframes) keyframe.time_s.reset();
  EXPECT_EQ(fault_in_form(request), std::nullopt);
  page = wire::decode<plan_request_t>(to_pages(request, "me", 7).at(0)).message;
  EXPECT_EQ(page->has_times, 0);
  for (const keyframe_t& keyframe : page->keyframes) EXPECT_EQ(keyframe.time_s, 0.0);
  request.keyframes[2].time_s = 0.0;
  EXPECT_THAT(*fault_in_form(request), HasSubstr("keyframes[2].time_s: is set"));
  request = request_with(3);
  request.keyframes[1].time_s.reset();
  EXPECT_THAT(*fault_in_form(request), HasSubstr("keyframes[1].time_s: is not set"));
}

TEST(PlanPages, AFrameGoesWithTheImagesOfItsKeyframes) {
  PlanRequest request = request_with(2);
  request.keyframes[1] = PathKeyframe{2.0, {}, {1, 0, 0, 0}, true, false, {0, 0, 1, 0}}.again();
  request.frame = {{1, 2, 3, 4}, {{5, 6, 7}, {8, 9, 10, 11}}, {{12, 13, 14}, {15, 16, 17, 18}}};
  auto page = wire::decode<plan_request_t>(to_pages(request, "me", 7).at(0)).message;
  EXPECT_EQ(page->has_frame, 1);
  EXPECT_EQ(page->frame.reference_wxyz[1], 2.0);
  EXPECT_EQ(page->frame.begin.velocity_m_per_s[2], 7.0);
  EXPECT_EQ(page->frame.end.image_rate_per_s[3], 18.0);
  EXPECT_EQ(page->keyframes[1].time_s, 2.0);
  EXPECT_EQ(page->keyframes[1].image[2], 1.0);
  request.frame.reset();
  page = wire::decode<plan_request_t>(to_pages(request, "me", 7).at(0)).message;
  EXPECT_EQ(page->has_frame, 0);
  EXPECT_EQ(page->frame.reference_wxyz[0], 0.0);
}

TEST(PlanPages, EveryOrientationHasItsForm) {
  const auto sent = [](const Orientation& orientation) {
    PlanRequest request = request_with(2);
    request.orientation = orientation;
    const auto page = wire::decode<plan_request_t>(to_pages(request, "me", 7).at(0)).message;
    return page ? page->orientation : orientation_t{};
  };
  EXPECT_EQ(sent({}).policy, orientation_t::FREE);
  EXPECT_EQ(sent({}).has_max_turn, 0);
  EXPECT_EQ(sent(Orientation::keep()).policy, orientation_t::KEEP);
  EXPECT_EQ(sent(Orientation::level({0, 2, 0})).policy, orientation_t::LEVEL);
  EXPECT_EQ(sent(Orientation::level({0, 2, 0})).up[1], 2.0);
}

TEST(PlanPages, WhatHasNoFormIsNamed) {
  PlanRequest request = request_with(2);
  request.scene = std::string(200, 's');
  EXPECT_THAT(*fault_in_form(request), HasSubstr("scene: 200 bytes"));
  request.scene = std::string("of\0fice", 7);
  EXPECT_THAT(*fault_in_form(request), HasSubstr("scene: holds a NUL"));
  request = request_with(2);
  request.method = std::string(65, 'm');
  EXPECT_THAT(*fault_in_form(request), HasSubstr("method: 65 bytes"));
  EXPECT_THAT(*fault_in_form(request_with(100'001)), HasSubstr("keyframes: there are 100001"));
  request = request_with(2);
  request.body = Body::mesh(std::vector<Body::Point>(100'001), {});
  EXPECT_THAT(*fault_in_form(request),
              HasSubstr("body.vertices_m: there are 100001, at most 100000"));
  request.body = Body::mesh({}, std::vector<std::array<std::int32_t, 3>>(100'001));
  EXPECT_THAT(*fault_in_form(request),
              HasSubstr("body.triangles: there are 100001, at most 100000"));
  request.body = Body::convex({std::vector<Body::Point>(300), std::vector<Body::Point>(300)});
  EXPECT_THAT(*fault_in_form(request), HasSubstr("body.pieces_m: there are 600"));
  request.body = Body::convex(std::vector<std::vector<Body::Point>>(513));
  EXPECT_THAT(*fault_in_form(request), HasSubstr("body.pieces_m: there are 513"));
}

}  // namespace
}  // namespace camway
