// SPDX-License-Identifier: MIT
#include "daemon/correction/infeasibility/cage.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <random>
#include <vector>

#include "daemon/correction/infeasibility/face_grid.h"
#include "tests/support/cage_checker.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace camway::correction {
namespace {

using geometry::Box;
using geometry::Vec3;
using ::testing::HasSubstr;

/// Returns bars of square section on the faces of a box, `bars` + 1 in each direction on each face,
/// including those on the edges.
std::vector<Box> cage_bars(const Box& box, const std::array<int, 3>& bars, double thickness_m) {
  std::vector<Box> result;
  const Vec3 half = Vec3::Constant(thickness_m / 2);
  const auto add = [&](const Vec3& a, const Vec3& b) { result.emplace_back(a - half, b + half); };
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (const double at : {box.min()[axis], box.max()[axis]}) {
      for (const auto& [along, across] : {std::pair(u, v), std::pair(v, u)}) {
        const int count = bars[static_cast<std::size_t>(across)];
        for (int i = 0; i <= count; ++i) {
          Vec3 from = box.min();
          Vec3 to = box.max();
          from[axis] = to[axis] = at;
          from[across] = to[across] = box.min()[across] + box.sizes()[across] * i / count;
          add(from, to);
        }
      }
    }
  }
  return result;
}

scene::Mesh mesh_of(const std::vector<Box>& bars) {
  scene::Mesh mesh;
  for (const Box& bar : bars) testing::add_cuboid(mesh, bar.min(), bar.max());
  return mesh;
}

std::optional<Cage> cage(const scene::Mesh& mesh, const std::vector<Vec3>& centers,
                         double chord_m) {
  return find_cage(mesh, find_closed_surfaces(mesh), centers, chord_m, 1e-9);
}

/// Returns the fault that the independent checker finds.
std::string fault_in(const Cage& found, const scene::Mesh& mesh, const std::vector<Vec3>& centers) {
  return testing::CageChecker(mesh, found.triangles, found.box)
      .check(centers[found.inside], centers[found.outside]);
}

void turn_about(scene::Mesh& mesh, std::vector<Vec3>& centers, double angle_rad, const Vec3& axis) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle_rad, axis).toRotationMatrix();
  for (Vec3& vertex : mesh.vertices) vertex = turn * vertex;
  for (Vec3& center : centers) center = turn * center;
}

/// Removes the bars on one side of the box; the bars of the adjacent faces end at its plane.
std::vector<Box> open_below(std::vector<Box> bars, double z) {
  std::erase_if(bars,
                [&](const Box& bar) { return bar.min().z() < z && bar.max().z() < z + 0.05; });
  std::vector<Box> result;
  for (Box& bar : bars) {
    bar.min().z() = std::max(bar.min().z(), z);
    // Two copies of a bar that two faces share would cancel the floor below, modulo 2.
    if (std::none_of(result.begin(), result.end(), [&](const Box& b) { return b.isApprox(bar); })) {
      result.push_back(bar);
    }
  }
  return result;
}

