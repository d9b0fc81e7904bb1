// SPDX-License-Identifier: MIT
// Answers that a deadline cut short at any place are true.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "daemon/planning/plan.h"
#include "daemon/planning/stages/path_check.h"
#include "tests/support/scenes.h"

namespace camway::planning {
namespace {

using base::Deadline;
using collision::CollisionInterval;
using geometry::Quat;
using ::testing::HasSubstr;

// Returns a row of posts in the way of a straight flight, to be passed one by one.
std::shared_ptr<const scene::Snapshot> posts(int count = 4) {
  scene::Mesh mesh;
  for (int i = 0; i < count; ++i)
    testing::add_cuboid(mesh, {2.0 * i + 0.9, -3, -0.15}, {2.0 * i + 1.1, 3, 0.0});
  return scene::make_snapshot("test", std::move(mesh)).snapshot;
}

PlanRequest flight(int posts = 4) {
  PlanRequest request;
  request.camera = testing::small_camera();
  request.has_times = true;
  for (int i = 0; i <= posts; ++i)
    request.keyframes.push_back({2.0 * i, {{2.0 * i, 0, 0}, Quat::Identity()}});
  return request;
}

/// Returns the fault of an answer, whenever it was cut short; empty if there is none.
std::string fault_in(const scene::Snapshot& snapshot, const PlanRequest& request,
                     const PlanResult& result) {
  if (result.path.empty()) {
    const bool says_so = result.status == Status::kTimeout && result.keyframes.empty() &&
                         result.message.find("no path was made") != std::string::npos;
    return says_so && !result.certificate.certified ? "" : "no path";
  }
  const motion::Body body(request.camera);
  const auto found = *collision::detect_collisions(
      {collision::Obstacles(snapshot), body, detect_options(request.options)}, result.path,
      result.path.begin_s(), result.path.end_s(), Deadline::never());
  if (result.certificate.certified && !found.empty()) return "certified, and collides";
  if (result.status == Status::kOk && !result.certificate.certified) return "ok without proof";
  if (result.certificate.certified && !result.remaining_collisions.empty())
    return "certified, and says that it collides";
  constexpr double kTolerance_s = 0.01 * 6.0;  // of a path that may have been slowed
  for (const CollisionInterval& collision : found) {
    const bool is_told =
        std::ranges::any_of(result.remaining_collisions, [&](const CollisionInterval& told) {
          return told.t_begin_s <= collision.t_begin_s + kTolerance_s &&
                 collision.t_end_s <= told.t_end_s + kTolerance_s;
        });
    if (!is_told) return "hides a collision";
  }
  const auto inserted = std::ranges::count(result.keyframes, motion::KeyframeOrigin::kInserted,
                                           &motion::Keyframe::origin);
  const bool any_corrected = std::ranges::any_of(result.corrections, [](const auto& correction) {
    return correction.kind != correction::CorrectionKind::kNone;
  });
  if (inserted > 0 && !any_corrected) return "keyframes of no correction";
  const auto meets_keyframe = [&](const motion::Keyframe& keyframe) {
    constexpr double kRounding_m = 1e-9;  // that of coordinates up to 600 m is below 1e-12
    return (result.path.pose(keyframe.time_s).position - keyframe.pose.position).norm() <
           kRounding_m;
  };
  if (!std::ranges::all_of(result.keyframes, meets_keyframe)) return "misses a keyframe";
  return {};
}

bool are_same(const PlanResult& a, const PlanResult& b) {
  const auto same_segment = [](const motion::Segment& s, const motion::Segment& t) {
    return s.t0_s == t.t0_s && s.t1_s == t.t1_s && s.position == t.position &&
           s.orientation == t.orientation;
  };
  return a.status == b.status && a.message == b.message && a.time_scale == b.time_scale &&
         std::ranges::equal(a.path.segments(), b.path.segments(), same_segment) &&
         a.collisions == b.collisions && a.remaining_collisions == b.remaining_collisions &&
         a.certificate.clearance_lower_bound_m == b.certificate.clearance_lower_bound_m;
}

/// Plans with deadlines after a growing number of checks of the deadline, until planning completes.
/// An answer without deadline_reached must equal that without a deadline.
template <class Visit>
void for_each_cut(const scene::Snapshot& snapshot, const PlanRequest& request, const Visit& visit) {
  const PlanResult whole = plan(snapshot, request, Deadline::never());
  EXPECT_FALSE(whole.deadline_reached);
  for (int looks = 0;; looks += 1 + looks / 16) {
    const Deadline deadline = Deadline::after_looks(looks);
    const PlanResult result = plan(snapshot, request, deadline);
    EXPECT_EQ(fault_in(snapshot, request, result), "")
        << "after " << looks << " looks: " << result.message;
    EXPECT_TRUE(result.deadline_reached || are_same(result, whole)) << "after " << looks;
    visit(result);
    if (!result.deadline_reached) break;
    ASSERT_LT(looks, 1'000'000);
  }
}

TEST(PlanDeadline, WhatIsSaidIsTrueWhereverItStrikes) {
  const auto snapshot = posts();
  std::set<std::size_t> left;
  std::set<Status> statuses;
  for_each_cut(*snapshot, flight(), [&](const PlanResult& result) {
    statuses.insert(result.status);
    if (result.status == Status::kTimeout) left.insert(result.remaining_collisions.size());
  });
  EXPECT_EQ(statuses, (std::set<Status>{Status::kOk, Status::kTimeout}));
  EXPECT_TRUE(left.contains(4)) << "nothing was corrected yet";
  EXPECT_TRUE(left.contains(2)) << "what was corrected by then was kept";
}

// Each keyframe is in an open hall; the camera passes the door between them only if it turns.
TEST(PlanDeadline, ASearchThatItEndsSaysNothingOfWhereItBegan) {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-4, -0.1, 0}, {0, 0.1, 3});
  testing::add_cuboid(mesh, {1, -0.1, 0}, {4, 0.1, 3});
  testing::add_cuboid(mesh, {0, -0.1, 2}, {1, 0.1, 3});
  for (const double side : {-1.0, 1.0}) {
    testing::add_cuboid(mesh, {side * 4 - 0.1, -4, 0}, {side * 4 + 0.1, 4, 3});
    testing::add_cuboid(mesh, {-4, side * 4 - 0.1, 0}, {4, side * 4 + 0.1, 3});
  }
  testing::add_cuboid(mesh, {-4, -4, -0.1}, {4, 4, 0});
  testing::add_cuboid(mesh, {-4, -4, 3}, {4, 4, 3.1});
  const auto snapshot = scene::make_snapshot("test", std::move(mesh)).snapshot;
  PlanRequest request;
  request.camera = {.fov_x_rad = 1.745, .fov_y_rad = 0.698, .near_m = 0.59};
  for (const double y_m : {-2.0, 2.0}) {
    request.keyframes.push_back({0.0, {{0.3, y_m, 1.2}, Quat::Identity()}});
  }
  int timeouts = 0;
  for (int looks = 10; looks < 20'000; looks += looks / 3) {
    const PlanResult result = plan(*snapshot, request, Deadline::after_looks(looks));
    if (result.status != Status::kTimeout) continue;
    ++timeouts;
    EXPECT_THAT(result.message, ::testing::Not(HasSubstr("no search found"))) << looks;
  }
  EXPECT_GT(timeouts, 3);
}

