// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <string>

#include "daemon/collision/detect.h"
#include "daemon/motion/spline/derive_times.h"
#include "daemon/motion/spline/interpolate.h"
#include "daemon/scene/import/unigrafix/unigrafix_reader.h"
#include "daemon/scene/index/scene_index.h"
#include "tools/make_scenes/catalogue.h"
#include "tools/make_scenes/office.h"

namespace camway::make_scenes {
namespace {

namespace fs = std::filesystem;

/// Returns the contents of all files below `folder` by relative name.
std::map<std::string, std::string> files_below(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    std::ifstream in(entry.path(), std::ios::binary);
    files[fs::relative(entry.path(), folder).string()] = {std::istreambuf_iterator<char>(in), {}};
  }
  return files;
}

TEST(MakeScenes, WritesTheCommittedBytes) {
  const fs::path folder = fs::path(::testing::TempDir()) / "make_scenes_test";
  fs::remove_all(folder);
  const std::string command =
      std::string(CAMWAY_MAKE_SCENES_BINARY) + " --out '" + folder.string() + "' > /dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const std::map<std::string, std::string> made = files_below(folder);
  const std::map<std::string, std::string> committed = files_below(CAMWAY_SCENES_FOLDER);
  std::uintmax_t bytes = 0;
  for (const auto& [name, text] : made) {
    ASSERT_TRUE(committed.contains(name)) << name << " is not committed";
    EXPECT_TRUE(committed.at(name) == text) << name << " differs: run make_scenes --out scenes";
    bytes += text.size();
  }
  for (const auto& [name, text] : committed) {
    // Sessions are recorded, by tools/scripts/golden_sessions.sh.
    const bool is_session = name.starts_with("sessions/");
    EXPECT_TRUE(is_session || made.contains(name)) << name << " is stale";
  }
  EXPECT_LT(bytes, 5U << 20U);
  fs::remove_all(folder);
}

geometry::Vec3 metres(const Point& p) {
  const geometry::Vec3 um(static_cast<double>(p[0]), static_cast<double>(p[1]),
                          static_cast<double>(p[2]));
  return um / 1e6;
}

scene::Mesh mesh_of(const Scene& scene) {
  scene::Mesh mesh;
  for (const Triangle& triangle : scene.triangles()) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Point& p : triangle) mesh.vertices.push_back(metres(p));
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

motion::Path path_of(const Request& request) {
  std::vector<motion::Pose> poses;
  for (const View& view : request.views) {
    const Quaternion& q = view.orientation;
    poses.push_back({metres(view.eye), geometry::from_wxyz({q[0], q[1], q[2], q[3]})});
  }
  const std::vector<double> derived = motion::derive_times_s(poses);
  std::vector<motion::Keyframe> keyframes;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double time_s = request.times_ms.empty() ? derived[i] : request.times_ms[i] / 1000.0;
    keyframes.push_back({time_s, poses[i], motion::KeyframeOrigin::kGiven});
  }
  return motion::interpolate(keyframes);
}

motion::Corners corners_of(const Request& request) {
  constexpr double kDegree = 3.14159265358979323846 / 180.0;
  return motion::near_corners_C({request.lens.fov_x_deg * kDegree, request.lens.fov_y_deg * kDegree,
                                 static_cast<double>(request.lens.near) / 1e6});
}

/// `free` requests are free and all others collide, as their names say.
TEST(MakeScenes, RequestsDoWhatTheirNamesSay) {
  for (const Entry& entry : make_catalogue()) {
    const scene::SceneIndex index = scene::SceneIndex::build(mesh_of(entry.scene));
    for (const Request& request : entry.requests) {
      const motion::Path path = path_of(request);
      const auto found = collision::detect_collisions(
          {collision::Obstacles(index), motion::Body(corners_of(request))}, path, path.begin_s(),
          path.end_s(), base::Deadline::never());
      ASSERT_TRUE(found.has_value());
      double colliding_s = 0.0;
      for (const collision::CollisionInterval& c : *found) colliding_s += c.t_end_s - c.t_begin_s;
      const double share = colliding_s / (path.end_s() - path.begin_s());
      std::cout << request.name << ": " << found->size() << " intervals, " << 100.0 * share
                << " % of the time\n";
      const bool is_free = request.name.find("-free-") != std::string::npos;
      EXPECT_EQ(found->empty(), is_free) << request.name;
      if (request.name.find("-graze-") != std::string::npos) {
        EXPECT_LT(share, 0.5) << request.name;
      }
    }
  }
}

/// The generator's own check finds the faults of these keyframes.
TEST(MakeScenes, ClearanceIsMeasuredFromTheFilledQuadrilateral) {
  Scene scene;
  scene.begin_object("spike");
  scene.add_box({}, {mm(-5), mm(-5), mm(-900)}, {mm(5), mm(5), mm(-400)});
  const Lens lens{90, 90, mm(200)};  // 0.4 x 0.4 m, 0.2 m in front of the eye
  const View north{{0, 0, 0}, look_along({0, 0, -1})};
  EXPECT_NEAR(clearance_m(scene.triangles(), lens, north, 1.0), 0.2, 1e-12);
  const View inside{{0, 0, mm(-300)}, look_along({0, 0, -1})};
  EXPECT_EQ(clearance_m(scene.triangles(), lens, inside, 1.0), 0.0) << "through the middle only";
  const View beside{{mm(305), 0, mm(-300)}, look_along({0, 0, -1})};
  EXPECT_NEAR(clearance_m(scene.triangles(), lens, beside, 1.0), 0.1, 1e-12);
  const View east{{0, 0, mm(-300)}, look_along({1, 0, 0})};
  EXPECT_NEAR(clearance_m(scene.triangles(), lens, east, 1.0), 0.195, 1e-12);
  EXPECT_EQ(clearance_m(scene.triangles(), lens, {{mm(9000), 0, 0}, {1, 0, 0, 0}}, 1.0), 1.0);
}

