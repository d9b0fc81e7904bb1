// SPDX-License-Identifier: MIT
#ifndef CAMWAY_C_MEASURES_H
#define CAMWAY_C_MEASURES_H

#include <camway/c/answer.h>

#ifdef __cplusplus
extern "C" {
#endif

/// Measures for the comparison of paths. Largest values come from samples and may be slightly too
/// small. Only the clearance is proved.
typedef struct camway_path_measures {
  uint32_t struct_size;  ///< bytes that the library has set
  uint32_t reserved;
  double length_m;             ///< of the eye's way
  double largest_deviation_m;  ///< of the eye from the path as interpolated at the same time
  double largest_shift_rad;    ///< shift of the picture from the path as interpolated
  double mean_shift_rad;
  double bending_energy_m2_per_s3;  ///< integral of the squared acceleration
  double largest_speed_m_per_s;
  double largest_acceleration_m_per_s2;
  double largest_turn_rate_rad_per_s;
  double largest_turn_acceleration_rad_per_s2;
  double clearance_m;  ///< proved distance between body and scene; 0 for a path that collides
} camway_path_measures;

/// The measures of the path, and those of the path as interpolated, before corrections.
/// `struct_size` is `sizeof(camway_path_measures)`. CAMWAY_INVALID if the answer has none.
camway_status camway_answer_measures(const camway_answer* answer, camway_path_measures* measures,
                                     size_t struct_size);
camway_status camway_answer_measures_before(const camway_answer* answer,
                                            camway_path_measures* measures, size_t struct_size);

/// How a collision was corrected.
enum {
  CAMWAY_CORRECTION_NONE = 0,
  CAMWAY_CORRECTION_MOVE = 1,      ///< the camera moves to one side
  CAMWAY_CORRECTION_TURN = 2,      ///< the camera turns
  CAMWAY_CORRECTION_GO_ROUND = 3,  ///< the path makes a detour
  CAMWAY_CORRECTION_SHRINK = 4     ///< the near distance is smaller
};

/// The correction of a collision.
typedef struct camway_correction {
  int32_t method;  ///< CAMWAY_CORRECTION_NONE, ...; others may be added
  int32_t reserved;
  double t_begin_s;  ///< time range of the collision
  double t_end_s;
  double changed_t_begin_s;  ///< part of the path that was changed
  double changed_t_end_s;
  double moved_m;            ///< largest distance of the eye from its former position
  double turned_rad;         ///< largest angle of the camera from its former orientation
  double largest_shift_rad;  ///< shift of the picture in the changed part
  double mean_shift_rad;
} camway_correction;

/// Writes the first `capacity` corrections, one for each of `camway_answer_collisions` or none, and
/// the number of all into `count`. The array may be NULL if `capacity` is 0.
camway_status camway_answer_corrections(const camway_answer* answer, camway_correction* corrections,
                                        size_t capacity, size_t* count);

/// A time range of the path that was slowed to meet motion limits; elsewhere times are only
/// shifted.
typedef struct camway_slowed_stretch {
  double t_begin_s;  ///< time range on the answer's path
  double t_end_s;
  double given_t_begin_s;  ///< that time range, by the times of the request
  double given_t_end_s;
} camway_slowed_stretch;

/// Writes the first `capacity` slowed parts of the path, in order of time, and the number of all
/// into `count`. The array may be NULL if `capacity` is 0. `camway_answer_summary::time_scale` is
/// that of the whole path.
camway_status camway_answer_slowed(const camway_answer* answer, camway_slowed_stretch* slowed,
                                   size_t capacity, size_t* count);

/// A stretch of the path with a proved distance between body and scene.
typedef struct camway_clearance_stretch {
  double t_begin_s;
  double t_end_s;
  double clearance_m;  ///< 0 where nothing is proved; at most 100 unless more is required
} camway_clearance_stretch;

/// Writes the first `capacity` stretches, which follow each other without gaps over all of the
/// path, and the number of all into `count`. There are none unless
/// `camway_plan_request::clearance_profile` is set. The array may be NULL if `capacity` is 0.
camway_status camway_answer_clearance_profile(const camway_answer* answer,
                                              camway_clearance_stretch* stretches, size_t capacity,
                                              size_t* count);

/// Wall-clock times of the stages of planning in the daemon, in milliseconds. 0 for a stage that
/// did not run.
typedef struct camway_plan_timing {
  uint32_t struct_size;  ///< bytes that the library has set
  uint32_t reserved;
  double motion_ms;   ///< interpolation and the check of the keyframes
  double detect_ms;   ///< search for collisions
  double correct_ms;  ///< correction
  double certify_ms;  ///< proof of the final path
  double total_ms;
} camway_plan_timing;

/// `struct_size` is `sizeof(camway_plan_timing)`.
camway_status camway_answer_timing(const camway_answer* answer, camway_plan_timing* timing,
                                   size_t struct_size);

#ifdef __cplusplus
}
#endif

#endif