/// Returns the largest diagonal of the bounds of a connected part of the faces of `box` outside of
/// the bars; nothing if a part reaches a border. Uses lines through all coordinates of bars instead
/// of a grid. The bounds of a part reach the axes of the adjacent bars, as if these were half as
/// thick.
std::optional<double> widest_hole(const std::vector<Box>& bars, const Box& box) {
  double widest = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double at : {box.min()[axis], box.max()[axis]}) {
      const int u = (axis + 1) % 3;
      const int v = (axis + 2) % 3;
      std::vector<double> xs = {box.min()[u], box.max()[u]};
      std::vector<double> ys = {box.min()[v], box.max()[v]};
      std::vector<Box> solid;
      for (const Box& bar : bars) {
        if (!(bar.min()[axis] < at && at < bar.max()[axis])) continue;
        solid.push_back(bar);
        for (const Vec3& corner : {bar.min(), bar.max()}) {
          if (corner[u] > box.min()[u] && corner[u] < box.max()[u]) xs.push_back(corner[u]);
          if (corner[v] > box.min()[v] && corner[v] < box.max()[v]) ys.push_back(corner[v]);
        }
      }
      for (std::vector<double>* lines : {&xs, &ys}) {
        std::sort(lines->begin(), lines->end());
        lines->erase(std::unique(lines->begin(), lines->end()), lines->end());
      }
      const std::size_t nx = xs.size() - 1;
      const std::size_t ny = ys.size() - 1;
      std::vector<char> done(nx * ny, 0);
      for (std::size_t j = 0; j < ny; ++j) {
        for (std::size_t i = 0; i < nx; ++i) {
          const double x = (xs[i] + xs[i + 1]) / 2;
          const double y = (ys[j] + ys[j + 1]) / 2;
          done[j * nx + i] = std::any_of(solid.begin(), solid.end(), [&](const Box& s) {
            return s.min()[u] < x && x < s.max()[u] && s.min()[v] < y && y < s.max()[v];
          });
        }
      }
      for (std::size_t start = 0; start < done.size(); ++start) {
        if (done[start] != 0) continue;
        std::vector<std::size_t> part = {start};
        done[start] = 1;
        Eigen::AlignedBox2d bounds;
        while (!part.empty()) {
          const std::size_t i = part.back() % nx;
          const std::size_t j = part.back() / nx;
          part.pop_back();
          bounds.extend(Eigen::Vector2d(xs[i], ys[j]));
          bounds.extend(Eigen::Vector2d(xs[i + 1], ys[j + 1]));
          if (i == 0 || j == 0 || i + 1 == nx || j + 1 == ny) return std::nullopt;
          for (const std::size_t next :
               {j * nx + i - 1, j * nx + i + 1, (j - 1) * nx + i, (j + 1) * nx + i}) {
            if (done[next] == 0) part.push_back(next);
            done[next] = 1;
          }
        }
        widest = std::max(widest, bounds.sizes().norm());
      }
    }
  }
  return widest;
}

const Box kBox(Vec3(1, 2, 3), Vec3(2, 3, 4));
const std::array<int, 3> kTenBars = {10, 10, 10};
const Vec3 kInside(1.53, 2.47, 3.52);
const Vec3 kOutside(0.2, 2.5, 3.5);

TEST(Cage, HoldsWhatIsLargerThanItsHoles) {
  const std::vector<Box> bars = cage_bars(kBox, kTenBars, 0.02);
  const scene::Mesh mesh = mesh_of(bars);
  const double hole_m = *widest_hole(bars, kBox);
  EXPECT_NEAR(hole_m, 0.08 * std::sqrt(2.0), 1e-12);
  const std::optional<Cage> found = cage(mesh, {kOutside, kInside}, 0.15);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->inside, 1U);
  EXPECT_EQ(found->outside, 0U);
  EXPECT_TRUE(found->box.box.isApprox(kBox));
  EXPECT_GE(found->box.widest_hole_m, hole_m);
  EXPECT_LT(found->box.widest_hole_m, 0.15);
  EXPECT_FALSE(cage(mesh, {kOutside, kInside}, hole_m)) << "what just fits may pass";
  EXPECT_FALSE(cage(mesh, {kOutside, kInside}, 0.05));
}

TEST(Cage, NothingIsBetweenPointsOnOneSide) {
  const scene::Mesh mesh = mesh_of(cage_bars(kBox, kTenBars, 0.02));
  EXPECT_FALSE(cage(mesh, {kInside, Vec3(1.2, 2.2, 3.2)}, 0.15));
  EXPECT_FALSE(cage(mesh, {kOutside, Vec3(5, 5, 5)}, 0.15));
  EXPECT_FALSE(cage(mesh, {kInside}, 0.15));
  EXPECT_FALSE(cage(scene::Mesh{}, {kInside, kOutside}, 0.15));
  EXPECT_FALSE(cage(mesh, {Vec3(1.0 + 1e-10, 2.55, 3.55), kOutside}, 0.15)) << "in a hole";
}

// Keyframes are met up to rounding only: a keyframe that is nearer than that to a side or a bar is
// on neither side of it.
TEST(Cage, IsToldOnlyByKeyframesThatAreClearOfItsSides) {
  const scene::Mesh mesh = mesh_of(cage_bars(kBox, kTenBars, 0.02));
  const auto is_found = [&](const Vec3& inside, const Vec3& outside, double within_m) {
    return find_cage(mesh, find_closed_surfaces(mesh), std::vector<Vec3>{inside, outside}, 0.15,
                     within_m)
        .has_value();
  };
  const Vec3 before_a_hole(0.998, 2.55, 3.55);
  EXPECT_TRUE(is_found(kInside, before_a_hole, 1e-3));
  EXPECT_FALSE(is_found(kInside, before_a_hole, 3e-3));
  const Vec3 beside_a_bar(1.012, 2.5, 3.52);  // by 2 mm
  EXPECT_TRUE(is_found(beside_a_bar, kOutside, 1e-3));
  EXPECT_FALSE(is_found(beside_a_bar, kOutside, 3e-3));
}

