// SPDX-License-Identifier: MIT
// The ladder under each orientation policy, on scenes in which the camera has to turn.
#include <gtest/gtest.h>

#include "daemon/collision/detect.h"
#include "daemon/correction/ladder/ladder.h"
#include "daemon/motion/spline/interpolate.h"
#include "tests/support/orientation_oracle.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace camway::correction {
namespace {

using base::Deadline;
using collision::CollisionInterval;
using geometry::Quat;
using geometry::Vec3;
using motion::CubicPath;
using motion::Keyframe;
using scene::Mesh;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kFar = 60.0;

struct PolicyCase {
  Mesh mesh;
  motion::Body body{testing::small_camera()};
  std::vector<Keyframe> keyframes;
};

struct Outcome {
  LadderResult result;
  CubicPath before;
  bool is_free;
  double breach_deg;
  double turned_deg;
};

Outcome corrected(const PolicyCase& c, const OrientationPolicy& policy, Objective objective) {
  const scene::SceneIndex index = scene::SceneIndex::build(c.mesh);
  const collision::Query query{collision::Obstacles(index), c.body};
  LadderOptions options;
  options.max_inserted_keyframes = 200;
  options.orientation = policy;
  options.objective = objective;
  const CubicPath before = motion::interpolate_cubic(c.keyframes);
  const auto collisions = [&](const CubicPath& path) {
    return collision::detect_collisions(query, path.path(), path.begin_s(), path.end_s(),
                                        Deadline::never())
        .value();
  };
  const std::vector<CollisionInterval> found = collisions(before);
  EXPECT_FALSE(found.empty()) << "nothing to correct";
  Outcome outcome{correct_by_ladder(std::make_shared<const scene::Mesh>(c.mesh), query, c.keyframes,
                                    before, found, options, Deadline::never()),
                  before, false, 0.0, 0.0};
  const motion::Path now = outcome.result.path.path();
  outcome.is_free = collisions(outcome.result.path).empty();
  outcome.breach_deg =
      testing::worst_breach_deg(policy, now, before.path(), before.begin_s(), before.end_s());
  outcome.turned_deg = testing::largest_turn_deg(now, before.path());
  return outcome;
}

void expect_free(const PolicyCase& c, const OrientationPolicy& policy,
                 Objective objective = Objective::kClosest) {
  const Outcome outcome = corrected(c, policy, objective);
  EXPECT_TRUE(outcome.is_free);
  EXPECT_LE(outcome.breach_deg, testing::kOracleRounding_deg);
}

void expect_stuck(const PolicyCase& c, const OrientationPolicy& policy) {
  const Outcome outcome = corrected(c, policy, Objective::kClosest);
  EXPECT_FALSE(outcome.is_free);
  EXPECT_LE(outcome.breach_deg, testing::kOracleRounding_deg);
}

OrientationPolicy limited(double max_turn_deg) {
  OrientationPolicy policy;
  policy.max_turn_rad = max_turn_deg * kDegree;
  return policy;
}

OrientationPolicy level(double max_turn_deg = 180.0) {
  OrientationPolicy policy = limited(std::min(max_turn_deg, 179.0));
  if (max_turn_deg >= 180.0) policy.max_turn_rad = std::numbers::pi;
  policy.rule = OrientationRule::kLevel;
  return policy;
}

OrientationPolicy towards(const Vec3& target_W, double cone_deg) {
  OrientationPolicy policy;
  policy.rule = OrientationRule::kTarget;
  policy.target_W = target_W;
  policy.cone_rad = cone_deg * kDegree;
  return policy;
}

OrientationPolicy keep() {
  OrientationPolicy policy;
  policy.rule = OrientationRule::kKeep;
  return policy;
}

motion::Body camera_of(double half_width_m, double half_height_m) {
  constexpr double kNear_m = 0.2;
  return motion::Body(motion::Camera{2.0 * std::atan(half_width_m / kNear_m),
                                     2.0 * std::atan(half_height_m / kNear_m), kNear_m});
}

Quat yawed_and_pitched(double yaw_deg, double pitch_deg) {
  return Eigen::AngleAxisd(yaw_deg * kDegree, Vec3::UnitY()) *
         Eigen::AngleAxisd(pitch_deg * kDegree, Vec3::UnitX());
}

// Returns a wall across z with an endless slit at `slant_deg` from the x axis. If it is thicker
// than the camera is wide, the whole camera has to fit at once.
Mesh wall_with_slit(double slant_deg, double half_width_m, double thickness_m) {
  Mesh mesh;
  testing::add_cuboid(mesh, {-kFar, half_width_m, -0.5 * thickness_m},
                      {kFar, kFar, 0.5 * thickness_m});
  testing::add_cuboid(mesh, {-kFar, -kFar, -0.5 * thickness_m},
                      {kFar, -half_width_m, 0.5 * thickness_m});
  for (Vec3& vertex : mesh.vertices)
    vertex = Eigen::AngleAxisd(slant_deg * kDegree, Vec3::UnitZ()) * vertex;
  return mesh;
}

// The near quadrilateral is 0.4 wide and 0.1 high, and the slit 0.14 wide. The camera fits at up to
// 5.7° from the slit; without roll only if it turns by more than 60°.
PolicyCase slanted_slit() {
  return {wall_with_slit(30.0, 0.07, 0.5),
          camera_of(0.2, 0.05),
          {{0, {{0, 0, 1.5}, Quat::Identity()}}, {4, {{0, 0, -1.5}, Quat::Identity()}}}};
}

// A vertical gap of 0.34 and a camera that is 0.4 wide and 0.38 high: it has to be yawed by 32°,
// between two keyframes that look down and turn.
PolicyCase upright_gap() {
  return {wall_with_slit(90.0, 0.17, 0.04),
          camera_of(0.2, 0.19),
          {{0, {{0, 0.5, 1.6}, yawed_and_pitched(-10, -15)}},
           {4, {{0, -0.5, -1.2}, yawed_and_pitched(15, -25)}}}};
}

// Returns a path past a column_case, looking at a point beyond it.
PolicyCase column_case() {
  Mesh mesh;
  testing::add_cuboid(mesh, {-0.3, -kFar, -0.2}, {0.5, kFar, 0.0});
  return {mesh,
          motion::Body(testing::small_camera()),
          {{0, {{-0.15, 0, 2}, Quat::Identity()}}, {6, {{-0.15, 0, -2}, Quat::Identity()}}}};
}

PolicyCase door_case() {
  Mesh mesh;
  testing::add_cuboid(mesh, {-6, -8, -0.05}, {2, 8, 0.05});
  testing::add_cuboid(mesh, {3.5, -8, -0.05}, {9, 8, 0.05});
  return {mesh,
          motion::Body(testing::small_camera()),
          {{0, {{0, 0, 2}, Quat::Identity()}}, {5, {{0, 0, -2}, Quat::Identity()}}}};
}

TEST(OrientationPolicy, TurnsWithinTheLimit) {
  const Outcome outcome = corrected(slanted_slit(), limited(45), Objective::kClosest);
  EXPECT_TRUE(outcome.is_free);
  EXPECT_GT(outcome.turned_deg, 20.0);
  EXPECT_LE(outcome.turned_deg, 45.0);
  for (const Correction& correction : outcome.result.corrections)
    EXPECT_NEAR(correction.turned_rad / kDegree, outcome.turned_deg, 1.0);
}

// A limit takes nothing away that the answer without it does not need.
TEST(OrientationPolicy, LetsWhatTurnsLessPass) {
  testing::Random random(8117);
  for (int run = 0; run < 12; ++run) {
    PolicyCase c = slanted_slit();
    c.mesh = wall_with_slit(random.uniform(15.0, 75.0), random.uniform(0.056, 0.09),
                            random.uniform(0.05, 0.5));
    c.keyframes[0].pose.orientation = yawed_and_pitched(random.uniform(-20, 20), 0.0);
    c.keyframes[1].pose.orientation = yawed_and_pitched(random.uniform(-20, 20), 0.0);
    const Outcome outcome = corrected(c, {}, Objective::kClosest);
    EXPECT_TRUE(outcome.is_free);
    SCOPED_TRACE(::testing::Message() << "run " << run << ", turned " << outcome.turned_deg);
    expect_free(c, limited(outcome.turned_deg + 1.0));
  }
}

TEST(OrientationPolicy, DoesNotTurnBeyondTheLimit) { expect_stuck(slanted_slit(), limited(10)); }

TEST(OrientationPolicy, YawsWhereTheHorizonHasToStayLevel) {
  expect_free(upright_gap(), level());
  expect_free(upright_gap(), level(50));
}

TEST(OrientationPolicy, DoesNotRollWhereTheHorizonHasToStayLevel) {
  expect_stuck(slanted_slit(), level(60));
  expect_free(slanted_slit(), limited(60));
}

TEST(OrientationPolicy, TurnsNothingWhereOrientationsAreKept) {
  expect_stuck(slanted_slit(), keep());
  expect_stuck(upright_gap(), keep());
  expect_free(column_case(), keep());
  expect_free(door_case(), keep());
  expect_free(column_case(), limited(0));
}

// Passing the column_case takes a motion of some 30 cm, or 4° as seen from the target.
/// A box that is wider than a door when it is turned, in front of the door and behind it.
PolicyCase box_before_a_door(testing::Random& random) {
  const Vec3 half_m(random.uniform(0.3, 0.5), 0.8, random.uniform(0.2, 0.45));
  const double door_m = random.uniform(1.03, 1.2) * 2.0 * half_m.x();
  PolicyCase c;
  testing::add_cuboid(c.mesh, {-6, 0, -0.05}, {-0.5 * door_m, 3, 0.05});
  testing::add_cuboid(c.mesh, {0.5 * door_m, 0, -0.05}, {6, 3, 0.05});
  testing::add_cuboid(c.mesh, {-0.5 * door_m, 2, -0.05}, {0.5 * door_m, 3, 0.05});
  testing::add_cuboid(c.mesh, {-6, 0, -4}, {6, 2.6, 4});
  c.body = *motion::Body::make(motion::BoxShape{Vec3::Zero(), half_m});
  c.keyframes = {{0, {{random.uniform(0.4, 0.7), 0.85, 2}, Quat::Identity()}},
                 {6, {{random.uniform(0.4, 0.7), 0.85, -2}, Quat::Identity()}}};
  return c;
}

// The ball that holds the box in any orientation does not fit through the door.
TEST(OrientationPolicy, PassesDoorsThatTheBodyFitsWithoutTurning) {
  constexpr double kLeastTurn_deg = 1.2;  // without a comparison with paths that turn less: 2.4
  testing::Random random(4612);
  for (int run = 0; run < 12; ++run) {
    const PolicyCase c = box_before_a_door(random);
    OrientationPolicy keep;
    keep.rule = OrientationRule::kKeep;
    const Outcome kept = corrected(c, keep, Objective::kClosest);
    EXPECT_TRUE(kept.is_free) << run;
    EXPECT_EQ(kept.turned_deg, 0.0) << run;
    const Outcome free = corrected(c, {}, Objective::kClosest);
    EXPECT_TRUE(free.is_free) << run;
    EXPECT_LT(free.turned_deg, kLeastTurn_deg) << run << ": a turn changes more of the picture";
  }
}

/// A corridor with a table across it, and a body that is too high to pass above it. A small ball
/// passes under it, the body only beside it.
PolicyCase body_before_a_table() {
  PolicyCase c;
  testing::add_cuboid(c.mesh, {-1.6, -0.1, -4.1}, {1.6, 0, 4.1});
  testing::add_cuboid(c.mesh, {-1.6, 2.5, -4.1}, {1.6, 2.6, 4.1});
  testing::add_cuboid(c.mesh, {-1.6, 0, -4.1}, {-1.5, 2.5, 4.1});
  testing::add_cuboid(c.mesh, {1.5, 0, -4.1}, {1.6, 2.5, 4.1});
  testing::add_cuboid(c.mesh, {-1.6, 0, -4.1}, {1.6, 2.5, -4});
  testing::add_cuboid(c.mesh, {-1.6, 0, 4}, {1.6, 2.5, 4.1});
  testing::add_cuboid(c.mesh, {-1.5, 0.7, -0.4}, {0.7, 0.75, 0.4});
  c.body = *motion::Body::make(motion::BoxShape{Vec3::Zero(), Vec3(0.6, 1.9, 0.5)});
  c.keyframes = {{0, {{-0.8, 1.2, 2}, Quat::Identity()}}, {6, {{-0.8, 1.1, -2}, Quat::Identity()}}};
  return c;
}

TEST(OrientationPolicy, PassesATableThatOnlyASmallBallPassesUnder) {
  const PolicyCase c = body_before_a_table();
  expect_free(c, {});
  const Outcome kept = corrected(c, keep(), Objective::kClosest);
  EXPECT_TRUE(kept.is_free);
  EXPECT_EQ(kept.turned_deg, 0.0);
}

TEST(OrientationPolicy, TurnsTowardsTheTargetAsItMovesAside) {
  const OrientationPolicy policy = towards({-0.15, 0, -4}, 2.0);
  const Outcome outcome = corrected(column_case(), policy, Objective::kClosest);
  EXPECT_TRUE(outcome.is_free);
  EXPECT_LE(outcome.breach_deg, testing::kOracleRounding_deg);
  EXPECT_GT(outcome.turned_deg, 1.0) << "or the scene asks for nothing";
}

TEST(OrientationPolicy, KeepsTheTargetInViewOnAWayRound) {
  expect_free(door_case(), towards({0, 0, -6}, 8.0));
}

// The target is behind the camera, which may then not turn further away from it.
TEST(OrientationPolicy, LooksNoFurtherAwayFromATargetOutsideTheCone) {
  expect_free(column_case(), towards({1, 0.5, 7}, 10.0));
}

TEST(OrientationPolicy, HoldsUnderEveryObjective) {
  for (const Objective objective :
       {Objective::kShortest, Objective::kSmoothest, Objective::kSafest}) {
    expect_free(slanted_slit(), limited(45), objective);
    expect_free(upright_gap(), level(), objective);
    expect_free(door_case(), towards({0, 0, -6}, 8.0), objective);
    expect_free(door_case(), keep(), objective);
  }
}

}  // namespace
}  // namespace camway::correction
