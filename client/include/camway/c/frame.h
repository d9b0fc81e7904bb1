// SPDX-License-Identifier: MIT
#ifndef CAMWAY_C_FRAME_H
#define CAMWAY_C_FRAME_H

#include <camway/c/answer.h>

#ifdef __cplusplus
extern "C" {
#endif

/// First derivatives of a path at one of its ends.
typedef struct camway_path_end {
  double velocity_m_per_s[3];
  double image_rate_per_s[4];
} camway_path_end;

/// The part of a corrected path that its keyframes do not determine. A request with the keyframes
/// of an answer, their images and its frame has the same path; edit some of the keyframes to change
/// it there. The numbers of frames and images are not meant to be edited.
typedef struct camway_path_frame {
  double reference_wxyz[4];
  camway_path_end begin;
  camway_path_end end;
} camway_path_frame;

/// The frame for `camway_plan_request::frame`. CAMWAY_INVALID if the answer has none: nothing was
/// corrected, the path was slowed, or the method was "keyframe_insertion".
camway_status camway_answer_frame(const camway_answer* answer, camway_path_frame* frame);

/// Writes the images for `camway_plan_request::images`, four numbers for each of the first
/// `capacity` items of `camway_answer_keyframes`, and the number of all keyframes into `count`.
/// They are zero without a frame. The array may be NULL if `capacity` is 0.
camway_status camway_answer_images(const camway_answer* answer, double* images, size_t capacity,
                                   size_t* count);

#ifdef __cplusplus
}
#endif

#endif
