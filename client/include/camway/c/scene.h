// SPDX-License-Identifier: MIT
#ifndef CAMWAY_C_SCENE_H
#define CAMWAY_C_SCENE_H

#include <camway/c/client.h>

#ifdef __cplusplus
extern "C" {
#endif

/// The answer to a call about scenes.
typedef struct camway_scene_answer camway_scene_answer;

camway_status camway_scene_answer_free(camway_scene_answer* answer);

/// A scene that the daemon holds.
typedef struct camway_scene_info {
  uint32_t struct_size;  ///< bytes that the library has set
  uint32_t reserved;
  const char* name;
  const char* digest;  ///< equal scenes have equal digests
  int64_t revision;    ///< increases with every change; for `camway_plan_request::least_revision`
  int64_t num_triangles;
  double bounds_min_m[3];  ///< bounding box of the triangles
  double bounds_max_m[3];
  double occupancy_resolution_m;  ///< edge of a voxel of the occupancy map; 0: no map
} camway_scene_info;

/// An object of a scene.
typedef struct camway_object_info {
  uint32_t struct_size;  ///< bytes that the library has set
  uint32_t reserved;
  const char* name;
  const char* kind;    ///< "mesh", "box", "sphere", "cylinder", "point cloud", "occupancy map"
  const char* digest;  ///< of its triangles in the world
  int64_t num_triangles;
  camway_pose pose;
  double bounds_min_m[3];  ///< bounding box in the world
  double bounds_max_m[3];
} camway_object_info;

/// The scene after a change. `struct_size` is `sizeof(camway_scene_info)`.
camway_status camway_scene_answer_scene(const camway_scene_answer* answer, camway_scene_info* scene,
                                        size_t struct_size);
/// Warnings of the import of a file, "" without any; NULL if the handle is not live.
const char* camway_scene_answer_message(const camway_scene_answer* answer);

/// Number of scenes or objects in a list, and one of them: CAMWAY_INVALID beyond its end.
camway_status camway_scene_answer_num_scenes(const camway_scene_answer* answer, size_t* count);
camway_status camway_scene_answer_scene_at(const camway_scene_answer* answer, size_t index,
                                           camway_scene_info* scene, size_t struct_size);
camway_status camway_scene_answer_num_objects(const camway_scene_answer* answer, size_t* count);
camway_status camway_scene_answer_object_at(const camway_scene_answer* answer, size_t index,
                                            camway_object_info* object, size_t struct_size);

/// A mesh, an OctoMap or a cloud of points in a format that Camway reads.
typedef struct camway_mesh_file {
  uint32_t struct_size;
  int32_t up;            ///< 0: axes as in the file; 1: Z up to Y up; 2: Y up to Z up
  const char* file;      ///< path relative to a scene root of the daemon; NULL: `bytes`
  const uint8_t* bytes;  ///< content of a file
  size_t num_bytes;
  const char* format;  ///< file extension for `bytes`: "obj", "ply", "glb", ...
  double scale;        ///< metres per unit of the file; 1
  double voxel_m;      ///< edge of the voxels of a cloud of points; 0: chosen from its points
} camway_mesh_file;

/// Sets all members to their defaults. `struct_size` is `sizeof(camway_mesh_file)`.
camway_status camway_mesh_file_init(camway_mesh_file* mesh, size_t struct_size);

// In all functions below `answer` may be NULL. It gets a handle if the status is CAMWAY_OK, else
// NULL. They wait, so handlers must not call them.

/// Lists all scenes, or all objects of one, in order of name.
camway_status camway_scene_list(camway_client* client, camway_scene_answer** answer);
camway_status camway_scene_describe(camway_client* client, const char* scene,
                                    camway_scene_answer** answer);

/// Makes or replaces a scene. NULL for `mesh` makes an empty one. With a resolution (0: none), the
/// scene has an occupancy map of such voxels.
camway_status camway_scene_load(camway_client* client, const char* scene,
                                const camway_mesh_file* mesh, double occupancy_resolution_m,
                                camway_scene_answer** answer);
camway_status camway_scene_unload(camway_client* client, const char* scene,
                                  camway_scene_answer** answer);

/// Each `put` function adds an object to a scene, or replaces the one of that name. NULL for `pose`
/// is the origin of the world.
camway_status camway_scene_put_box(camway_client* client, const char* scene, const char* object,
                                   const double size_m[3], const camway_pose* pose,
                                   camway_scene_answer** answer);
camway_status camway_scene_put_sphere(camway_client* client, const char* scene, const char* object,
                                      double radius_m, const camway_pose* pose,
                                      camway_scene_answer** answer);
/// The axis of a cylinder is its z axis; its origin is the middle.
camway_status camway_scene_put_cylinder(camway_client* client, const char* scene,
                                        const char* object, double radius_m, double height_m,
                                        const camway_pose* pose, camway_scene_answer** answer);
camway_status camway_scene_put_file(camway_client* client, const char* scene, const char* object,
                                    const camway_mesh_file* mesh, const camway_pose* pose,
                                    camway_scene_answer** answer);
/// A mesh of an engine: x, y, z of each vertex, and three indices of vertices for each triangle.
camway_status camway_scene_put_triangles(camway_client* client, const char* scene,
                                         const char* object, const double* vertices_m,
                                         size_t num_vertices, const uint32_t* triangles,
                                         size_t num_triangles, const camway_pose* pose,
                                         camway_scene_answer** answer);

camway_status camway_scene_move(camway_client* client, const char* scene, const char* object,
                                const camway_pose* pose, camway_scene_answer** answer);
camway_status camway_scene_remove(camway_client* client, const char* scene, const char* object,
                                  camway_scene_answer** answer);

/// Ends all calls about scenes that other threads wait in: with CAMWAY_CANCELLED, or with their
/// answer if the change was made already.
camway_status camway_scene_cancel_calls(camway_client* client);

#ifdef __cplusplus
}
#endif

#endif
