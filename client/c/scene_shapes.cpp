// SPDX-License-Identifier: MIT
#include "client/c/scene_shapes.h"

#include <algorithm>
#include <bit>
#include <string>
#include <vector>

#include "client/c/sized.h"

namespace camway::c {
namespace {

void append(std::vector<std::uint8_t>& bytes, const void* from, std::size_t size) {
  const auto* const first = static_cast<const std::uint8_t*>(from);
  bytes.insert(bytes.end(), first, first + size);
}

}  // namespace

camway_mesh_file default_mesh_file() {
  camway_mesh_file mesh{};
  mesh.scale = SceneMesh{}.scale;
  return mesh;
}

SceneMesh mesh_of(const camway_mesh_file* pointer) {
  const camway_mesh_file given = read_sized(pointer, default_mesh_file(), "mesh");
  require_choice(given.up, static_cast<int>(SceneMesh::Up::kYToZ), "mesh.up");
  SceneMesh mesh;
  mesh.file = optional_text(given.file);
  if (mesh.file.empty()) {
    require(given.bytes, "mesh.file and mesh.bytes");
    mesh.bytes.assign(given.bytes, given.bytes + given.num_bytes);
    mesh.format = text_of(given.format, "mesh.format");
  }
  mesh.scale = given.scale;
  mesh.up = static_cast<SceneMesh::Up>(given.up);
  mesh.voxel_m = given.voxel_m;
  return mesh;
}

Pose pose_of(const camway_pose* given) {
  Pose pose;
  if (given == nullptr) return pose;
  std::copy_n(given->position_m, 3, pose.position_m.begin());
  const double* const wxyz = given->orientation_wxyz;
  if (std::any_of(wxyz, wxyz + 4, [](double part) { return part != 0.0; })) {
    std::copy_n(wxyz, 4, pose.orientation_wxyz.begin());
  }
  return pose;
}

SceneMesh ply_of(const double* vertices_m, std::size_t num_vertices, const std::uint32_t* triangles,
                 std::size_t num_triangles) {
  require_array(vertices_m, num_vertices, "vertices_m");
  require_array(triangles, num_triangles, "triangles");
  const std::string header =
      std::string("ply\nformat binary_") +
      (std::endian::native == std::endian::little ? "little" : "big") +
      "_endian 1.0\nelement vertex " + std::to_string(num_vertices) +
      "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
      std::to_string(num_triangles) + "\nproperty list uchar uint vertex_indices\nend_header\n";
  constexpr std::uint8_t kCorners = 3;
  SceneMesh mesh;
  mesh.format = "ply";
  mesh.bytes.reserve(header.size() + num_vertices * 3 * sizeof(double) +
                     num_triangles * (1 + kCorners * sizeof(std::uint32_t)));
  append(mesh.bytes, header.data(), header.size());
  append(mesh.bytes, vertices_m, num_vertices * 3 * sizeof(double));
  for (std::size_t i = 0; i < num_triangles; ++i) {
    const std::uint32_t* const corners = triangles + kCorners * i;
    for (std::size_t corner = 0; corner < kCorners; ++corner) {
      if (corners[corner] < num_vertices) continue;
      throw Refusal{CAMWAY_INVALID,
                    "triangles[" + std::to_string(i) + "]: " + std::to_string(corners[corner]) +
                        " is no index of " + std::to_string(num_vertices) + " vertices"};
    }
    append(mesh.bytes, &kCorners, 1);
    append(mesh.bytes, corners, kCorners * sizeof(std::uint32_t));
  }
  return mesh;
}

}  // namespace camway::c
