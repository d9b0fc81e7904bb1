// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "daemon/base/named_enum.h"
#include "daemon/correction/path/constraints.h"
#include "daemon/geometry/bounds.h"
#include "daemon/planning/request/enum_names.h"

namespace camway::planning {

/// How a colliding path is corrected.
enum class Method {
  kLadder,             ///< kinds of correction, cheapest first
  kKeyframeInsertion,  ///< the paper's method: Ptacek & Johnstone 2006, section 4
};

constexpr std::array<std::string_view, 2> names_of(Method) {
  return {"ladder", "keyframe_insertion"};
}
inline std::string_view to_string(Method method) { return base::name_of(method); }

/// Ends of ranges.
inline constexpr double kMaxCoordinate_m = 1e9;  ///< doubles still resolve 0.1 micrometre there
/// A finer tessellation takes seconds and adds nothing, since the final check does not depend on
/// it.
inline constexpr double kLeastChordError_m = 1e-5;
inline constexpr double kLeastIntervalTolerance_m = 1e-9;  ///< rounding far from the origin
inline constexpr double kMostIntervalTolerance_m = kMaxCoordinate_m;  ///< squares must not overflow
/// Range of speeds from which times may be derived. A speed beyond it is a mistake of units.
inline constexpr double kLeastDefaultSpeed_m_per_s = 1e-6;
inline constexpr double kMostDefaultSpeed_m_per_s = 1e6;

/// The options of a request. Every default works.
struct PlanOptions {
  Method method = Method::kLadder;
  /// Planning stops after this time and answers `timeout` with the path that it has. The check of
  /// that path may take a second more. [Limit: 0 < value] [Units: seconds]
  double deadline_s = 10.0;
  /// Largest distance of the tessellated swept surface from the true one.
  /// [Limit: kLeastChordError_m <= value] [Units: metres]
  double chord_error_m = 0.005;
  /// The ends of collision intervals are bracketed to within this much motion of a corner.
  /// [Limit: kLeastIntervalTolerance_m <= value <= kMostIntervalTolerance_m] [Units: metres]
  double interval_tolerance_m = 1e-3;
  /// Required clearance: the body collides where it is nearer to the scene than this.
  /// [Limit: 0 <= value <= kMaxCoordinate_m] [Units: metres]
  double clearance_m = 0.0;
  /// Bounds that no point of the body may leave, in addition to those of the scene. `clearance_m`
  /// does not apply to them. [Limit: finite ones are below kMaxCoordinate_m; min < max]
  geometry::Bounds bounds = {};
  /// Largest number of keyframes that the corrections of a request may insert. With 0 neither the
  /// path nor, by `max_shrink`, the camera is corrected; keyframes are repaired and times moved all
  /// the same, if the request asks for that. [Limit: 0 <= value]
  std::int32_t max_inserted_keyframes = 2000;
  correction::Objective objective = correction::Objective::kClosest;
  correction::OrientationPolicy orientation;
  correction::MotionLimits limits;
  /// Largest share by which the near distance may be reduced where no other correction succeeds.
  /// Cameras only. [Limit: 0 <= value < 1]
  double max_shrink = 0.0;
  /// Moves given keyframes that collide to the nearest free pose instead of refusing the request.
  bool repair_keyframes = false;
  bool clearance_profile = false;  ///< adds `PlanResult::clearance_profile`
  std::uint64_t seed = 1;  ///< random seed of the searches for ways round [Limit: 1 <= value]
  /// Speed along the chords from which times are derived; if not set,
  /// motion::kNominalSpeed_m_per_s. Refused where keyframes have times.
  /// [Limit: kLeastDefaultSpeed_m_per_s <= value <= kMostDefaultSpeed_m_per_s]
  std::optional<double> default_speed_m_per_s;
  /// Distance of what the picture shows: corrections weigh moves against turns by it. If not set,
  /// it is taken from the scene. [Limit: 0 < value <= kMaxCoordinate_m] [Units: metres]
  std::optional<double> viewing_distance_m;

  bool operator==(const PlanOptions&) const = default;
};

}  // namespace camway::planning
