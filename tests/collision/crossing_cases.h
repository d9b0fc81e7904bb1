// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "daemon/motion/body/camera.h"
#include "daemon/motion/path/path.h"
#include "daemon/scene/mesh/mesh.h"

/// Camera paths and obstacles of which it is known, by construction and in extended precision,
/// whether and when they collide. Shared by the test and by the benchmark-sized campaign.
namespace camway::testing {

/// What kind of crossing a case is.
enum class CrossingFamily : std::uint8_t {
  kThinWall,   ///< a slab of 0.1 mm to 1 cm, or thinner where the camera is tiny
  kZeroPlate,  ///< a wall without any thickness, at any tilt
  kPole,       ///< a prism thinner than any sample step
  kInterior,   ///< a speck that passes through the inside of the quadrilateral
  kParallel,   ///< a plate that lies in the quadrilateral's plane, almost, for one instant
  kOnPiece,    ///< uniform motion, head-on
  kSwing,      ///< a turn on the spot with a corner in front, that meets a wedge head-on
  kGrazeFace,  ///< a plane that the camera's furthest reach passes by a known depth
  kGrazeTip,   ///< the same with the tip or edge of a wedge
  kSpin,       ///< a camera that turns on the spot, and whose corner just reaches a wedge
  kFreeFace,   ///< as kGrazeFace, but short of it by a known clearance
  kFreeTip,    ///< as kGrazeTip, short of it
  kFreeSpin,   ///< as kSpin, short of it
  kFreeSlot,   ///< between two parallel planes, with a known clearance from the nearer
};
inline constexpr std::size_t kCrossingFamilies = 14;
std::string_view to_string(CrossingFamily family);

struct CrossingCase {
  CrossingFamily family = CrossingFamily::kThinWall;
  motion::Camera camera;
  motion::Path path;
  scene::Mesh obstacle;
  /// Resolution to detect with; always well above what rounding leaves at these coordinates.
  double tolerance_m = 0.0;

  /// Whether to look things up in a distance field as well: a share of the cases does.
  bool with_field = false;

  bool collides = false;
  /// Colliding cases: an instant at which obstacle and filled quadrilateral certainly meet; free
  /// cases: one at which they are no further apart than `clearance_below_m`. Exact.
  double known_s = 0.0;
  /// Free cases: the true least distance over the whole path lies between these, and the lower one
  /// is above the tolerance by more than rounding.
  double clearance_above_m = 0.0;
  double clearance_below_m = 0.0;
  /// How often the draw was repeated because the truth could not be certified.
  int redrawn = 0;
};

/// Case `index` of the campaign with that seed; depends on nothing else.
CrossingCase make_crossing_case(std::uint64_t seed, std::uint64_t index);

}  // namespace camway::testing
