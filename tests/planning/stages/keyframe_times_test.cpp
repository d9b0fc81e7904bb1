// SPDX-License-Identifier: MIT
// Times as robots send them: far from 0, and nearly but not exactly equidistant.
#include "daemon/planning/stages/keyframe_times.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "daemon/motion/spline/knot_row.h"
#include "daemon/planning/plan.h"
#include "daemon/planning/request/validate.h"
#include "tests/planning/plan_fixture.h"
#include "tests/support/path_continuity.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace camway::planning {
namespace {

using geometry::Quat;
using geometry::Vec3;
using motion::Keyframe;
using motion::KeyframeOrigin;
using testing_plan::planned;

constexpr int kCells = 5;  // in a row of columns, 2 m apart

std::shared_ptr<const scene::Snapshot> columns(double scale = 1.0) {
  scene::Mesh mesh;
  for (int i = 0; i < kCells; ++i) {
    for (int k = 0; k < kCells; ++k) {
      testing::add_cuboid(mesh, scale * Vec3(2.0 * i - 0.3, -3, 2.0 * k - 0.3),
                          scale * Vec3(2.0 * i + 0.3, 3, 2.0 * k + 0.3));
    }
  }
  return scene::make_snapshot("test", std::move(mesh)).snapshot;
}

/// Returns a tour between columns, mostly through some, with rotations about the vertical and
/// without times.
PlanRequest tour(testing::Random& random) {
  const auto draw = [&](std::uint64_t count) { return static_cast<double>(random() % count); };
  PlanRequest request;
  request.camera = testing::small_camera();
  request.has_times = true;
  const int count = 3 + static_cast<int>(draw(3));
  for (int i = 0; i < count; ++i) {
    const Vec3 place(1.0 + 2.0 * draw(kCells - 1), 0.1 * draw(5), 1.0 + 2.0 * draw(kCells - 1));
    request.keyframes.push_back({0.0, {place, Quat(Eigen::AngleAxisd(draw(6), Vec3::UnitY()))}});
  }
  return request;
}

void set_times(PlanRequest& request, double first_s, double gap_s) {
  for (std::size_t i = 0; i < request.keyframes.size(); ++i)
    request.keyframes[i].time_s = first_s + static_cast<double>(i) * gap_s;
}

double keyframe_miss(const PlanRequest& request, const PlanResult& result) {
  double worst = 0.0;
  for (const Keyframe& keyframe : request.keyframes) {
    const motion::Pose pose = result.path.pose(keyframe.time_s);
    worst = std::max({worst, (pose.position - keyframe.pose.position).norm(),
                      pose.orientation.angularDistance(keyframe.pose.orientation)});
  }
  return worst;
}

/// Expects the given times, with the same bits, in the given keyframes and at ends of segments.
void expect_given_times(const PlanRequest& request, const PlanResult& result) {
  std::vector<double> given_s;
  for (const Keyframe& keyframe : result.keyframes) {
    if (keyframe.origin == KeyframeOrigin::kGiven) given_s.push_back(keyframe.time_s);
  }
  std::set<double> ends_s = {result.path.begin_s()};
  for (const motion::Segment& segment : result.path.segments()) ends_s.insert(segment.t1_s);
  std::vector<double> asked_s;
  for (const Keyframe& keyframe : request.keyframes) {
    asked_s.push_back(keyframe.time_s);
    EXPECT_TRUE(ends_s.contains(keyframe.time_s));
  }
  EXPECT_EQ(given_s, asked_s);
  EXPECT_EQ(result.path.begin_s(), asked_s.front());
  EXPECT_EQ(result.path.end_s(), asked_s.back());
}

/// Expects each time of the answer within the path.
void expect_times_within(const PlanResult& result) {
  const auto within = [&](double time_s) {
    return result.path.begin_s() <= time_s && time_s <= result.path.end_s();
  };
  for (const Keyframe& keyframe : result.keyframes) EXPECT_TRUE(within(keyframe.time_s));
  for (const auto* list : {&result.collisions, &result.remaining_collisions}) {
    for (const collision::CollisionInterval& interval : *list) {
      EXPECT_TRUE(within(interval.t_begin_s) && within(interval.t_end_s));
      if (!interval.witness) continue;
      EXPECT_LE(interval.t_begin_s, interval.witness->time_s);
      EXPECT_GE(interval.t_end_s, interval.witness->time_s);
    }
  }
  for (const correction::Correction& correction : result.corrections) {
    EXPECT_TRUE(within(correction.interval.t_begin_s) && within(correction.interval.t_end_s));
    if (correction.kind == correction::CorrectionKind::kNone) continue;
    EXPECT_TRUE(within(correction.t_begin_s) && within(correction.t_end_s));
  }
  for (const SlowedStretch& stretch : result.slowed)
    EXPECT_TRUE(within(stretch.t_begin_s) && within(stretch.t_end_s));
}

/// Returns the largest error of accelerations from the rounding of control points, relative to the
/// largest acceleration.
double acceleration_noise(const PlanResult& result) {
  double noise = 0.0;
  for (const motion::Segment& segment : result.path.segments()) {
    const double duration_s = segment.t1_s - segment.t0_s;
    for (const Vec3& point : segment.position) {
      const double rounding_m = 4.0 * 2.220446049250313e-16 * point.cwiseAbs().maxCoeff();
      noise = std::max(noise, 24.0 * rounding_m / duration_s / duration_s);
    }
  }
  return noise / result.measures->largest_acceleration_m_per_s2;
}

struct Tally {
  int corrected = 0;
  double jump = 0.0;
  double shortest_share = 1.0;  ///< shortest segment divided by its interval
};

void look_at(const PlanRequest& request, const PlanResult& result, double gap_s, Tally& tally) {
  ASSERT_EQ(result.status, Status::kOk) << result.message;
  expect_given_times(request, result);
  expect_times_within(result);
  EXPECT_LT(keyframe_miss(request, result), 1e-9);
  EXPECT_LT(acceleration_noise(result), motion::kAccelerationNoise);
  const testing::Jumps jumps = testing::jumps_of(result.path.segments());
  EXPECT_LE(jumps.largest(), 1.0) << jumps.value << ' ' << jumps.first << ' ' << jumps.second;
  tally.jump = std::max(tally.jump, jumps.largest());
  tally.shortest_share =
      std::min(tally.shortest_share, testing::shortest_s(result.path.segments()) / gap_s);
  if (!result.collisions.empty()) ++tally.corrected;
}

TEST(KeyframeTimes, PathsAreSmoothWhereverTimeBegins) {
  const auto scene = columns();
  for (const double first_s : {0.0, 0.1, -7.7, 1e3, 1e5, 1e7, 1.76e9, 2147483640.3, 4e9, -1.76e9}) {
    testing::Random random(71);
    Tally tally;
    for (const double gap_s : {2.1, 3.33, 0.05}) {
      for (int run = 0; run < 3; ++run) {
        SCOPED_TRACE(::testing::Message() << "from " << first_s << " by " << gap_s << ", " << run);
        PlanRequest request = tour(random);
        set_times(request, first_s, gap_s);
        look_at(request, planned(*scene, request), gap_s, tally);
      }
    }
    EXPECT_GE(tally.corrected, 6);
    EXPECT_GT(tally.shortest_share, 1e-6);
  }
}

// Times as other clocks and sums of floats make them.
TEST(KeyframeTimes, NearlyEqualGapsMakeNoShortSegments) {
  const auto scene = columns();
  for (const double jitter_s : {0.0, 1e-12, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6}) {
    testing::Random random(72);
    Tally tally;
    double even_sum = 0.0;
    double sum = 0.0;
    for (int run = 0; run < 6; ++run) {
      SCOPED_TRACE(::testing::Message() << "jitter " << jitter_s << ", " << run);
      PlanRequest request = tour(random);
      set_times(request, 0.0, 2.0);
      const PlanResult even = planned(*scene, request);
      for (Keyframe& keyframe : request.keyframes)
        keyframe.time_s += jitter_s * static_cast<double>(random() % 1000) / 1000.0;
      const PlanResult result = planned(*scene, request);
      look_at(request, result, 2.0, tally);
      even_sum += even.measures->largest_acceleration_m_per_s2;
      sum += result.measures->largest_acceleration_m_per_s2;
    }
    // A single search may have another result; the sums are about the same.
    EXPECT_LT(sum, 1.25 * even_sum) << jitter_s;
    EXPECT_GE(tally.corrected, 4);
    EXPECT_GT(tally.shortest_share, 1e-6);
  }
}

// The same request at another pace has the same curve; accelerations scale with the square.
TEST(KeyframeTimes, AnyScaleOfTimeWillDo) {
  const auto scene = columns();
  for (const double gap_s : {2e-4, 1e-3, 0.1, 100.0, 1e4}) {
    testing::Random random(73);
    Tally tally;
    double even_sum = 0.0;
    double sum = 0.0;
    for (int run = 0; run < 5; ++run) {
      SCOPED_TRACE(::testing::Message() << "gap " << gap_s << ", " << run);
      PlanRequest request = tour(random);
      set_times(request, 0.0, 1.0);
      const PlanResult even = planned(*scene, request);
      set_times(request, 1.76e9, gap_s);
      const PlanResult result = planned(*scene, request);
      const double scale = request.keyframes[1].time_s - request.keyframes[0].time_s;
      look_at(request, result, scale, tally);
      even_sum += even.measures->largest_acceleration_m_per_s2;
      sum += scale * scale * result.measures->largest_acceleration_m_per_s2;
    }
    // As above: a single search may have another result.
    EXPECT_LT(sum, 1.25 * even_sum) << gap_s;
    EXPECT_GE(tally.corrected, 3);
  }
}

// Where times are coarse, rows of many short steps could leave knots too near to one another for a
// request that holds them as keyframes. The answer then has no frame.
TEST(KeyframeTimes, FastPathsSince1970CanBePlannedAgain) {
  const auto scene = columns();
  testing::Random random(75);
  int corrected = 0;
  for (int run = 0; run < 12; ++run) {
    PlanRequest request = tour(random);
    for (const correction::Objective objective :
         {correction::Objective::kShortest, correction::Objective::kSmoothest,
          correction::Objective::kSafest}) {
      SCOPED_TRACE(run);
      request.options.objective = objective;
      set_times(request, 1.7e9, 0.02);
      const PlanResult result = planned(*scene, request);
      ASSERT_EQ(result.status, Status::kOk) << result.message;
      if (result.collisions.empty()) continue;
      ++corrected;
      EXPECT_TRUE(result.frame.has_value());
      for (std::size_t i = 1; i < result.keyframes.size(); ++i) {
        EXPECT_GE(result.keyframes[i].time_s - result.keyframes[i - 1].time_s,
                  kLeastRelativeTimeStep * 1.7e9);
      }
    }
  }
  EXPECT_GT(corrected, 20);
}

// Roundings grow with coordinates.
TEST(KeyframeTimes, PathsOfKilometresCanBePlannedAgain) {
  constexpr double kScale = 4000.0;
  const auto scene = columns(kScale);
  testing::Random random(76);
  int corrected = 0;
  for (int run = 0; run < 30; ++run) {
    PlanRequest request = tour(random);
    request.camera.near_m *= kScale;
    request.options.interval_tolerance_m *= kScale;
    for (Keyframe& keyframe : request.keyframes) keyframe.pose.position *= kScale;
    set_times(request, 0.0, 1.0);
    for (const correction::Objective objective :
         {correction::Objective::kClosest, correction::Objective::kSmoothest}) {
      SCOPED_TRACE(run);
      request.options.objective = objective;
      const PlanResult result = planned(*scene, request);
      ASSERT_EQ(result.status, Status::kOk) << result.message;
      if (result.collisions.empty()) continue;
      ++corrected;
      EXPECT_TRUE(result.frame.has_value());
    }
  }
  EXPECT_GT(corrected, 30);
}

/// Returns the answer with limits that the path breaks, slowed.
PlanRequest limited(const scene::Snapshot& scene, PlanRequest request) {
  const PlanResult free = planned(scene, request);
  EXPECT_EQ(free.status, Status::kOk) << free.message;
  request.options.limits.speed_m_per_s = 0.8 * free.measures->largest_speed_m_per_s;
  request.options.limits.acceleration_m_per_s2 = 0.8 * free.measures->largest_acceleration_m_per_s2;
  request.options.limits.may_retime = true;
  return request;
}

TEST(KeyframeTimes, SlowedPathsAreSmoothToo) {
  const auto scene = columns();
  for (const double first_s : {0.0, 1e5, 1.76e9, 4e9}) {
    testing::Random random(74);
    for (int run = 0; run < 5; ++run) {
      SCOPED_TRACE(::testing::Message() << "from " << first_s << ", " << run);
      PlanRequest request = tour(random);
      set_times(request, first_s, 2.1);
      const PlanResult result = planned(*scene, limited(*scene, request));
      ASSERT_EQ(result.status, Status::kOk) << result.message;
      EXPECT_GT(result.time_scale, 1.0);
      EXPECT_LT(result.time_scale, 1.6) << result.message;
      EXPECT_EQ(result.path.begin_s(), first_s);
      EXPECT_EQ(result.keyframes.back().time_s, result.path.end_s());
      expect_times_within(result);
      const testing::Jumps jumps = testing::jumps_of(result.path.segments());
      EXPECT_LE(jumps.largest(), 1.0) << jumps.value << ' ' << jumps.first << ' ' << jumps.second;
    }
  }
}

// A path that collides is slowed by one factor everywhere.
TEST(KeyframeTimes, CollidingPathsThatAreSlowedAreSmooth) {
  const auto scene = columns();
  for (const double first_s : {0.0, 1e5, 1.76e9, 4e9}) {
    testing::Random random(75);
    int colliding = 0;
    for (int run = 0; run < 6; ++run) {
      SCOPED_TRACE(::testing::Message() << "from " << first_s << ", " << run);
      PlanRequest request = tour(random);
      set_times(request, first_s, 2.1);
      request = limited(*scene, request);
      request.options.max_inserted_keyframes = 1;
      const PlanResult result = planned(*scene, request);
      if (result.remaining_collisions.empty()) continue;
      ++colliding;
      EXPECT_GT(result.time_scale, 1.0) << result.message;
      expect_times_within(result);
      const testing::Jumps jumps = testing::jumps_of(result.path.segments());
      EXPECT_LE(jumps.largest(), 1.0) << jumps.value << ' ' << jumps.first << ' ' << jumps.second;
    }
    EXPECT_GE(colliding, 2);
  }
}

TEST(KeyframeTimes, InsertionIsSmoothToo) {
  const auto scene = columns();
  testing::Random random(76);
  for (int run = 0; run < 6; ++run) {
    PlanRequest request = tour(random);
    set_times(request, 1.76e9, 2.1);
    request.options.method = Method::kKeyframeInsertion;
    const PlanResult result = planned(*scene, request);
    expect_given_times(request, result);
    expect_times_within(result);
    for (const Keyframe& keyframe : result.keyframes) {
      EXPECT_LT((result.path.pose(keyframe.time_s).position - keyframe.pose.position).norm(), 1e-9);
    }
    EXPECT_LE(testing::jumps_of(result.path.segments()).largest(), 1.0);
  }
}

TEST(KeyframeTimes, AreNamedAsTheSenderHasThem) {
  const auto scene = columns();
  testing::Random random(77);
  PlanRequest request = tour(random);
  set_times(request, 1.76e9, 2.1);
  request = limited(*scene, request);
  request.options.limits.may_retime = false;
  const PlanResult result = planned(*scene, request);
  EXPECT_EQ(result.status, Status::kPartial);
  EXPECT_THAT(result.message, ::testing::HasSubstr("too fast from 176000000"));
  EXPECT_EQ(time_text(1760000002.1), "1760000002.100");
  EXPECT_EQ(time_text(2.1), "2.1");
}

}  // namespace
}  // namespace camway::planning
