// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <span>

#include "daemon/base/deadline.h"
#include "daemon/correction/narrow/hole_line.h"
#include "daemon/correction/path/guide.h"

namespace camway::correction {

/// A narrow place of a way, and a line through it that has room.
struct LinePlace {
  HoleLine line;
  std::array<geometry::Vec3, 4> shifts_W;  ///< shifts from the line at which the body is tried
  std::span<const geometry::Vec3> way_W;   ///< the part of the way through the narrow place
  double farthest_m = 0.0;                 ///< largest motion along the line to either side
};

/// Finds motions along a line through a narrow place on which the body turns little from the
/// interpolated path. When the body passes is open, so its turn is the angle to the nearest
/// orientation that the interpolated path ever has.
///
/// Refers to all that it is made of, which must outlive it. Not thread-safe.
class LeastTurn {
 public:
  /// `from` and `to`: the poses at the ends, whose signs the motions have. `interpolated`: poses of
  /// the interpolated path at equal steps in time. Motions are proved free with `margin_m` beyond
  /// the required clearance. [Limit: `interpolated` has two poses or more]
  LeastTurn(FreeSpace& space, const motion::SignedPose& from, const motion::SignedPose& to,
            std::span<const motion::Pose> interpolated, double margin_m,
            const base::Deadline& deadline);

  /// Returns a motion on which the body is not turned at all; nothing if none was found.
  [[nodiscard]] std::optional<Guide> unturned(const LinePlace& place);

  /// Returns `found`, a motion through the narrow place, or one that turns less. Orientations
  /// between that of `found` and the nearest of the interpolated path are tried by bisection. Where
  /// the turn stays large, orientations of the interpolated path are turned about the axes of the
  /// camera frame, by more and more. If none of them fits, scaled-down bodies with these
  /// orientations grow in the narrow place (`centering.h`), turned as their contacts ask for.
  [[nodiscard]] Guide reduced(const LinePlace& place, Guide found);

 private:
  /// The nearest orientation that the interpolated path has.
  [[nodiscard]] geometry::Quat nearest(const geometry::Quat& orientation) const;
  [[nodiscard]] double turn_rad(const Guide& guide) const;
  /// A straight motion with one orientation, with the middle of the body on the line or beside it.
  [[nodiscard]] std::optional<Guide> straight(const LinePlace& place,
                                              const geometry::Quat& orientation);
  [[nodiscard]] std::optional<Guide> straight_from(const LinePlace& place,
                                                   const motion::Pose& pose);
  [[nodiscard]] Guide turned_back(const LinePlace& place, Guide found);
  [[nodiscard]] std::optional<Guide> turned_little(const LinePlace& place, double most_rad);
  [[nodiscard]] std::optional<Guide> grown(const LinePlace& place);

  FreeSpace& space_;
  const motion::SignedPose& from_;
  const motion::SignedPose& to_;
  const std::span<const motion::Pose> interpolated_;
  const double margin_m_;
  const base::Deadline& deadline_;
};

}  // namespace camway::correction