TEST(Cage, AMissingBarIsAWayOut) {
  const std::vector<Box> whole = cage_bars(kBox, kTenBars, 0.02);
  ASSERT_TRUE(cage(mesh_of(whole), {kOutside, kInside}, 0.15));
  int held = 0;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::vector<Box> bars = whole;
    bars.erase(bars.begin() + static_cast<std::ptrdiff_t>(i));
    const std::optional<double> hole_m = widest_hole(bars, kBox);
    const bool closed = hole_m && *hole_m < 0.15;
    // Bars on edges occur twice, once for each face.
    ASSERT_EQ(cage(mesh_of(bars), {kOutside, kInside}, 0.15).has_value(), closed) << i;
    held += closed ? 1 : 0;
  }
  EXPECT_EQ(held, 24);
}

TEST(Cage, ABarThatIsNotClosedIsNoBar) {
  scene::Mesh mesh = mesh_of(cage_bars(kBox, kTenBars, 0.02));
  mesh.triangles.erase(mesh.triangles.begin() + 12 * 5);  // of a bar in the middle of a face
  EXPECT_FALSE(cage(mesh, {kOutside, kInside}, 0.15));
}

const FaceGrid::BorderIsBlocked kOpenBorder = [](int, bool, std::size_t) { return false; };

TEST(FaceGrid, BlocksTheOtherSideOfASurfaceOnly) {
  scene::Mesh around;
  testing::add_cuboid(around, Vec3(0, 0, 0), Vec3(9, 9, 9));
  std::vector<std::uint32_t> all(12);
  std::iota(all.begin(), all.end(), 0U);
  const std::array<FaceGrid::Lines, 2> lines = {FaceGrid::Lines{2, 2.5, 3},
                                                FaceGrid::Lines{3, 3.5, 4}};
  FaceGrid outside(0, 1.0, lines);
  outside.block(around, all, false);
  EXPECT_EQ(outside.widest_hole_m(kOpenBorder), 0.0);
  FaceGrid inside(0, 1.0, lines);
  inside.block(around, all, true);
  EXPECT_FALSE(inside.widest_hole_m(kOpenBorder)) << "the body may be anywhere";
  FaceGrid beyond(0, 10.0, lines);
  beyond.block(around, all, true);
  EXPECT_EQ(beyond.widest_hole_m(kOpenBorder), 0.0);
}

// The bounds of a slanted bar cover half of the face, and the bar does not.
TEST(Cage, ASlantedBarFillsNoMoreThanItself) {
  std::vector<Box> bars = cage_bars(kBox, kTenBars, 0.02);
  std::erase_if(bars, [](const Box& bar) {
    return bar.center().x() > 1.99 && bar.center().y() > 2.05 && bar.center().y() < 2.95 &&
           bar.center().z() > 3.05 && bar.center().z() < 3.95;
  });
  scene::Mesh mesh = mesh_of(bars);
  const std::size_t first = mesh.vertices.size();
  testing::add_cuboid(mesh, Vec3(-0.01, -0.6, -0.01), Vec3(0.01, 0.6, 0.01));
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vec3::UnitX()).toRotationMatrix();
  for (std::size_t i = first; i < mesh.vertices.size(); ++i) {
    mesh.vertices[i] = turn * mesh.vertices[i] + Vec3(2.0, 2.5, 3.5);
  }
  EXPECT_FALSE(cage(mesh, {kOutside, kInside}, 0.15));
  EXPECT_TRUE(cage(mesh, {kOutside, kInside}, 1.4)) << "wider than the whole face";
}

TEST(Cage, AnotherCheckerAgrees) {
  std::vector<Box> bars = cage_bars(kBox, {3, 4, 2}, 0.02);
  const std::vector<Vec3> centers = {kOutside, kInside};
  const std::optional<Cage> found = cage(mesh_of(bars), centers, 0.7);
  ASSERT_TRUE(found);
  const scene::Mesh mesh = mesh_of(bars);
  EXPECT_EQ(fault_in(*found, mesh, centers), "");
  EXPECT_THAT(fault_in(*found, mesh, {kInside, kInside}), HasSubstr("outside is in the box"));
  Cage wrong = *found;
  wrong.box.shortest_chord_m = 0.5;
  EXPECT_THAT(fault_in(wrong, mesh, centers), HasSubstr("too wide"));
  wrong = *found;
  std::erase(wrong.triangles, 12U);  // leaves a bar open
  EXPECT_NE(fault_in(wrong, mesh, centers), "");
}

