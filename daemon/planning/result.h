// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/named_enum.h"
#include "daemon/collision/interval.h"
#include "daemon/correction/infeasibility/cage_box.h"
#include "daemon/correction/path/correction.h"
#include "daemon/correction/search/shut_in.h"
#include "daemon/geometry/bounds.h"
#include "daemon/motion/path/keyframe.h"
#include "daemon/motion/path/measures.h"
#include "daemon/motion/path/path.h"

namespace camway::planning {

enum class Status {
  kOk,       ///< the path is proved free of collision; see the certificate
  kPartial,  ///< a path, but with the remaining collisions listed; or free, but beyond the limits
  kInfeasible,     ///< no path exists, and that was proved
  kTimeout,        ///< the deadline came first; the best path so far with its remaining collisions
  kInvalid,        ///< the request cannot be planned; the message says which part of it
  kUnknownScene,   ///< no such scene
  kInternalError,  ///< our fault
};

constexpr std::array<std::string_view, 7> names_of(Status) {
  return {"ok", "partial", "infeasible", "timeout", "invalid", "unknown_scene", "internal_error"};
}
inline std::string_view to_string(Status status) { return base::name_of(status); }
inline std::optional<Status> status_from_string(std::string_view text) {
  return base::value_of<Status>(text);
}

/// What is proved about the returned segments, exactly as sent. With `kOk` always; with `kPartial`
/// and `kTimeout` only where nothing but limits of the motion is not met.
struct Certificate {
  bool certified = false;
  double clearance_lower_bound_m = 0.0;
};

/// Wall-clock milliseconds. The only part of a result that may differ between two runs, unless
/// `PlanResult::deadline_reached`.
struct Timing {
  double load_scene_ms = 0.0;
  double motion_ms = 0.0;
  double detect_ms = 0.0;
  double correct_ms = 0.0;
  double certify_ms = 0.0;
  double total_ms = 0.0;  ///< planning alone, scene loading apart
};

/// What the witness of a collision is called, for people.
struct WitnessNames {
  std::string object;   ///< of the scene; empty if it has no name
  std::string feature;  ///< of the body, as `motion::Body::feature_name`

  bool operator==(const WitnessNames&) const = default;
};

/// A given keyframe that collides, is nearer to the scene than required, or beyond the bounds.
struct KeyframeFault {
  std::size_t keyframe = 0;
  double depth_m = 0.0;                   ///< estimate of how far it would have to move to be free
  std::optional<motion::Pose> free_pose;  ///< the nearest that was found, if any
  bool leaves_bounds = false;  ///< it is the bounds that it is deepest in; not on the wire
};

/// A stretch of the path that was made slower to meet limits.
struct SlowedStretch {
  double t_begin_s = 0.0;
  double t_end_s = 0.0;
  double given_t_begin_s = 0.0;  ///< when it was to begin and end by the times asked for
  double given_t_end_s = 0.0;

  bool operator==(const SlowedStretch&) const = default;
};

/// Why there is no path: a closed surface of the scene, with one keyframe inside and another
/// outside. Whoever wants to check it needs the triangles alone: each edge (by the coordinates of
/// its ends) has an even number of them, and a ray from one keyframe meets an odd number, from the
/// other an even one. No continuous motion of a connected body gets from one side to the other
/// without touching it.
///
/// Or, with `cage`, a box that the centre of the near quadrilateral is inside of at the one
/// keyframe and outside at the other, and never on: `correction::find_cage` says why. Then the
/// triangles are those of what closes the faces of the box but for its holes.
struct Infeasibility {
  std::size_t keyframe_inside = 0;
  std::size_t keyframe_outside = 0;
  std::vector<std::uint32_t> triangles;  ///< indices into the scene's mesh, increasing
  std::optional<correction::CageBox> cage = {};
};

struct PlanResult {
  Status status = Status::kInternalError;
  std::string message;  ///< one sentence for a person
  /// Index of the keyframe at fault: for kInvalid; or from which no way out was found.
  std::optional<std::size_t> keyframe;
  motion::Path path;
  std::vector<motion::Keyframe> keyframes;  ///< given and inserted ones, with their times
  std::vector<collision::CollisionInterval> collisions;            ///< before correction
  std::vector<collision::CollisionInterval> remaining_collisions;  ///< of `path`
  /// Names for the witnesses of the two lists above, one for each interval, empty strings where it
  /// has no witness; see `name_witnesses`. In a result that was read back from a file or the wire,
  /// the name of a feature stands here alone, and its number is 0.
  std::vector<WitnessNames> collision_names;
  std::vector<WitnessNames> remaining_names;
  Certificate certificate;
  /// What became of each collision; empty where nothing was corrected, and with the seed's method.
  std::vector<correction::Correction> corrections;
  /// Of the path as interpolated, and of `path`; nothing where there is none.
  std::optional<motion::PathMeasures> measures_before;
  std::optional<motion::PathMeasures> measures;
  /// The near distance that the proof is for, as a share of the one asked for; below 1 only if
  /// `PlanOptions::max_shrink` allowed it.
  double near_scale = 1.0;
  /// What the body had to stay within: the bounds of the request and those of the scene together.
  geometry::Bounds bounds;
  /// How many times as long `path` takes as was asked for, to meet limits. It is slower where it
  /// has to be, or all the way (`planning/limits.h`); every time of the result is a new one.
  double time_scale = 1.0;
  std::vector<SlowedStretch> slowed;  ///< where that was, in order of time; beyond, times are moved
  std::vector<KeyframeFault> keyframe_faults;  ///< for kInvalid, or what was repaired
  std::optional<Infeasibility> infeasibility;  ///< set exactly for kInfeasible
  /// Keyframes from which no way out was found; no proof. Part of the message elsewhere.
  std::vector<correction::ShutIn> shut_in;
  /// Whether anything was left undone because of the deadline, of whatever status: then, and only
  /// then, the answer to the same request may be another one the next time.
  bool deadline_reached = false;
  Timing timing;
};

}  // namespace camway::planning