// There are more stretches to check than checks of the deadline that are kept for that at least.
TEST(PlanDeadline, WhatWasNotCheckedIsPutBack) {
  constexpr int kPosts = 40;
  const auto snapshot = posts(kPosts);
  std::set<std::ptrdiff_t> kept;
  for (int looks = 100; looks <= 600; looks += 25) {
    const PlanResult result = plan(*snapshot, flight(kPosts), Deadline::after_looks(looks));
    EXPECT_EQ(fault_in(*snapshot, flight(kPosts), result), "") << looks << ": " << result.message;
    if (result.collisions.empty()) continue;  // it struck before they were searched for
    const auto corrected = std::ranges::count_if(result.corrections, [](const auto& correction) {
      return correction.kind != correction::CorrectionKind::kNone;
    });
    // A collision whose correction was undone does not count as corrected.
    EXPECT_EQ(std::ssize(result.remaining_collisions), kPosts - corrected) << looks;
    kept.insert(corrected);
  }
  EXPECT_GT(kept.size(), 2u);
}

// There are so many keyframes that checking them, interpolation and measuring take longer than the
// deadline.
TEST(PlanDeadline, IsKeptHoweverManyKeyframesThereAre) {
  constexpr int kKeyframes = 10'000;
  const auto snapshot = posts(100);
  const PlanRequest request = flight(kKeyframes - 1);
  std::set<bool> any_path;
  for (const int looks : {5, 20, 60, 100}) {
    const Deadline deadline = Deadline::after_looks(looks);
    const PlanResult result = plan(*snapshot, request, deadline);
    EXPECT_EQ(result.status, Status::kTimeout);
    EXPECT_TRUE(result.deadline_reached);
    EXPECT_FALSE(result.certificate.certified);
    EXPECT_EQ(fault_in(*snapshot, request, result), "");
    EXPECT_FALSE(result.measures) << "which takes time, too";
    constexpr int kLooksAfterwards = 20;  // each is a millisecond
    EXPECT_LT(deadline.elapsed_ms(), looks + kLooksAfterwards);
    any_path.insert(!result.path.empty());
  }
  EXPECT_EQ(any_path, (std::set<bool>{false, true}));
}

TEST(PlanDeadline, HoldsForThePapersMethod) {
  const auto snapshot = posts();
  PlanRequest request = flight();
  request.options.method = Method::kKeyframeInsertion;
  for_each_cut(*snapshot, request, [](const PlanResult&) {});
}

TEST(PlanDeadline, AFreePathThatWasNotSlowedInTimeSaysSo) {
  // There are so many keyframes that the least time for slowing is not enough.
  PlanRequest request = flight();
  for (int i = 5; i <= 300; ++i)
    request.keyframes.push_back({2.0 * i, {{2.0 * i, 0, 0}, Quat::Identity()}});
  request.options.limits.speed_m_per_s = 0.5;
  request.options.limits.may_retime = true;
  const auto snapshot = scene::make_snapshot("test", scene::Mesh{}).snapshot;
  int unslowed = 0;
  for_each_cut(*snapshot, request, [&](const PlanResult& result) {
    if (result.status == Status::kOk) {
      EXPECT_GT(result.time_scale, 1.9);
    }
    if (!result.certificate.certified || result.status == Status::kOk) return;
    ++unslowed;
    EXPECT_EQ(result.status, Status::kTimeout);
    EXPECT_EQ(result.time_scale, 1.0);
    EXPECT_THAT(result.message, HasSubstr("options.limits: the path is free, but too fast"));
  });
  EXPECT_GT(unslowed, 0);
}

/// With little time, a shorter way or fewer keyframes are not searched.
TEST(PlanDeadline, APathThatIsNotImprovedToTheEndSaysSo) {
  int unimproved = 0;
  for_each_cut(*posts(), flight(), [&](const PlanResult& result) {
    if (result.status != Status::kOk || !result.deadline_reached) return;
    ++unimproved;
    EXPECT_THAT(result.message, HasSubstr(" s was reached before it was improved to the end"));
  });
  EXPECT_GT(unimproved, 0);
}

}  // namespace
}  // namespace camway::planning
