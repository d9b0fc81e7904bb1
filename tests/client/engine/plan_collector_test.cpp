// SPDX-License-Identifier: MIT
#include "client/engine/plan_collector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include <camway/plan_request_t.hpp>

#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/layout.h"
#include "tests/client/fake_daemon.h"
#include "tests/support/random.h"

namespace camway {
namespace {

using ::testing::HasSubstr;
using testing_support::answer_pages;
using testing_support::encode_all;
using wire::Bytes;

constexpr std::uint32_t kCollectorSeed = 1995;

plan_request_t wire_request() {
  plan_request_t request{};
  request.client_id = "me";
  request.request_id = 7;
  request.scene = "office";
  return request;
}

TEST(PlanCollector, PutsPagesTogetherInAnyOrderWithRepetitions) {
  testing::Random random(kCollectorSeed);
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
    page.viewing_distance_m = 4.5;
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
  EXPECT_EQ(response.viewing_distance_m, 4.5);
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
  SCOPED_TRACE(::testing::Message() << "seed " << kCollectorSeed);
  testing::Random random(kCollectorSeed);
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
