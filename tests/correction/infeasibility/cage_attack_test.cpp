// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <optional>

#include "daemon/correction/infeasibility/cage.h"
#include "daemon/correction/path/free_space.h"
#include "daemon/correction/search/tree_search.h"
#include "tests/support/random.h"
#include "tests/support/random_cages.h"

namespace camway::correction {
namespace {

using geometry::Quat;
using geometry::Vec3;
using testing::RandomCage;

/// Returns the number of cages: few by default, more from the environment for a long run.
int cages_to_make() {
  const char* wanted = std::getenv("CAMWAY_CAGES");
  return wanted != nullptr ? std::max(1, std::atoi(wanted)) : 120;
}
constexpr int kPosesAFace = 60;
constexpr double kNear_m = 0.1;

/// The body that tries to leave: a rectangle, with its shorter side first.
motion::Body rectangle(double short_m, double long_m) {
  return motion::Body(motion::Camera{2.0 * std::atan(0.5 * short_m / kNear_m),
                                     2.0 * std::atan(0.5 * long_m / kNear_m), kNear_m});
}

class Attack {
 public:
  Attack(const RandomCage& cage, double short_m, testing::Random& random)
      : cage_(cage),
        random_(random),
        index_(scene::SceneIndex::build(cage.mesh)),
        long_m_(short_m * within(1.0, 2.0)),
        body_(rectangle(short_m, long_m_)),
        space_({collision::Obstacles(index_), body_, options_}) {}

  /// Searches a free pose with the centre on the box, which a proof excludes: at the centres of the
  /// holes, along their sides and diagonals, and near these.
  bool finds_pose_on_a_face() {
    for (std::size_t name = 0; name < 6; ++name) {
      for (int i = 0; i < kPosesAFace; ++i) {
        if (space_.is_free(pose_on(name), 0.0)) return true;
      }
    }
    return false;
  }

  /// Searches motions from inside to outside that are proved free, through the centre of a hole and
  /// aligned with it.
  bool finds_way_out(const Vec3& inside_W, const Vec3& outside_W, int samples) {
    const std::size_t name = std::uniform_int_distribution<std::size_t>(0, 5)(random_);
    const motion::Pose hole = pose_on(name);
    const Vec3 out = (name % 2 == 1 ? 1.0 : -1.0) * Vec3::Unit(static_cast<int>(name / 2));
    const Vec3 beyond_W = space_.center_W(hole) + 1.2 * long_m_ * cage_.in_world(out);
    const motion::Pose from = space_.pose_around(inside_W, hole.orientation);
    const motion::Pose to = space_.pose_around(beyond_W, hole.orientation);
    if (!space_.is_free(from, 0.0) || !space_.is_free(to, 0.0)) return false;
    TreeOptions options;
    options.max_samples = samples;
    options.about_W = {inside_W, space_.center_W(hole), beyond_W, outside_W};
    options.reach_m = long_m_;
    options.interpolated = {from, to};
    options.seed = random_();
    return !tree_way(space_, motion::signed_pose(from), motion::signed_pose(to), options,
                     base::Deadline::never())
                .guide.empty();
  }

