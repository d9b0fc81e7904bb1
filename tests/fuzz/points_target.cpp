// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "daemon/scene/import/child/splat_voxels.h"
#include "daemon/scene/import/points/point_reader.h"
#include "daemon/scene/voxels/voxel_grid.h"
#include "tests/fuzz/targets.h"
#include "tests/scene/import/points/point_files.h"

namespace camway::testing {
namespace {

namespace points = scene::point_files;

/// The first byte selects the format of the others; one beyond these is of voxels of splats.
constexpr std::array<std::string_view, 3> kPointExtensions = {".pcd", ".xyz", ".las"};
/// Between the description and the tree of voxels.
constexpr char kTreeMark = '\0';

bool exercise_points(std::string_view extension, std::string_view bytes) {
  const auto read = scene::point_readers::read_points(extension, bytes);
  promise(static_cast<bool>(read) == read.error.empty(), "a record or a reason");
  if (!read) return false;
  promise(read->header.is_cloud == 1 && read->triangles.empty(), "points and nothing else");
  promise(read->header.relative_rounding >= 0.0 && read->header.absolute_rounding >= 0.0,
          "the rounding is a bound");
  // A point has three bytes at least, of which LZF makes 264 of three.
  promise(!read->vertices.empty() && read->vertices.size() <= 88 * bytes.size(),
          "no more points than the file can hold");
  return true;
}

bool is_aligned(const scene::import_record::Cube& cube) {
  for (const std::int32_t at : cube.min) {
    if (at < 0 || at % cube.size != 0 || at + cube.size > scene::VoxelGrid::kMaxVoxel + 1) {
      return false;
    }
  }
  return std::has_single_bit(static_cast<std::uint32_t>(cube.size));
}

bool exercise_splat_voxels(std::string_view bytes) {
  const std::string_view json = bytes.substr(0, bytes.find(kTreeMark));
  const std::string_view tree = bytes.substr(std::min(json.size() + 1, bytes.size()));
  const auto read = scene::read_splat_voxels(
      "a.voxel.json", json,
      [&](const std::string&, const std::string& name) -> base::Result<scene::IncludedFile> {
        promise(name == "a.voxel.bin", "the tree is beside it");
        return scene::IncludedFile{name, std::string(tree)};
      });
  promise(static_cast<bool>(read) == read.error.empty(), "a record or a reason");
  if (!read) return false;
  for (const auto* cubes : {&read->occupied, &read->free}) {
    for (const auto& cube : *cubes) promise(is_aligned(cube), "cubes are nodes of the tree");
  }
  return true;
}

bool exercise_cloud(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return false;
  const std::size_t kind = bytes[0] % (kPointExtensions.size() + 1);
  const std::string_view text = as_text(bytes.subspan(1));
  return kind < kPointExtensions.size() ? exercise_points(kPointExtensions[kind], text)
                                        : exercise_splat_voxels(text);
}

FuzzBytes seed(std::uint8_t kind, const std::string& file) {
  FuzzBytes bytes{kind};
  bytes.insert(bytes.end(), file.begin(), file.end());
  return bytes;
}

std::string splat_voxel_file() {
  const std::array<std::uint32_t, 6> tree = {0x81000001, 0xFF000000, 0x01000003,
                                             0,          0x0F0F0F0F, 0x12345678};
  std::string bytes =
      R"({"version": "1.1", "gridBounds": {"min": [0.3, 0, 1], "max": [1.9, 1.6, 2.6]},
          "voxelResolution": 0.1, "leafSize": 4, "treeDepth": 2, "nodeCount": 4,
          "leafDataCount": 2})";
  bytes += kTreeMark;
  bytes.append(reinterpret_cast<const char*>(tree.data()), sizeof tree);
  return bytes;
}

std::vector<FuzzBytes> point_seeds() {
  constexpr std::uint64_t kSeed = 20261126;
  Random random(kSeed);
  const auto cloud = points::random_points(random, 12, 10.0);
  std::vector<FuzzBytes> all;
  for (const auto encoding : {points::PcdEncoding::kText, points::PcdEncoding::kBinary,
                              points::PcdEncoding::kCompressed}) {
    all.push_back(seed(0, points::write_pcd(cloud, encoding)));
    all.push_back(seed(0, points::write_pcd(cloud, encoding, {'I', 8}, &random)));
  }
  all.push_back(seed(1, points::write_xyz(cloud, ",", "z,y,x\n")));
  all.push_back(seed(1, points::write_xyz(cloud) + "1 2 nan # x\n"));
  all.push_back(seed(2, points::write_las(cloud)));
  all.push_back(seed(2, points::write_las(cloud, {.minor_version = 4, .format = 10})));
  all.push_back(seed(3, splat_voxel_file()));
  return all;
}

}  // namespace

constinit const FuzzTarget kPointsTarget{"points", exercise_cloud, point_seeds, 40'000};

}  // namespace camway::testing
