// SPDX-License-Identifier: MIT
#include "daemon/scene/field/surface_cells.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <numeric>

#include "tests/scene/test_meshes.h"
#include "tests/scene/voxels/voxel_oracle.h"
#include "tests/support/random.h"

namespace camway::scene {
namespace {

using geometry::Box;
using geometry::Triangle;
using geometry::Vec3;
using SurfaceCell = std::array<std::int32_t, 3>;

constexpr std::uint64_t kCellsSeed = 20120;

/// Returns a grid of 32 cells per axis whose face number 16 is at `middle_m` on each axis.
CellGrid grid_about(double middle_m, double resolution_m) {
  CellGrid grid;
  grid.resolution_m = resolution_m;
  grid.cells_per_m = 1.0 / resolution_m;
  grid.low_W = Vec3::Constant(middle_m - 16.0 * resolution_m);
  grid.size = {32, 32, 32};
  return grid;
}

std::vector<std::uint8_t> marks_of(const Mesh& mesh, const CellGrid& grid, unsigned threads = 1) {
  std::vector<std::uint8_t> marks(grid.cells());
  mark_touched_cells(mesh, grid, threads, marks);
  return marks;
}

/// Returns the exact cube of a cell, with all sides moved outwards by `margin_cells`.
oracle::RealBox cube_of(const CellGrid& grid, const SurfaceCell& cell, oracle::Real margin_cells) {
  oracle::RealBox box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const oracle::Real low = grid.low_W[static_cast<Eigen::Index>(axis)];
    box.min[axis] = low + grid.resolution_m * (cell[axis] - margin_cells);
    box.max[axis] = low + grid.resolution_m * (cell[axis] + 1 + margin_cells);
  }
  return box;
}

bool touched(const Mesh& mesh, const oracle::RealBox& box) {
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (oracle::touches(mesh.triangle(i), box)) return true;
  }
  return false;
}

/// Expects that every cell is marked that clipping in extended precision finds within the promised
/// margin, and that no cell is marked beyond the margin that is used.
void expect_marks_as_clipping_says(const Mesh& mesh, const CellGrid& grid) {
  const std::vector<std::uint8_t> marks = marks_of(mesh, grid);
  // The oracle rounds as well, but in units that are 2000 times smaller.
  const oracle::Real promised = 0.99 * reliable_margin_cells(grid);
  const oracle::Real allowed = 2.01 * mark_margin_cells(grid);
  std::size_t at = 0;
  for (std::int32_t z = 0; z < grid.size[2]; ++z) {
    for (std::int32_t y = 0; y < grid.size[1]; ++y) {
      for (std::int32_t x = 0; x < grid.size[0]; ++x, ++at) {
        const SurfaceCell cell{x, y, z};
        if (marks[at] == 0) {
          ASSERT_FALSE(touched(mesh, cube_of(grid, cell, promised))) << "a cell is missing";
        } else {
          ASSERT_TRUE(touched(mesh, cube_of(grid, cell, allowed))) << "nothing is near this cell";
        }
      }
    }
  }
}

TEST(MarkTouchedCells, AgreesWithClippingEveryCell) {
  testing::Random random(kCellsSeed);
  for (int trial = 0; trial < 40; ++trial) {
    SCOPED_TRACE(trial);
    const double resolution_m = random.log_uniform(1e-5, 10.0);
    const Mesh mesh = oracle::random_mesh(random, resolution_m, 1);
    expect_marks_as_clipping_says(mesh, grid_about(0.0, resolution_m));
  }
}

TEST(MarkTouchedCells, AgreesWithClippingFarFromTheOrigin) {
  testing::Random random(kCellsSeed);
  for (int trial = 0; trial < 20; ++trial) {
    SCOPED_TRACE(trial);
    const double resolution_m = random.log_uniform(1e-5, 10.0);
    Mesh mesh = oracle::random_mesh(random, resolution_m, 1);
    for (Vec3& vertex : mesh.vertices) vertex += Vec3::Constant(1e6);
    expect_marks_as_clipping_says(mesh, grid_about(1e6, resolution_m));
  }
}

TEST(MarkTouchedCells, FaceEdgeAndCornerTouchAllNeighbours) {
  const CellGrid grid = grid_about(0.0, 0.25);
  const auto count = [&](const Vec3& point) {
    const std::vector<std::uint8_t> marks =
        marks_of(mesh_of_triangles({{point, point, point}}), grid);
    return std::accumulate(marks.begin(), marks.end(), 0);
  };
  EXPECT_EQ(count({0.1, 0.1, 0.1}), 1);
  EXPECT_EQ(count({0.1, 0.1, 0.25}), 2);
  EXPECT_EQ(count({0.1, 0.5, 0.25}), 4);
  EXPECT_EQ(count({-0.75, 0.5, 0.25}), 8);
}

