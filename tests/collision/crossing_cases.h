// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "daemon/motion/body/camera.h"
#include "daemon/motion/path/path.h"
#include "daemon/scene/mesh/mesh.h"

/// Camera paths and obstacles for which it is known, by construction and in extended precision,
/// whether and when they collide. The test and the benchmark campaign share them.
namespace camway::testing {

/// The kind of crossing of a case.
enum class CrossingFamily : std::uint8_t {
  kThinWall,   ///< a slab of 0.1 mm to 1 cm, or thinner for a tiny camera
  kZeroPlate,  ///< a wall without thickness, at any tilt
  kPole,       ///< a prism thinner than any sample step
  kInterior,   ///< a small triangle that passes through the inside of the quadrilateral
  kParallel,   ///< a plate that lies almost in the quadrilateral's plane for one instant
  kOnPiece,    ///< uniform motion, head-on
  kSwing,      ///< a rotation about the eye whose corner meets a wedge head-on
  kGrazeFace,  ///< a plane that the furthest point of the sweep passes by a known depth
  kGrazeTip,   ///< the tip or edge of a wedge that this point passes by a known depth
  kSpin,       ///< a rotation about the eye whose corner just reaches a wedge
  kFreeFace,   ///< like kGrazeFace, but with a known clearance
  kFreeTip,    ///< like kGrazeTip, but with a known clearance
  kFreeSpin,   ///< like kSpin, but with a known clearance
  kFreeSlot,   ///< a path between two parallel planes, with a known clearance from the nearer one
};
inline constexpr std::size_t kCrossingFamilies = 14;
std::string_view to_string(CrossingFamily family);

struct CrossingCase {
  CrossingFamily family = CrossingFamily::kThinWall;
  motion::Camera camera;
  motion::Path path;
  scene::Mesh obstacle;
  /// Tolerance of the detection, always well above the rounding at these coordinates.
  double tolerance_m = 0.0;

  /// Whether detection uses a distance field, as in a fraction of the cases.
  bool with_field = false;

  bool collides = false;
  /// Colliding cases: an instant at which obstacle and filled quadrilateral certainly meet. Free
  /// cases: an instant at which their distance is at most `clearance_below_m`. Exact.
  double known_s = 0.0;
  /// Free cases: bounds of the true least distance over the whole path. The lower one exceeds the
  /// tolerance by more than rounding.
  double clearance_above_m = 0.0;
  double clearance_below_m = 0.0;
  /// How often the case was drawn again because its truth could not be certified.
  int redrawn = 0;
};

/// Returns case `index` of the campaign with this seed. It depends on nothing else.
CrossingCase make_crossing_case(std::uint64_t seed, std::uint64_t index);

}  // namespace camway::testing
