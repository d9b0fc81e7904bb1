// SPDX-License-Identifier: MIT
#include "daemon/correction/narrow/least_turn.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "daemon/correction/narrow/hole_motion.h"
#include "daemon/correction/narrow/narrow_passage.h"
#include "tests/correction/search_scene.h"
#include "tests/support/random.h"

namespace camway::correction {
namespace {

using base::Deadline;
using geometry::Quat;
using geometry::Vec3;
using motion::SignedPose;
using testing_search::is_proved_free;
using testing_search::SearchScene;

constexpr double kTurnMargin_m = 0.002;
constexpr double kPictureWide_m = 0.4;
constexpr double kPictureHigh_m = 0.3;
constexpr std::uint64_t kTurnSeed = 5201;
/// Rounding of the angle between two equal orientations, a few epsilons, and to spare.
constexpr double kSameOrientation_rad = 1e-12;

motion::Body camera() {
  return motion::Body(
      motion::Camera{2.0 * std::atan(1.0), 2.0 * std::atan(0.5 * kPictureHigh_m / 0.2), 0.2});
}

Quat about(const Vec3& axis, double angle_rad) { return Quat(Eigen::AngleAxisd(angle_rad, axis)); }

/// A camera that moves along z through an upright slit in the plane z = 0, everything turned by
/// `world_W`.
class Slit {
 public:
  Slit(double width_m, const Quat& world_W)
      : world_W_(world_W), scene_(slit_mesh(width_m, world_W), camera()), space_(scene_.space()) {
    for (const double z_m : {1.5, -1.5}) way_W_.push_back(world_W * Vec3(0, 0, z_m));
  }

  /// A path that rolls from one end to the other, tilted all the time.
  void interpolate(double from_rad, double to_rad, double tilt_rad) {
    constexpr int kSteps = 64;
    for (int i = 0; i <= kSteps; ++i) {
      const double share = static_cast<double>(i) / kSteps;
      const Quat roll = about(Vec3::UnitZ(), std::lerp(from_rad, to_rad, share));
      interpolated_.push_back({std::lerp(1.0, 0.0, share) * way_W_[0] + share * way_W_[1],
                               world_W_ * about(Vec3::UnitX(), tilt_rad) * roll});
    }
    from_ = motion::signed_pose(interpolated_.front());
    to_ = motion::signed_pose(interpolated_.back());
  }

  /// A path with one orientation.
  void look(const Quat& orientation) {
    for (const Vec3& end_W : way_W_) interpolated_.push_back({end_W, orientation});
    from_ = motion::signed_pose(interpolated_.front());
    to_ = motion::signed_pose(interpolated_.back());
  }

  [[nodiscard]] LeastTurn least_turn() {
    return {space_, from_, to_, interpolated_, kTurnMargin_m, deadline_};
  }
  [[nodiscard]] LinePlace place() const {
    const Vec3 none = Vec3::Zero();
    const HoleLine line = line_about(space_, none, world_W_ * -Vec3::UnitZ(), 0.7);
    return {line, {none, none, none, none}, way_W_, 2.0};
  }
  /// The straight motion of the camera with that roll, upright otherwise.
  [[nodiscard]] std::optional<Guide> rolled(double roll_rad) {
    const motion::Pose pose =
        space_.pose_around(Vec3::Zero(), world_W_ * about(Vec3::UnitZ(), roll_rad));
    return straight_passage(space_, signed_as_ends(pose, from_, to_).pose,
                            place().line.direction_W(), 2.0, kTurnMargin_m);
  }
  /// The straight motion of the camera whose picture is in the plane of the slit's middle.
  [[nodiscard]] Guide edge_on() {
    const motion::Pose pose =
        space_.pose_around(Vec3::Zero(), world_W_ * about(Vec3::UnitY(), 0.5 * std::numbers::pi));
    return *straight_passage(space_, signed_as_ends(pose, from_, to_).pose,
                             place().line.direction_W(), 2.0, kTurnMargin_m);
  }
  /// Angle to the nearest orientation of the interpolated path.
  [[nodiscard]] double turn_rad(const Guide& guide) const {
    double least_rad = std::numbers::pi;
    for (const motion::Pose& pose : interpolated_) {
      const Quat orientation = geometry::from_wxyz(guide.front().orientation);
      least_rad = std::min(least_rad, pose.orientation.angularDistance(orientation));
    }
    return least_rad;
  }
  void expect_leads_through(const Guide& guide) const {
    EXPECT_TRUE(is_proved_free(scene_, guide, kTurnMargin_m));
    EXPECT_TRUE(leads_through(guide, way_W_, space_));
  }

