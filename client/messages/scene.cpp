// SPDX-License-Identifier: MIT
#include "client/messages/scene.h"

#include <algorithm>
#include <cstring>

#include "lcmtypes/wire/checksum.h"
#include "lcmtypes/wire/layout.h"

namespace camway {
namespace {

using Bytes = std::vector<std::uint8_t>;

void name_upload(const Bytes& bytes, scene_request_t& request) {
  request.upload_bytes = static_cast<std::int64_t>(bytes.size());
  request.upload_checksum = wire::crc64(bytes.data(), bytes.size());
}

/// Returns the coordinates as little-endian doubles.
Bytes little_endian(const std::vector<std::array<double, 3>>& points) {
  Bytes bytes;
  bytes.reserve(points.size() * 3 * sizeof(double));
  for (const std::array<double, 3>& point : points) {
    for (const double coordinate : point) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &coordinate, sizeof bits);
      for (unsigned shift = 0; shift < 64; shift += 8) {
        bytes.push_back(static_cast<std::uint8_t>(bits >> shift));
      }
    }
  }
  return bytes;
}

/// Writes a shape into a request; returns the bytes to upload.
struct ShapeWriter {
  scene_request_t& request;

  Bytes operator()(const SceneMesh& mesh) const {
    request.kind = scene_request_t::MESH;
    return put_mesh(mesh, request);
  }
  Bytes operator()(const SceneBox& box) const {
    request.kind = scene_request_t::BOX;
    convert(box.size_m, request.size_m);
    return {};
  }
  Bytes operator()(const SceneSphere& sphere) const {
    request.kind = scene_request_t::SPHERE;
    request.radius_m = sphere.radius_m;
    request.chord_error_m = sphere.chord_error_m;
    return {};
  }
  Bytes operator()(const SceneCylinder& cylinder) const {
    request.kind = scene_request_t::CYLINDER;
    request.radius_m = cylinder.radius_m;
    request.height_m = cylinder.height_m;
    request.chord_error_m = cylinder.chord_error_m;
    return {};
  }
  Bytes operator()(const ScenePoints& points) const {
    request.kind = scene_request_t::POINTS;
    request.cell_m = points.cell_m;
    return put_points(points.points_m, request);
  }
  Bytes operator()(const SceneVoxels& voxels) const {
    request.kind = scene_request_t::MAP;
    request.cell_m = voxels.resolution_m;
    request.unknown = static_cast<std::int8_t>(voxels.unknown);
    request.hit_probability = voxels.sensor.hit_probability;
    request.miss_probability = voxels.sensor.miss_probability;
    request.least_probability = voxels.sensor.least_probability;
    request.most_probability = voxels.sensor.most_probability;
    request.max_range_m = voxels.sensor.max_range_m;
    return {};
  }
};

}  // namespace

void convert(const scene_object_t& wire, SceneObject& mine) {
  static_assert(wire::lacks_only<scene_object_t, SceneObject>({"position_m", "orientation_wxyz"}));
  convert_common(wire, mine);
  convert_common(wire, mine.pose);
}

Bytes put_mesh(const SceneMesh& mesh, scene_request_t& request) {
  request.scale = mesh.scale;
  request.up = static_cast<std::int8_t>(mesh.up);
  request.unknown = static_cast<std::int8_t>(mesh.unknown);
  request.cell_m = mesh.voxel_m;
  request.file = mesh.file;
  if (!mesh.file.empty() || mesh.bytes.empty()) return {};
  request.upload_format = mesh.format;
  name_upload(mesh.bytes, request);
  return mesh.bytes;
}

Bytes put_shape(const SceneShape& shape, scene_request_t& request) {
  return std::visit(ShapeWriter{request}, shape);
}

Bytes put_points(const std::vector<std::array<double, 3>>& points, scene_request_t& request) {
  Bytes bytes = little_endian(points);
  name_upload(bytes, request);
  return bytes;
}

void put_pose(const Pose& pose, scene_request_t& request) {
  convert(pose.position_m, request.position_m);
  convert(pose.orientation_wxyz, request.orientation_wxyz);
}

upload_page_t page_of(const Bytes& bytes, std::int64_t checksum, std::int32_t page) {
  upload_page_t wire{};
  wire.total_bytes = static_cast<std::int64_t>(bytes.size());
  wire.checksum = checksum;
  if (page < 0) return wire;
  const std::size_t begin = static_cast<std::size_t>(page) * wire::kUploadPageBytes;
  const std::size_t size = std::min(wire::kUploadPageBytes, bytes.size() - begin);
  const auto first = bytes.begin() + static_cast<std::ptrdiff_t>(begin);
  wire.page = page;
  wire.bytes.assign(first, first + static_cast<std::ptrdiff_t>(size));
  wire.num_bytes = static_cast<std::int32_t>(size);
  wire.page_checksum = wire::crc64(bytes.data() + begin, size);
  return wire;
}

}  // namespace camway
