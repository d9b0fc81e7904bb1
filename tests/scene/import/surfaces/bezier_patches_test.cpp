// SPDX-License-Identifier: MIT
#include "daemon/scene/import/surfaces/bezier_patches.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "daemon/scene/import/surfaces/faceted_surface.h"
#include "tests/scene/import/surfaces/triangle_distance.h"
#include "tests/support/random.h"

namespace camway::scene::surfaces {
namespace {

constexpr std::uint64_t kPatchSeed = 20311;

using geometry::Vec3;
using import_record::Record;
using ::testing::HasSubstr;
using ::testing::StartsWith;

using Patch = std::array<Vec3, 16>;

/// A file of patches that share no point.
std::string file_of(const std::vector<Patch>& patches) {
  std::ostringstream text;
  text.precision(std::numeric_limits<double>::max_digits10);
  text << patches.size() << "\n";
  for (std::size_t i = 0; i < patches.size(); ++i) {
    for (std::size_t k = 0; k < 16; ++k) text << 16 * i + k + 1 << (k < 15 ? "," : "\n");
  }
  text << 16 * patches.size() << "\n";
  for (const Patch& patch : patches) {
    for (const Vec3& p : patch) text << p.x() << ", " << p.y() << " " << p.z() << "\n";
  }
  return text.str();
}

Record sound_patches(const std::string& text) {
  base::Result<Record> record = read_bezier_patches(text);
  EXPECT_EQ(record.error, "");
  return record ? *std::move(record) : Record{};
}

Vec3 vertex_of(const Record& record, std::size_t i) {
  const import_record::Vertex& v = record.vertices[i];
  return {v[0], v[1], v[2]};
}

camway::testing::NearTriangles near_triangles(const Record& record) {
  camway::testing::NearTriangles near(2.0 * record.header.surface_error);
  for (const auto& t : record.triangles) {
    near.add(vertex_of(record, t[0]), vertex_of(record, t[1]), vertex_of(record, t[2]));
  }
  return near;
}

/// De Casteljau's algorithm in extended precision: an oracle that shares no code.
Vec3 exact_point(const Patch& patch, long double u, long double v) {
  using Exact = std::array<long double, 3>;
  const auto curve = [](std::array<Exact, 4> p, long double t) {
    for (std::size_t r = 3; r > 0; --r) {
      for (std::size_t i = 0; i < r; ++i) {
        for (std::size_t k = 0; k < 3; ++k) p[i][k] = (1 - t) * p[i][k] + t * p[i + 1][k];
      }
    }
    return p[0];
  };
  std::array<Exact, 4> column;
  for (std::size_t j = 0; j < 4; ++j) {
    std::array<Exact, 4> row;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        row[i][k] = static_cast<long double>(patch[4 * j + i][static_cast<Eigen::Index>(k)]);
      }
    }
    column[j] = curve(row, u);
  }
  const Exact p = curve(column, v);
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

Patch random_patch(camway::testing::Random& random) {
  Patch patch;
  for (std::size_t k = 0; k < 16; ++k) {
    patch[k] = Vec3(static_cast<double>(k % 4), static_cast<double>(k / 4), 0.0);
    patch[k] += random.in_cube(0.6);
  }
  return patch;
}

TEST(BezierPatches, AreWithinTheirErrorOfTheExactSurface) {
  camway::testing::Random random(kPatchSeed);
  constexpr int kPatches = 5;
  constexpr int kPointsOfEach = 2000;
  double closest = 0.0;
  for (int trial = 0; trial < kPatches; ++trial) {
    const Patch patch = random_patch(random);
    const Record record = sound_patches(file_of({patch}));
    const double error = record.header.surface_error;
    camway::testing::NearTriangles near = near_triangles(record);
    EXPECT_GT(error, 0.0);
    EXPECT_LE(error, 1e-3 * 4.0) << "half the diagonal is less than 4";
    for (int i = 0; i < kPointsOfEach; ++i) {
      const Vec3 p = exact_point(patch, random.uniform(0.0, 1.0), random.uniform(0.0, 1.0));
      const double off = near.distance(p);
      ASSERT_LE(off, error + 1e-13);
      closest = std::max(closest, off / error);
    }
  }
  EXPECT_GT(closest, 0.2) << "the bound is of no use";
}

TEST(BezierPatches, AParaboloidIsWithinItsErrorBothWays) {
  // z = x y + x^2 / 2 over the unit square: the blossom of each monomial at thirds.
  Patch patch;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) {
      const double x = i / 3.0;
      const double y = j / 3.0;
      const double square = i * (i - 1) / 6.0;
      patch[static_cast<std::size_t>(4 * j + i)] = Vec3(x, y, x * y + 0.5 * square);
    }
  }
  const Record record = sound_patches(file_of({patch}));
  const auto height = [](const Vec3& p) { return p.x() * p.y() + 0.5 * p.x() * p.x(); };
  camway::testing::Random random(kPatchSeed);
  double closest = 0.0;
  for (const auto& t : record.triangles) {
    const double a = random.uniform(0.0, 1.0);
    const double b = random.uniform(0.0, 1.0 - a);
    const Vec3 p = a * vertex_of(record, t[0]) + b * vertex_of(record, t[1]) +
                   (1.0 - a - b) * vertex_of(record, t[2]);
    // x and y are the parameters, so the bound holds along z.
    const double off = std::abs(p.z() - height(p));
    ASSERT_LE(off, record.header.surface_error + 1e-14);
    closest = std::max(closest, off / record.header.surface_error);
  }
  EXPECT_GT(closest, 0.2) << "the bound is of no use";
}

