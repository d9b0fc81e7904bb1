// SPDX-License-Identifier: MIT
#include "tools/camway/replay/difference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "daemon/messages/plan.h"
#include "daemon/motion/spline/interpolate.h"

namespace camway::tools {
namespace {

constexpr motion::Camera kCamera{1.2, 0.9, 0.1};

motion::Body body() { return motion::Body(kCamera); }

planning::PlanResult result_through(const std::vector<motion::Keyframe>& keyframes) {
  planning::PlanResult result;
  result.status = planning::Status::kOk;
  result.keyframes = keyframes;
  result.path = motion::interpolate(keyframes);
  return result;
}

/// Compares with an answer that the log has as a message.
Difference difference_of(const planning::PlanResult& recorded, const planning::PlanResult& now,
                         const motion::Body& body) {
  return tools::difference_of(messages::to_wire(recorded, {}), now, body);
}

std::vector<motion::Keyframe> three_keyframes() {
  std::vector<motion::Keyframe> keyframes(3);
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    keyframes[i].time_s = static_cast<double>(i);
    keyframes[i].pose.position = {static_cast<double>(i * i), 0.5 * static_cast<double>(i), 1.0};
  }
  return keyframes;
}

TEST(Difference, FindsNothingBetweenEqualBits) {
  const planning::PlanResult result = result_through(three_keyframes());
  planning::PlanResult other = result;
  other.message = "in other words";
  other.timing.total_ms = 5;
  const Difference difference = difference_of(result, other, body());
  EXPECT_EQ(difference.path_m, 0.0);
  EXPECT_EQ(difference.what, "");
}

TEST(Difference, MeasuresAShiftedPath) {
  const planning::PlanResult a = result_through(three_keyframes());
  std::vector<motion::Keyframe> shifted = three_keyframes();
  for (motion::Keyframe& keyframe : shifted) keyframe.pose.position.z() += 0.25;
  const Difference difference = difference_of(a, result_through(shifted), body());
  // Interpolation is affine: the whole path moves by the same vector, up to rounding at metre
  // scale.
  EXPECT_NEAR(difference.path_m, 0.25, 1e-14);
  EXPECT_EQ(difference.what, "keyframes[0].position");
}

TEST(Difference, MeasuresATurnByTheCorners) {
  const planning::PlanResult a = result_through(three_keyframes());
  std::vector<motion::Keyframe> turned = three_keyframes();
  const double angle_rad = 0.1;
  for (motion::Keyframe& keyframe : turned) {
    keyframe.pose.orientation = Eigen::AngleAxisd(angle_rad, geometry::Vec3::UnitZ());
  }
  // In a rotation about the viewing axis a corner moves on a circle through the corners of the near
  // quadrilateral.
  const motion::Corners corners = motion::near_corners_C(kCamera);
  const double expected_m = 2 * corners[0].head<2>().norm() * std::sin(angle_rad / 2);
  EXPECT_NEAR(difference_of(a, result_through(turned), body()).path_m, expected_m, 1e-13);
}

TEST(Difference, SeesTheLastBitOfOneControlPoint) {
  const planning::PlanResult a = result_through(three_keyframes());
  planning::PlanResult b = a;
  std::vector<motion::Segment> segments(a.path.segments().begin(), a.path.segments().end());
  double& coordinate = segments[1].position[2].x();
  coordinate = std::nextafter(coordinate, 10.0);
  b.path = motion::Path(segments);
  const Difference difference = difference_of(a, b, body());
  EXPECT_GT(difference.path_m, 0.0);
  EXPECT_LT(difference.path_m, 1e-14);
  EXPECT_EQ(difference.what, "segments[1].position");
}

TEST(Difference, IsInfiniteWhereThereIsNoCommonTime) {
  const planning::PlanResult a = result_through(three_keyframes());
  planning::PlanResult none = a;
  none.path = {};
  EXPECT_TRUE(std::isinf(difference_of(a, none, body()).path_m));
  std::vector<motion::Keyframe> longer = three_keyframes();
  longer.back().time_s += 1.0;
  EXPECT_TRUE(std::isinf(difference_of(a, result_through(longer), body()).path_m));
  EXPECT_EQ(difference_of(none, none, body()).path_m, 0.0);
}

TEST(Difference, NamesWhatDiffersFirst) {
  const planning::PlanResult a = result_through(three_keyframes());
  planning::PlanResult b = a;
  b.remaining_collisions = {{0.25, 0.5}};
  EXPECT_EQ(difference_of(a, b, body()).what, "remaining_collisions 0 -> 1");
  b.status = planning::Status::kPartial;
  EXPECT_EQ(difference_of(a, b, body()).what, "status ok -> partial");
  b = a;
  b.certificate.clearance_lower_bound_m = 0.5;
  EXPECT_EQ(difference_of(a, b, body()).what, "certificate.clearance_lower_bound");
  b = a;
  b.keyframes[1].origin = motion::KeyframeOrigin::kInserted;
  EXPECT_EQ(difference_of(a, b, body()).what, "keyframes[1].origin");
  b = a;
  b.collisions = {{0.5, 0.5}};
  planning::PlanResult c = b;
  c.collisions = {{0.5, std::nextafter(0.5, 1.0)}};
  EXPECT_EQ(difference_of(b, c, body()).what, "collisions[0].t_end");
}

TEST(Difference, SeesAnotherWitness) {
  planning::PlanResult a = result_through(three_keyframes());
  a.collisions = {{0.25, 0.5, collision::Witness{0.375, 7, 2, 0.01, {1, 2, 3}}}};
  a.collision_names = {{"table", "edge 1"}};
  planning::PlanResult b = a;
  b.collisions[0].witness->feature = 0;
  EXPECT_EQ(difference_of(a, b, body()).what, "") << "answers hold the name alone";
  b.collision_names[0].feature = "edge 2";
  EXPECT_EQ(difference_of(a, b, body()).what, "collisions[0].witness.feature");
  b = a;
  b.collisions[0].witness->point_W.z() = 3.5;
  EXPECT_EQ(difference_of(a, b, body()).what, "collisions[0].witness.point");
  b.collisions[0].witness.reset();
  EXPECT_EQ(difference_of(a, b, body()).what, "collisions[0].witness");
}

/// Returns an answer with a value in each member that corrections and proofs have.
planning::PlanResult result_with_all() {
  planning::PlanResult result = result_through(three_keyframes());
  result.corrections.resize(1);
  result.corrections[0].interval = {0.25, 0.5, collision::Witness{}};
  result.measures = motion::PathMeasures{};
  result.measures_before = motion::PathMeasures{};
  result.keyframe_faults.resize(1);
  result.infeasibility = planning::Infeasibility{0, 1, {2, 3}, correction::CageBox{}};
  result.infeasibility->cage->box = geometry::Box(geometry::Vec3::Zero(), geometry::Vec3::Ones());
  return result;
}

TEST(Difference, SeesWhatCorrectionDid) {
  const planning::PlanResult a = result_with_all();
  const auto difference_after = [&](const auto& edit) {
    planning::PlanResult b = a;
    edit(b);
    return difference_of(a, b, body()).what;
  };
  using Result = planning::PlanResult;
  EXPECT_EQ(difference_after([](Result& b) { b.corrections[0].interval.witness.reset(); }), "")
      << "it stands with the collision";
  EXPECT_EQ(difference_after([](Result& b) { b.corrections.clear(); }), "corrections 1 -> 0");
  EXPECT_EQ(difference_after([](Result& b) { b.corrections[0].interval.t_end_s = 0.75; }),
            "corrections[0].t_end");
  EXPECT_EQ(difference_after(
                [](Result& b) { b.corrections[0].kind = correction::CorrectionKind::kTurn; }),
            "corrections[0].kind");
  EXPECT_EQ(difference_after([](Result& b) { b.corrections[0].t_begin_s = -0.0; }),
            "corrections[0].changed");
  EXPECT_EQ(difference_after([](Result& b) { b.corrections[0].t_end_s = 1.0; }),
            "corrections[0].changed");
  EXPECT_EQ(difference_after([](Result& b) { b.corrections[0].moved_m = 1.0; }),
            "corrections[0].moved_m");
  EXPECT_EQ(difference_after([](Result& b) { b.corrections[0].turned_rad = 1.0; }),
            "corrections[0].turned_deg");
  EXPECT_EQ(difference_after([](Result& b) { b.measures->length_m = 1.0; }),
            "measures.after.length_m");
  EXPECT_EQ(difference_after([](Result& b) { b.measures_before.reset(); }), "measures.before");
  EXPECT_EQ(difference_after([](Result& b) { b.bounds.min_W.y() = 0.5; }), "bounds");
  EXPECT_EQ(difference_after([](Result& b) { b.near_scale = 0.5; }), "near_scale");
  EXPECT_EQ(difference_after([](Result& b) { b.time_scale = 2.0; }), "time_scale");
  EXPECT_EQ(difference_after([](Result& b) { b.slowed.resize(1); }), "slowed 0 -> 1");
  EXPECT_EQ(difference_after([](Result& b) { b.keyframe_faults[0].depth_m = 1.0; }),
            "keyframe_faults[0].depth_m");
  EXPECT_EQ(difference_after([](Result& b) { b.keyframe_faults[0].free_pose.emplace(); }),
            "keyframe_faults[0].free_pose");
  EXPECT_EQ(difference_after([](Result& b) { b.infeasibility->triangles[1] = 4; }),
            "infeasibility.triangles[1]");
  EXPECT_EQ(difference_after([](Result& b) { b.infeasibility.reset(); }), "infeasibility");
}

TEST(Difference, SeesAnotherCage) {
  const planning::PlanResult a = result_with_all();
  const auto cage_difference_after = [&](const auto& edit) {
    planning::PlanResult b = a;
    edit(b.infeasibility->cage);
    return difference_of(a, b, body()).what;
  };
  using Cage = std::optional<correction::CageBox>;
  const std::string cage = "infeasibility.cage";
  EXPECT_EQ(cage_difference_after([](Cage&) {}), "");
  EXPECT_EQ(cage_difference_after([](Cage& its) { its.reset(); }), cage);
  EXPECT_EQ(cage_difference_after([](Cage& its) { its->box.max().y() = 2.0; }), cage + ".max");
  EXPECT_EQ(cage_difference_after([](Cage& its) { its->box.min().z() = -0.0; }), cage + ".min");
  EXPECT_EQ(cage_difference_after([](Cage& its) { its->orientation.x() = 1.0; }),
            cage + ".orientation");
  EXPECT_EQ(cage_difference_after([](Cage& its) { its->widest_hole_m = 1.0; }),
            cage + ".widest_hole_m");
  EXPECT_EQ(cage_difference_after([](Cage& its) { its->shortest_chord_m = 1.0; }),
            cage + ".shortest_chord_m");
}

TEST(Difference, MeasuresATurnByTheCornersOfAnyBody) {
  const planning::PlanResult a = result_through(three_keyframes());
  std::vector<motion::Keyframe> turned = three_keyframes();
  for (motion::Keyframe& keyframe : turned) {
    keyframe.pose.orientation = Eigen::AngleAxisd(std::numbers::pi, geometry::Vec3::UnitZ());
  }
  const auto rod = motion::Body::make(motion::ConvexShape{{{{2, 0, 0}, {0, 0, 5}}}});
  ASSERT_TRUE(rod) << rod.error;
  EXPECT_NEAR(difference_of(a, result_through(turned), *rod).path_m, 4.0, 1e-13);
}

}  // namespace
}  // namespace camway::tools
