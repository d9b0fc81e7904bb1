// SPDX-License-Identifier: MIT
#include "daemon/correction/narrow/hole_line.h"

#include <gtest/gtest.h>

#include <cstdint>

#include "tests/correction/search_scene.h"
#include "tests/support/random.h"

namespace camway::correction {
namespace {

using geometry::Quat;
using geometry::Vec3;
using testing_search::SearchScene;
using testing_search::sphere;

constexpr std::uint64_t kLineSeed = 5301;
constexpr double kRadius_m = 0.17;
constexpr double kHalfLength = 0.7;  // of the line, in radii
constexpr double kMostLean_rad = 0.35;

/// Lines that lean in an upright slit turn until they go straight through it: a line that leans is
/// nearer to two of its edges.
TEST(HoleLine, WidensUntilItGoesStraightThroughASlit) {
  testing::Random random(kLineSeed);
  int checked = 0;
  for (int run = 0; run < 40; ++run) {
    SCOPED_TRACE(run);
    const double width_m = kRadius_m * random.uniform(1.0, 1.8);
    const double half_thick_m = kRadius_m * random.uniform(0.1, 0.7);
    const Quat world_W = random.rotation();
    scene::Mesh mesh;
    testing::add_cuboid(mesh, {-3, -3, -half_thick_m}, {-0.5 * width_m, 3, half_thick_m});
    testing::add_cuboid(mesh, {0.5 * width_m, -3, -half_thick_m}, {3, 3, half_thick_m});
    for (Vec3& vertex : mesh.vertices) vertex = world_W * vertex;
    const SearchScene scene(mesh, sphere(kRadius_m));
    const FreeSpace space = scene.space();

    const double lean_rad = random.uniform(-kMostLean_rad, kMostLean_rad);
    const Vec3 along_W = world_W * Quat(Eigen::AngleAxisd(lean_rad, Vec3::UnitY())) * Vec3::UnitZ();
    const HoleLine leaning = line_about(space, Vec3::Zero(), along_W, kHalfLength);
    if (!(room_m(space, leaning) > 0.0)) continue;
    ++checked;
    const HoleLine wide = widened(space, leaning);
    EXPECT_GT(room_m(space, wide), 0.9 * 0.5 * width_m);
    EXPECT_LE(room_m(space, wide), 0.5 * width_m);
  }
  EXPECT_GT(checked, 20);
}

}  // namespace
}  // namespace camway::correction
