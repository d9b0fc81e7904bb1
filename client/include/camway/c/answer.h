// SPDX-License-Identifier: MIT
#ifndef CAMWAY_C_ANSWER_H
#define CAMWAY_C_ANSWER_H

#include <camway/c/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/// The answer to a request for a path. It never changes.
typedef struct camway_answer camway_answer;

camway_status camway_answer_free(camway_answer* answer);

/// Makes another handle of the same answer, for example of one that a handler was given.
camway_status camway_answer_copy(const camway_answer* answer, camway_answer** copy);

typedef struct camway_answer_summary {
  uint32_t struct_size;  ///< bytes that the library has set
  camway_status status;
  int32_t certified;  ///< whether the path is proved free at every instant, rounding included
  int32_t deadline_reached;  ///< whether the deadline left anything undone, whatever the status
  int32_t keyframe;          ///< index of the given keyframe that is at fault; -1: none
  int32_t corrected;         ///< number of collisions that were corrected
  int64_t request_id;
  int64_t scene_revision;  ///< revision of the scene that the answer holds for
  double begin_s;          ///< first and last instant of the path; 0 without a path
  double end_s;
  double clearance_m;  ///< proved lower bound of the distance between body and scene
  double near_scale;   ///< near distance that is proved, divided by the requested one
  double time_scale;   ///< duration of the path divided by the requested one
  double elapsed_s;    ///< time from the call to the answer
  /// Viewing distance of all shifts in the answer; 0: no shift was measured.
  double viewing_distance_m;
} camway_answer_summary;

/// `struct_size` is `sizeof(camway_answer_summary)`.
camway_status camway_answer_summarize(const camway_answer* answer, camway_answer_summary* summary,
                                      size_t struct_size);

/// Returns why there is no proved path, and the remedy, "" if the status is CAMWAY_OK; NULL if the
/// handle is not live.
const char* camway_answer_error(const camway_answer* answer);

/// Returns a sentence of the daemon, also for CAMWAY_OK; NULL if the handle is not live.
const char* camway_answer_message(const camway_answer* answer);

/// The box that the path was planned within, the intersection of the bounds of request and scene.
/// A side without a limit is -infinity or infinity.
camway_status camway_answer_bounds(const camway_answer* answer, double min_m[3], double max_m[3]);

/// Evaluates the path at `count` times: three numbers each into `positions_m`, and four each into
/// `orientations_wxyz`; either may be NULL. A time outside of the path gets its first or last pose.
/// CAMWAY_INVALID if there is no path.
camway_status camway_answer_poses(const camway_answer* answer, const double* times_s, size_t count,
                                  double* positions_m, double* orientations_wxyz);

/// A segment of a path, with the numbers that were proved: with u = (t - t0_s) / (t1_s - t0_s), the
/// position is the cubic Bezier curve of `position_m`, the orientation the Bezier curve of degree 6
/// of `orientation_wxyz`, divided by its length.
typedef struct camway_segment {
  double t0_s;
  double t1_s;
  double position_m[4][3];
  double orientation_wxyz[7][4];
} camway_segment;

/// A pose that the path passes through.
typedef struct camway_path_keyframe {
  double time_s;
  double position_m[3];
  double orientation_wxyz[4];
  int32_t inserted;  ///< whether a correction inserted it
  int32_t repaired;  ///< whether it is a given keyframe that was moved because it collided
} camway_path_keyframe;

/// A time range in which the body collides, and the deepest point that was found in it.
typedef struct camway_collision {
  double t_begin_s;
  double t_end_s;
  int32_t has_witness;  ///< whether the members below are set
  int32_t triangle;     ///< of the scene, from 0; -1 to -6: a side of the bounds
  double time_s;
  double depth_m;  ///< estimated distance that the body has to move to be free
  double point_m[3];
  const char* object;  ///< object of the scene; "" without a name; belongs to the answer
} camway_collision;

/// A given keyframe that collides, or that was repaired.
typedef struct camway_keyframe_fault {
  int32_t keyframe;  ///< index of the given keyframe
  int32_t has_free_pose;
  double depth_m;         ///< estimated distance that the body has to move to be free
  camway_pose free_pose;  ///< nearest free pose that was found
} camway_keyframe_fault;

/// The next functions write the first `capacity` items of a list, and the number of all into
/// `count`. The array may be NULL if `capacity` is 0.
camway_status camway_answer_segments(const camway_answer* answer, camway_segment* segments,
                                     size_t capacity, size_t* count);
camway_status camway_answer_keyframes(const camway_answer* answer, camway_path_keyframe* keyframes,
                                      size_t capacity, size_t* count);
/// Collisions of the path as interpolated, before corrections.
camway_status camway_answer_collisions(const camway_answer* answer, camway_collision* collisions,
                                       size_t capacity, size_t* count);
/// Collisions that remain in the path; none for CAMWAY_OK.
camway_status camway_answer_remaining(const camway_answer* answer, camway_collision* collisions,
                                      size_t capacity, size_t* count);
camway_status camway_answer_keyframe_faults(const camway_answer* answer,
                                            camway_keyframe_fault* faults, size_t capacity,
                                            size_t* count);

#ifdef __cplusplus
}
#endif

#endif
