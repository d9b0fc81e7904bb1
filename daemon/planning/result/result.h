// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/named_enum.h"
#include "daemon/collision/clearance_profile.h"
#include "daemon/collision/interval.h"
#include "daemon/correction/infeasibility/cage_box.h"
#include "daemon/correction/path/correction.h"
#include "daemon/correction/search/shut_in.h"
#include "daemon/geometry/bounds.h"
#include "daemon/motion/path/keyframe.h"
#include "daemon/motion/path/measures.h"
#include "daemon/motion/path/path.h"
#include "daemon/motion/spline/path_frame.h"
#include "daemon/planning/request/enum_names.h"

namespace camway::planning {

enum class Status {
  kOk,  ///< the path is proved free of collision; see the certificate
  /// A path with remaining collisions, which are listed; or free, but beyond the motion limits.
  kPartial,
  kInfeasible,    ///< no path exists, and that was proved
  kTimeout,       ///< the deadline struck first; the best path so far with its remaining collisions
  kInvalid,       ///< the request cannot be planned; the message says which part of it
  kUnknownScene,  ///< no such scene
  kInternalError,  ///< a fault of this program, not of the request
};

constexpr std::array<std::string_view, 7> names_of(Status) {
  return {"ok", "partial", "infeasible", "timeout", "invalid", "unknown_scene", "internal_error"};
}
inline std::string_view to_string(Status status) { return base::name_of(status); }

/// Whether the returned segments, exactly as sent, are proved free of collision. With `kOk` always;
/// with `kPartial` and `kTimeout` only where the path fails nothing but motion limits.
struct Certificate {
  bool certified = false;
  double clearance_lower_bound_m = 0.0;
};

/// Wall-clock times of the stages, in milliseconds. Only these may differ between two runs, unless
/// `PlanResult::deadline_reached`.
struct Timing {
  double load_scene_ms = 0.0;
  double motion_ms = 0.0;
  double detect_ms = 0.0;
  double correct_ms = 0.0;
  double certify_ms = 0.0;
  double total_ms = 0.0;  ///< planning alone, without loading the scene
};

/// Names of a collision's witness, for people.
struct WitnessNames {
  std::string object;   ///< name of the object, or "bounds." and a side; may be empty
  std::string feature;  ///< feature of the body, as named by `motion::Body::feature_name`

  bool operator==(const WitnessNames&) const = default;
};

/// A given keyframe that collides, is nearer to the scene than required, or is beyond the bounds.
struct KeyframeFault {
  std::size_t keyframe = 0;
  double depth_m = 0.0;                   ///< estimated distance by which it has to move to be free
  std::optional<motion::Pose> free_pose;  ///< nearest free pose that was found, if any
  bool leaves_bounds = false;  ///< its deepest contact is with the bounds; not on the wire
};

/// A part of the path that was slowed to meet motion limits.
struct SlowedStretch {
  double t_begin_s = 0.0;
  double t_end_s = 0.0;
  double given_t_begin_s = 0.0;  ///< begin and end of the same part by the times asked for
  double given_t_end_s = 0.0;

  bool operator==(const SlowedStretch&) const = default;
};

/// Proof that there is no path: a closed surface of the scene, with one keyframe inside and another
/// outside. The triangles alone suffice to check it: each edge (by the coordinates of its ends)
/// belongs to an even number of them; a ray from one keyframe meets an odd number of them, from the
/// other an even one. A continuous motion of a connected body from one side to the other touches
/// the surface.
///
/// With `cage`, the proof is a box: the centre of the near quadrilateral is inside it at one
/// keyframe, outside at the other, and can never be on its surface (see `correction::find_cage`).
/// Then the triangles are those that close the faces of the box except for its holes.
struct Infeasibility {
  std::size_t keyframe_inside = 0;
  std::size_t keyframe_outside = 0;
  std::vector<std::uint32_t> triangles;  ///< indices into the scene's mesh, increasing
  std::optional<correction::CageBox> cage = {};
};

struct PlanResult {
  Status status = Status::kInternalError;
  std::string message;  ///< one sentence for a person
  /// Index of the keyframe at fault with kInvalid, or of one from which no way out was found.
  std::optional<std::size_t> keyframe;
  motion::Path path;
  std::vector<motion::Keyframe> keyframes;  ///< given and inserted keyframes with their times
  /// With it, a request with these keyframes has the same path. Nothing where the keyframes alone
  /// give the path, and where nothing does: a slowed path (`planning/stages/path_keyframes.h`).
  std::optional<motion::PathFrame> frame;
  std::vector<collision::CollisionInterval> collisions;            ///< collisions before correction
  std::vector<collision::CollisionInterval> remaining_collisions;  ///< collisions of `path`
  /// Names of the witnesses of the two lists above, one for each interval; empty strings where it
  /// has no witness. Filled in by `name_witnesses`. In a result that was read back from a file or
  /// the wire, a feature is known by this name only, and its number is 0.
  std::vector<WitnessNames> collision_names;
  std::vector<WitnessNames> remaining_names;
  Certificate certificate;
  /// Outcome of each collision; empty where nothing was corrected, and with keyframe insertion.
  std::vector<correction::Correction> corrections;
  /// Measures of the path as interpolated, and of `path`; nothing where they were not computed.
  std::optional<motion::PathMeasures> measures_before;
  std::optional<motion::PathMeasures> measures;
  /// Viewing distance of the shifts in `corrections` and `measures`; nothing where no correction
  /// was found by shifts. [Limit: 0 < value]
  std::optional<double> viewing_distance_m;
  /// Near distance that the proof is for, as a share of the requested one; below 1 only if
  /// `PlanOptions::max_shrink` allows it.
  double near_scale = 1.0;
  /// Bounds that the body had to keep to: those of the request and those of the scene together.
  geometry::Bounds bounds;
  /// Duration of `path` as a multiple of the requested one. To meet motion limits it is slowed in
  /// part or all the way (`planning/stages/slowing.h`); every time of the result is a slowed one.
  double time_scale = 1.0;
  std::vector<SlowedStretch> slowed;  ///< in order of time; times between them are only shifted
  /// Proved clearance of all of `path` by stretches, at most `collision::kMostProfileStretches`;
  /// the least is that of `certificate`. Empty unless the request asks for it, and without a path.
  std::vector<collision::ClearanceStretch> clearance_profile;
  std::vector<KeyframeFault> keyframe_faults;  ///< faults with kInvalid; else the repaired ones
  std::optional<Infeasibility> infeasibility;  ///< set exactly for kInfeasible
  /// Keyframes from which no way out was found; no proof. On the wire only a part of `message`.
  std::vector<correction::ShutIn> shut_in;
  /// Whether the deadline left anything undone, whatever the status. Then, and only then, the next
  /// answer to the same request may differ.
  bool deadline_reached = false;
  /// Whether corrections were found that need more keyframes than the request allows. On the wire
  /// only a part of `message`.
  bool needs_more_keyframes = false;
  Timing timing;
};

}  // namespace camway::planning
