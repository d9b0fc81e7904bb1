// SPDX-License-Identifier: MIT
#include "client/messages/plan_pages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>

#include <camway/plan_request_t.hpp>

#include "client/messages/plan.h"
#include "client/messages/plan_faults.h"
#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/layout.h"
#include "tests/client/fake_daemon.h"
#include "tests/support/random.h"

namespace camway {
namespace {

using ::testing::HasSubstr;
using testing_support::answer_pages;
using testing_support::encode_all;

constexpr std::uint32_t kPlanPagesSeed = 1995;

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

plan_request_t wire_request() {
  plan_request_t request{};
  request.client_id = "me";
  request.request_id = 7;
  request.scene = "office";
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

TEST(PlanCollector, PutsPagesTogetherInAnyOrderWithRepetitions) {
  testing::Random random(kPlanPagesSeed);
  const std::vector<Bytes> pages = encode_all(answer_pages(wire_request(), 1000, 90));
  for (int round = 0; round < 50; ++round) {
    std::vector<Bytes> arriving = pages;
    arriving.insert(arriving.end(), pages.begin(), pages.begin() + 5);
    std::shuffle(arriving.begin(), arriving.end(), random);
    PlanCollector collector("me", 7);
    for (const Bytes& page : arriving) collector.take(page);
    ASSERT_TRUE(collector.complete());
    const PlanResponse response = collector.response();
    ASSERT_TRUE(response.ok()) << response.error;
    ASSERT_EQ(response.path.segments().size(), 1000u);
    EXPECT_EQ(response.path.begin(), 0.0);
    EXPECT_EQ(response.path.end(), 1000.0);
    EXPECT_EQ(response.message, "all is well");
    EXPECT_EQ(response.scene_revision, 3);
  }
}

TEST(PlanCollector, ReadsWitnesses) {
  plan_response_t page = answer_pages(wire_request(), 1, 1)[0];
  page.collisions.resize(2);
  page.num_collisions = 2;
  page.collisions[0].t_end_s = 0.25;
  page.collisions[1].has_witness = 1;
  page.collisions[1].witness_time_s = 0.5;
  page.collisions[1].witness_object = "table";
  page.collisions[1].witness_triangle = 12;
  page.collisions[1].witness_feature = "edge 2";
  page.collisions[1].witness_depth_m = 0.125;
  page.collisions[1].witness_point_m[2] = 3.0;
  PlanCollector collector("me", 7);
  ASSERT_EQ(collector.take(wire::encode(page)), PlanCollector::Taken::kNew);
  const PlanResponse response = collector.response();
  ASSERT_EQ(response.collisions.size(), 2u);
  EXPECT_EQ(response.collisions[0].t_end_s, 0.25);
  EXPECT_FALSE(response.collisions[0].witness);
  ASSERT_TRUE(response.collisions[1].witness);
  const Witness& witness = *response.collisions[1].witness;
  EXPECT_EQ(witness.time_s, 0.5);
  EXPECT_EQ(witness.object, "table");
  EXPECT_EQ(witness.triangle, 12);
  EXPECT_EQ(witness.feature, "edge 2");
  EXPECT_EQ(witness.depth_m, 0.125);
  EXPECT_EQ(witness.point_m, (std::array<double, 3>{0, 0, 3}));
}

/// Returns the answer that the client reads from the pages, the last of which comes first.
PlanResponse response_of(const std::vector<plan_response_t>& pages) {
  PlanCollector collector("me", 7);
  for (auto page = pages.rbegin(); page != pages.rend(); ++page) {
    collector.take(wire::encode(*page));
  }
  EXPECT_TRUE(collector.complete());
  return collector.response();
}

TEST(PlanCollector, ReadsWhatCorrectionDidOverAllPages) {
  std::vector<plan_response_t> pages = answer_pages(wire_request(), 2, 1);
  for (plan_response_t& page : pages) {
    page.near_scale = 0.75;
    page.time_scale = 1.25;
    page.deadline_reached = 1;
    page.has_measures = 1;
    page.measures.length_m = 7.0;
    page.measures.largest_turn_acceleration_rad_per_s2 = 8.0;
    page.measures.clearance_lower_bound_m = 9.0;
  }
  correction_t correction{};
  correction.t_end_s = 0.5;
  correction.method = correction_t::GO_ROUND;
  correction.changed_t_end_s = 1.5;
  correction.moved_m = 0.25;
  correction.turned_rad = 0.125;
  correction.tried_directions = 1;
  correction.tried_paths = 2;
  correction.tried_lattice_points = 3;
  correction.tried_tree_samples = 4;
  pages[0].corrections = {correction};
  pages[0].num_corrections = 1;
  for (const std::size_t page : {0U, 1U}) {
    slowed_stretch_t slowed{};
    slowed.given_t_end_s = 2.5 + static_cast<double>(page);
    pages[page].slowed = {slowed};
    pages[page].num_slowed = 1;
  }
  const PlanResponse response = response_of(pages);
  ASSERT_TRUE(response.ok()) << response.error;
  ASSERT_EQ(response.slowed.size(), 2u);
  EXPECT_EQ(response.slowed[0].given_t_end_s, 2.5);
  EXPECT_EQ(response.slowed[1].given_t_end_s, 3.5);
  ASSERT_EQ(response.corrections.size(), 1u);
  EXPECT_EQ(response.corrections[0].t_end_s, 0.5);
  EXPECT_EQ(response.corrections[0].method, Correction::Method::kGoRound);
  EXPECT_EQ(response.corrections[0].changed_t_end_s, 1.5);
  EXPECT_EQ(response.corrections[0].moved_m, 0.25);
  EXPECT_EQ(response.corrections[0].turned_rad, 0.125);
  EXPECT_EQ(response.corrections[0].tried.directions, 1);
  EXPECT_EQ(response.corrections[0].tried.paths, 2);
  EXPECT_EQ(response.corrections[0].tried.lattice_points, 3);
  EXPECT_EQ(response.corrections[0].tried.tree_samples, 4);
  EXPECT_FALSE(response.measures_before);
  ASSERT_TRUE(response.measures);
  EXPECT_EQ(response.measures->length_m, 7.0);
  EXPECT_EQ(response.measures->largest_turn_acceleration_rad_per_s2, 8.0);
  EXPECT_EQ(response.measures->clearance_lower_bound_m, 9.0);
  EXPECT_EQ(response.near_scale, 0.75);
  EXPECT_EQ(response.time_scale, 1.25);
  EXPECT_TRUE(response.deadline_reached);
}

TEST(PlanCollector, ReadsFaultsOfKeyframes) {
  std::vector<plan_response_t> pages = answer_pages(wire_request(), 2, 1);
  keyframe_fault_t fault{};
  fault.keyframe = 4;
  fault.depth_m = 0.5;
  fault.has_free_pose = 1;
  fault.free_position_m[2] = 3.0;
  fault.free_orientation_wxyz[0] = 1.0;
  pages[1].keyframe_faults = {fault, keyframe_fault_t{}};
  pages[1].num_keyframe_faults = 2;
  const PlanResponse response = response_of(pages);
  ASSERT_EQ(response.keyframe_faults.size(), 2u);
  EXPECT_EQ(response.keyframe_faults[0].keyframe, 4);
  EXPECT_EQ(response.keyframe_faults[0].depth_m, 0.5);
  ASSERT_TRUE(response.keyframe_faults[0].free_pose);
  EXPECT_EQ(response.keyframe_faults[0].free_pose->position_m[2], 3.0);
  EXPECT_FALSE(response.keyframe_faults[1].free_pose);
}

TEST(PlanCollector, ReadsTheProofThatThereIsNoPathOverAllPages) {
  std::vector<plan_response_t> pages = answer_pages(wire_request(), 2, 1);
  for (plan_response_t& page : pages) {
    page.has_infeasibility = 1;
    page.keyframe_inside = 3;
    page.keyframe_outside = 1;
    page.has_cage = 1;
    page.proof_cage.orientation_wxyz[3] = 1.0;
    page.proof_cage.min_m[1] = 2.0;
    page.proof_cage.max_m[2] = 3.0;
    page.proof_cage.widest_hole_m = 0.0625;
    page.proof_cage.shortest_chord_m = 0.25;
  }
  pages[0].proof_triangles = {2, 4};
  pages[0].num_proof_triangles = 2;
  pages[1].proof_triangles = {6};
  pages[1].num_proof_triangles = 1;
  const PlanResponse response = response_of(pages);
  ASSERT_TRUE(response.infeasibility);
  EXPECT_EQ(response.infeasibility->keyframe_inside, 3);
  EXPECT_EQ(response.infeasibility->keyframe_outside, 1);
  EXPECT_EQ(response.infeasibility->triangles, (std::vector<std::int32_t>{2, 4, 6}));
  ASSERT_TRUE(response.infeasibility->cage);
  EXPECT_EQ(response.infeasibility->cage->orientation_wxyz,
            (std::array<double, 4>{0.0, 0.0, 0.0, 1.0}));
  EXPECT_EQ(response.infeasibility->cage->min_m[1], 2.0);
  EXPECT_EQ(response.infeasibility->cage->max_m[2], 3.0);
  EXPECT_EQ(response.infeasibility->cage->widest_hole_m, 0.0625);
  EXPECT_EQ(response.infeasibility->cage->shortest_chord_m, 0.25);
}

TEST(PlanCollector, ReadsTheFrameWithTheImages) {
  plan_response_t page = answer_pages(wire_request(), 1, 1).at(0);
  page.keyframes.resize(1);
  page.num_keyframes = 1;
  page.keyframes[0].time_s = 2.5;
  page.keyframes[0].image[3] = 0.5;
  page.has_frame = 1;
  page.frame.reference_wxyz[2] = 1.0;
  page.frame.end.velocity_m_per_s[1] = 3.0;
  const auto read = [](const plan_response_t& answer) {
    PlanCollector collector("me", 7);
    collector.take(wire::encode(answer));
    return collector.response();
  };
  const PlanResponse response = read(page);
  ASSERT_TRUE(response.frame);
  EXPECT_EQ(response.frame->reference_wxyz[2], 1.0);
  EXPECT_EQ(response.frame->end.velocity_m_per_s[1], 3.0);
  EXPECT_EQ(response.keyframes.at(0).again().time_s, 2.5);
  EXPECT_EQ(response.keyframes.at(0).again().image[3], 0.5);
  page.has_frame = 0;
  EXPECT_FALSE(read(page).frame);
}

TEST(PlanCollector, IsNotCompleteWhileAPageIsMissing) {
  const std::vector<Bytes> pages = encode_all(answer_pages(wire_request(), 100, 10));
  for (std::size_t missing = 0; missing < pages.size(); ++missing) {
    PlanCollector collector("me", 7);
    for (std::size_t i = 0; i < pages.size(); ++i) {
      if (i != missing) collector.take(pages[i]);
    }
    EXPECT_FALSE(collector.complete());
    EXPECT_EQ(collector.take(pages[missing]), PlanCollector::Taken::kNew);
    EXPECT_EQ(collector.take(pages[missing]), PlanCollector::Taken::kKnown);
    EXPECT_TRUE(collector.complete());
  }
}

TEST(PlanCollector, LeavesWhatIsForOthers) {
  PlanCollector collector("me", 7);
  plan_request_t other = wire_request();
  other.request_id = 8;
  EXPECT_EQ(collector.take(encode_all(answer_pages(other, 1, 1))[0]),
            PlanCollector::Taken::kForeign);
  other = wire_request();
  other.client_id = "you";
  EXPECT_EQ(collector.take(encode_all(answer_pages(other, 1, 1))[0]),
            PlanCollector::Taken::kForeign);
  EXPECT_EQ(collector.pages().held(), 0u);
}

TEST(PlanCollector, DoesNotMixPagesOfTwoAnswers) {
  std::vector<plan_response_t> first = answer_pages(wire_request(), 20, 10);
  std::vector<plan_response_t> second = answer_pages(wire_request(), 20, 10);
  for (plan_response_t& page : second) page.utime = 2;  // the daemon was restarted
  PlanCollector collector("me", 7);
  collector.take(wire::encode(first[0]));
  collector.take(wire::encode(second[1]));
  EXPECT_FALSE(collector.complete());
  EXPECT_EQ(collector.pages().held(), 1u);
  collector.take(wire::encode(second[0]));
  EXPECT_TRUE(collector.complete());
}

TEST(PlanCollector, SurvivesBrokenMessages) {
  SCOPED_TRACE(::testing::Message() << "seed " << kPlanPagesSeed);
  testing::Random random(kPlanPagesSeed);
  const Bytes good = encode_all(answer_pages(wire_request(), 3, 3))[0];
  std::uniform_int_distribution<std::size_t> position(0, good.size() - 1);
  std::uniform_int_distribution<int> byte(0, 255);
  int bad = 0;
  for (int round = 0; round < 20'000; ++round) {
    Bytes bytes = good;
    for (int i = 0; i <= round % 4; ++i) {
      bytes[position(random)] = static_cast<std::uint8_t>(byte(random));
    }
    if (round % 3 == 0) bytes.resize(position(random));
    PlanCollector collector("me", 7);
    bad += collector.take(bytes) == PlanCollector::Taken::kBad ? 1 : 0;
    if (collector.complete()) static_cast<void>(collector.response());
  }
  EXPECT_GT(bad, 20'000 / 3);  // all that are cut short, at least
}

TEST(PlanCollector, RefusesPageNumbersOutOfRange) {
  for (const auto& [page, num_pages] :
       {std::pair{-1, 1}, {1, 1}, {0, 0}, {0, -1}, {0, wire::kMaxResponsePages + 1}}) {
    plan_response_t message = answer_pages(wire_request(), 1, 1)[0];
    message.page = page;
    message.num_pages = num_pages;
    PlanCollector collector("me", 7);
    EXPECT_EQ(collector.take(wire::encode(message)), PlanCollector::Taken::kBad);
    EXPECT_THAT(collector.fault(), HasSubstr(num_pages == 1 ? "plan_response_t.page: "
                                                            : "plan_response_t.num_pages: "));
  }
}

/// Returns the response to one page of three segments after `damage` was applied to it.
template <class Damage>
PlanResponse damaged(Damage damage) {
  plan_response_t page = answer_pages(wire_request(), 3, 3)[0];
  damage(page);
  PlanCollector collector("me", 7);
  collector.take(wire::encode(page));
  return collector.response();
}

TEST(PlanCollector, RefusesAPathThatIsNone) {
  const auto refused = [](const PlanResponse& response, const std::string& text) {
    EXPECT_EQ(response.status, Status::kBadAnswer);
    EXPECT_THAT(response.error, HasSubstr(text));
    EXPECT_TRUE(response.path.empty());
  };
  refused(damaged([](auto& p) { p.segments[1].t0_s = 1.5; }), "does not begin where");
  refused(damaged([](auto& p) { p.segments[1].t1_s = 1.0; }), "does not end after");
  refused(damaged([](auto& p) { p.segments[2].position_m[3][1] = NAN; }), "not finite");
  refused(damaged([](auto& p) { p.segments[0].orientation_wxyz[6][3] = INFINITY; }), "not finite");
  refused(damaged([](auto& p) { p.status = 77; }), "status 77");
  refused(damaged([](auto& p) {
            p.corrections.resize(1);
            p.num_corrections = 1;
            p.corrections[0].method = 5;
          }),
          "a correction by method 5");
  refused(damaged([](auto& p) {
            p.segments.clear();
            p.num_segments = 0;
          }),
          "ok without a path");
  EXPECT_TRUE(damaged([](auto&) {}).ok());
}

}  // namespace
}  // namespace camway