 private:
  static scene::Mesh slit_mesh(double width_m, const Quat& world_W) {
    scene::Mesh mesh;
    testing::add_cuboid(mesh, {-3, -3, -0.01}, {-0.5 * width_m, 3, 0.01});
    testing::add_cuboid(mesh, {0.5 * width_m, -3, -0.01}, {3, 3, 0.01});
    for (Vec3& vertex : mesh.vertices) vertex = world_W * vertex;
    return mesh;
  }

  const Deadline deadline_ = Deadline::never();
  Quat world_W_;
  SearchScene scene_;
  FreeSpace space_;
  std::vector<Vec3> way_W_;
  std::vector<motion::Pose> interpolated_;
  SignedPose from_;
  SignedPose to_;
};

/// The camera is too wide for the slit at both ends of the path, and fits where the path has rolled
/// it by a quarter of a turn.
TEST(LeastTurn, IsNoneWherePathsHaveAnOrientationThatFits) {
  testing::Random random(kTurnSeed);
  for (int run = 0; run < 10; ++run) {
    SCOPED_TRACE(run);
    Slit slit(1.15 * kPictureHigh_m, random.rotation());
    slit.interpolate(0.0, std::numbers::pi, 0.1);
    const std::optional<Guide> found = slit.least_turn().unturned(slit.place());
    ASSERT_TRUE(found);
    slit.expect_leads_through(*found);
    EXPECT_LT(slit.turn_rad(*found), kSameOrientation_rad);
  }
}

/// The path never rolls, so the camera has to turn: by most of a quarter of a turn if it rolls, but
/// a turn to the side whose cosine is the slit's width to its own is enough.
TEST(LeastTurn, IsAboutTheLeastThatFits) {
  testing::Random random(kTurnSeed + 1);
  for (const double width_m : {0.305, 0.35, 0.36, 0.37}) {
    SCOPED_TRACE(width_m);
    Slit slit(width_m, random.rotation());
    slit.interpolate(0.0, 0.0, 0.0);
    EXPECT_FALSE(slit.least_turn().unturned(slit.place()));
    const std::optional<Guide> rolled = slit.rolled(0.5 * std::numbers::pi);
    ASSERT_TRUE(rolled);
    const Guide found = slit.least_turn().reduced(slit.place(), *rolled);
    slit.expect_leads_through(found);
    const double enough_rad = std::acos((width_m - 2.0 * kTurnMargin_m) / kPictureWide_m);
    EXPECT_LT(slit.turn_rad(found), 1.1 * enough_rad);
  }
}

/// A quarter of a turn is always enough to stand edge-on in the slit. The search does not promise
/// to find it, but few answers turn farther.
TEST(LeastTurn, IsRarelyMoreThanAQuarterOfATurn) {
  testing::Random random(kTurnSeed + 2);
  constexpr int kRuns = 40;
  int turned = 0;
  int turned_farther = 0;
  for (int run = 0; run < kRuns; ++run) {
    SCOPED_TRACE(run);
    Slit slit(0.2, random.rotation());
    slit.look(random.rotation());
    if (slit.least_turn().unturned(slit.place())) continue;
    ++turned;
    const Guide found = slit.least_turn().reduced(slit.place(), slit.edge_on());
    slit.expect_leads_through(found);
    if (slit.turn_rad(found) > 0.5 * std::numbers::pi) ++turned_farther;
  }
  EXPECT_GT(turned, kRuns / 2);
  EXPECT_LE(turned_farther, kRuns / 8);
}

/// The slit fits the camera only if it is rolled by a quarter of a turn, to 4 milliradians. The
/// path has it rolled by less, so no orientation on the way back fits, and the motion stays as it
/// was.
TEST(LeastTurn, KeepsWhatCannotTurnLess) {
  testing::Random random(kTurnSeed + 3);
  Slit slit(1.005 * kPictureHigh_m + 2.0 * kTurnMargin_m, random.rotation());
  constexpr double kRoll_rad = 0.5 * std::numbers::pi - 0.25;
  slit.interpolate(kRoll_rad, kRoll_rad, 0.0);
  const std::optional<Guide> rolled = slit.rolled(0.5 * std::numbers::pi);
  ASSERT_TRUE(rolled);
  const Guide found = slit.least_turn().reduced(slit.place(), *rolled);
  EXPECT_EQ(found.front().orientation, rolled->front().orientation);
}

}  // namespace
}  // namespace camway::correction
