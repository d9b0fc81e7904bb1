// SPDX-License-Identifier: MIT
#ifndef CAMWAY_C_OCCUPANCY_H
#define CAMWAY_C_OCCUPANCY_H

#include <camway/c/client.h>

#ifdef __cplusplus
extern "C" {
#endif

// Queries of the occupancy map of a scene, `count` at a time. The map is conservative: every voxel
// that a triangle touches is occupied, and distances are never too long. CAMWAY_NO_MAP if the scene
// was loaded without a map. The functions wait; their results are undefined unless they return
// CAMWAY_OK. A point is three numbers.

/// Whether the voxel that holds a point is occupied: 1 or 0.
camway_status camway_occupancy_points(camway_client* client, const char* scene,
                                      const double* points_m, size_t count, uint8_t* occupied);
/// Whether an occupied voxel touches the ball.
camway_status camway_occupancy_spheres(camway_client* client, const char* scene,
                                       const double* centers_m, const double* radii_m, size_t count,
                                       uint8_t* occupied);
/// Whether an occupied voxel touches the box, `min <= max` in each axis.
camway_status camway_occupancy_boxes(camway_client* client, const char* scene, const double* min_m,
                                     const double* max_m, size_t count, uint8_t* occupied);
/// Distance along a ray to the first occupied voxel; infinity if none is within its range.
camway_status camway_occupancy_rays(camway_client* client, const char* scene,
                                    const double* origins_m, const double* directions,
                                    const double* ranges_m, size_t count, double* hits_m);
/// Distance to the nearest occupied voxel; infinity if none is within `max_m`.
camway_status camway_occupancy_distances(camway_client* client, const char* scene,
                                         const double* points_m, const double* max_m, size_t count,
                                         double* distances_m);
/// Distance that a ball moves from one point to another until it touches an occupied voxel;
/// infinity if it never does.
camway_status camway_occupancy_moves(camway_client* client, const char* scene, const double* from_m,
                                     const double* to_m, const double* radii_m, size_t count,
                                     double* hits_m);

#ifdef __cplusplus
}
#endif

#endif
