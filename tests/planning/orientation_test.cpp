// SPDX-License-Identifier: MIT
// Orientation policies end to end: the returned path keeps the policy, whatever the status.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/motion/spline/interpolate.h"
#include "daemon/planning/plan.h"
#include "tests/planning/plan_fixture.h"
#include "tests/support/orientation_oracle.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace camway::planning {
namespace {

using correction::OrientationPolicy;
using correction::OrientationRule;
using geometry::Quat;
using geometry::Vec3;
using scene::Mesh;
using testing_plan::snapshot_of;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kFar = 4.0;
constexpr double kEnough_s = 300.0;  // far from what it takes: no outcome depends on it

// Returns a closed room with a wall across z, whose slit from end to end is 0.14 wide, at 30° from
// the x axis: the only way is through the slit.
std::shared_ptr<const scene::Snapshot> slanted_slit() {
  Mesh mesh;
  for (const double side : {-kFar, kFar}) {
    testing::add_cuboid(mesh, {side - 0.1, -kFar, -kFar}, {side + 0.1, kFar, kFar});
    testing::add_cuboid(mesh, {-kFar, side - 0.1, -kFar}, {kFar, side + 0.1, kFar});
    testing::add_cuboid(mesh, {-kFar, -kFar, side - 0.1}, {kFar, kFar, side + 0.1});
  }
  testing::add_cuboid(mesh, {-kFar, 0.07, -0.25}, {kFar, kFar, 0.25});
  testing::add_cuboid(mesh, {-kFar, -kFar, -0.25}, {kFar, -0.07, 0.25});
  for (Vec3& vertex : mesh.vertices)
    vertex = Eigen::AngleAxisd(30.0 * kDegree, Vec3::UnitZ()) * vertex;
  return snapshot_of(std::move(mesh));
}

// Returns a request straight through the slit; the near quadrilateral is 0.4 wide and 0.1 high.
PlanRequest through_slit() {
  PlanRequest request;
  request.camera = {2.0 * std::atan(1.0), 2.0 * std::atan(0.25), 0.2};
  request.has_times = true;
  request.keyframes = {{0.0, {{0, 0, 1.5}, Quat::Identity()}},
                       {4.0, {{0, 0, -1.5}, Quat::Identity()}}};
  request.options.deadline_s = kEnough_s;
  return request;
}

motion::Path interpolated(const PlanRequest& request) {
  return motion::interpolate(request.keyframes);
}

/// Returns by how much the returned path breaks the policy, whatever the status.
double breach_deg(const PlanRequest& request, const PlanResult& result) {
  return testing::worst_breach_deg(request.options.orientation, result.path, interpolated(request),
                                   result.path.begin_s(), result.path.end_s(), 2000);
}

TEST(PlanOrientation, RollsThroughASlitWithinTheLimit) {
  PlanRequest request = through_slit();
  request.options.orientation.max_turn_rad = 45.0 * kDegree;
  const PlanResult result = plan(*slanted_slit(), request);
  EXPECT_EQ(result.status, Status::kOk) << result.message;
  EXPECT_TRUE(result.certificate.certified);
  EXPECT_LE(breach_deg(request, result), testing::kOracleRounding_deg);
  const double turned_deg = testing::largest_turn_deg(result.path, interpolated(request));
  EXPECT_GT(turned_deg, 20.0);
  ASSERT_FALSE(result.corrections.empty());
  for (const correction::Correction& correction : result.corrections) {
    EXPECT_NE(correction.kind, correction::CorrectionKind::kNone);
    EXPECT_NEAR(correction.turned_rad / kDegree, turned_deg, 1.0) << "of what is reported";
  }
}

TEST(PlanOrientation, IsPartialWhereTheLimitIsTooTight) {
  PlanRequest request = through_slit();
  request.options.orientation.max_turn_rad = 10.0 * kDegree;
  const PlanResult result = plan(*slanted_slit(), request);
  EXPECT_EQ(result.status, Status::kPartial) << result.message;
  EXPECT_FALSE(result.certificate.certified);
  EXPECT_FALSE(result.remaining_collisions.empty());
  EXPECT_LE(breach_deg(request, result), testing::kOracleRounding_deg);
}

TEST(PlanOrientation, DoesNotRollALevelCamera) {
  PlanRequest request = through_slit();
  request.options.orientation.rule = OrientationRule::kLevel;
  request.options.orientation.max_turn_rad = 60.0 * kDegree;
  const PlanResult result = plan(*slanted_slit(), request);
  EXPECT_EQ(result.status, Status::kPartial) << result.message;
  EXPECT_LE(breach_deg(request, result), testing::kOracleRounding_deg);
}

TEST(PlanOrientation, NotesThatKeyframesAreNotLevelByTheAxisThatIsUp) {
  PlanRequest request = through_slit();
  request.options.orientation.rule = OrientationRule::kLevel;
  const auto nothing = snapshot_of(Mesh{});
  EXPECT_THAT(plan(*nothing, request).message, ::testing::Not(::testing::HasSubstr("tilted")));
  request.options.orientation.up_W = Vec3(1, 1, 0).normalized();
  EXPECT_THAT(plan(*nothing, request).message, ::testing::HasSubstr("keyframe 0 is tilted by 45"));
}

class RandomRequests : public testing::Random {
 public:
  using Random::Random;