 private:
  double within(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  /// Returns the centre between two bars, adjacent or with one bar between them, and their
  /// distance.
  std::pair<double, double> between(const std::vector<double>& bars) {
    const auto last = static_cast<int>(bars.size()) - 1;
    const int i = std::uniform_int_distribution<int>(0, last - 1)(random_);
    const int j = std::min(last, i + std::uniform_int_distribution<int>(1, 2)(random_));
    const double a = bars[static_cast<std::size_t>(i)];
    const double b = bars[static_cast<std::size_t>(j)];
    return {0.5 * (a + b), b - a};
  }

  motion::Pose pose_on(std::size_t name) {
    const int axis = static_cast<int>(name / 2);
    const auto [u, width_m] = between(cage_.at_u[name]);
    const auto [v, height_m] = between(cage_.at_v[name]);
    std::normal_distribution<double> near(0.0, within(0, 1) < 0.5 ? 0.002 : 0.03);
    Vec3 center;
    center[axis] = (name % 2 == 1 ? cage_.box.max() : cage_.box.min())[axis];
    center[(axis + 1) % 3] = u + near(random_);
    center[(axis + 2) % 3] = v + near(random_);
    center = center.cwiseMax(cage_.box.min()).cwiseMin(cage_.box.max());
    const double diagonal = std::atan2(height_m - cage_.thickness_m, width_m - cage_.thickness_m);
    const std::array<double, 5> angles = {diagonal, -diagonal, 0.0, std::numbers::pi / 2,
                                          within(0, 3.2)};
    const double angle =
        angles[std::uniform_int_distribution<std::size_t>(0, 4)(random_)] + 0.3 * near(random_);
    // Not flat in the plane of the face, where the body might be inside a plate.
    const double tilt = within(0, 1) < 0.5 ? 0.0 : within(-1.0, 1.0);
    const Vec3 normal = Vec3::Unit(axis);
    const Vec3 chord =
        std::cos(angle) * Vec3::Unit((axis + 1) % 3) + std::sin(angle) * Vec3::Unit((axis + 2) % 3);
    const Vec3 other = std::cos(tilt) * normal + std::sin(tilt) * normal.cross(chord);
    Eigen::Matrix3d axes;
    axes << chord, other, chord.cross(other);
    return space_.pose_around(cage_.in_world(center), cage_.turn.normalized() * Quat(axes));
  }

  const RandomCage& cage_;
  testing::Random& random_;
  scene::SceneIndex index_;
  double long_m_;
  motion::Body body_;
  collision::DetectOptions options_;
  FreeSpace space_;
};

/// Returns a side of the body a little below or above the widest hole between adjacent bars, of all
/// faces or sometimes of one face.
double side_near_a_hole(const RandomCage& cage, testing::Random& random) {
  const auto any = [&](int most) { return std::uniform_int_distribution<int>(0, most)(random); };
  const auto hole_m = [&](const std::vector<double>& bars) {
    double widest_m = 0.0;
    for (std::size_t i = 1; i < bars.size(); ++i) {
      widest_m = std::max(widest_m, bars[i] - bars[i - 1]);
    }
    return widest_m - cage.thickness_m;
  };
  double widest_m = 0.05;
  const int only = any(23);
  for (int name = 0; name < 6; ++name) {
    if (only < 6 && name != only) continue;
    const auto i = static_cast<std::size_t>(name);
    widest_m = std::max(widest_m, std::hypot(hole_m(cage.at_u[i]), hole_m(cage.at_v[i])));
  }
  constexpr std::array<double, 6> kFactors = {0.97, 0.998, 1.0005, 1.01, 1.1, 1.4};
  return kFactors[static_cast<std::size_t>(any(5))] * widest_m;
}

/// Returns the exact frame of the cage, with the order of axes of the found one.
std::optional<Quat> exact_frame(const RandomCage& cage, const CageBox& found) {
  for (const Quat& named : {cage.turn, Quat(cage.turn.conjugate()), Quat::Identity()}) {
    if (named.normalized().angularDistance(found.orientation) < 1e-9) return named;
  }
  return std::nullopt;
}

// If a cage counts as closed, exact arithmetic agrees, and there is neither a free pose on its
// faces nor a way out. If it counts as open, there are both.
TEST(Cage, NothingGetsOutOfRandomCages) {
  testing::Random random(41);
  testing::CageMaker maker(random);
  int closed = 0;
  int turned = 0;
  int checked = 0;
  int open_poses = 0;
  int open_ways = 0;
  const int cages = cages_to_make();
  for (int i = 0; i < cages; ++i) {
    const RandomCage cage = maker.make();
    const double short_m = side_near_a_hole(cage, random);
    const std::vector<Vec3> centers = {
        cage.in_world(cage.box.center()),
        cage.in_world(cage.box.max() + Vec3(0.9, 1.1, 0.6 + short_m))};
    const std::optional<Cage> found =
        find_cage(cage.mesh, find_closed_surfaces(cage.mesh), centers, short_m, 1e-9);
    Attack attack(cage, short_m, random);
    const bool is_pose = attack.finds_pose_on_a_face();
    const bool is_way = i % 4 == 0 && attack.finds_way_out(centers[0], centers[1], 200);
    if (!found) {
      open_poses += is_pose ? 1 : 0;
      open_ways += is_way ? 1 : 0;
      continue;
    }
    ++closed;
    ASSERT_FALSE(is_pose && found->box.box.isApprox(cage.box)) << "cage " << i;
    ASSERT_FALSE(is_way) << "cage " << i;
    const std::optional<Quat> frame = exact_frame(cage, found->box);
    turned += found->box.orientation.w() != 1.0 ? 1 : 0;
    if (!cage.is_stepped || !frame) continue;
    ++checked;
    ASSERT_EQ(testing::CageChecker(cage.mesh, cage.parts, found->box, *frame)
                  .check(centers[0], centers[1]),
              "")
        << "cage " << i;
  }
  std::printf(
      "%d cages: %d closed (%d turned, %d checked in fractions); of the others %d with a "
      "pose on a face, %d with a way out\n",
      cages, closed, turned, checked, open_poses, open_ways);
  EXPECT_GT(closed, cages / 10);
  EXPECT_GT(turned, cages / 30);
  EXPECT_GT(checked, cages / 30);
  EXPECT_GT(open_poses, cages / 10);
}

}  // namespace
}  // namespace camway::correction