/// A wall beside a face, from either side: `DistanceField` relies on this for its rounding.
TEST(MarkTouchedCells, MarksTheCellBeyondAFaceWithinTheMargin) {
  const CellGrid grid = grid_about(0.0, 0.25);
  EXPECT_GE(reliable_margin_cells(grid), 12.0 * geometry::kUnitRoundoff * 32);
  const auto marked_layers = [&](double x_cells) {
    const double x = x_cells * 0.25;
    const std::vector<std::uint8_t> marks = marks_of(
        mesh_of_triangles({{Vec3(x, 0.1, 0.1), Vec3(x, 0.2, 0.1), Vec3(x, 0.1, 0.2)}}), grid);
    return std::accumulate(marks.begin(), marks.end(), 0);
  };
  for (const double face : {-13.0, -1.0, 1.0, 2.0, 13.0}) {
    for (const double side : {-1.0, 1.0}) {
      EXPECT_EQ(marked_layers(face + side * 0.9 * reliable_margin_cells(grid)), 2) << face;
      EXPECT_EQ(marked_layers(face + side * 2.1 * mark_margin_cells(grid)), 1) << face;
    }
  }
}

TEST(MarkTouchedCells, LooksAtNoMoreCellsThanTheEffortForetells) {
  testing::Random random(kCellsSeed);
  double fullest = 0.0;
  for (int trial = 0; trial < 500; ++trial) {
    const double resolution_m = random.log_uniform(1e-3, 10.0);
    const Mesh mesh = oracle::random_mesh(random, resolution_m, 1);
    const std::vector<std::uint8_t> marks = marks_of(mesh, grid_about(0.0, resolution_m));
    const double effort = surface_extent(mesh, 1).effort(resolution_m);
    const double cells_per_effort = std::accumulate(marks.begin(), marks.end(), 0.0) / effort;
    ASSERT_LE(cells_per_effort, SurfaceExtent::kCellsPerEffort);
    fullest = std::max(fullest, cells_per_effort);
  }
  std::cout << "up to " << fullest << " cells per effort\n";
}

TEST(SurfaceExtent, OfATriangleWithSides3And4And5) {
  const SurfaceExtent extent =
      surface_extent(mesh_of_triangles({{Vec3(1, 1, 1), Vec3(4, 1, 1), Vec3(1, 1, 5)}}), 1);
  EXPECT_DOUBLE_EQ(extent.area_m2, 6.0);
  EXPECT_DOUBLE_EQ(extent.outline_m, 12.0);
  EXPECT_EQ(extent.triangles, 1.0);
  EXPECT_DOUBLE_EQ(extent.effort(0.5), 24.0 + 24.0 + 1.0);
}

TEST(SurfaceCells, AreTheSameForAnyNumberOfThreads) {
  testing::Random random(kCellsSeed);
  const Mesh mesh = oracle::random_mesh(random, 1.0, 5000);
  const CellGrid grid = grid_about(0.0, 1.0);
  for (const unsigned threads : {2U, 7U}) {
    EXPECT_EQ(marks_of(mesh, grid, threads), marks_of(mesh, grid, 1));
    EXPECT_EQ(surface_extent(mesh, threads).area_m2, surface_extent(mesh, 1).area_m2);
    EXPECT_EQ(surface_extent(mesh, threads).outline_m, surface_extent(mesh, 1).outline_m);
  }
}

TEST(CellGrid, KeepsHalfACellAroundTheSceneOnAllSides) {
  const Box bounds(Vec3(-1.0, 2.0, 1e6), Vec3(9.0, 2.0, 1e6 + 3.3));
  const auto grid = CellGrid::around(bounds, 0.5);
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->size, (SurfaceCell{21, 1, 8}));
  EXPECT_EQ(grid->cells(), 21U * 8U);
  const Vec3 low = grid->in_cells(bounds.min());
  const Vec3 high = grid->in_cells(bounds.max());
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double size = grid->size[static_cast<std::size_t>(axis)];
    EXPECT_GE(low[axis], 0.5 - 1e-9);
    EXPECT_LE(low[axis], 1.0);
    EXPECT_NEAR(size - high[axis], low[axis], 1e-9) << "as much above as below";
  }
}

TEST(CellGrid, RefusesWhatItCannotHold) {
  const Box room(Vec3(0, 0, 0), Vec3(10, 10, 3));
  EXPECT_FALSE(CellGrid::around(Box(), 0.1));
  for (const double resolution_m : {0.0, -1.0, 1e-12, 1e12, 10.0 / CellGrid::kMaxSide,
                                    std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_FALSE(CellGrid::around(room, resolution_m)) << resolution_m;
  }
  // At 1e15 doubles are an eighth of a metre apart.
  const Box far(Vec3(1e15, 0, 0), Vec3(1e15 + 10, 10, 3));
  EXPECT_FALSE(CellGrid::around(far, 0.125));
  EXPECT_TRUE(CellGrid::around(far, 4.0));
}

}  // namespace
}  // namespace camway::scene