/// The teapot's way to make a dome: quarters of a circle turned about z, as cubics, with a pole.
std::vector<Patch> dome() {
  constexpr double kCircle = 0.5522847498;
  const std::array<Vec3, 4> profile = {Vec3(1, 0, 0), Vec3(1, 0, kCircle), Vec3(kCircle, 0, 1),
                                       Vec3(0, 0, 1)};
  std::vector<Patch> patches;
  const std::array<Vec3, 5> corners = {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, -1, 0),
                                       Vec3(1, 0, 0)};
  for (std::size_t quarter = 0; quarter < 4; ++quarter) {
    const Vec3& from = corners[quarter];
    const Vec3& to = corners[quarter + 1];
    const std::array<Vec3, 4> arc = {from, from + kCircle * to, to + kCircle * from, to};
    Patch& patch = patches.emplace_back();
    for (std::size_t j = 0; j < 4; ++j) {
      for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t k = quarter % 2 == 0 ? 4 * j + i : 4 * j + 3 - i;  // every other reversed
        patch[k] = profile[j].x() * arc[i] + Vec3(0, 0, profile[j].z());
      }
    }
  }
  return patches;
}

TEST(BezierPatches, ADomeIsNearTheSphereAndHasNoGap) {
  const Record record = sound_patches(file_of(dome()));
  // The cubics are off the circle by 2.7e-4.
  for (const auto& v : record.vertices) {
    EXPECT_NEAR(std::hypot(v[0], v[1], v[2]), 1.0, 6e-4);
  }
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (const auto& t : record.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NE(t[k], t[(k + 1) % 3]);
      ++uses[std::minmax(t[k], t[(k + 1) % 3])];
    }
  }
  for (const auto& [edge, count] : uses) {
    const bool is_rim =
        record.vertices[edge.first][2] == 0.0 && record.vertices[edge.second][2] == 0.0;
    ASSERT_EQ(count, is_rim ? 1 : 2);
  }
  EXPECT_EQ(record.objects.size(), 4U);
  EXPECT_THAT(record.names, StartsWith("patch_1patch_2"));
}

TEST(BezierPatches, NeighboursAreDividedAlike) {
  // A patch that is nearly flat beside one that is not: they share the edge x = 3.
  std::vector<Patch> patches(2);
  for (std::size_t k = 0; k < 16; ++k) {
    const auto x = static_cast<double>(k % 4);
    const auto y = static_cast<double>(k / 4);
    patches[0][k] = Vec3(x, y, 0.0);
    patches[1][k] = Vec3(3.0 + x, y, x == 1.0 && y == 1.0 ? 9.0 : 0.0);
  }
  const Record record = sound_patches(file_of(patches));
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (const auto& t : record.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto side = std::minmax(t[k], t[(k + 1) % 3]);
      if (record.vertices[side.first][0] == 3.0 && record.vertices[side.second][0] == 3.0) {
        ++uses[side];
      }
    }
  }
  EXPECT_GT(uses.size(), 4U);
  for (const auto& [side, count] : uses) EXPECT_EQ(count, 2);
}

