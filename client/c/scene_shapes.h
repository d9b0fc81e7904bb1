// SPDX-License-Identifier: MIT
#pragma once

#include <camway/camway.h>
#include <camway/scene.h>

#include <cstddef>
#include <cstdint>

namespace camway::c {

camway_mesh_file default_mesh_file();

/// Returns the file of a caller. Throws `Refusal` if it is NULL or wrong in form.
SceneMesh mesh_of(const camway_mesh_file* given);

/// Returns a pose; the origin for NULL, and no rotation for a quaternion of zeros.
Pose pose_of(const camway_pose* given);

/// Returns a mesh as a binary PLY file, whose numbers are those of the caller bit for bit. Throws
/// `Refusal` if an array is missing or an index is out of range.
SceneMesh ply_of(const double* vertices_m, std::size_t num_vertices, const std::uint32_t* triangles,
                 std::size_t num_triangles);

}  // namespace camway::c
