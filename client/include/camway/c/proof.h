// SPDX-License-Identifier: MIT
#ifndef CAMWAY_C_PROOF_H
#define CAMWAY_C_PROOF_H

#include <camway/c/answer.h>

#ifdef __cplusplus
extern "C" {
#endif

/// A box whose faces have no hole that the near quadrilateral can pass, in any orientation.
/// Coordinates are in a rotated frame with the world's origin.
typedef struct camway_cage {
  double orientation_wxyz[4];  ///< rotates vectors of that frame into the world
  double min_m[3];
  double max_m[3];
  double widest_hole_m;     ///< upper bound of the distance between two points of one hole
  double shortest_chord_m;  ///< through the centre of the near quadrilateral; above `widest_hole_m`
} camway_cage;

/// The barrier of a proof. The body is inside at one given keyframe, and outside at another.
enum {
  CAMWAY_PROOF_SURFACE = 0,  ///< a closed surface of the scene
  CAMWAY_PROOF_CAGE = 1      ///< a box that the centre of the near quadrilateral cannot leave
};

/// A proof that there is no path.
typedef struct camway_infeasibility {
  uint32_t struct_size;      ///< bytes that the library has set
  int32_t proof;             ///< CAMWAY_PROOF_SURFACE, ...; others may be added
  int32_t keyframe_inside;   ///< index of the given keyframe inside
  int32_t keyframe_outside;  ///< index of the given keyframe outside
  camway_cage cage;          ///< CAMWAY_PROOF_CAGE; else zero
} camway_infeasibility;

/// The proof of CAMWAY_INFEASIBLE; `camway_answer_message` says it in words. `struct_size` is
/// `sizeof(camway_infeasibility)`. CAMWAY_INVALID if the answer has no proof.
camway_status camway_answer_infeasibility(const camway_answer* answer,
                                          camway_infeasibility* infeasibility, size_t struct_size);

/// Writes the first `capacity` triangles of the closed surface, or of those that close the faces of
/// the cage except for its holes, and the number of all into `count`; none without a proof. They
/// are indices into the scene, from 0, increasing. The array may be NULL if `capacity` is 0.
camway_status camway_answer_proof_triangles(const camway_answer* answer, int32_t* triangles,
                                            size_t capacity, size_t* count);

#ifdef __cplusplus
}
#endif

#endif