/// Looking along d means that the camera's -z axis points along d, and that +y stays up.
TEST(MakeScenes, ViewsLookWhereTheyShould) {
  for (const Direction& d : {Direction{1, 0, 0}, Direction{0, 0, -1}, Direction{0, 0, 1},
                             Direction{-3, 0, 2}, Direction{1, 2, -1}, Direction{-1, -4, 3}}) {
    const Quaternion c = look_along(d);
    const geometry::Quat q = geometry::from_wxyz({c[0], c[1], c[2], c[3]});
    EXPECT_NEAR(q.norm(), 1.0, 1e-15);
    const geometry::Vec3 forward = q * geometry::Vec3(0, 0, -1);
    EXPECT_LT((forward - geometry::Vec3(d[0], d[1], d[2]).normalized()).norm(), 1e-15 * 8);
    const geometry::Vec3 right = q * geometry::Vec3(1, 0, 0);
    EXPECT_NEAR(right.y(), 0.0, 1e-15) << "no roll";
    EXPECT_GE((q * geometry::Vec3(0, 1, 0)).y(), 0.0);
    const Quaternion r = rolled_90(c);
    const geometry::Vec3 rolled_right =
        geometry::from_wxyz({r[0], r[1], r[2], r[3]}) * geometry::Vec3(1, 0, 0);
    EXPECT_LT((rolled_right - q * geometry::Vec3(0, 1, 0)).norm(), 1e-15 * 8);
  }
}

/// No piece of furniture floats: its lowest point is on the floor of a storey.
TEST(MakeScenes, FurnitureStandsOnTheFloor) {
  const Scene scene = make_office();
  int pieces = 0;
  for (std::size_t i = 0; i < scene.objects().size(); ++i) {
    const std::string kind = scene.objects()[i].name.substr(0, scene.objects()[i].name.find('_'));
    if (kind != "desk" && kind != "chair" && kind != "shelf" && kind != "table" && kind != "lamp" &&
        kind != "plant" && kind != "bench" && kind != "safe" && kind != "railing") {
      continue;
    }
    const std::size_t end = i + 1 < scene.objects().size() ? scene.objects()[i + 1].first_triangle
                                                           : scene.triangles().size();
    Um lowest = mm(1'000'000);
    for (std::size_t t = scene.objects()[i].first_triangle; t < end; ++t) {
      for (const Point& p : scene.triangles()[t]) lowest = std::min(lowest, p[1]);
    }
    EXPECT_EQ(lowest % office::kStoreyHeight, 0) << scene.objects()[i].name;
    ++pieces;
  }
  EXPECT_GT(pieces, 150);
}

/// Every edge of a closed solid is shared by two triangles that run along it in opposite
/// directions.
TEST(MakeScenes, SolidsAreClosedAndFaceOutwards) {
  Scene scene;
  scene.begin_object("solids");
  scene.add_box({{mm(5), 0, mm(7)}, compose(kTurn37, kTurn90)}, {0, 0, 0},
                {mm(100), mm(200), mm(300)});
  scene.add_prism({}, {mm(5000), 0, 0}, mm(400), mm(900), 12);
  add_wall(scene, WallAlongX{0, mm(4000), 0, mm(3000), mm(9000), mm(9200)},
           {{mm(1000), mm(2000), 0, mm(2100)}, {mm(2500), mm(3500), mm(900), mm(2000)}});
  add_wall(scene, WallAlongZ{0, mm(4000), 0, mm(3000), mm(-9000), mm(-8800)},
           {{mm(1000), mm(2000), 0, mm(2100)}});
  add_slab(scene, {mm(20000), mm(30000), 0, mm(4000), 0, mm(300)},
           {{mm(22000), mm(23000), mm(1000), mm(2000)}});
  std::map<std::pair<Point, Point>, int> edges;
  double six_volumes = 0.0;
  for (const Triangle& t : scene.triangles()) {
    for (std::size_t i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
    six_volumes += metres(t[0]).dot(metres(t[1]).cross(metres(t[2])));
  }
  for (const auto& [edge, count] : edges) {
    const auto opposite = edges.find({edge.second, edge.first});
    ASSERT_TRUE(opposite != edges.end() && opposite->second == count)
        << "edge from " << metres(edge.first).transpose() << " to "
        << metres(edge.second).transpose();
  }
  const double prism_m3 = 12 * 0.5 * 0.4 * 0.4 * 0.5 * 0.9;
  const double walls_m3 = 0.2 * (12.0 - 2.1 - 1.1) + 0.2 * (12.0 - 2.1);
  EXPECT_NEAR(six_volumes / 6.0, 0.006 + prism_m3 + walls_m3 + 0.3 * (40.0 - 1.0), 1e-5);
}

TEST(MakeScenes, UnigrafixHoldsTheSameTriangles) {
  const Scene scene = make_office();
  const auto read = scene::unigrafix::read_unigrafix(scene.unigrafix("office"), {});
  ASSERT_TRUE(read) << read.error;
  ASSERT_EQ(read->triangles.size(), scene.triangles().size());
  EXPECT_EQ(read->objects.size(), scene.objects().size());
  for (std::size_t t = 0; t < scene.triangles().size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < 3; ++i) {
        const double metres = static_cast<double>(scene.triangles()[t][k][i]) / 1e6;
        ASSERT_EQ(read->vertices[read->triangles[t][k]][i], metres) << "triangle " << t;
      }
    }
  }
}

}  // namespace
}  // namespace camway::make_scenes