  /// Returns bars and blocks in a corridor along z.
  std::shared_ptr<const scene::Snapshot> scene() {
    Mesh mesh;
    for (int i = 0; i < 8; ++i) {
      const Vec3 middle(uniform(-0.4, 0.4), uniform(-0.4, 0.4), uniform(-1.6, 1.6));
      Vec3 half(uniform(0.02, 0.15), uniform(0.02, 0.15), uniform(0.02, 0.15));
      if (i % 2 == 0) half[i % 4 == 0 ? 0 : 1] = 3.0;
      testing::add_cuboid(mesh, middle - half, middle + half);
    }
    return snapshot_of(std::move(mesh));
  }

  PlanRequest request(OrientationRule rule) {
    PlanRequest request;
    request.camera = testing::small_camera();
    request.has_times = true;
    for (int i = 0; i < 3; ++i) {
      const Quat q = Eigen::AngleAxisd(uniform(-0.6, 0.6), Vec3::UnitY()) *
                     Eigen::AngleAxisd(uniform(-0.5, 0.5), Vec3::UnitX()) *
                     Eigen::AngleAxisd(uniform(-0.1, 0.1), Vec3::UnitZ());
      request.keyframes.push_back(
          {3.0 * i, {{uniform(-0.3, 0.3), uniform(-0.3, 0.3), 2.0 - 2.0 * i}, q}});
    }
    OrientationPolicy& policy = request.options.orientation;
    policy.rule = rule;
    policy.target_W = {uniform(-1, 1), uniform(-1, 1), -6};
    policy.cone_rad = uniform(0.1, 0.5);
    if (uniform(0, 1) < 0.5) policy.max_turn_rad = uniform(0.0, 1.0);
    request.options.deadline_s = kEnough_s;
    return request;
  }
};

TEST(PlanOrientation, EveryRuleHoldsOnWhateverIsReturned) {
  RandomRequests requests(77);
  constexpr int kEach = 25;
  for (const OrientationRule rule : {OrientationRule::kFree, OrientationRule::kKeep,
                                     OrientationRule::kLevel, OrientationRule::kTarget}) {
    int corrected = 0;
    for (int i = 0; i < kEach; ++i) {
      const auto scene = requests.scene();
      const PlanRequest request = requests.request(rule);
      const PlanResult result = plan(*scene, request);
      if (result.status == Status::kInvalid) continue;
      EXPECT_LE(breach_deg(request, result), testing::kOracleRounding_deg)
          << "rule " << static_cast<int>(rule) << ", request " << i;
      corrected += result.status == Status::kOk && !result.corrections.empty() ? 1 : 0;
    }
    EXPECT_GE(corrected, kEach / 4) << "rule " << static_cast<int>(rule);
  }
}

/// A limit that the roundings of orientations break: obeyed to the letter, it refuses every path.
constexpr double kLessThanRoundings_rad = 1e-11;
static_assert(kLessThanRoundings_rad < correction::kLeastTurn_rad);

TEST(PlanOrientation, TakesATurnThatNobodySeesForNone) {
  RandomRequests requests(78);
  int corrected = 0;
  for (int i = 0; i < 10; ++i) {
    const auto scene = requests.scene();
    PlanRequest request = requests.request(OrientationRule::kFree);
    request.options.orientation.max_turn_rad = 0.0;
    const PlanResult none = plan(*scene, request);
    request.options.orientation.max_turn_rad = kLessThanRoundings_rad;
    const PlanResult hardly = plan(*scene, request);
    EXPECT_EQ(hardly.message, none.message);
    ASSERT_EQ(hardly.keyframes.size(), none.keyframes.size());
    for (std::size_t k = 0; k < none.keyframes.size(); ++k) {
      EXPECT_EQ(hardly.keyframes[k].pose.position, none.keyframes[k].pose.position);
    }
    corrected += none.status == Status::kOk && !none.corrections.empty() ? 1 : 0;
  }
  EXPECT_GE(corrected, 3);
}

}  // namespace
}  // namespace camway::planning
