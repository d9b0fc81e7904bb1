// SPDX-License-Identifier: MIT
#ifndef CAMWAY_C_SCAN_H
#define CAMWAY_C_SCAN_H

#include <camway/c/scene.h>

#ifdef __cplusplus
extern "C" {
#endif

/// An occupancy map (OctoMap) without known voxels, to be filled by scans, and the model of the
/// sensor that makes them.
typedef struct camway_scan_map {
  uint32_t struct_size;
  int32_t unknown_is_occupied;  ///< whether voxels that no scan has seen collide; 0
  double resolution_m;          ///< edge of a voxel; has to be set
  double hit_probability;       ///< for a voxel with a point; 0.7, above 0.5
  double miss_probability;      ///< for a voxel seen through; 0.4, below 0.5
  double least_probability;     ///< lower clamp of a voxel; 0.1192, below 0.5
  double most_probability;      ///< upper clamp of a voxel; 0.971, above 0.5
  double max_range_m;  ///< a point beyond it marks free space up to it; 0: no limit, the default
} camway_scan_map;

/// Sets all members to their defaults. `struct_size` is `sizeof(camway_scan_map)`.
camway_status camway_scan_map_init(camway_scan_map* map, size_t struct_size);

// The functions below wait, so handlers must not call them. `answer` may be NULL. It gets a handle
// if the status is CAMWAY_OK, else NULL. A point is three numbers.

/// Adds an object that scans fill, or replaces the object of that name. NULL for `pose` is the
/// origin of the world.
camway_status camway_scene_put_scan_map(camway_client* client, const char* scene,
                                        const char* object, const camway_scan_map* map,
                                        const camway_pose* pose, camway_scene_answer** answer);

/// Inserts a scan into such an object, or into an OctoMap of a file: a sensor at `origin_m` saw
/// `points_m`, in the world. Each scan makes a new revision of the scene.
camway_status camway_scene_insert_scan(camway_client* client, const char* scene, const char* object,
                                       const double* points_m, size_t num_points,
                                       const double origin_m[3], camway_scene_answer** answer);

/// Adds a cloud of points, or replaces the object of that name: each cube of a grid of edge
/// `cell_m` is solid if it holds a point, in the frame of the object.
camway_status camway_scene_put_points(camway_client* client, const char* scene, const char* object,
                                      const double* points_m, size_t num_points, double cell_m,
                                      const camway_pose* pose, camway_scene_answer** answer);

/// Has the daemon write the occupancy map of a scene to a file of OctoMap (".bt") below one of its
/// scene roots.
camway_status camway_scene_export_map(camway_client* client, const char* scene, const char* file,
                                      camway_scene_answer** answer);

#ifdef __cplusplus
}
#endif

#endif
