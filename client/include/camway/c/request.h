// SPDX-License-Identifier: MIT
#ifndef CAMWAY_C_REQUEST_H
#define CAMWAY_C_REQUEST_H

#include <camway/c/frame.h>

#ifdef __cplusplus
extern "C" {
#endif

/// A pose that the path must pass through.
typedef struct camway_keyframe {
  double time_s;  ///< does not count where `camway_plan_request::untimed` is set
  double position_m[3];
  double orientation_wxyz[4];  ///< of any length but zero
} camway_keyframe;

/// The shape that moves along the path. Coordinates are metres in the camera's frame.
typedef int32_t camway_body_shape;
enum {
  CAMWAY_BODY_CAMERA = 0,     ///< the near quadrilateral of the request's camera
  CAMWAY_BODY_BOX = 1,        ///< a solid box along the camera's axes: `center_m`, `size_m`
  CAMWAY_BODY_SPHERE = 2,     ///< a solid ball: `center_m`, `radius_m`
  CAMWAY_BODY_CONVEX = 3,     ///< solid convex hulls: `vertices_m`, `piece_sizes`
  CAMWAY_BODY_MESH = 4,       ///< a surface without an inside: `vertices_m`, `triangles`
  CAMWAY_BODY_SOLID_MESH = 5  ///< a closed surface and its inside: `vertices_m`, `triangles`
};

/// A body. Only the members that `shape` names count.
typedef struct camway_body {
  uint32_t struct_size;
  camway_body_shape shape;
  double center_m[3];
  double size_m[3];  ///< full edge lengths
  double radius_m;
  const double* vertices_m;  ///< x, y, z of each vertex
  size_t num_vertices;
  const int32_t* triangles;  ///< three indices of vertices each, from 0
  size_t num_triangles;
  const uint32_t* piece_sizes;  ///< vertices of each convex piece, which follow each other
  size_t num_pieces;
} camway_body;

/// Sets all members to their defaults. `struct_size` is `sizeof(camway_body)`.
camway_status camway_body_init(camway_body* body, size_t struct_size);

/// The quantity that corrections optimise.
enum { CAMWAY_CLOSEST = 0, CAMWAY_SHORTEST = 1, CAMWAY_SMOOTHEST = 2, CAMWAY_SAFEST = 3 };

/// The changes of orientation that corrections may make.
enum {
  CAMWAY_ORIENTATION_FREE = 0,
  CAMWAY_ORIENTATION_KEEP = 1,   ///< none
  CAMWAY_ORIENTATION_LEVEL = 2,  ///< the horizon does not tilt: `up`
  CAMWAY_ORIENTATION_TARGET =
      3  ///< the view stays within a cone about a point: `target_m`, `cone_rad`
};

/// A request for a path. docs/requests.md describes the options; 0 stands for the daemon's default
/// unless something else is said here.
typedef struct camway_plan_request {
  uint32_t struct_size;
  int32_t untimed;    ///< whether keyframes have no times: `default_speed_m_per_s` makes them
  const char* scene;  ///< name of a scene that the daemon holds
  const camway_keyframe* keyframes;
  size_t num_keyframes;
  const camway_body* body;  ///< the moving body; NULL: the camera's near quadrilateral
  double fov_x_rad;         ///< full horizontal field of view; 90 degrees
  double fov_y_rad;         ///< full vertical field of view; 60 degrees
  double near_m;            ///< distance from the eye to the near plane; 0.1

  double clearance_m;  ///< required distance between body and scene
  double deadline_s;   ///< from the daemon's receipt to its answer, waiting included
  double default_speed_m_per_s;
  double viewing_distance_m;
  double interval_tolerance_m;
  double max_shrink;         ///< largest fraction by which the near distance may shrink
  double progress_period_s;  ///< time between two reports of progress; 0: 0.5

  double max_speed_m_per_s;  ///< motion limits; 0: none
  double max_acceleration_m_per_s2;
  double max_turn_rate_rad_per_s;
  double bounds_min_m[3];  ///< box that the body must not leave; -infinity: no limit, the default
  double bounds_max_m[3];  ///< upper sides of that box; infinity: no limit, the default

  double up[3];
  double target_m[3];
  double cone_rad;
  double max_turn_rad;  ///< of corrections; negative: no limit, the default

  const char* method;      ///< NULL: the daemon's default
  int64_t least_revision;  ///< the answer must be for this revision of the scene or a later one
  int64_t seed;
  int32_t objective;               ///< CAMWAY_CLOSEST, ...
  int32_t orientation;             ///< CAMWAY_ORIENTATION_FREE, ...
  int32_t priority;                ///< -1 low, 0 normal, 1 high
  int32_t may_retime;              ///< whether the path may be slowed to meet motion limits
  int32_t max_inserted_keyframes;  ///< negative: the daemon's default; 0: nothing is corrected
  int32_t repair_keyframes;  ///< whether keyframes that collide are moved to the nearest free pose

  /// Frame of the answer whose keyframes these are, as they were or edited; NULL: none. The
  /// keyframes have times then.
  const camway_path_frame* frame;
  /// Four numbers for each keyframe: those of `camway_answer_images`, zero for keyframes that are
  /// new. All are zero without a frame. NULL: all zero, the default.
  const double* images;
  int32_t clearance_profile;  ///< whether the answer has a profile of the clearance
  int32_t reserved;           ///< 0
} camway_plan_request;

/// Sets all members to their defaults. `struct_size` is `sizeof(camway_plan_request)`.
camway_status camway_plan_request_init(camway_plan_request* request, size_t struct_size);

#ifdef __cplusplus
}
#endif

#endif