TEST(Cage, AFloorMakesAFace) {
  const std::vector<Vec3> centers = {kOutside, kInside};
  const scene::Mesh bars = mesh_of(open_below(cage_bars(kBox, {3, 3, 3}, 0.02), 3.0));
  EXPECT_FALSE(cage(bars, centers, 0.5)) << "open below";
  scene::Mesh mesh = bars;
  testing::add_parallelogram(mesh, Vec3(-5, -5, 3), Vec3(9, 0, 0), Vec3(0, 9, 0));
  std::optional<Cage> found = cage(mesh, centers, 0.5);
  ASSERT_TRUE(found);
  EXPECT_EQ(fault_in(*found, mesh, centers), "");
  EXPECT_NEAR(found->box.widest_hole_m, std::hypot(1.0 / 3 - 0.02, 1.0 / 3 - 0.01), 1e-9)
      << "between the floor and the lowest ring, which is half in it";
  mesh = bars;
  testing::add_parallelogram(mesh, Vec3(-5, -5, 3), Vec3(9, 0, 0), Vec3(0, 7.5, 0));
  EXPECT_FALSE(cage(mesh, centers, 0.5)) << "a floor that ends under the cage";
  mesh = bars;
  testing::add_parallelogram(mesh, Vec3(-5, -5, 2.99), Vec3(9, 0, 0), Vec3(0, 9, 0));
  EXPECT_FALSE(cage(mesh, centers, 0.5)) << "a flat thing gets through below";
}

TEST(Cage, PlatesMakeFaces) {
  const std::vector<Vec3> centers = {kOutside, kInside};
  std::vector<Box> bars = open_below(cage_bars(kBox, {3, 3, 3}, 0.02), 3.0);
  bars.emplace_back(Vec3(0.9, 1.9, 2.97), Vec3(2.1, 3.1, 3.0));
  scene::Mesh mesh = mesh_of(bars);
  std::optional<Cage> found = cage(mesh, centers, 0.5);
  ASSERT_TRUE(found);
  EXPECT_EQ(fault_in(*found, mesh, centers), "");
  bars.back().max().y() = 2.5;
  EXPECT_FALSE(cage(mesh_of(bars), centers, 0.5)) << "a plate for half of the face";
}

// There are no bars, so the size of the body does not matter. Boxes about the points outside, which
// are tried first, are no cages.
TEST(Cage, PlatesAreEnough) {
  const double thick_m = 0.2;
  std::vector<Box> plates;
  for (int axis = 0; axis < 3; ++axis) {
    Box low(kBox.min() - Vec3::Constant(thick_m), kBox.max() + Vec3::Constant(thick_m));
    Box high = low;
    low.max()[axis] = kBox.min()[axis];
    high.min()[axis] = kBox.max()[axis];
    // Adjacent to the plates before, without intersecting them.
    for (int done = 0; done < axis; ++done) {
      low.min()[done] = high.min()[done] = kBox.min()[done];
      low.max()[done] = high.max()[done] = kBox.max()[done];
    }
    plates.insert(plates.end(), {low, high});
  }
  const std::vector<Vec3> centers = {kOutside, kOutside + Vec3(0.5, 0.1, 0.2), kInside};
  const scene::Mesh mesh = mesh_of(plates);
  for (const double chord_m : {1.0, 0.05, 0.001}) {
    const std::optional<Cage> found = cage(mesh, centers, chord_m);
    ASSERT_TRUE(found) << chord_m;
    EXPECT_EQ(found->inside, 2U);
    EXPECT_EQ(found->box.widest_hole_m, 0.0);
    EXPECT_EQ(fault_in(*found, mesh, centers), "");
  }
  plates.pop_back();
  EXPECT_FALSE(cage(mesh_of(plates), centers, 0.05)) << "a plate is missing";
}

