// SPDX-License-Identifier: MIT
#pragma once

#include <camway/path.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace camway {

/// How hard a correction was looked for. 0 where that was not tried at all.
struct Effort {
  std::int32_t directions = 0;      ///< to one side or about an axis, to move or turn the camera
  std::int32_t paths = 0;           ///< changed paths that were checked for collisions
  /// Of lattices and cells, at which there might have been room on a way round.
  std::int32_t lattice_points = 0;
  std::int32_t tree_samples = 0;    ///< poses towards which ways round were looked for that turn
};

/// What became of one collision of the path as interpolated.
struct Correction {
  enum class Method {
    kNone,     ///< it was not corrected
    kMove,     ///< the camera was moved to one side
    kTurn,     ///< it was turned
    kGoRound,  ///< it goes another way
    kShrink,   ///< its near distance was made smaller
  };

  double t_begin_s = 0.0;  ///< the collision
  double t_end_s = 0.0;
  Method method = Method::kNone;
  double changed_t_begin_s = 0.0;  ///< what of the path was changed for it
  double changed_t_end_s = 0.0;
  double moved_m = 0.0;     ///< furthest that the eye is from where it was at the same time
  double turned_rad = 0.0;  ///< most that the camera is turned from how it was
  Effort tried = {};        ///< where it was not corrected
};

/// What a path is like, for comparing paths. Extrema are over samples; no part of any
/// proof but for the clearance.
struct PathMeasures {
  double length_m = 0.0;             ///< of the way of the eye
  double largest_deviation_m = 0.0;  ///< of the eye from the path as interpolated
  double bending_energy_m2_per_s3 = 0.0;
  double largest_speed_m_per_s = 0.0;
  double largest_acceleration_m_per_s2 = 0.0;
  double largest_turn_rate_rad_per_s = 0.0;
  double largest_turn_acceleration_rad_per_s2 = 0.0;
  double clearance_lower_bound_m = 0.0;  ///< of the body; proved; 0 where the path collides
};

/// A stretch of the path that was made slower to meet limits.
struct SlowedStretch {
  double t_begin_s = 0.0;
  double t_end_s = 0.0;
  double given_t_begin_s = 0.0;  ///< when it was to begin and end by the times asked for
  double given_t_end_s = 0.0;
};

/// A given keyframe that collides, or is nearer to the scene than required.
struct KeyframeFault {
  std::int32_t keyframe = 0;
  double depth_m = 0.0;           ///< about how far it would have to move to be free
  std::optional<Pose> free_pose;  ///< the nearest that was found, if any
};

/// A box whose faces are closed but for holes that the camera is too large for. Coordinates are in
/// a frame that has its origin in common with the world's.
struct Cage {
  std::array<double, 4> orientation_wxyz = {1, 0, 0, 0};  ///< from that frame into the world
  std::array<double, 3> min_m = {};
  std::array<double, 3> max_m = {};
  double widest_hole_m = 0.0;     ///< no two points of one hole are further apart
  double shortest_chord_m = 0.0;  ///< of the near quadrilateral, through its centre
};

/// Why there is no path: a closed surface of the scene with one given keyframe inside and another
/// outside, or a cage.
struct Infeasibility {
  std::int32_t keyframe_inside = 0;
  std::int32_t keyframe_outside = 0;
  /// The surface, or what closes the cage: triangles of the scene, increasing.
  std::vector<std::int32_t> triangles;
  std::optional<Cage> cage = {};
};

}  // namespace camway
