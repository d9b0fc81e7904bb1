// SPDX-License-Identifier: MIT
#pragma once

#include <camway/path.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace camway {

/// The effort of the searches for one correction. A count is 0 where that search did not run.
struct Effort {
  std::int32_t directions = 0;  ///< directions of motion and axes of rotation that were tried
  std::int32_t paths = 0;       ///< changed paths that were checked for collisions
  /// Lattice points and octree cells that the searches for a way round examined.
  std::int32_t lattice_points = 0;
  /// Random poses of the tree search, which moves and turns the body.
  std::int32_t tree_samples = 0;
};

/// The correction of one collision of the path as interpolated.
struct Correction {
  enum class Method {
    kNone,     ///< the collision was not corrected
    kMove,     ///< the camera moves to one side
    kTurn,     ///< the camera turns
    kGoRound,  ///< the path makes a detour
    kShrink,   ///< the near distance is smaller
  };

  double t_begin_s = 0.0;  ///< begin of the collision
  double t_end_s = 0.0;    ///< end of the collision
  Method method = Method::kNone;
  double changed_t_begin_s = 0.0;  ///< begin of the part of the path that was changed
  double changed_t_end_s = 0.0;    ///< end of the part of the path that was changed
  double moved_m = 0.0;            ///< largest distance of the eye from its former position
  double turned_rad = 0.0;         ///< largest angle of the camera from its former orientation
  double largest_shift_rad = 0.0;  ///< largest shift of the picture in the changed part
  double mean_shift_rad = 0.0;     ///< mean shift of the picture over that part
  /// Effort of the searches; reported only if the collision was not corrected (kNone), otherwise
  /// all zero.
  Effort tried = {};
};

/// Measures for the comparison of paths. Largest values come from samples and may be slightly too
/// small. Only the clearance is proved.
struct PathMeasures {
  double length_m = 0.0;  ///< length of the eye's way
  /// Largest distance of the eye from the path as interpolated at the same time. If the path was
  /// slowed, it is compared with the interpolated path under the same slow-down.
  double largest_deviation_m = 0.0;
  /// Shift of the picture from the path as interpolated: the angle by which a point moves in the
  /// picture that lies at the viewing distance. Before slowing; 0 for "keyframe_insertion".
  double largest_shift_rad = 0.0;
  double mean_shift_rad = 0.0;
  double bending_energy_m2_per_s3 = 0.0;  ///< integral of the squared acceleration
  double largest_speed_m_per_s = 0.0;
  double largest_acceleration_m_per_s2 = 0.0;
  double largest_turn_rate_rad_per_s = 0.0;
  double largest_turn_acceleration_rad_per_s2 = 0.0;
  double clearance_lower_bound_m = 0.0;  ///< proved clearance; 0 for a path that collides
};

/// A time range of the path that was slowed to meet motion limits.
struct SlowedStretch {
  double t_begin_s = 0.0;        ///< begin on the answer's path
  double t_end_s = 0.0;          ///< end on the answer's path
  double given_t_begin_s = 0.0;  ///< begin by the times of the request
  double given_t_end_s = 0.0;    ///< end by the times of the request
};

/// A time range of the path with a proved lower bound of the distance between body and scene.
struct ClearanceStretch {
  double t_begin_s = 0.0;
  double t_end_s = 0.0;
  double clearance_m = 0.0;  ///< 0 where nothing is proved; at most 100 unless more is required
};

/// A given keyframe at which the body collides, is nearer to the scene than the required clearance,
/// or leaves its bounds.
struct KeyframeFault {
  std::int32_t keyframe = 0;      ///< index of the given keyframe
  double depth_m = 0.0;           ///< estimated distance that the body has to move to be free
  std::optional<Pose> free_pose;  ///< nearest free pose that was found, if any
};

/// A box whose faces have no hole that the near quadrilateral can pass, in any orientation.
/// Coordinates are in a rotated frame with the world's origin.
struct Cage {
  /// Rotates vectors of that frame into the world.
  std::array<double, 4> orientation_wxyz = {1, 0, 0, 0};
  std::array<double, 3> min_m = {};
  std::array<double, 3> max_m = {};
  double widest_hole_m = 0.0;  ///< upper bound of the distance between two points of one hole
  /// Shortest chord through the centre of the near quadrilateral; more than `widest_hole_m`.
  double shortest_chord_m = 0.0;
};

/// A proof that there is no path: a closed surface of the scene with one given keyframe inside and
/// another outside, or a cage: the centre of the near quadrilateral is inside it at
/// `keyframe_inside` and outside it at `keyframe_outside`.
struct Infeasibility {
  std::int32_t keyframe_inside = 0;   ///< index of the given keyframe inside
  std::int32_t keyframe_outside = 0;  ///< index of the given keyframe outside
  /// Triangles of the closed surface, or those that close the faces of the cage except for its
  /// holes. Indices into the scene, increasing.
  std::vector<std::int32_t> triangles;
  std::optional<Cage> cage = {};  ///< unset if the proof is a closed surface
};

}  // namespace camway