TEST(Cage, StandsAtAnyAngle) {
  for (const double angle_rad : {0.3, -0.7}) {
    for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(0, 1, 0)}) {
      std::vector<Vec3> centers = {kOutside, kInside};
      scene::Mesh mesh = mesh_of(cage_bars(kBox, {3, 3, 3}, 0.02));
      turn_about(mesh, centers, angle_rad, axis);
      const std::optional<Cage> found = cage(mesh, centers, 0.5);
      ASSERT_TRUE(found) << angle_rad << " about " << axis.transpose();
      EXPECT_LT(found->box.widest_hole_m, 0.46);
      EXPECT_FALSE(cage(mesh, centers, 0.44));
    }
  }
}

TEST(Cage, OnATurnedFloor) {
  std::vector<Vec3> centers = {kOutside, kInside};
  scene::Mesh mesh = mesh_of(open_below(cage_bars(kBox, {3, 3, 3}, 0.02), 3.0));
  scene::Mesh open = mesh;
  testing::add_parallelogram(mesh, Vec3(-5, -5, 3), Vec3(9, 0, 0), Vec3(0, 9, 0));
  std::vector<Vec3> same = centers;
  turn_about(mesh, centers, 0.4, Vec3::UnitZ());
  turn_about(open, same, 0.4, Vec3::UnitZ());
  EXPECT_TRUE(cage(mesh, centers, 0.5));
  EXPECT_FALSE(cage(open, centers, 0.5));
}

// A face that is long in one direction and has many grid lines in the other.
TEST(Cage, LongAndNarrowIsNoMatterOfMemory) {
  const Box box(Vec3(0, 0, 0), Vec3(2e7, 1, 1));
  scene::Mesh mesh = mesh_of(cage_bars(box, {4, 200, 200}, 0.001));
  for (Vec3& vertex : mesh.vertices) {
    if (vertex.x() < 0.1 && vertex.y() > 1.0) vertex.y() += 0.5 * vertex.z();  // one is slanted
  }
  EXPECT_FALSE(cage(mesh, {box.center(), kOutside + Vec3(0, 9, 0)}, 0.15));
}

TEST(Cage, FarFromTheOrigin) {
  const Vec3 far(1e5, -3e5, 2e5);
  const Box box(kBox.min() + far, kBox.max() + far);
  const scene::Mesh mesh = mesh_of(cage_bars(box, kTenBars, 0.02));
  EXPECT_TRUE(cage(mesh, {kInside + far, kOutside + far}, 0.15));
  EXPECT_FALSE(cage(mesh, {kInside + far, kOutside + far}, 0.11));
}

// Cages of any size, thickness and number of bars, some with bars removed or moved. One may be
// found only if its holes, measured independently, are narrower than the chord, and must be found
// if they are narrower by more than the width of some cells.
TEST(Cage, RandomCagesAgainstAnotherMeasure) {
  testing::Random random(17);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int found_some = 0;
  int found_none = 0;
  for (int i = 0; i < 400; ++i) {
    const Vec3 low(unit(random), unit(random), unit(random));
    const Vec3 size = Vec3(unit(random), unit(random), unit(random)) + Vec3::Constant(0.5);
    const Box box(low, low + size);
    std::array<int, 3> count{};
    for (int& n : count) n = std::uniform_int_distribution<int>(3, 9)(random);
    const double thickness_m = 0.015 + 0.02 * unit(random);
    std::vector<Box> bars = cage_bars(box, count, thickness_m);
    for (auto gone = random() % 3; gone > 0; --gone) {
      bars.erase(bars.begin() + static_cast<std::ptrdiff_t>(random() % bars.size()));
    }
    const std::optional<double> hole_m = widest_hole(bars, box);
    const double chord_m = 0.1 + 0.5 * unit(random);
    const std::vector<Vec3> centers = {
        box.center() + 0.2 * size.cwiseProduct(Vec3(unit(random), unit(random), unit(random))),
        low - Vec3::Constant(0.5)};
    const std::optional<Cage> found = cage(mesh_of(bars), centers, chord_m);
    if (found) {
      ++found_some;
      ASSERT_TRUE(hole_m) << i;
      ASSERT_GE(found->box.widest_hole_m, *hole_m) << i;
      ASSERT_LT(found->box.widest_hole_m, chord_m) << i;
    } else {
      ++found_none;
      // Two cells on either side, in both directions.
      const double blur_m = std::sqrt(2.0) * 4.0 * thickness_m / 5.0;
      ASSERT_FALSE(hole_m && *hole_m + blur_m < chord_m) << i << " " << *hole_m << " " << chord_m;
    }
  }
  EXPECT_GT(found_some, 50);
  EXPECT_GT(found_none, 50);
}

}  // namespace
}  // namespace camway::correction