TEST(BezierPatches, SeparatorsMayDiffer) {
  camway::testing::Random random(kPatchSeed);
  const std::string text = file_of({random_patch(random)});
  std::string other = text;
  for (char& c : other) c = c == ',' ? '\t' : c;
  std::string windows;
  for (const char c : text) windows += c == '\n' ? "\r\n\n" : std::string(1, c);
  const Record record = sound_patches(text);
  EXPECT_EQ(sound_patches(other).vertices, record.vertices);
  EXPECT_EQ(sound_patches(windows).vertices, record.vertices);
  EXPECT_EQ(record.text, "Bezier patches");
  EXPECT_EQ(record.header.unit_m, 0.0);
  EXPECT_THAT(record.notes, HasSubstr("state no unit and no axes"));
}

TEST(BezierPatches, FaultsAreNamedWithTheirLine) {
  const std::string indices = "1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,";
  std::string points = "16\n";
  for (int i = 0; i < 16; ++i)
    points += std::to_string(i % 4) + "," + std::to_string(i / 4) + ",0\n";
  const std::string sound = "1\n" + indices + "16\n" + points;
  sound_patches(sound);
  const auto fault = [](const std::string& text) { return read_bezier_patches(text).error; };
  EXPECT_EQ(fault(""), "line 1: the file ends before its number of patches");
  EXPECT_EQ(fault("teapot\n"), "line 1: the number of patches was expected");
  EXPECT_EQ(fault("0\n16\n"), "line 1: the number of patches was expected");
  EXPECT_EQ(fault("999999999999\n" + indices + "16\n"),
            "line 1: says it has 999999999999 patches, in 52 bytes");
  EXPECT_EQ(fault("1\n" + indices + "0\n" + points),
            "line 2: '0' is no index of a point: these begin at 1");
  EXPECT_EQ(fault("1\n" + indices + "17\n" + points), "line 2: there is no point 17");
  EXPECT_EQ(fault("1\n" + indices + "1.5\n" + points),
            "line 2: '1.5' is no index of a point: these begin at 1");
  EXPECT_EQ(fault("1\n" + indices + "\n" + points), "line 2: has 15 numbers, not 16");
  EXPECT_EQ(fault("2\n" + indices + "16\n" + points), "line 3: has 1 numbers, not 16");
  EXPECT_EQ(fault("1\n" + indices + "16\n"), "line 3: the file ends before its number of points");
  EXPECT_EQ(fault(sound + "1 2 3\n"),
            "line 20: the file goes on after the 16 points that it says it has");
  std::string broken = sound;
  broken.replace(broken.rfind("3,3,0"), 5, "3,nan");
  EXPECT_EQ(fault(broken), "line 19: has 2 numbers, not 3");
  broken.replace(broken.rfind("3,nan"), 5, "3,3,nan");
  EXPECT_EQ(fault(broken), "line 19: 'nan' is no usable coordinate");
  broken.replace(broken.rfind("nan"), 3, "1e400");
  EXPECT_EQ(fault(broken), "line 19: '1e400' is no usable coordinate");
}

TEST(BezierPatches, EveryTruncationIsRefused) {
  camway::testing::Random random(kPatchSeed);
  const std::string text = file_of({random_patch(random), random_patch(random)});
  const std::size_t last_number = text.find_last_of(" ");
  for (std::size_t size = 0; size < last_number; size += 3) {
    const std::string error = read_bezier_patches(text.substr(0, size)).error;
    ASSERT_THAT(error, StartsWith("line ")) << size;
  }
}

TEST(BezierPatches, TooManyTrianglesAreRefused) {
  camway::testing::Random random(kPatchSeed);
  EXPECT_EQ(read_bezier_patches(file_of({random_patch(random)}), 10).error,
            "its patches come to more than 10 triangles");
  Patch point;
  point.fill(Vec3(1, 2, 3));
  EXPECT_EQ(read_bezier_patches(file_of({point})).error, "its patches have no area");
}

}  // namespace
}  // namespace camway::scene::surfaces
