// SPDX-License-Identifier: MIT
// Answers that the deadline cut short, at any place: what they say is true.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "daemon/planning/check.h"
#include "daemon/planning/plan.h"
#include "tests/support/scenes.h"

namespace camway::planning {
namespace {

using collision::CollisionInterval;
using collision::Deadline;
using geometry::Quat;
using ::testing::HasSubstr;

// A row of posts in the way of a straight flight, to be passed one by one.
std::shared_ptr<const scene::Snapshot> posts() {
  scene::Mesh mesh;
  for (int i = 0; i < 4; ++i)
    testing::add_cuboid(mesh, {2.0 * i + 0.9, -3, -0.15}, {2.0 * i + 1.1, 3, 0.0});
  return scene::make_snapshot("test", std::move(mesh)).snapshot;
}

PlanRequest flight() {
  PlanRequest request;
  request.camera = testing::small_camera();
  request.has_times = true;
  for (int i = 0; i <= 4; ++i)
    request.keyframes.push_back({2.0 * i, {{2.0 * i, 0, 0}, Quat::Identity()}});
  return request;
}

/// What is wrong with an answer, whenever it was cut short; empty if nothing is.
std::string fault_in(const scene::Snapshot& snapshot, const PlanRequest& request,
                     const PlanResult& result) {
  if (result.path.empty()) return "no path";
  const motion::Body body(request.camera);
  const auto found = *collision::detect_collisions(
      collision::Obstacles(snapshot), result.path, body, result.path.begin_s(), result.path.end_s(),
      detect_options(request.options), Deadline::never());
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
    return correction.rung != correction::Rung::kNone;
  });
  if (inserted > 0 && !any_corrected) return "keyframes of no correction";
  const auto meets_keyframe = [&](const motion::Keyframe& keyframe) {
    return (result.path.pose(keyframe.time_s).position - keyframe.pose.position).norm() < 1e-9;
  };
  if (!std::ranges::all_of(result.keyframes, meets_keyframe)) return "misses a keyframe";
  return {};
}

/// Plans with deadlines that strike at every so many looks, until one does not any more.
template <class Visit>
void for_each_cut(const scene::Snapshot& snapshot, const PlanRequest& request, const Visit& visit) {
  for (int looks = 0;; looks += 1 + looks / 16) {
    const Deadline deadline = Deadline::after_looks(looks);
    const PlanResult result = plan(snapshot, request, deadline);
    EXPECT_EQ(fault_in(snapshot, request, result), "")
        << "after " << looks << " looks: " << result.message;
    visit(result);
    if (!deadline.passed()) break;
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

TEST(PlanDeadline, OfTheSeedsMethodToo) {
  const auto snapshot = posts();
  PlanRequest request = flight();
  request.options.method = Method::kKeyframeInsertion;
  for_each_cut(*snapshot, request, [](const PlanResult&) {});
}

TEST(PlanDeadline, AFreePathThatWasNotSlowedInTimeSaysSo) {
  PlanRequest request = flight();
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
  RecordProperty("unslowed", unslowed);
}

}  // namespace
}  // namespace camway::planning
